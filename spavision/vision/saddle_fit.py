"""Sub-pixel corners: a blurred corner of four squares is fitted to the pixels around each, compiled."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from scipy.special import erf

from .arrays import FloatArray, FloatImage

REACH_SQUARES = 0.5
"""Half width of the fitted window, in squares: up to where the next corner begins to show."""

LONGEST_REACH_PX = 12.0
"""Farther edges of large squares would make the fit slow, and tell no more than is needed."""

TAPER = 0.2
"""Outer share of the window over which its weight falls to zero, so that pixels enter and leave smoothly."""

FIRST_BLUR_PX = 0.9
BLUR_RANGE_PX = (0.5, 6.0)
"""Sharper than the pixels themselves no edge can be told to be."""

MOST_STEPS = 15
FAINTEST_CONTRAST = 1.0
"""Half the step between bright and dark, in grey levels, below which nothing is to be found."""

LAST_STEP_PX = 0.003
LARGEST_STEP_PX = 0.6

N_UNKNOWN = 5
CELLS_PER_BLUR, TABLE_END = 128, 5.0
_TABLE_PLACES = np.arange(int(CELLS_PER_BLUR * TABLE_END) + 2) / CELLS_PER_BLUR
EDGE = erf(_TABLE_PLACES / math.sqrt(2.0))
"""Profile of a blurred edge at multiples of 1/128 of its blur; and its slope there."""
EDGE_SLOPE = math.sqrt(2.0 / math.pi) * np.exp(-0.5 * _TABLE_PLACES**2)


def fit_saddles(gray: FloatImage, start: FloatArray, across: FloatArray, down: FloatArray) -> FloatArray:
    """Fit the corner of four squares to the pixels around each start.

    The model is ``level + contrast · E(u) E(v)``, where u and v are the distances from the corner's edges
    and E the profile of an edge blurred by a Gaussian, from −1 to 1. Place, level, contrast and blur are
    found by Gauss-Newton; the edges' directions are the lattice's. Pixels enter as they are, without
    interpolation, so that the place does not depend on where the corner lies between pixels. An edge's
    profile may be lopsided (tone curve, clipping): a corner looks the same turned by half a turn, and stays.

    Parameters
    ----------
    gray : float32 array, shape (height, width)
        The photograph.
    start : array, shape (n, 2)
        Approximate places, px.
    across, down : array, shape (n, 2)
        Lattice vectors there, px.

    Returns
    -------
    array, shape (n, 2)
        Refined places; NaN where the fit fails, leaves its window or meets the photograph's border.
    """
    places = np.full((len(start), 2), np.nan)
    _fit_all(
        np.ascontiguousarray(gray, dtype=np.float32),
        np.ascontiguousarray(start, dtype=np.float64),
        np.ascontiguousarray(across, dtype=np.float64),
        np.ascontiguousarray(down, dtype=np.float64),
        places,
    )
    return places


@njit(cache=True, nogil=True, error_model="numpy")
def _fit_all(gray, start, across, down, places):  # type: ignore[no-untyped-def]
    normal, right = np.empty((N_UNKNOWN, N_UNKNOWN)), np.empty(N_UNKNOWN)
    unknown, edges = np.empty(N_UNKNOWN), np.empty(6)
    for k in range(len(start)):
        if not _edges(across[k], down[k], edges):
            continue
        reach = REACH_SQUARES * min(1.0, LONGEST_REACH_PX * max(edges[4], edges[5]) / REACH_SQUARES)
        edges[4] /= reach
        edges[5] /= reach
        span_x = math.ceil(reach * (abs(across[k, 0]) + abs(down[k, 0])))
        span_y = math.ceil(reach * (abs(across[k, 1]) + abs(down[k, 1])))
        unknown[0], unknown[1] = start[k]
        unknown[2:4] = 0.0
        unknown[4] = math.log(FIRST_BLUR_PX)
        if _fit(gray, unknown, edges, span_x, span_y, normal, right):
            moved = math.hypot(unknown[0] - start[k, 0], unknown[1] - start[k, 1])
            if moved < 1.0 / max(edges[4], edges[5]):
                places[k, 0], places[k, 1] = unknown[0], unknown[1]


@njit(cache=True, nogil=True, error_model="numpy")
def _edges(across, down, edges):  # type: ignore[no-untyped-def]
    """Set the edges' unit normals, along ``down`` and ``across``, and squares a px; False if flat."""
    determinant = across[0] * down[1] - across[1] * down[0]
    if determinant < 1.0:
        return False
    long_across, long_down = math.hypot(across[0], across[1]), math.hypot(down[0], down[1])
    edges[0], edges[1] = down[1] / long_down, -down[0] / long_down
    edges[2], edges[3] = -across[1] / long_across, across[0] / long_across
    edges[4], edges[5] = long_down / determinant, long_across / determinant
    return True


