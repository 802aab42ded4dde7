"""A centre line fitted to both edges of the body, which may swell between its walls."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from numpy.polynomial import legendre

from .arrays import FloatArray, IntArray
from .centre_line import HEADING_DEGREE, STATIONS, WIDTH_DEGREE, CentreLine, integral

HEADING_SIGMA_RAD = (np.inf, np.inf, np.inf, 0.015, 0.006, 0.005, 0.003)
"""How large a Legendre coefficient of the heading is expected to be: half the largest in the centre lines of
the finite-element model, 0 to 65 kPa, crimp ratios 0.2 and 0.3. The first three, which are a curvature that
changes evenly, are left free."""

SWELLING_SIGMA_MM = 0.3
"""How much either edge is expected to swell and shrink between the walls."""

PERIODS: FloatArray = 1.0 / np.linspace(5.0, 30.0, 101)
"""Distances of the walls that are tried, over the length of the body."""

FIT_STEPS = 6
OUTLIER_MM = 0.2
OUTLIER_MADS = 3.5
"""Distance from the fit, mm or median distances, at which an edge point loses its say (Tukey's biweight)."""

FIRST_SIGMA_MM = 0.45
CLEAR_SAY = 0.2
"""Say from which an edge point counts for the scatter."""

SYSTEMATIC_MM, SYSTEMATIC_STATIONS = 0.1, 20
"""Part of the edge points' error that scatter does not show: a stretch of so many stations (16 mm) has
it in common: rounded edges, shade, blur."""

LEAST_CORRELATION = 0.1
"""Correlation of neighbouring points' errors below which they count as independent."""

HALF_WIDTH_SIGMA_MM = (np.inf, 0.2, 0.1, 0.05)
"""How large a Legendre coefficient of the half-width is expected to be: a body hardly tapers."""

DAMPING = 1e-6
"""Keeps the equations solvable where a stretch of the line has no edge points."""


@dataclass(frozen=True)
class Edge:
    """One edge, as measured from a line.

    Parameters
    ----------
    distance_mm : array, shape (STATIONS,)
        Its distance across the line, positive; NaN where it is not seen.
    weight : array, shape (STATIONS,)
        How much each distance has to say, 0 to 1.
    """

    distance_mm: FloatArray
    weight: FloatArray


@dataclass(frozen=True)
class EdgeFit:
    """A line fitted to edges, and how well they determine it.

    Parameters
    ----------
    line : CentreLine
    residuals_mm : array, shape (2, STATIONS)
        Distance of the left and right edge points from the fitted edges, outwards; NaN where there is none.
    sigma_across_mm, sigma_heading_rad : array, shape (STATIONS,)
        Standard uncertainty of the line's place across itself, and of its heading.
    """

    line: CentreLine
    residuals_mm: FloatArray
    sigma_across_mm: FloatArray
    sigma_heading_rad: FloatArray


def fit_edges(line: CentreLine, left: Edge, right: Edge) -> EdgeFit:
    """Move a line so that it runs midway between measured edges.

    Each edge may swell and shrink with a period of its own finding, so that an edge which is seen over one
    half of the swells alone does not bend the line.

    Parameters
    ----------
    line : CentreLine
        The line from which the edges were measured.
    left, right : Edge
        The measured edges.
    """
    n = HEADING_DEGREE + 2
    centre, widths = _centre_columns(line), legendre.legvander(_places(), WIDTH_DEGREE)
    columns = np.vstack([np.hstack([-centre, widths]), np.hstack([centre, widths])])
    edges = _Edges(
        np.concatenate([left.distance_mm, right.distance_mm]), np.concatenate([left.weight, right.weight])
    )
    rest = np.concatenate([[0.0], -line.heading, np.zeros(WIDTH_DEGREE + 1)])
    rest[1:4], rest[n] = 0.0, line.half_width[0]
    sigma = np.array([np.inf, *HEADING_SIGMA_RAD, *HALF_WIDTH_SIGMA_MM])
    first = edges.solve(columns, rest, sigma)
    swelling = _strongest_swelling(edges.distance_mm - columns @ first.values, first.weight)
    columns = np.hstack([columns, swelling])
    rest = np.concatenate([rest, np.zeros(swelling.shape[1])])
    sigma = np.concatenate([sigma, np.full(swelling.shape[1], SWELLING_SIGMA_MM)])
    solution = edges.solve(columns, rest, sigma)
    shift, turn, half_width = np.split(solution.values[: n + WIDTH_DEGREE + 1], [1, n])
    better = replace(
        line,
        start_mm=line.start_mm + shift * line.rightward[0],
        heading=line.heading + turn,
        half_width=half_width,
    )
    residuals = (edges.distance_mm - columns @ solution.values).reshape(2, STATIONS)
    headings = legendre.legvander(_places(), HEADING_DEGREE)
    return EdgeFit(
        better,
        residuals,
        _sigma_of(centre, solution.covariance[:n, :n]),
        _sigma_of(np.asarray(headings, dtype=float), solution.covariance[1:n, 1:n]),
    )


@dataclass(frozen=True)
class _Solution:
    """Unknowns, their covariance, and the say that each edge point was left with."""

    values: FloatArray
    covariance: FloatArray
    weight: FloatArray


@dataclass(frozen=True)
class _Edges:
    """Points of both edges, the left one's first."""

    distance_mm: FloatArray
    say: FloatArray

    def solve(self, columns: FloatArray, rest: FloatArray, sigma: FloatArray) -> _Solution:
        """Least squares with Tukey's biweight, the unknowns known beforehand to be ``rest`` ± ``sigma``.

        How far the points of either edge scatter is their own to tell: one that is seen badly says less.
        """
        found = np.isfinite(self.distance_mm)
        design, measured, say = columns[found], self.distance_mm[found], self.say[found]
        side = np.repeat([0, 1], STATIONS)[found]
        damping = DAMPING * (design**2).sum(axis=0)
        pull = 1.0 / np.square(sigma) + damping
        weight = say / FIRST_SIGMA_MM**2
        for _ in range(FIT_STEPS):
            normal = design.T @ (design * weight[:, None]) + np.diag(pull)
            values = np.linalg.solve(normal, design.T @ (measured * weight) + pull * rest)
            away = measured - design @ values
            for k in (0, 1):
                own = side == k
                weight[own] = _weights(away[own], say[own], np.flatnonzero(found)[own])
        kept = np.zeros(len(found))
        kept[found] = weight
        return _Solution(np.asarray(values), np.asarray(np.linalg.inv(normal)), kept)


def _weights(away_mm: FloatArray, say: FloatArray, station: IntArray) -> FloatArray:
    """Return the inverse variances of one edge's points, by their distances from the fit."""
    if len(away_mm) == 0:
        return say
    clear = say >= CLEAR_SAY
    spread = float(np.median(np.abs((away_mm * np.sqrt(say))[clear if clear.any() else slice(None)])))
    cut = max(OUTLIER_MADS * spread, OUTLIER_MM)
    variance = (1.4826 * spread) ** 2 * _hanging_together(np.clip(away_mm * np.sqrt(say), -cut, cut), station)
    variance += SYSTEMATIC_MM**2 * SYSTEMATIC_STATIONS
    return np.asarray(say * np.maximum(0.0, 1.0 - (away_mm / cut) ** 2) ** 2 / variance)


def _places() -> FloatArray:
    return np.linspace(-1.0, 1.0, STATIONS)


def _centre_columns(line: CentreLine) -> FloatArray:
    """Return how the stations move across the line with a shift of its start and with its heading."""
    basis = legendre.legvander(_places(), HEADING_DEGREE)
    rightward = line.rightward
    sway = [
        (rightward * integral(rightward * basis[:, k : k + 1], line.length_mm)).sum(axis=1)
        for k in range(HEADING_DEGREE + 1)
    ]
    return np.column_stack([rightward @ rightward[0], *sway])


def _strongest_swelling(residual_mm: FloatArray, weight: FloatArray) -> FloatArray:
    """Return the columns of the period that explains most of what a smooth outline leaves."""
    found = np.isfinite(residual_mm)
    target = residual_mm[found] * weight[found]
    candidates = _swellings()
    explained = []
    for columns in candidates:
        design = columns[found]
        normal = design.T @ (design * weight[found, None]) + 1e-3 * np.eye(design.shape[1])
        gradient = design.T @ target
        explained.append(float(gradient @ np.linalg.solve(normal, gradient)))
    return candidates[int(np.argmax(explained))]


@cache
def _swellings() -> tuple[FloatArray, ...]:
    """Return the columns of every period that is tried."""
    return tuple(_swelling_columns(period) for period in PERIODS.tolist())


def _swelling_columns(period: float) -> FloatArray:
    """Waves of one period (over the length) and half of it, growing along the body, either edge's own."""
    places = _places()
    phase = np.pi * places / period
    waves = [
        wave(k * phase) * growth for k in (1, 2) for wave in (np.cos, np.sin) for growth in (1.0, places)
    ]
    own = np.column_stack(waves)
    return np.block([[own, np.zeros_like(own)], [np.zeros_like(own), own]])


def _hanging_together(residual_mm: FloatArray, station: IntArray) -> float:
    """Return how many neighbouring points count as one, from the residuals' correlation."""
    values, found = np.zeros(2 * STATIONS), np.zeros(2 * STATIONS)
    values[station], found[station] = residual_mm, 1.0
    variance = max(float((values**2).sum() / found.sum()), 1e-12)
    total = 1.0
    for lag in range(1, SYSTEMATIC_STATIONS + 1):
        pairs = max(float(found[lag:] @ found[:-lag]), 1.0)
        correlation = float(values[lag:] @ values[:-lag]) / pairs / variance
        if correlation < LEAST_CORRELATION:
            break
        total += 2.0 * correlation
    return total


def _sigma_of(columns: FloatArray, covariance: FloatArray) -> FloatArray:
    return np.sqrt(np.maximum(np.einsum("ij,jk,ik->i", columns, covariance, columns), 0.0))
