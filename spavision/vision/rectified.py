"""The board as seen from straight ahead, and how unlike a bare board each place of it looks."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, cast

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtri

from .arrays import BoolArray, FloatArray, FloatImage, IntArray, RgbImage, blur, sample, shrink, shrunk_place
from .camera import Camera, Pose, project
from .grid import median_pitch

PIXELS_A_SQUARE = 8
"""Side of a square in the rectified picture, px: 0.3 mm a pixel on 2.5 mm squares."""

MOST_SQUARES = 200_000
"""A board of more squares than this does not fit the memory set aside for the picture."""

BARE_MARGIN_SQUARES = 8
"""Bare board that is kept around what hides it."""

LARGEST_STRANGENESS = 9.0
"""Squared deviation, in variances, beyond which a pixel says no more than that it is not the board."""

SHADE_RANGE = (0.3, 1.15)
"""Brightness against the neighbourhood that a shadow, or its end, may give the board."""

BLUR_RANGE = (0.05, 0.3)
"""Blur, in squares, that is believed: less cannot be told, with more there are no corners."""

LEVEL_REACH_SQUARES = 2.5
LEVEL_WIDE_REACH_SQUARES = 12.0
SMALLEST_SIGMA = 2.5
CELLS_FOR_PATTERN = 500
FEWEST_BARE = 20
"""Bare squares of either kind that are needed to learn what they look like."""


@dataclass(frozen=True)
class RectifiedBoard:
    """A photograph mapped onto the board's plane, `PIXELS_A_SQUARE` pixels a square.

    Parameters
    ----------
    rgb : float32 array, shape (rows × pixels, columns × pixels, 3)
        Colours, 0 to 255.
    origin : int array, shape (2,)
        Column and row of the first square.
    square_mm : float
        Side of a square.
    seen : bool array, shape (rows, columns)
        Squares whose four corners were measured: bare board for certain.
    known : bool array, shape (rows, columns)
        Squares that lie in the photograph.
    bright_parity : int
        Bright squares are those whose row and column, counted from the first, add up to this modulo 2.
    """

    rgb: FloatImage
    origin: IntArray
    square_mm: float
    seen: BoolArray
    known: BoolArray
    bright_parity: int

    @property
    def pixel_mm(self) -> float:
        """Side of a pixel, mm."""
        return self.square_mm / PIXELS_A_SQUARE

    def to_mm(self, pixels: FloatArray) -> FloatArray:
        """Return the board points, mm, of rectified pixels, shape (..., 2)."""
        return (self.origin + (pixels + 0.5) / PIXELS_A_SQUARE) * self.square_mm

    def to_pixels(self, points_mm: FloatArray) -> FloatArray:
        """Return the rectified pixels of board points, shape (..., 2)."""
        return (points_mm / self.square_mm - self.origin) * PIXELS_A_SQUARE - 0.5


def rectify(
    photo_rgb: RgbImage,
    camera: Camera,
    pose: Pose,
    *,
    indices: IntArray,
    corners_px: FloatArray,
    square_mm: float,
    around_mm: FloatArray,
) -> RectifiedBoard | None:
    """Map a part of a photograph onto the board's plane: all that may hide the board around a point.

    Parameters
    ----------
    indices, corners_px : arrays, shape (n, 2)
        The measured corners: column and row, and pixels.
    square_mm : float
        Side of a square.
    around_mm : array, shape (2,)
        A point of the board that something hides.

    Returns
    -------
    RectifiedBoard or None
        None where the point lies on bare board or off it, or the board has too many squares to be real.
    """
    low, high = indices.min(axis=0) - 1, indices.max(axis=0) + 1
    if np.prod(high - low) > MOST_SQUARES:
        return None
    measured = np.zeros(tuple((high - low + 1)[::-1]), dtype=bool)
    measured[indices[:, 1] - low[1], indices[:, 0] - low[0]] = True
    seen = _all_four(measured)
    part = _hidden_part(seen, np.floor(around_mm / square_mm).astype(np.intp) - low)
    if part is None:
        return None
    seen, low = seen[part], low + np.array([part[1].start, part[0].start])
    rows, columns = seen.shape
    nodes = np.stack(np.meshgrid(np.arange(columns + 1), np.arange(rows + 1)), axis=-1) + low
    flat = nodes.reshape(-1, 2) * square_mm
    pixels = project(camera, pose, flat.astype(float)).reshape(rows + 1, columns + 1, 2)
    factor = min(1.0, PIXELS_A_SQUARE / median_pitch(indices, corners_px))
    places = _between_nodes(shrunk_place(pixels, factor))
    # OpenCV takes bytes as well as floats; a large photo is not turned into floats whole.
    rgb = sample(shrink(cast(FloatImage, photo_rgb), factor), places)
    height, width = photo_rgb.shape[:2]
    inside = np.asarray(((pixels >= 0) & (pixels <= [width - 1, height - 1])).all(axis=-1))
    # Column + row of a corner is even where the square to its lower right is bright.
    return RectifiedBoard(rgb, low, square_mm, seen, _all_four(inside), bright_parity=int(low.sum() % 2))


@dataclass(frozen=True)
class BareBoard:
    """What the board would look like bare, and how unlike that each rectified pixel looks.

    Parameters
    ----------
    expected : float32 array, shape (rows × pixels, columns × pixels, 3)
        Colours of the bare board, without shadows that no bare square near by shows.
    strangeness : float32 array, shape (rows × pixels, columns × pixels)
        Mean squared deviation in variances, 0 to `LARGEST_STRANGENESS`; NaN outside the photograph.
    blur_squares : float
        Blur of the squares' borders, one standard deviation.
    """

    expected: FloatImage
    strangeness: FloatImage
    blur_squares: float


def imagine_bare(board: RectifiedBoard) -> BareBoard | None:
    """Compare a rectified photograph with the bare board; None where too few squares are seen bare.

    What a bare square looks like (its level, its blurred border, its scatter) is learnt from the squares
    whose four corners were measured. A shadow dims a square but leaves its hue and its dark neighbours dark,
    so each pixel is compared with the expected colour times the best factor within `SHADE_RANGE`.
    """
    n = PIXELS_A_SQUARE
    rows, columns = board.seen.shape
    cells = board.rgb.reshape(rows, n, columns, n, 3)
    core = cells[:, n // 4 : -(n // 4), :, n // 4 : -(n // 4)].mean(axis=(1, 3))
    bright = np.add.outer(np.arange(rows), np.arange(columns)) % 2 == board.bright_parity
    if min(np.count_nonzero(board.seen & bright), np.count_nonzero(board.seen & ~bright)) < FEWEST_BARE:
        return None
    light, dark = _levels(core, board.seen & bright), _levels(core, board.seen & ~bright)
    imagined = np.empty_like(cells)
    strange = np.empty((rows, n, columns, n), np.float32)
    blurs = []
    for parity in (True, False):
        chosen = bright == parity
        pattern, sigma = _learn(cells, light, dark, chosen & board.seen)
        blurs.append(_blur_squares(pattern if parity else 1.0 - pattern))
        row, column = np.nonzero(chosen)
        expected = _expected(light[row, column], dark[row, column], pattern)
        imagined[row, :, column] = expected
        strange[row, :, column] = _deviation(cells[row, :, column], expected, sigma)
    strange[np.broadcast_to(~board.known[:, None, :, None], strange.shape)] = np.nan
    pictures = imagined.reshape(rows * n, columns * n, 3), strange.reshape(rows * n, columns * n)
    return BareBoard(*pictures, float(np.mean(blurs)))


def _hidden_part(seen: BoolArray, square: IntArray) -> tuple[slice, slice] | None:
    """Rows and columns around the hidden squares that hang together with ``square`` (column, row)."""
    column, row = square.tolist()
    if not (0 <= row < seen.shape[0] and 0 <= column < seen.shape[1]):
        return None
    hidden = (~seen).astype(np.uint8)
    # The rim of the board, never seen whole, would join everything that reaches it.
    hidden[[0, -1]], hidden[:, [0, -1]] = 0, 0
    _, labels, boxes, _ = cv2.connectedComponentsWithStats(hidden, connectivity=4)
    label = int(labels[row, column])
    if label == 0:
        return None
    left, top, width, height, _ = boxes[label].tolist()
    rows = slice(max(0, top - BARE_MARGIN_SQUARES), top + height + BARE_MARGIN_SQUARES)
    return rows, slice(max(0, left - BARE_MARGIN_SQUARES), left + width + BARE_MARGIN_SQUARES)


def _between_nodes(nodes: FloatArray) -> FloatArray:
    """Interpolate positions at the squares' corners to the centres of the rectified pixels."""
    rows, columns = (nodes.shape[0] - 1, nodes.shape[1] - 1)
    down, right = _weights(rows), _weights(columns)
    return np.stack([down @ nodes[..., k] @ right.T for k in range(2)], axis=-1)


