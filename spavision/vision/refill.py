"""Guided refill: a fitted lattice tells where its missing corners must be; they are looked for there."""

from __future__ import annotations

from dataclasses import dataclass, replace

import cv2
import numpy as np

from .adjustment import Adjustment, Priors, View, adjust
from .arrays import BoolArray, FloatArray, FloatImage, IntArray, blur
from .camera import Camera, Pose, project
from .grid import median_pitch, spread_subset
from .saddle_fit import fit_saddles
from .saddles import ring_test

FIT_CORNERS = 1500
"""Corners that enter a fit on the way."""

FINAL_CORNERS = 5000
"""Corners that enter the last fit."""

FRONTIER_SQUARES = (6, 12, 24, 48)
"""How far beyond known corners the lattice is extended: farther once nothing is gained near by."""

LEAST_GAIN = 0.003
"""Share of new corners below which the search goes farther out, or ends."""

GAIN_A_CORNER = 0.005
"""Gain in chi-square, a corner, at which a fit on the way ends: corners then move by a tenth of their noise,
while focal length, distance and distortion of a board seen from ahead could creep on for long."""

LOWEST_QUALITY = 0.62
LOWEST_CONTRAST = 0.25
LARGEST_STEP_SQUARES = 0.2

LEAST_GATE_PX = 0.15
"""A corner this near its expected place stays: the fit on the way is no better than that itself."""


@dataclass(frozen=True)
class Corners:
    """Indexed corners: indices (n, 2), pixels (n, 2), and the typical contrast of the board, grey levels."""

    indices: IntArray
    pixels: FloatArray
    contrast: float

    def take(self, rows: BoolArray) -> Corners:
        """Return the corners at the given rows."""
        return replace(self, indices=self.indices[rows], pixels=self.pixels[rows])

    def pitch_px(self) -> float:
        """Return the median distance between neighbouring corners."""
        return median_pitch(self.indices, self.pixels)


def fit_corners(
    corners: Corners, priors: Priors, *, largest: int, start: Adjustment | None = None
) -> Adjustment:
    """Fit camera and pose to corners on a lattice of unit squares."""
    rows = spread_subset(corners.indices, largest)
    view = View(corners.indices[rows].astype(float), corners.pixels[rows])
    return adjust([view], priors, start=start, least_gain=GAIN_A_CORNER * len(rows))


def guided_refill(gray: FloatImage, corners: Corners, priors: Priors) -> Corners:
    """Extend a grown lattice over the whole board.

    The lattice is projected a few squares beyond what is known, refined there, gated by ring test, colour
    parity and distance from its expected place, and the model is fitted again. When little is gained, the
    search goes farther out: across an actuator or a cable that splits the board in two.

    Parameters
    ----------
    gray : float32 array
        FloatImage in which the corners' pixels were measured.
    corners : Corners
        The grown lattice.
    priors : Priors
        Weak knowledge of the camera, for squares of unit length.
    """
    cautious = replace(priors, sigma_radial=0.15, sigma_tangential=0.003)
    pitch = corners.pitch_px()
    tested = blur(gray, max(0.1 * pitch, 0.5))
    corners, fit = drop_outliers(corners, cautious)
    tried = np.zeros((0, 2), dtype=np.intp)
    reaches = iter(FRONTIER_SQUARES)
    reach = next(reaches)
    for _ in range(16):
        if fit is None or reach == 0:
            break
        nodes = _frontier(corners.indices, tried, reach)
        tried = np.concatenate([tried, nodes])
        found = _measure(gray, tested, nodes, fit, corners, pitch)
        joined = replace(
            corners,
            indices=np.concatenate([corners.indices, found.indices]),
            pixels=np.concatenate([corners.pixels, found.pixels]),
        )
        gain = len(found.indices) / len(corners.indices)
        corners = joined
        if gain < LEAST_GAIN:
            reach = next(reaches, 0)
        else:
            corners, fit = drop_outliers(joined, cautious if gain > 0.02 else priors, start=fit)
    return corners