@njit(cache=True, nogil=True, error_model="numpy")
def _fit(gray, unknown, edges, span_x, span_y, normal, right):  # type: ignore[no-untyped-def]
    """Gauss-Newton from ``unknown`` (x, y, level, contrast, log blur); True if it settles."""
    height, width = gray.shape
    for step in range(MOST_STEPS):
        x, y = round(unknown[0]), round(unknown[1])
        if x < span_x or y < span_y or x + span_x >= width or y + span_y >= height:
            return False
        window = gray[y - span_y : y + span_y + 1, x - span_x : x + span_x + 1]
        _normal_equations(window, x - span_x, y - span_y, unknown, edges, normal, right)
        # Without a contrast nothing else can be told: the first step finds level and contrast alone.
        first = 2 if step == 0 else 0
        count = 4 if step < 2 else N_UNKNOWN
        if not _solve(normal, right, first, count):
            return False
        length = 0.0 if step == 0 else math.hypot(right[0], right[1])
        share = min(1.0 if step < 6 else 0.6, LARGEST_STEP_PX / max(length, 1e-9))
        for i in range(first, count):
            if i < 2:
                unknown[i] += share * right[i]
            elif i < 4:
                unknown[i] += right[i]
            else:
                unknown[i] += min(max(right[i], -0.3), 0.3)
        unknown[4] = min(max(unknown[4], math.log(BLUR_RANGE_PX[0])), math.log(BLUR_RANGE_PX[1]))
        if step > 2:
            if abs(unknown[3]) < FAINTEST_CONTRAST:
                return False
            if length < LAST_STEP_PX:
                return True
    return False


@njit(cache=True, nogil=True, error_model="numpy")
def _normal_equations(window, left, top, unknown, edges, normal, right):  # type: ignore[no-untyped-def]
    """Fill the normal equations of the window's pixels about the current unknowns."""
    normal[:] = 0.0
    right[:] = 0.0
    slope = np.empty(N_UNKNOWN)
    level, contrast, blur = unknown[2], unknown[3], math.exp(unknown[4])
    slope[2] = 1.0
    for row in range(window.shape[0]):
        dy = top + row - unknown[1]
        for column in range(window.shape[1]):
            dx = left + column - unknown[0]
            u, v = edges[0] * dx + edges[1] * dy, edges[2] * dx + edges[3] * dy
            outward = max(abs(u) * edges[4], abs(v) * edges[5])
            if outward >= 1.0:
                continue
            weight = min(1.0, (1.0 - outward) / TAPER)
            step_u, slope_u = _edge(u / blur)
            step_v, slope_v = _edge(v / blur)
            rise_u, rise_v = contrast * step_v * slope_u / blur, contrast * step_u * slope_v / blur
            slope[0] = -rise_u * edges[0] - rise_v * edges[2]
            slope[1] = -rise_u * edges[1] - rise_v * edges[3]
            slope[3] = step_u * step_v
            slope[4] = -rise_u * u - rise_v * v
            rest = window[row, column] - level - contrast * slope[3]
            for i in range(N_UNKNOWN):
                weighted = weight * slope[i]
                right[i] += weighted * rest
                for j in range(i + 1):
                    normal[i, j] += weighted * slope[j]


@njit(cache=True, nogil=True, error_model="numpy")
def _edge(place):  # type: ignore[no-untyped-def]
    """Look up the profile of a blurred edge and its slope."""
    far = abs(place)
    if far >= TABLE_END:
        return math.copysign(1.0, place), 0.0
    cell = int(far * CELLS_PER_BLUR)
    share = far * CELLS_PER_BLUR - cell
    value = EDGE[cell] + share * (EDGE[cell + 1] - EDGE[cell])
    return math.copysign(value, place), EDGE_SLOPE[cell] + share * (EDGE_SLOPE[cell + 1] - EDGE_SLOPE[cell])


@njit(cache=True, nogil=True, error_model="numpy")
def _solve(normal, right, first, end):  # type: ignore[no-untyped-def]
    """Solve unknowns ``first`` to ``end`` by Cholesky's method in place; False where undetermined."""
    for i in range(first, end):
        for j in range(first, i + 1):
            rest = normal[i, j]
            for k in range(first, j):
                rest -= normal[i, k] * normal[j, k]
            if i > j:
                normal[i, j] = rest / normal[j, j]
            elif rest > 1e-6 * normal[i, i] and rest > 0.0:
                normal[i, i] = math.sqrt(rest)
            else:
                return False
    for i in range(first, end):
        for k in range(first, i):
            right[i] -= normal[i, k] * right[k]
        right[i] /= normal[i, i]
    for i in range(end - 1, first - 1, -1):
        for k in range(i + 1, end):
            right[i] -= normal[k, i] * right[k]
        right[i] /= normal[i, i]
    return True