def _weights(squares: int) -> FloatArray:
    place = (np.arange(squares * PIXELS_A_SQUARE) + 0.5) / PIXELS_A_SQUARE
    return np.maximum(0.0, 1.0 - np.abs(place[:, None] - np.arange(squares + 1)))


def _all_four(nodes: BoolArray) -> BoolArray:
    return np.asarray(nodes[:-1, :-1] & nodes[1:, :-1] & nodes[:-1, 1:] & nodes[1:, 1:])


def _levels(core: FloatImage, chosen: BoolArray) -> FloatImage:
    """Spread the colours of the chosen squares over all, near ones first, shape (rows, columns, 3)."""
    weight = chosen.astype(np.float32)
    value = core * weight[..., None]
    total, mass = np.zeros_like(core), np.zeros_like(weight)
    for reach, share in ((LEVEL_REACH_SQUARES, 1.0), (LEVEL_WIDE_REACH_SQUARES, 1e-2), (60.0, 1e-5)):
        total += share * blur(value, reach)
        mass += share * blur(weight, reach)
    return np.asarray(total / np.maximum(mass, 1e-12)[..., None], dtype=np.float32)


def _learn(
    cells: FloatImage, light: FloatImage, dark: FloatImage, bare: BoolArray
) -> tuple[FloatImage, FloatImage]:
    """Learn a bare square's pattern (0 dark, 1 bright; shape (n, n)) and its scatter (n, n, 3)."""
    row, column = np.nonzero(bare)
    pick = np.linspace(0, len(row) - 1, min(CELLS_FOR_PATTERN, len(row))).astype(np.intp)
    row, column = row[pick], column[pick]
    values, low, high = cells[row, :, column], dark[row, column], light[row, column]
    span = np.maximum(high - low, 4.0)[:, None, None]
    pattern = np.median(((values - low[:, None, None]) / span).mean(axis=-1), axis=0)
    residual = values - _expected(high, low, pattern)
    sigma = 1.4826 * np.median(np.abs(residual), axis=0)
    return pattern.astype(np.float32), np.maximum(sigma, SMALLEST_SIGMA).astype(np.float32)