def drop_outliers(
    corners: Corners, priors: Priors, *, start: Adjustment | None = None, last: bool = False
) -> tuple[Corners, Adjustment | None]:
    """Fit, drop what lies beyond 4 sigma or stands alone; None when too little is left.

    The ``last`` time it is done once more, with more corners in the fit.
    """
    fit = start
    for largest in (FIT_CORNERS, FINAL_CORNERS) if last else (FIT_CORNERS,):
        if len(corners.indices) < 12:
            return corners, None
        fit = fit_corners(corners, priors, largest=largest, start=fit)
        expected = project(fit.camera, fit.poses[0], corners.indices.astype(float))
        error = np.linalg.norm(corners.pixels - expected, axis=1)
        corners = corners.take(error < max(4.0 * fit.sigma_px, LEAST_GATE_PX))
        corners = corners.take(_has_neighbours(corners.indices))
    return corners, fit


def _frontier(indices: IntArray, tried: IntArray, reach: int) -> IntArray:
    """Lattice nodes within ``reach`` squares of a known corner that are neither known nor tried."""
    lowest = indices.min(axis=0) - reach
    size = indices.max(axis=0) + reach + 1 - lowest
    known = np.zeros((size[1], size[0]), dtype=np.uint8)
    known[indices[:, 1] - lowest[1], indices[:, 0] - lowest[0]] = 1
    near = cv2.dilate(known, np.ones((2 * reach + 1, 2 * reach + 1), np.uint8)) > known
    rows, columns = np.nonzero(near)
    nodes = np.column_stack([columns, rows]) + lowest
    stride = 1 << 20
    return nodes[~np.isin(nodes @ [1, stride], tried @ [1, stride])]


def _measure(
    gray: FloatImage,
    tested: FloatImage,
    nodes: IntArray,
    fit: Adjustment,
    corners: Corners,
    pitch: float,
) -> Corners:
    """Look for the given nodes' corners where the fit expects them."""
    expected, (across, down) = expected_corners(fit.camera, fit.poses[0], nodes)
    local_pitch = np.sqrt(np.abs(across[:, 0] * down[:, 1] - across[:, 1] * down[:, 0]))
    height, width = gray.shape
    visible = (
        (expected > 0).all(axis=1)
        & (expected[:, 0] < width - 1)
        & (expected[:, 1] < height - 1)
        & (local_pitch > 0.3 * pitch)
    )
    nodes, expected, across, down = nodes[visible], expected[visible], across[visible], down[visible]
    if len(nodes) == 0:
        return replace(corners, indices=nodes, pixels=expected)
    pixels = fit_saddles(gray, expected, across, down)
    pixels = np.where(np.isfinite(pixels), pixels, -1e6)
    near = np.linalg.norm(pixels - expected, axis=1) < LARGEST_STEP_SQUARES * pitch
    nodes, pixels, across, down = nodes[near], pixels[near], across[near], down[near]
    parity, quality, contrast = ring_test(tested, pixels, (across, down))
    wanted = 1 - 2 * (nodes.sum(axis=1) % 2)
    good = (quality > LOWEST_QUALITY) & (parity == wanted) & (contrast > LOWEST_CONTRAST * corners.contrast)
    return replace(corners, indices=nodes[good], pixels=pixels[good])


def expected_corners(
    camera: Camera, pose: Pose, nodes: IntArray
) -> tuple[FloatArray, tuple[FloatArray, FloatArray]]:
    """Where the model expects the nodes, and the local lattice vectors, all of shape (n, 2), px."""
    points, along = nodes.astype(float), np.array([0.5, 0.0])
    expected = project(camera, pose, points)
    across = project(camera, pose, points + along) - project(camera, pose, points - along)
    down = project(camera, pose, points + along[::-1]) - project(camera, pose, points - along[::-1])
    return expected, (across, down)


def _has_neighbours(indices: IntArray) -> BoolArray:
    """Corners with at least two of their eight neighbours present."""
    if len(indices) == 0:
        return np.zeros(0, dtype=bool)
    lowest = indices.min(axis=0) - 1
    size = indices.max(axis=0) + 2 - lowest
    known = np.zeros((size[1], size[0]), dtype=np.float32)
    column, row = (indices - lowest).T
    known[row, column] = 1.0
    around = cv2.filter2D(known, -1, np.ones((3, 3), np.float32), borderType=cv2.BORDER_CONSTANT)
    return around[row, column] >= 3.0
