"""The ray caster: light that reaches each pixel, with exact edges of squares and dots, compiled."""

from __future__ import annotations

import math
import os
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numba import njit
from numpy.typing import NDArray

from .distortion import undistort
from .primitives import (
    box_distance,
    disc_distance,
    segment_meets_box,
    smooth_step,
    soft_step,
    stripe_mean,
    tube_distance,
    value_noise,
    window_share,
)
from .scene import BODY, BOX, DISC, TUBE, Scene
from .surface import body_across, body_colour, body_distance, shadow_on_board

ROWS_A_BLOCK = 32
CELLS = 4
FAR_MM = 1e6

NOTHING, INSIDE, EDGE = 0, 1, 2
"""What a pixel may see of the things before the board: none, plain surface only, or an edge."""

JOINT_CLEARANCE_MM = 0.6


def cast(scene: Scene, width_px: int, height_px: int) -> NDArray[np.float32]:
    """Return the linear light of every pixel, shape (height, width, 3); white paper in full light is near 1.

    Each pixel is the mean over its square. Where a pixel sees an edge it is divided into 4×4 cells; the
    board's squares and the rims of discs are averaged exactly over each cell.
    """
    picture = np.empty((height_px, width_px, 3), dtype=np.float32)
    starts = range(0, height_px, ROWS_A_BLOCK)
    with ThreadPoolExecutor(max_workers=os.cpu_count()) as pool:
        list(pool.map(lambda first: _cast_rows(scene, first, picture), starts))
    return picture


@njit(cache=True, nogil=True)
def _cast_rows(scene, first, picture):  # type: ignore[no-untyped-def]
    """Fill one block of rows; blocks share nothing, so that they can run side by side."""
    height, width = picture.shape[:2]
    upper = np.empty((width + 1, 2))
    lower = np.empty((width + 1, 2))
    colours = np.empty((2, 3))
    _board_points(scene.eye, first - 0.5, upper)
    for row in range(first, min(first + ROWS_A_BLOCK, height)):
        _board_points(scene.eye, row + 0.5, lower)
        for column in range(width):
            _pixel(scene, upper, lower, column, colours, picture[row, column])
        upper, lower = lower, upper


@njit(cache=True)
def _board_points(eye, v, points):  # type: ignore[no-untyped-def]
    """Fill the board points seen along one line of pixel corners, at image row v."""
    x, y = 0.0, 0.0
    for column in range(points.shape[0]):
        xd = (column - 0.5 - eye.cx) / eye.fx
        yd = (v - eye.cy) / eye.fy
        if column == 0:
            x, y = xd, yd
        x, y = undistort(xd, yd, eye.distortion, x, y)
        r = eye.rotation
        dx = r[0, 0] * x + r[1, 0] * y + r[2, 0]
        dy = r[0, 1] * x + r[1, 1] * y + r[2, 1]
        dz = r[0, 2] * x + r[1, 2] * y + r[2, 2]
        if dz < 1e-6:
            points[column, 0], points[column, 1] = FAR_MM, FAR_MM
            continue
        reach = eye.centre[2] / dz
        points[column, 0] = eye.centre[0] + reach * dx
        points[column, 1] = eye.centre[1] + reach * dy


@njit(cache=True)
def _pixel(scene, upper, lower, column, colours, out):  # type: ignore[no-untyped-def]
    """Find the light of one pixel from the board points of its four corners."""
    ax, ay = upper[column, 0], upper[column, 1]
    bx, by = upper[column + 1, 0], upper[column + 1, 1]
    cx, cy = lower[column, 0], lower[column, 1]
    dx, dy = lower[column + 1, 0], lower[column + 1, 1]
    x, y = 0.25 * (ax + bx + cx + dx), 0.25 * (ay + by + cy + dy)
    width_x = math.hypot(0.5 * (bx - ax + dx - cx), 0.5 * (cx - ax + dx - bx))
    width_y = math.hypot(0.5 * (by - ay + dy - cy), 0.5 * (cy - ay + dy - by))
    light, shadow = _light_at(scene, x, y)
    blotch = 1.0 + scene.sheet.mottle * (
        0.6 * value_noise(1.7 * x, 1.7 * y) + 0.4 * value_noise(0.09 * x, 0.09 * y)
    )
    near = _what_is_near(scene, x, y, max(width_x, width_y))
    colour, total = colours[0], colours[1]
    if near == NOTHING and _is_plain(scene.sheet, ax, ay, bx, by, cx, cy, dx, dy):
        _paint_sheet(scene.sheet, x, y, width_x, width_y, light * shadow * blotch, colour)
        out[0], out[1], out[2] = colour[0], colour[1], colour[2]
        return
    total[:] = 0.0
    cells = 1 if near == INSIDE else CELLS
    for i in range(cells):
        v = (i + 0.5) / cells
        for j in range(cells):
            u = (j + 0.5) / cells
            sx = (1 - v) * ((1 - u) * ax + u * bx) + v * ((1 - u) * cx + u * dx)
            sy = (1 - v) * ((1 - u) * ay + u * by) + v * ((1 - u) * cy + u * dy)
            _paint_sheet(
                scene.sheet, sx, sy, width_x / cells, width_y / cells, light * shadow * blotch, colour
            )
            if near != NOTHING:
                _paint_things(scene, sx, sy, math.sqrt(width_x * width_y) / cells, light, shadow, colour)
            for channel in range(3):
                total[channel] += colour[channel]
    for channel in range(3):
        out[channel] = total[channel] / (cells * cells)


