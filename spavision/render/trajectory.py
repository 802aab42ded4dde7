"""How the tip moves with pressure: the article's published points and a smooth road through them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

from spavision.errors import InputError

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Trajectory:
    """Displacement of the dot in its own plane, one row a photo.

    Parameters
    ----------
    pressure_kPa, ux_mm, uy_mm : array, shape (n,)
        x to the right, y down, relative to the straight hanging actuator.
    uz_mm : array, shape (n,)
        Motion out of the plane, towards the camera.
    """

    pressure_kPa: FloatArray
    ux_mm: FloatArray
    uy_mm: FloatArray
    uz_mm: FloatArray

    def __len__(self) -> int:
        return len(self.pressure_kPa)


@dataclass(frozen=True)
class PathPoint:
    """A point the sample path goes through; ``published`` names the numbers taken from the article."""

    pressure_kPa: float
    ux_mm: float
    uy_mm: float
    published: str = ""


SAMPLE_POINTS: dict[float, tuple[PathPoint, ...]] = {
    0.2: (
        PathPoint(0, 0.0, 0.0),
        PathPoint(10, 3.6, -0.1),
        PathPoint(20, 10.4, -0.5),
        PathPoint(30, 17.5, -0.8, "x: 17.5 mm in the first direction (article; its pressure is not given)"),
        PathPoint(40, 4.0, 3.2),
        PathPoint(50, -28.0, 4.4),
        PathPoint(60, -55.0, -1.6),
        PathPoint(65, -65.0, -4.8, "x: 65 mm in the second direction (article; its pressure is not given)"),
    ),
    0.25: (
        PathPoint(0, 0.0, 0.0),
        PathPoint(10, 4.8, -0.2),
        PathPoint(20, 15.2, -1.2),
        PathPoint(30, 31.0, -3.4),
        PathPoint(35, 38.5, -4.6),
        PathPoint(45, 27.0, 3.6),
        PathPoint(55, -2.0, 13.0),
        PathPoint(65, -30.0, 15.5),
    ),
    0.3: (
        PathPoint(0, 0.0, 0.0),
        PathPoint(10, 5.8, -0.3),
        PathPoint(20, 20.0, -2.2),
        PathPoint(30, 46.5, -10.4),
        PathPoint(40, 71.25, -21.5, "x: the largest, 71.25 mm, at 40 kPa (article)"),
        PathPoint(50, 58.0, -2.0, "falls after 40 kPa while y lengthens (article; the amounts are assumed)"),
        PathPoint(60, 37.0, 17.0),
        PathPoint(65, 27.5, 24.5, "the highest pressure is 65 kPa (article)"),
    ),
}
"""The sample sets' paths; what carries no note is interpolated by us, shaped to be plausible."""

SAMPLE_PRESSURES_KPA = np.arange(0.0, 66.0, 5.0)


def sample_trajectory(crimp_ratio: float, pressure_kPa: FloatArray = SAMPLE_PRESSURES_KPA) -> Trajectory:
    """Return the path of one of the sample crimp ratios by monotone cubic interpolation (PCHIP).

    Raises
    ------
    InputError
        If the crimp ratio has no sample path.
    """
    points = SAMPLE_POINTS.get(round(crimp_ratio, 6))
    if points is None:
        known = ", ".join(str(ratio) for ratio in SAMPLE_POINTS)
        raise InputError(
            f"--crimp {crimp_ratio:g}: there are sample paths for {known}; give --trajectory for others"
        )
    knots = [point.pressure_kPa for point in points]
    ux = PchipInterpolator(knots, [point.ux_mm for point in points])(pressure_kPa)
    uy = PchipInterpolator(knots, [point.uy_mm for point in points])(pressure_kPa)
    return Trajectory(pressure_kPa, ux, uy, np.zeros(len(pressure_kPa)))
