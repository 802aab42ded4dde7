"""The actuator's centre line, measured against modelled: bend angle and distance at each pressure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from spavision.tip_path import FloatArray

if TYPE_CHECKING:
    import pandas as pd

TIP_SHARE = 0.2
"""Share of the length, from the tip, that the bend angle is read from: a void or two, so that neither swollen
voids nor noise of single points turn it."""

RESAMPLED = 201
SAME_PRESSURE_kPa = 1e-6


@dataclass(frozen=True)
class CentreLine:
    """A centre line at one pressure, from the clamp to the tip.

    Parameters
    ----------
    pressure_kPa : float
    points_mm : array, shape (n, 2)
        x positive in the direction of the first bend, y down, from the tracked point at rest.
    """

    pressure_kPa: float
    points_mm: FloatArray

    @property
    def length_mm(self) -> float:
        """Length of the line."""
        return float(_arc_mm(self.points_mm)[-1])

    @property
    def bend_angle_deg(self) -> float:
        """Direction of the line at the tip against the downward axis, positive towards the first bend.

        The end tangent of parabolas x(s), y(s) fitted to the last `TIP_SHARE` of the line.
        """
        points = _even_points(self.points_mm)
        arc = _arc_mm(points)
        last = arc >= (1.0 - TIP_SHARE) * arc[-1]
        along = arc[last] - arc[-1]
        slope_x, slope_y = (np.polynomial.Polynomial.fit(along, c, 2).deriv()(0.0) for c in points[last].T)
        return float(np.degrees(np.arctan2(slope_x, slope_y)))


@dataclass(frozen=True)
class ShapeDiscrepancy:
    """Centre lines of both sides compared, one entry a pressure that both have.

    Parameters
    ----------
    pressure_kPa : array, shape (n,)
    measured_angle_deg, modelled_angle_deg : array, shape (n,)
        Bend angles at the tip.
    measured_length_mm, modelled_length_mm : array, shape (n,)
    mean_distance_mm, largest_distance_mm : array, shape (n,)
        Distance of the measured line's points from the modelled line.
    """

    pressure_kPa: FloatArray
    measured_angle_deg: FloatArray
    modelled_angle_deg: FloatArray
    measured_length_mm: FloatArray
    modelled_length_mm: FloatArray
    mean_distance_mm: FloatArray
    largest_distance_mm: FloatArray

    def __len__(self) -> int:
        return len(self.pressure_kPa)

    @property
    def angle_error_deg(self) -> FloatArray:
        """Modelled less measured bend angle, shape (n,)."""
        return self.modelled_angle_deg - self.measured_angle_deg

    def sentence(self) -> str:
        """Say how far apart the shapes are."""
        worst, furthest = (
            int(np.argmax(np.abs(self.angle_error_deg))),
            int(np.argmax(self.largest_distance_mm)),
        )
        return (
            f"The bend angle at the tip differs most at {self.pressure_kPa[worst]:g} kPa: measured "
            f"{self.measured_angle_deg[worst]:.0f}°, modelled {self.modelled_angle_deg[worst]:.0f}°; "
            f"the centre lines are up to {self.largest_distance_mm[furthest]:.1f} mm apart, at "
            f"{self.pressure_kPa[furthest]:g} kPa."
        )

    def table(self) -> pd.DataFrame:
        """Return the comparison as a DataFrame, one row a pressure."""
        import pandas as pd

        return pd.DataFrame(
            {
                "pressure_kPa": self.pressure_kPa,
                "measured_angle_deg": self.measured_angle_deg,
                "modelled_angle_deg": self.modelled_angle_deg,
                "angle_error_deg": self.angle_error_deg,
                "measured_length_mm": self.measured_length_mm,
                "modelled_length_mm": self.modelled_length_mm,
                "mean_distance_mm": self.mean_distance_mm,
                "largest_distance_mm": self.largest_distance_mm,
            }
        )


def compare_centre_lines(
    measured: Sequence[CentreLine], modelled: Sequence[CentreLine]
) -> ShapeDiscrepancy | None:
    """Pair centre lines of equal pressures; None where there is no such pair.

    Nothing is interpolated between pressures.
    """
    pairs = [
        (line, other)
        for line in sorted(measured, key=lambda line: line.pressure_kPa)
        for other in modelled
        if abs(line.pressure_kPa - other.pressure_kPa) <= SAME_PRESSURE_kPa
    ]
    if not pairs:
        return None
    apart = [distances_mm(line.points_mm, other.points_mm) for line, other in pairs]
    return ShapeDiscrepancy(
        pressure_kPa=np.array([line.pressure_kPa for line, _ in pairs]),
        measured_angle_deg=np.array([line.bend_angle_deg for line, _ in pairs]),
        modelled_angle_deg=np.array([other.bend_angle_deg for _, other in pairs]),
        measured_length_mm=np.array([line.length_mm for line, _ in pairs]),
        modelled_length_mm=np.array([other.length_mm for _, other in pairs]),
        mean_distance_mm=np.array([distance.mean() for distance in apart]),
        largest_distance_mm=np.array([distance.max() for distance in apart]),
    )


def distances_mm(points_mm: FloatArray, line_mm: FloatArray) -> FloatArray:
    """Return each point's distance from a polyline.

    Parameters
    ----------
    points_mm : array, shape (n, 2)
    line_mm : array, shape (m, 2)

    Returns
    -------
    array, shape (n,)
    """
    start, step = line_mm[:-1], np.diff(line_mm, axis=0)
    squared = np.maximum((step**2).sum(axis=1), np.finfo(float).tiny)
    from_start = points_mm[:, None] - start
    along = np.clip((from_start * step).sum(axis=2) / squared, 0.0, 1.0)
    return np.asarray(np.linalg.norm(from_start - along[..., None] * step, axis=2).min(axis=1))


def _arc_mm(points: FloatArray) -> FloatArray:
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])


def _even_points(points: FloatArray) -> FloatArray:
    """Return the same line at even distances, so that either side's spacing weighs alike."""
    arc = _arc_mm(points)
    even = np.linspace(0.0, arc[-1], RESAMPLED)
    return np.column_stack([np.interp(even, arc, column) for column in points.T])
