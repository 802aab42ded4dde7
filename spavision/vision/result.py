"""What the tracker hands over: one reading a photograph, and the whole track."""

from __future__ import annotations

from dataclasses import dataclass

import pandas as pd

from spavision.tip_path import TipPath

from .arrays import FloatArray, IntArray
from .budget import BudgetEntry
from .camera import Camera, Pose


@dataclass(frozen=True)
class Reading:
    """Everything measured in one photograph.

    Parameters
    ----------
    photo : str
        File name.
    pressure_kPa : float
    status, reason : str
        As in the tip path.
    marker_px : array, shape (2,), or None
        Projection of the marker's centre.
    marker_mm : array, shape (2,), or None
        The centre in its plane, in the board's axes (origin at an arbitrary corner).
    radius_mm : float or None
        Radius of the marker's circle.
    rim_px : array, shape (n, 2)
        Edge points of the marker; NaN where a ray shows no edge; empty without a marker.
    base_px : array, shape (2,), or None
        Projection of the base marker's centre.
    corners_px : array, shape (n, 2)
        The board's corners.
    indices : int array, shape (n, 2)
        Their column and row, from the same origin in all photographs.
    residuals_px : array, shape (n, 2)
        Corners less the projected lattice.
    rms_px : float
        Root mean square length of the residuals; NaN without a board.
    pose : Pose or None
        The board before the camera.
    """

    photo: str
    pressure_kPa: float
    status: str
    reason: str
    marker_px: FloatArray | None
    marker_mm: FloatArray | None
    radius_mm: float | None
    rim_px: FloatArray
    base_px: FloatArray | None
    corners_px: FloatArray
    indices: IntArray
    residuals_px: FloatArray
    rms_px: float
    pose: Pose | None


@dataclass(frozen=True)
class Track:
    """Result of `track`.

    Parameters
    ----------
    tip_path : TipPath
        One row a photograph, in order of pressure.
    camera : Camera
        The camera that all photographs share.
    distance_mm : float
        Perpendicular distance from the camera to the board, reference photograph.
    sigma_distance_mm : float
        Its standard uncertainty.
    distance_source : str
        ``calibration``, ``given``, ``fit``, ``exif`` or ``none``.
    standoff_mm : float or None
        Distance of the marker's plane from the board, as given.
    parallax_factor : float
        Displacement in the marker's plane over the reading in the board's plane; 1 where uncorrected.
    correction : str
        One sentence on the correction applied.
    square_mm : float
        Side of a square, as printed.
    marker_diameter_mm : float or None
        Found or given diameter of the marker.
    readings : tuple of Reading
        In the tip path's order.
    budget : tuple of BudgetEntry
        Sources of uncertainty and their effect on each reading.
    notes : tuple of str
        What the user should know.
    """

    tip_path: TipPath
    camera: Camera
    distance_mm: float
    sigma_distance_mm: float
    distance_source: str
    standoff_mm: float | None
    parallax_factor: float
    correction: str
    square_mm: float
    marker_diameter_mm: float | None
    readings: tuple[Reading, ...]
    budget: tuple[BudgetEntry, ...]
    notes: tuple[str, ...]


def budget_table(track: Track) -> pd.DataFrame:
    """Return the budget as one table: a row a photograph and source, both displacements' sigma, the basis."""
    path = track.tip_path
    parts = [
        pd.DataFrame(
            {
                "pressure_kPa": path.pressure_kPa,
                "photo": path.photo,
                "source": entry.name,
                "sigma_ux_mm": entry.sigma_ux_mm,
                "sigma_uy_mm": entry.sigma_uy_mm,
                "basis": entry.basis,
            }
        )
        for entry in track.budget
    ]
    return pd.concat(parts, ignore_index=True)
