"""The marker as a disc fitted to its pixels: every pixel about the rim speaks, not edge points alone."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import erf

from .arrays import FloatArray, FloatImage, blur
from .board import BoardView
from .camera import project, to_plane
from .circle import Circle

REACH_RADII = 1.4
"""Pixels up to here take part, in radii."""

INNER_RADII = 0.55
"""Farther in nothing tells where the rim is, and highlights are many."""

FIRST_BLUR_PX = 0.9
BLUR_RANGE_PX = (0.4, 5.0)
STEPS = 14
FEWEST_PIXELS = 40
REACH_SIGMAS = 6.0
"""Pixels of the rim itself disagree more than those beside it; what covers the disc does so far more."""

LARGEST_MOVE_RADII = 0.25
"""A disc farther than this from the circle through the edge points is something else."""

CORRELATION_PX = 2.0
"""Pixels this near share their error (demosaicing, JPEG, the smoothing): the reach of its covariance."""


@dataclass(frozen=True)
class Disc:
    """A disc in the plane of the board.

    Parameters
    ----------
    centre : array, shape (2,)
        In squares of the board.
    radius : float
        In squares of the board.
    sigma_px : float
        Standard uncertainty of one coordinate of the centre, px.
    """

    centre: FloatArray
    radius: float
    sigma_px: float


def fit_disc(image: FloatImage, board: BoardView, start: Circle) -> Disc | None:
    """Fit a blurred disc to the pixels about a rim; None where that fails.

    Inside and outside each have one level; pixels that disagree (a highlight, print, the body's edge) and
    sectors in which no edge was found lose their weight or count for nothing.

    Parameters
    ----------
    image : array, shape (height, width, 3)
        Colours, lightly smoothed: the zigzag that demosaicing leaves along coloured edges drops out.
    board : BoardView
        The board's lattice in this photograph.
    start : Circle
        Circle through the edge points, in squares of the board; its points are in order of angle.
    """
    pixels, colours = _window(image, board, start)
    plane = to_plane(board.camera, board.pose, pixels)
    offset = plane - start.centre
    distance = np.linalg.norm(offset, axis=1) / start.radius
    sector = np.floor(np.arctan2(offset[:, 1], offset[:, 0]) / (2.0 * np.pi) * len(start.support))
    seen = start.support[sector.astype(np.intp) % len(start.support)] & (distance < REACH_RADII)
    direction = _step_direction(colours[seen & (distance < 0.8)], colours[seen & (distance > 1.15)])
    used = seen & (distance > INNER_RADII)
    if direction is None or used.sum() < FEWEST_PIXELS:
        return None
    per_square = _pixels_per_square(board, start.centre)
    model = _Model(pixels[used], plane[used], colours[used] @ direction, per_square)
    return _settle(model, start)


def _settle(model: _Model, start: Circle) -> Disc | None:
    """Gauss-Newton with Cauchy weights from the circle through the edge points."""
    unknown = np.array([*start.centre, start.radius, np.log(FIRST_BLUR_PX)])
    limit = np.array([0.2 * start.radius] * 3 + [0.4])
    for _ in range(STEPS):
        design, rest = model.linearised(unknown)
        sigma = _spread(rest)
        weight = 1.0 / (1.0 + (rest / (REACH_SIGMAS * sigma)) ** 2)
        normal = design.T @ (weight[:, None] * design) + 1e-9 * np.eye(design.shape[1])
        step = np.linalg.solve(normal, design.T @ (weight * rest))[: len(unknown)]
        unknown = unknown + np.clip(step, -limit, limit)
        unknown[3] = np.clip(unknown[3], *np.log(BLUR_RANGE_PX))
    moved = np.abs(unknown[:3] - [*start.centre, start.radius]).max()
    if not moved < LARGEST_MOVE_RADII * start.radius or np.abs(step[:3]).max() > 0.01 * start.radius:
        return None
    pull = (weight * rest)[:, None] * design @ np.linalg.inv(normal)[:, :2] @ model.per_square.T
    rim_px = 2.0 * np.pi * unknown[2] * np.sqrt(abs(np.linalg.det(model.per_square))) * start.support.mean()
    return Disc(unknown[:2], float(unknown[2]), _scatter_px(model.pixels, pull, rim_px))


def _scatter_px(pixels: FloatArray, pull_px: FloatArray, rim_px: float) -> float:
    """Return the standard uncertainty of one coordinate of the centre, from the pull of each pixel's misfit.

    The misfits' own correlation counts, whatever its cause: products of near pixels' pulls are summed with
    weights that fall off with distance (White's covariance for correlated errors, Conley 1999). Centre and
    radius have taken three of the rim's independent stretches to themselves.
    """
    row, column = (pixels - pixels.min(axis=0)).astype(np.intp).T[::-1]
    pulls = np.zeros((row.max() + 1, column.max() + 1, 2), dtype=np.float32)
    pulls[row, column] = pull_px
    shared = 2.0 * np.pi * CORRELATION_PX**2 * blur(pulls, CORRELATION_PX)
    stretches = rim_px / (np.sqrt(2.0 * np.pi) * CORRELATION_PX)
    return float(np.sqrt(0.5 * (pulls * shared).sum() * stretches / max(stretches - 3.0, 1.0)))


@dataclass(frozen=True)
class _Model:
    """Pixels, where they lie in the plane of the board, their values, and pixels a square (2, 2) there."""

    pixels: FloatArray
    plane: FloatArray
    values: FloatArray
    per_square: FloatArray

    def linearised(self, unknown: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the derivatives by centre, radius, log blur and both levels, and what the disc leaves over.

        The levels enter linearly: the best ones for the disc at hand are found on the way.
        """
        offset = self.plane - unknown[:2]
        length = np.maximum(np.linalg.norm(offset, axis=1), 1e-9)
        normal = offset / length[:, None]
        # Pixels a square along the rim's normal in the photograph.
        stretch = 1.0 / np.linalg.norm(normal @ np.linalg.inv(self.per_square), axis=1)
        blur = np.exp(unknown[3])
        place = (length - unknown[2]) * stretch / blur
        outside = 0.5 * (1.0 + erf(place / np.sqrt(2.0)))
        shares = np.column_stack([1.0 - outside, outside])
        levels = _robust_levels(shares, self.values)
        rise = (levels[1] - levels[0]) * np.exp(-0.5 * place**2) / np.sqrt(2.0 * np.pi)
        outward = rise * stretch / blur
        design = np.column_stack([-outward[:, None] * normal, -outward, -rise * place, shares])
        return design, self.values - shares @ levels


def _robust_levels(shares: FloatArray, values: FloatArray) -> FloatArray:
    weight = np.ones(len(values))
    for _ in range(4):
        levels = np.linalg.lstsq(shares * weight[:, None], values * weight, rcond=None)[0]
        rest = values - shares @ levels
        weight = 1.0 / (1.0 + (rest / (REACH_SIGMAS * _spread(rest))) ** 2)
    return np.asarray(levels)


def _spread(rest: FloatArray) -> float:
    return 1.4826 * float(np.median(np.abs(rest))) + 1e-6


def _step_direction(inner: FloatArray, outer: FloatArray) -> FloatArray | None:
    """Colour direction that tells inside from outside best (Fisher's discriminant), the step scaled to 1."""
    if min(len(inner), len(outer)) < 8:
        return None
    step = np.median(inner, axis=0) - np.median(outer, axis=0)
    direction = np.linalg.solve(np.cov(inner.T) + np.cov(outer.T) + 4.0 * np.eye(3), step)
    length = float(step @ direction)
    if length <= 1e-9:
        return None
    scaled: FloatArray = np.asarray(direction / length, dtype=np.float64)
    return scaled


def _window(image: FloatImage, board: BoardView, start: Circle) -> tuple[FloatArray, FloatArray]:
    """Pixels of a box around the disc, shape (n, 2), and their colours, shape (n, 3)."""
    angle = np.linspace(0.0, 2.0 * np.pi, 32, endpoint=False)
    ring = start.centre + REACH_RADII * start.radius * np.column_stack([np.cos(angle), np.sin(angle)])
    border = project(board.camera, board.pose, ring)
    height, width = image.shape[:2]
    left, top = np.clip(np.floor(border.min(axis=0)), 0, [width, height]).astype(int)
    right, bottom = np.clip(np.ceil(border.max(axis=0)) + 1, 0, [width, height]).astype(int)
    columns, rows = np.meshgrid(np.arange(left, right), np.arange(top, bottom))
    pixels = np.column_stack([columns.ravel(), rows.ravel()]).astype(float)
    return pixels, image[top:bottom, left:right].reshape(-1, 3).astype(float)


def _pixels_per_square(board: BoardView, centre: FloatArray) -> FloatArray:
    """Jacobian of pixels by squares of the board, shape (2, 2)."""
    step = 0.5 * np.eye(2)
    ahead, behind = (project(board.camera, board.pose, centre + sign * step) for sign in (1.0, -1.0))
    return np.asarray((ahead - behind).T)
