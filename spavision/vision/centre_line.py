"""A smooth centre line: heading as a polynomial of the arc length."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import ArrayLike

from .arrays import FloatArray

HEADING_DEGREE = 6
WIDTH_DEGREE = 3
STATIONS = 201


@dataclass(frozen=True)
class CentreLine:
    """A centre line, its half-width along it, and the points in between.

    Parameters
    ----------
    start_mm : array, shape (2,)
        Its upper end.
    length_mm : float
    heading : array, shape (HEADING_DEGREE + 1,)
        Legendre coefficients of the heading, rad, over the length mapped to -1 to 1. Heading 0 is straight
        down, positive to the right.
    half_width : array, shape (WIDTH_DEGREE + 1,)
        Legendre coefficients of the half-width, mm.
    """

    start_mm: FloatArray
    length_mm: float
    heading: FloatArray
    half_width: FloatArray

    @property
    def arc_mm(self) -> FloatArray:
        """Arc length of the stations, shape (STATIONS,)."""
        return np.linspace(0.0, self.length_mm, STATIONS)

    @property
    def heading_rad(self) -> FloatArray:
        """Heading at the stations."""
        return np.asarray(legendre.legval(np.linspace(-1.0, 1.0, STATIONS), self.heading))

    @property
    def curvature_per_mm(self) -> FloatArray:
        """Change of the heading a millimetre, at the stations."""
        slope = legendre.legval(np.linspace(-1.0, 1.0, STATIONS), legendre.legder(self.heading))
        return np.asarray(slope * 2.0 / self.length_mm)

    @property
    def half_width_mm(self) -> FloatArray:
        """Half-width at the stations."""
        return np.asarray(legendre.legval(np.linspace(-1.0, 1.0, STATIONS), self.half_width))

    @property
    def points_mm(self) -> FloatArray:
        """Points at the stations, shape (STATIONS, 2)."""
        return self.start_mm + integral(self.along, self.length_mm)

    @property
    def along(self) -> FloatArray:
        """Unit vectors along the line, shape (STATIONS, 2)."""
        return np.column_stack([np.sin(self.heading_rad), np.cos(self.heading_rad)])

    @property
    def rightward(self) -> FloatArray:
        """Unit vectors across the line, to the right of one that hangs straight down, shape (STATIONS, 2)."""
        return np.column_stack([np.cos(self.heading_rad), -np.sin(self.heading_rad)])

    def trimmed(self, first_mm: float, last_mm: float) -> CentreLine:
        """Return the line between two arc lengths; either may lie a little beyond its ends."""
        place = np.linspace(first_mm, last_mm, STATIONS) / self.length_mm * 2.0 - 1.0
        new = np.linspace(-1.0, 1.0, STATIONS)
        heading = _coefficients(new, legendre.legval(place, self.heading), HEADING_DEGREE)
        width = _coefficients(new, legendre.legval(place, self.half_width), WIDTH_DEGREE)
        start = self.start_mm + self._step_to(first_mm)
        return CentreLine(start, last_mm - first_mm, heading, width)

    def _step_to(self, arc_mm: float) -> FloatArray:
        """Vector from the start to an arc length, which may be negative."""
        place = np.linspace(0.0, arc_mm, 33) / self.length_mm * 2.0 - 1.0
        heading = legendre.legval(place, self.heading)
        steps = np.column_stack([np.sin(heading), np.cos(heading)])
        return np.asarray(np.trapezoid(steps, dx=arc_mm / 32, axis=0))


def line_through(points_mm: FloatArray, half_width_mm: float) -> CentreLine:
    """Return a smooth line through a rough polyline, its ends in place."""
    steps = np.diff(points_mm, axis=0)
    arc = np.concatenate([[0.0], np.cumsum(np.hypot(*steps.T))])
    length = float(arc[-1])
    x, y = (legendre.legfit(arc / length * 2.0 - 1.0, points_mm[:, k], 4) for k in range(2))
    place = np.linspace(-1.0, 1.0, STATIONS)
    dx, dy = legendre.legval(place, legendre.legder(x)), legendre.legval(place, legendre.legder(y))
    heading = _coefficients(place, np.unwrap(np.arctan2(dx, dy)), HEADING_DEGREE)
    start = np.array([legendre.legval(-1.0, x), legendre.legval(-1.0, y)])
    return CentreLine(start, length, heading, np.array([half_width_mm] + [0.0] * WIDTH_DEGREE))


def _coefficients(places: FloatArray, values: ArrayLike, degree: int) -> FloatArray:
    return np.asarray(legendre.legfit(places, np.asarray(values, dtype=float), degree), dtype=float)


def integral(values: FloatArray, length: float) -> FloatArray:
    """Integrate along the stations by the trapezium rule, starting from zero; shape as ``values``."""
    step = length / (STATIONS - 1)
    total = np.cumsum(0.5 * step * (values[1:] + values[:-1]), axis=0)
    return np.concatenate([np.zeros((1, values.shape[1])), total])
