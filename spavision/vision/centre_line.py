"""A smooth centre line: heading as a polynomial of the arc length, fitted to points of both edges."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import ArrayLike

from .arrays import FloatArray

HEADING_DEGREE = 6
WIDTH_DEGREE = 3
STATIONS = 201
FIT_STEPS = 6
OUTLIER_MM = 0.3
OUTLIER_MADS = 4.5
"""Distance from the fit, mm or median distances, at which an edge point loses its say (Tukey's biweight)."""

LONE_EDGE = 0.3
"""Say of an edge point without one across."""

DAMPING = 1e-6
"""Keeps the equations solvable where a stretch of the line has no edge points."""

EDGE_SIGMA_MM = 0.45
"""Scatter of one edge point, about 0.2 mm, enlarged because some five neighbours share their squares."""

HEADING_SIGMA_RAD = (np.inf, np.inf, np.inf, 0.03, 0.01, 0.005, 0.003)
"""How large a Legendre coefficient of the heading is expected to be: ripples are unlikely, so noise does not
make any; the first three, which are a curvature that changes evenly, are left free."""


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
        return self.start_mm + _integral(self.along, self.length_mm)

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


@dataclass(frozen=True)
class Edge:
    """One edge, as measured from a line.

    Parameters
    ----------
    distance_mm : array, shape (STATIONS,)
        Its distance across the line, positive; NaN where it is not seen.
    weight : array, shape (STATIONS,)
        How much each distance has to say.
    """

    distance_mm: FloatArray
    weight: FloatArray


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


def fit_edges(line: CentreLine, left: Edge, right: Edge) -> tuple[CentreLine, FloatArray]:
    """Move a line so that it runs midway between measured edges.

    Parameters
    ----------
    line : CentreLine
        The line from which the edges were measured.
    left, right : Edge
        The measured edges.

    Returns
    -------
    line : CentreLine
    residuals_mm : array, shape (2, STATIONS)
        Distance of the edge points from the fitted edges, outwards; NaN where there is none.
    """
    basis = legendre.legvander(np.linspace(-1.0, 1.0, STATIONS), HEADING_DEGREE)
    widths = legendre.legvander(np.linspace(-1.0, 1.0, STATIONS), WIDTH_DEGREE)
    rightward = line.rightward
    sway = [
        (rightward * _integral(rightward * basis[:, k : k + 1], line.length_mm)).sum(axis=1)
        for k in range(HEADING_DEGREE + 1)
    ]
    moved = rightward @ rightward[0]
    centre = np.column_stack([moved, *sway])
    design = np.vstack([np.hstack([-centre, widths]), np.hstack([centre, widths])])
    measured = np.concatenate([left.distance_mm, right.distance_mm])
    weight = np.tile(_shared_weight(left, right), 2)
    found = np.isfinite(measured)
    stiffness = np.zeros(design.shape[1])
    stiffness[1 : centre.shape[1]] = (EDGE_SIGMA_MM / np.array(HEADING_SIGMA_RAD)) ** 2
    stiffness += DAMPING * (design**2).sum(axis=0)
    rest = np.concatenate([[0.0], -line.heading, line.half_width])
    rest[1:4] = 0.0
    solution = _robust_solution(design[found], measured[found], weight[found], stiffness, rest)
    residuals = np.full(2 * STATIONS, np.nan)
    residuals[found] = measured[found] - design[found] @ solution
    shift, turn = solution[0], solution[1 : centre.shape[1]]
    better = replace(
        line,
        start_mm=line.start_mm + shift * rightward[0],
        heading=line.heading + turn,
        half_width=solution[centre.shape[1] :],
    )
    return better, residuals.reshape(2, STATIONS)


def _coefficients(places: FloatArray, values: ArrayLike, degree: int) -> FloatArray:
    return np.asarray(legendre.legfit(places, np.asarray(values, dtype=float), degree), dtype=float)


def _shared_weight(left: Edge, right: Edge) -> FloatArray:
    """One weight for both edges of a station: swelling between the walls then moves neither side."""
    both = np.isfinite(left.distance_mm) & np.isfinite(right.distance_mm)
    shared = 2.0 * left.weight * right.weight / (left.weight + right.weight)
    alone = LONE_EDGE * np.where(np.isfinite(left.distance_mm), left.weight, right.weight)
    return np.where(both, shared, alone)


def _robust_solution(
    design: FloatArray, measured: FloatArray, say: FloatArray, stiffness: FloatArray, rest: FloatArray
) -> FloatArray:
    """Least squares with Tukey's biweight, springs pulling the unknowns towards ``rest``."""
    weight, solution = say, rest
    for _ in range(FIT_STEPS):
        normal = design.T @ (design * weight[:, None]) + np.diag(stiffness)
        target = design.T @ (measured * weight) + stiffness * rest
        solution = np.asarray(np.linalg.solve(normal, target), dtype=float)
        away = np.abs(measured - design @ solution)
        cut = max(OUTLIER_MADS * float(np.median(away[say == say.max()])), OUTLIER_MM)
        weight = say * np.maximum(0.0, 1.0 - (away / cut) ** 2) ** 2
    return solution


def _integral(values: FloatArray, length: float) -> FloatArray:
    """Integrate along the stations by the trapezium rule, starting from zero; shape as ``values``."""
    step = length / (STATIONS - 1)
    total = np.cumsum(0.5 * step * (values[1:] + values[:-1]), axis=0)
    return np.concatenate([np.zeros((1, values.shape[1])), total])
