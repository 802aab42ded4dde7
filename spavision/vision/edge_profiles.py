"""Lines across the actuator's edge: where the body ends on each, from the look of the board beyond."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import median_filter
from scipy.special import ndtr

from .arrays import BoolArray, FloatArray, FloatImage, IntArray
from .rectified import SHADE_RANGE

STEP_SQUARES = 0.05
"""Distance of the points along a line."""

CLEAN_RUN_SQUARES = 0.8
"""Board that must follow outside an edge, so that a hole in a light layer is not taken for one."""

EDGE_REACH_SQUARES = 0.4
"""How far from where it is expected the edge is looked for in the colours."""

EDGE_BEYOND_BLURS = 3.0
INSIDE_FROM_BLURS, INSIDE_SQUARES = 2.0, 0.25
SHADE_FROM_BLURS, SHADE_SQUARES = 3.0, 1.0
"""Where the colour of the body and the shade on the board are taken, inwards and outwards from the edge:
beyond its blur, and over such a stretch."""

SMOOTHED_LINES = 7
CLEAR_CONTRAST = 80.0
"""Contrast of body and board, grey levels, from which an edge counts fully."""

LARGEST_CONTRAST = 160.0

SLACK_BLURS = 1.5
"""How far blur may carry the look of the body or of the board across the edge."""


@dataclass(frozen=True)
class Ends:
    """Where the body ends on each line, mm against the prediction; NaN where nothing is known.

    Parameters
    ----------
    low, high : array, shape (lines,)
        It ends between these for certain.
    edge : array, shape (lines,)
        Where its edge is seen.
    weight : array, shape (lines,)
        How clearly.
    """

    low: FloatArray
    high: FloatArray
    edge: FloatArray
    weight: FloatArray


@dataclass(frozen=True)
class Profiles:
    """The picture along lines that run from the body outwards.

    Parameters
    ----------
    offsets_mm : array, shape (points,)
        Where the points lie against the predicted edge, positive outwards.
    strange, bright : bool array, shape (lines, points)
        Whether the point is not like the board, and whether it lies over a bright square.
    colours, expected : array, shape (lines, points, 3)
        Colours as seen, and those of the bare board.
    search_mm : float
        Where edges are looked for.
    blur_squares : float
        Blur of the picture, one standard deviation.
    """

    offsets_mm: FloatArray
    strange: BoolArray
    bright: BoolArray
    colours: FloatImage
    expected: FloatImage
    search_mm: float
    blur_squares: float

    def ends(self, tells: tuple[bool, bool]) -> Ends:
        """Find between which offsets the body ends, and where its edge is seen.

        Going outwards, the body reaches at least to its last strange pixel, and ends before the next pixel
        that would be strange if the body still covered it.

        Parameters
        ----------
        tells : tuple of bool
            Whether the body is strange over dark and over bright squares.
        """
        clean = round(CLEAN_RUN_SQUARES / STEP_SQUARES)
        slack = SLACK_BLURS * self.blur_squares / STEP_SQUARES * (self.offsets_mm[1] - self.offsets_mm[0])
        run = np.cumsum(self.strange, axis=1)
        last_of_body = self.strange[:, :-clean] & (run[:, clean:] == run[:, :-clean])
        last_of_body &= np.abs(self.offsets_mm[:-clean]) <= self.search_mm
        last = last_of_body.shape[1] - 1 - np.argmax(last_of_body[:, ::-1], axis=1)
        found = last_of_body.any(axis=1)
        bare = np.where(self.bright, tells[1], tells[0]) & ~self.strange
        bare &= np.arange(len(self.offsets_mm)) > last[:, None]
        high = np.where(bare.any(axis=1), self.offsets_mm[np.argmax(bare, axis=1)] + slack, np.inf)
        low = np.where(found, self.offsets_mm[last] - slack, np.nan)
        high = np.where(found, high, np.nan)
        edge, weight = self._mixed_edges(np.clip(0.0, low, high))
        edge[(edge < low - slack) | (edge > high + slack)] = np.nan
        return Ends(low, high, edge, weight)

    def _mixed_edges(self, near_mm: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Find near ``near_mm`` the offset at which body and bare board mix best to the picture; its weight.

        Each point is taken for a mixture of the body's colour just inside and the bare board's there, dimmed
        as it is farther out. Where these two are alike, the point has nothing to say.
        """
        step = self.offsets_mm[1] - self.offsets_mm[0]
        blur = self.blur_squares / STEP_SQUARES
        reach, beyond = round(EDGE_REACH_SQUARES / STEP_SQUARES), round(EDGE_BEYOND_BLURS * blur)
        centre = np.rint((np.nan_to_num(near_mm) - self.offsets_mm[0]) / step).astype(np.intp)
        centre = np.clip(centre, reach + beyond, len(self.offsets_mm) - 1 - reach - beyond)
        row = np.arange(len(centre))[:, None]
        place = np.arange(-reach - beyond, reach + beyond + 1)
        window = centre[:, None] + place
        bare = self.expected[row, window] * self._shade(row, centre)
        contrast = self._inside(row, centre) - bare
        size = np.einsum("ijk,ijk->ij", contrast, contrast)
        share = np.einsum("ijk,ijk->ij", self.colours[row, window] - bare, contrast) / np.maximum(size, 1.0)
        size = np.minimum(size, LARGEST_CONTRAST**2)
        candidates = np.arange(-reach, reach + 1)
        model = ndtr((candidates[:, None] - place[None, :]) / blur)
        share = np.clip(share, -0.5, 1.5)
        cost = size @ (model**2).T - 2.0 * (size * share) @ model.T
        best = np.clip(np.argmin(cost, axis=1), 1, len(candidates) - 2)
        at = np.arange(len(centre))
        before, here, after = (cost[at, best + k] for k in (-1, 0, 1))
        bend = before - 2.0 * here + after
        part = np.clip(0.5 * (before - after) / np.maximum(bend, 1e-6), -0.5, 0.5)
        edge = self.offsets_mm[centre] + (candidates[best] + part) * step
        good = np.isfinite(near_mm) & (bend > 0) & (here <= before) & (here <= after)
        near_edge = np.abs(candidates[best][:, None] - place[None, :]) <= blur
        strength = (size * near_edge).sum(axis=1) / near_edge.sum(axis=1) / CLEAR_CONTRAST**2
        return np.where(good, edge, np.nan), np.clip(strength, 1e-3, 1.0)

    def _shade(self, row: IntArray, centre: IntArray) -> FloatArray:
        """Brightness of the board just outside against what is expected, shape (lines, 1, 1)."""
        first, last = self._stretch(SHADE_FROM_BLURS, SHADE_SQUARES)
        window = np.minimum(centre[:, None] + np.arange(first, last), len(self.offsets_mm) - 1)
        seen, bare = self.colours[row, window], self.expected[row, window]
        shade = np.einsum("ijk,ijk->i", seen, bare) / np.maximum(np.einsum("ijk,ijk->i", bare, bare), 1.0)
        return np.asarray(median_filter(np.clip(shade, *SHADE_RANGE), SMOOTHED_LINES)[:, None, None])

    def _inside(self, row: IntArray, centre: IntArray) -> FloatArray:
        """Colour of the body just inside its edge, shape (lines, 1, 3)."""
        first, last = self._stretch(INSIDE_FROM_BLURS, INSIDE_SQUARES)
        window = np.maximum(centre[:, None] - np.arange(first, last), 0)
        return np.asarray(median_filter(self.colours[row, window].mean(axis=1), (SMOOTHED_LINES, 1))[:, None])

    def _stretch(self, from_blurs: float, squares: float) -> tuple[int, int]:
        """Return the first and last point of a stretch beyond the edge's blur."""
        first = from_blurs * self.blur_squares / STEP_SQUARES
        return round(first), round(first + squares / STEP_SQUARES)