@njit(cache=True)
def _light_at(scene, x, y):  # type: ignore[no-untyped-def]
    """Light falling on things in front of a board point, and the share of it that reaches the board."""
    light = scene.light
    level = 1.0 + light.gradient_x * x + light.gradient_y * y
    level = min(max(level, 0.1), 2.5)
    if light.edge_shadow > 0:
        ahead = x * light.edge_cos + y * light.edge_sin - light.edge_offset
        level *= 1.0 - light.edge_shadow * smooth_step(0.5 + ahead / light.edge_softness)
    return level, 1.0 - light.shadow * shadow_on_board(scene, x, y)


@njit(cache=True)
def _is_plain(sheet, ax, ay, bx, by, cx, cy, dx, dy):  # type: ignore[no-untyped-def]
    """Tell whether a pixel lies inside a single square, or well outside the sheet."""
    x_low, x_high = min(min(ax, bx), min(cx, dx)), max(max(ax, bx), max(cx, dx))
    y_low, y_high = min(min(ay, by), min(cy, dy)), max(max(ay, by), max(cy, dy))
    outer_x, outer_y = sheet.half_width + sheet.margin, sheet.half_height + sheet.margin
    if x_low > outer_x or x_high < -outer_x or y_low > outer_y or y_high < -outer_y:
        return True
    if x_low < -sheet.half_width or x_high > sheet.half_width:
        return False
    if y_low < -sheet.half_height or y_high > sheet.half_height:
        return False
    columns = (
        math.floor((x_low + sheet.half_width) / sheet.pitch),
        math.floor((x_high + sheet.half_width) / sheet.pitch),
    )
    rows = (
        math.floor((y_low + sheet.half_height) / sheet.pitch),
        math.floor((y_high + sheet.half_height) / sheet.pitch),
    )
    return columns[0] == columns[1] and rows[0] == rows[1]


@njit(cache=True)
def _paint_sheet(sheet, x, y, width_x, width_y, light, colour):  # type: ignore[no-untyped-def]
    """Set the colour of wall, paper and squares, averaged over a window."""
    paper = window_share(x, width_x, -sheet.half_width - sheet.margin, sheet.half_width + sheet.margin)
    paper *= window_share(y, width_y, -sheet.half_height - sheet.margin, sheet.half_height + sheet.margin)
    printed = window_share(x, width_x, -sheet.half_width, sheet.half_width)
    printed *= window_share(y, width_y, -sheet.half_height, sheet.half_height)
    ink = 0.0
    if printed > 0.0:
        stripes = stripe_mean(x + sheet.half_width, width_x, sheet.pitch)
        stripes *= stripe_mean(y + sheet.half_height, width_y, sheet.pitch)
        ink = printed * (0.5 + 0.5 * stripes)
    for channel in range(3):
        print_ = sheet.white[channel] + ink * (sheet.black[channel] - sheet.white[channel])
        wall = sheet.wall[channel] * (1.0 - paper)
        colour[channel] = (paper * print_ + wall) * light


@njit(cache=True)
def _what_is_near(scene, x, y, footprint):  # type: ignore[no-untyped-def]
    """Tell what the pixel around a board point may see of the things before the board."""
    near = NOTHING
    for k in range(scene.order.shape[0]):
        kind, index = scene.order[k]
        if kind == BODY:
            near = max(near, _body_near(scene, x, y, 2 * footprint))
        elif kind == DISC:
            px, py = _at_height(scene.eye, x, y, scene.discs[index, 2])
            if disc_distance(px, py, scene.discs[index]) < 2 * footprint:
                return EDGE
        elif kind == TUBE:
            px, py = _at_height(scene.eye, x, y, scene.tubes[index, 8])
            if abs(tube_distance(px, py, scene.tubes[index])) < scene.tubes[index, 9] + 2 * footprint:
                return EDGE
        elif kind == BOX:
            box = scene.boxes[index]
            px, py = _at_height(scene.eye, x, y, box[6])
            reach = (box[6] - box[7]) * _lean(scene.eye, x, y)
            distance = box_distance(px, py, box)
            if distance < -2 * footprint:
                near = max(near, INSIDE)
            elif distance < reach + 2 * footprint:
                return EDGE
    return near


