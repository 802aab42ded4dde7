"""The ray caster: light that reaches each pixel, with exact edges of squares and dots, compiled."""

from __future__ import annotations

import math
import os
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numba import njit
from numpy.typing import NDArray

from .kernel import kernel
from .paint import is_plain, paint_sheet, paint_things
from .primitives import value_noise
from .scene import Scene
from .shadow import find_casters, kept_light, light_level
from .sight import INSIDE, NOTHING, board_points, find_things, what_is_near

TILE_PX = 16
"""Things and shadows that cannot touch a tile of this side are sorted out once for all its pixels."""

SHEET_CELLS, EDGE_CELLS = 2, 4


def cast(scene: Scene, width_px: int, height_px: int) -> NDArray[np.float32]:
    """Return the linear light of every pixel, shape (height, width, 3); white paper in full light is near 1.

    Each pixel is the mean over its square. Where a pixel sees an edge of a thing it is divided into 4×4
    cells, at edges of squares into 2×2; squares and the rims of discs are averaged exactly over each cell.
    """
    picture = np.empty((height_px, width_px, 3), dtype=np.float32)
    starts = range(0, height_px, TILE_PX)
    with ThreadPoolExecutor(max_workers=os.cpu_count()) as pool:
        list(pool.map(lambda first: _cast_band(scene, first, picture), starts))
    return picture


@njit(cache=True, nogil=True, error_model="numpy")
def _cast_band(scene, first, picture):  # type: ignore[no-untyped-def]
    """Fill one band of tiles; bands share nothing, so that they can run side by side."""
    points = np.empty((TILE_PX + 1, TILE_PX + 1, 2))
    things, casters = np.empty_like(scene.order), np.empty_like(scene.order)
    colours = np.empty((2, 3))
    for start in range(0, picture.shape[1], TILE_PX):
        tile = picture[first : first + TILE_PX, start : start + TILE_PX]
        rows, columns = tile.shape[:2]
        corners = points[: rows + 1, : columns + 1]
        board_points(scene.eye, first, start, corners)
        x, y, radius = _surrounding_circle(corners)
        seen = things[: find_things(scene, x, y, radius, things)]
        shading = casters[: find_casters(scene, x, y, radius, casters)]
        for row in range(rows):
            for column in range(columns):
                _pixel(scene, seen, shading, corners, row, column, colours, tile[row, column])


@kernel
def _surrounding_circle(points):  # type: ignore[no-untyped-def]
    """Return centre and radius of a circle around all points of a tile, with room for its pixels' widths."""
    rows, columns = points.shape[0] - 1, points.shape[1] - 1
    x, y = points[rows // 2, columns // 2]
    radius = 0.0
    for i in range(rows + 1):
        for j in range(columns + 1):
            radius = max(radius, math.hypot(points[i, j, 0] - x, points[i, j, 1] - y))
    pixel = math.hypot(points[1, 1, 0] - points[0, 0, 0], points[1, 1, 1] - points[0, 0, 1])
    return x, y, radius + 2.0 * pixel


@kernel
def _pixel(scene, things, casters, points, row, column, colours, out):  # type: ignore[no-untyped-def]
    """Find the light of one pixel from the board points of its four corners."""
    a, b = points[row, column], points[row, column + 1]
    c, d = points[row + 1, column], points[row + 1, column + 1]
    x, y = 0.25 * (a[0] + b[0] + c[0] + d[0]), 0.25 * (a[1] + b[1] + c[1] + d[1])
    width_x = math.hypot(0.5 * (b[0] - a[0] + d[0] - c[0]), 0.5 * (c[0] - a[0] + d[0] - b[0]))
    width_y = math.hypot(0.5 * (b[1] - a[1] + d[1] - c[1]), 0.5 * (c[1] - a[1] + d[1] - b[1]))
    near = what_is_near(scene, things, x, y, 2.0 * max(width_x, width_y))
    light, shadow = light_level(scene.light, x, y), kept_light(scene, casters, x, y)
    on_sheet = light * shadow * _mottle(scene.sheet.mottle, x, y)
    if near == INSIDE or (near == NOTHING and is_plain(scene.sheet, a, b, c, d)):
        cells = 1
    else:
        cells = SHEET_CELLS if near == NOTHING else EDGE_CELLS
    colour, total = colours[0], colours[1]
    total[:] = 0.0
    for i in range(cells):
        v = (i + 0.5) / cells
        for j in range(cells):
            u = (j + 0.5) / cells
            sx = (1 - v) * ((1 - u) * a[0] + u * b[0]) + v * ((1 - u) * c[0] + u * d[0])
            sy = (1 - v) * ((1 - u) * a[1] + u * b[1]) + v * ((1 - u) * c[1] + u * d[1])
            paint_sheet(scene.sheet, sx, sy, width_x / cells, width_y / cells, on_sheet, colour)
            if near != NOTHING:
                cell = math.sqrt(width_x * width_y) / cells
                paint_things(scene, things, sx, sy, cell, light, shadow, colour)
            for channel in range(3):
                total[channel] += colour[channel]
    for channel in range(3):
        out[channel] = total[channel] / (cells * cells)


@kernel
def _mottle(strength, x, y):  # type: ignore[no-untyped-def]
    """Unevenness of paper and ink at a board point, around 1."""
    return 1.0 + strength * (0.6 * value_noise(1.7 * x, 1.7 * y) + 0.4 * value_noise(0.09 * x, 0.09 * y))
