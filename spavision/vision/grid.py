"""Small services for corners that carry a column and a row."""

from __future__ import annotations

import numpy as np

from .arrays import FloatArray, IntArray


def neighbour_rows(indices: IntArray, step: tuple[int, int]) -> tuple[IntArray, IntArray]:
    """Return the rows of corners that are one lattice step apart: starts and ends, shape (pairs,) each.

    Parameters
    ----------
    indices : int array, shape (n, 2)
        Column and row of each corner.
    step : tuple of int
        Step in columns and rows, none negative.
    """
    low = indices.min(axis=0)
    size = indices.max(axis=0) - low + 1 + step
    table = np.full((size[0], size[1]), -1, dtype=np.intp)
    column, row = (indices - low).T
    table[column, row] = np.arange(len(indices))
    ends = table[column + step[0], row + step[1]]
    starts = np.flatnonzero(ends >= 0)
    return starts, ends[starts]


def median_pitch(indices: IntArray, pixels: FloatArray) -> float:
    """Return the median distance between neighbouring corners, in the unit of ``pixels``; NaN without any."""
    lengths = []
    for step in ((1, 0), (0, 1)):
        starts, ends = neighbour_rows(indices, step)
        lengths.append(np.linalg.norm(pixels[starts] - pixels[ends], axis=1))
    both = np.concatenate(lengths)
    return float(np.median(both)) if len(both) else float("nan")


def common_rows(first: IntArray, second: IntArray) -> tuple[IntArray, IntArray]:
    """Return the rows of two index tables that hold the same node."""
    low = np.minimum(first.min(axis=0), second.min(axis=0))
    size = np.maximum(first.max(axis=0), second.max(axis=0)) - low + 1
    table = np.full((size[0], size[1]), -1, dtype=np.intp)
    column, row = (second - low).T
    table[column, row] = np.arange(len(second))
    column, row = (first - low).T
    partner = table[column, row]
    rows = np.flatnonzero(partner >= 0)
    return rows, partner[rows]


def spread_subset(indices: IntArray | FloatArray, largest: int) -> IntArray:
    """Return at most ``largest`` rows, spread evenly over the board, the same ones each time."""
    if len(indices) <= largest:
        return np.arange(len(indices))
    order = np.lexsort((indices[:, 0], indices[:, 1]))
    return np.sort(order[np.linspace(0, len(indices) - 1, largest).astype(np.intp)])