def _blur_squares(pattern: FloatImage) -> float:
    """Return the blur of a square's borders from its pattern, shape (n, n), 1 inside and 0 beyond."""
    n = PIXELS_A_SQUARE
    inside = slice(n // 4, n - n // 4)
    across = 0.5 * (pattern[inside].mean(axis=0) + pattern[:, inside].mean(axis=1))
    across = 0.5 * (across + across[::-1])
    # Two pixels from the border: a share Φ(distance / blur) of the step.
    share = np.clip(across[1] / max(float(across[n // 2]), 0.1), 0.6, 0.999)
    return float(np.clip(1.5 / n / ndtri(share), *BLUR_RANGE))


def _expected(light: FloatImage, dark: FloatImage, pattern: FloatImage) -> FloatImage:
    """Colours of bare squares, shape (squares, n, n, 3), from their levels, shape (squares, 3)."""
    return dark[:, None, None] + (light - dark)[:, None, None] * pattern[None, :, :, None]


def _deviation(values: FloatImage, expected: FloatImage, sigma: FloatImage) -> FloatImage:
    shade = _dot(values, expected) / np.maximum(_dot(expected, expected), 1.0)
    away = values - np.clip(shade, *SHADE_RANGE)[..., None] * expected
    away /= sigma
    return np.asarray(np.minimum(_dot(away, away) / 3.0, LARGEST_STRANGENESS), dtype=np.float32)


def _dot(first: NDArray[Any], second: NDArray[Any]) -> NDArray[Any]:
    """Sum of products over the colours; several times faster than NumPy's sum over a short axis."""
    return np.asarray(np.einsum("...k,...k->...", first, second))