@njit(cache=True)
def _body_near(scene, x, y, clearance):  # type: ignore[no-untyped-def]
    """Tell what a pixel may see of the actuator; the composite's fine pattern counts as edges."""
    body = scene.body
    px, py = _at_height(scene.eye, x, y, body.face_z)
    distance = body_distance(body, px, py)
    if distance > body.thickness * _lean(scene.eye, x, y) + 3.0 + clearance:
        return NOTHING
    depth = -body_across(body, px, py) * body.composite_side
    after_composite = depth > body.layer_edges[0] + JOINT_CLEARANCE_MM + clearance
    before_strip = depth < body.layer_edges[2] - JOINT_CLEARANCE_MM - clearance
    # The face may lean towards the camera by a millimetre or so: stay well inside its outline.
    if distance < -1.0 - clearance and after_composite and before_strip:
        return INSIDE
    return EDGE


@njit(cache=True)
def _at_height(eye, x, y, z):  # type: ignore[no-untyped-def]
    """Where the ray to a board point passes the plane at height z."""
    share = z / eye.centre[2]
    return x + (eye.centre[0] - x) * share, y + (eye.centre[1] - y) * share


@njit(cache=True)
def _lean(eye, x, y):  # type: ignore[no-untyped-def]
    """How far the ray to a board point moves sideways for each unit of height."""
    return math.hypot(eye.centre[0] - x, eye.centre[1] - y) / eye.centre[2]


@njit(cache=True)
def _paint_things(scene, x, y, cell, light, shadow, colour):  # type: ignore[no-untyped-def]
    """Lay everything that the ray to a board point meets over its colour, back to front."""
    for k in range(scene.order.shape[0]):
        kind, index = scene.order[k]
        if kind == BODY:
            _paint_body(scene, x, y, light, colour)
        elif kind == DISC:
            _paint_disc(scene, scene.discs[index], x, y, cell, light, shadow, colour)
        elif kind == TUBE:
            _paint_tube(scene, scene.tubes[index], x, y, cell, light, colour)
        else:
            _paint_box(scene, scene.boxes[index], x, y, cell, light, colour)


@njit(cache=True)
def _paint_disc(scene, disc, x, y, cell, light, shadow, colour):  # type: ignore[no-untyped-def]
    px, py = _at_height(scene.eye, x, y, disc[2])
    cover = soft_step(disc_distance(px, py, disc), cell * (1.0 - disc[2] / scene.eye.centre[2]))
    if cover <= 0.0:
        return
    lit = light * shadow if disc[2] < 1.0 else light
    away = math.hypot(px - disc[7], py - disc[8]) / disc[9]
    glint = 1.6 * disc[10] * math.exp(-2.0 * away * away * away * away)
    for channel in range(3):
        colour[channel] += cover * (lit * (disc[4 + channel] + glint) - colour[channel])


@njit(cache=True)
def _paint_tube(scene, tube, x, y, cell, light, colour):  # type: ignore[no-untyped-def]
    px, py = _at_height(scene.eye, x, y, tube[8])
    across = tube_distance(px, py, tube)
    cover = soft_step(abs(across) - tube[9], cell)
    if cover <= 0.0:
        return
    slope = min(1.0, max(-1.0, across / tube[9]))
    shade = 0.35 + 0.65 * math.sqrt(1.0 - 0.96 * slope * slope)
    glint = 0.25 * math.exp(-40.0 * (slope - 0.35) ** 2)
    for channel in range(3):
        colour[channel] += cover * (light * (tube[10 + channel] * shade + glint) - colour[channel])


@njit(cache=True)
def _paint_box(scene, box, x, y, cell, light, colour):  # type: ignore[no-untyped-def]
    fx, fy = _at_height(scene.eye, x, y, box[6])
    cover = soft_step(box_distance(fx, fy, box), cell)
    shade = 1.0
    if cover <= 0.0:
        bx, by = _at_height(scene.eye, x, y, box[7])
        if box[6] - box[7] < 0.1 or not segment_meets_box(fx, fy, bx, by, box):
            return
        cover, shade = 1.0, 0.45
    for channel in range(3):
        colour[channel] += cover * (light * shade * box[8 + channel] - colour[channel])


@njit(cache=True)
def _paint_body(scene, x, y, light, colour):  # type: ignore[no-untyped-def]
    """Find where the ray meets the face or, walking on, a side of the body."""
    body = scene.body
    px, py = _at_height(scene.eye, x, y, body.face_z)
    z = body.face_z + body.face_slope * (py - body.base_y)
    px, py = _at_height(scene.eye, x, y, z)
    distance = body_distance(body, px, py)
    shade = 1.0
    if distance > 0.0:
        lean = _lean(scene.eye, x, y)
        if distance > lean * body.thickness:
            return
        walked = 0.0
        while distance > 0.01 and walked < body.thickness:
            walked += max(distance / lean, 0.1)
            px, py = _at_height(scene.eye, x, y, z - walked)
            distance = body_distance(body, px, py)
        if walked >= body.thickness:
            return
        shade = 0.42 if body_across(body, px, py) > 0 else 0.6
    body_colour(body, px, py, light * shade, colour)
