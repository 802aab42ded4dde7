"""The shapes of a series of photographs: what agrees, one table, and what the user should know."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pandas as pd

from .result import Track
from .shape import NO_BOARD, NO_MARKER, ShapeReading

SAME_WIDTH = 0.12
"""Relative difference of width at which an outline is taken for something else."""

SAME_START_MM = 4.0
"""Distance within which two outlines start at the same place of the clamp."""

AT_REST_KPA = 5.0
LENGTH_TOLERANCE = 0.08
"""Relative difference of length that a mould, a clamp or a small pressure does not explain."""

SHAPE_COLUMNS = [
    "pressure_kPa",
    "photo",
    "point",
    "arc_mm",
    "x_mm",
    "y_mm",
    "heading_deg",
    "curvature_per_mm",
    "width_mm",
    "tip_angle_deg",
    "sigma_across_mm",
    "sigma_heading_deg",
    "sigma_tip_angle_deg",
]


def agreeing_shapes(readings: Sequence[ShapeReading]) -> tuple[ShapeReading, ...]:
    """Take back shapes that contradict the others: of another width, or leaving the clamp elsewhere.

    The clamp may slip during a test, so one other shape that starts at the same place is enough.
    """
    shapes = [reading.shape for reading in readings if reading.shape is not None]
    if len(shapes) < 3:
        return tuple(readings)
    usual = float(np.median([np.median(shape.width_mm) for shape in shapes]))
    starts = np.array([shape.points_mm[0] for shape in shapes])
    agreed = []
    for reading in readings:
        reason = ""
        if reading.shape is not None:
            near = np.linalg.norm(starts - reading.shape.points_mm[0], axis=1) < SAME_START_MM
            if abs(float(np.median(reading.shape.width_mm)) / usual - 1.0) > SAME_WIDTH:
                reason = "the outline's width differs from that in the other photos"
            elif np.count_nonzero(near) < 2:
                reason = "the outline starts elsewhere than in all other photos"
        agreed.append(replace(reading, shape=None, reason=reason) if reason else reading)
    return tuple(agreed)


def shape_table(readings: Sequence[ShapeReading], track: Track) -> pd.DataFrame:
    """Return all shapes as one table, a row a point.

    x and y are relative to the marker's place in the reference photograph, as displacements are: the marker
    of a photograph lies at (ux_mm, uy_mm) of the tip path. Photographs without a shape have no rows.
    """
    origin = next((r.marker_mm for r in track.readings if r.marker_mm is not None), np.zeros(2))
    parts = []
    for reading in readings:
        shape = reading.shape
        if shape is None:
            continue
        x, y = (shape.points_mm - origin).T
        columns = {
            "pressure_kPa": reading.pressure_kPa,
            "photo": reading.photo,
            "point": np.arange(len(shape.arc_mm)),
            "arc_mm": shape.arc_mm,
            "x_mm": x,
            "y_mm": y,
            "heading_deg": shape.heading_deg,
            "curvature_per_mm": shape.curvature_per_mm,
            "width_mm": shape.width_mm,
            "tip_angle_deg": shape.tip_angle_deg,
            "sigma_across_mm": shape.sigma_across_mm,
            "sigma_heading_deg": shape.sigma_heading_deg,
            "sigma_tip_angle_deg": shape.sigma_tip_angle_deg,
        }
        parts.append(pd.DataFrame(columns))
    return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame(columns=SHAPE_COLUMNS)


def shape_notes(readings: Sequence[ShapeReading], *, expected_length_mm: float) -> tuple[str, ...]:
    """Say which photographs gave no shape, and whether the body's length betrays a wrong square size.

    Photographs without a reading of the tip are told by the track.

    Parameters
    ----------
    expected_length_mm : float
        Length of the body at rest that hangs out of the clamp.
    """
    notes = []
    missing = [r for r in readings if r.shape is None and r.reason not in (NO_BOARD, NO_MARKER)]
    for reason in dict.fromkeys(reading.reason for reading in missing):
        names = ", ".join(reading.photo for reading in missing if reading.reason == reason)
        notes.append(f"no shape in {names}: {reason}")
    rest = [r.shape for r in readings if r.shape is not None and r.pressure_kPa <= AT_REST_KPA]
    if rest and abs(rest[0].length_mm / expected_length_mm - 1.0) > LENGTH_TOLERANCE:
        notes.append(
            f"the actuator measures {rest[0].length_mm:.1f} mm at rest, clamp to tip, but "
            f"{expected_length_mm:.1f} mm were expected: check the size of the squares (--square-mm), "
            "or void_count and pitch_mm"
        )
    return tuple(notes)
