"""Colour of what a ray meets: wall, paper and squares, and the things before them, compiled."""

from __future__ import annotations

import math

from .kernel import kernel
from .primitives import (
    box_distance,
    disc_distance,
    segment_meets_box,
    soft_step,
    stripe_mean,
    tube_place,
    window_share,
)
from .scene import BODY, DISC, TUBE
from .sight import at_height, lean
from .surface import body_colour, body_distance, body_place

ON_THE_BOARD_MM = 1.0


@kernel
def paint_sheet(sheet, x, y, width_x, width_y, light, colour):  # type: ignore[no-untyped-def]
    """Set the colour of wall, paper and squares, averaged over a window."""
    paper = window_share(x, width_x, -sheet.half_width - sheet.margin, sheet.half_width + sheet.margin)
    paper *= window_share(y, width_y, -sheet.half_height - sheet.margin, sheet.half_height + sheet.margin)
    printed = window_share(x, width_x, -sheet.half_width, sheet.half_width)
    printed *= window_share(y, width_y, -sheet.half_height, sheet.half_height)
    ink = 0.0
    if printed > 0.0:
        stripes = stripe_mean(x + sheet.half_width, width_x, sheet.pitch, 2.0 * sheet.half_width)
        stripes *= stripe_mean(y + sheet.half_height, width_y, sheet.pitch, 2.0 * sheet.half_height)
        ink = 0.5 * (printed + stripes)
    for channel in range(3):
        bare = (paper - ink) * sheet.white[channel] + (1.0 - paper) * sheet.wall[channel]
        colour[channel] = (bare + ink * sheet.black[channel]) * light


@kernel
def is_plain(sheet, a, b, c, d):  # type: ignore[no-untyped-def]
    """Tell whether four board points lie inside a single square, or well outside the sheet."""
    x_low, x_high = min(min(a[0], b[0]), min(c[0], d[0])), max(max(a[0], b[0]), max(c[0], d[0]))
    y_low, y_high = min(min(a[1], b[1]), min(c[1], d[1])), max(max(a[1], b[1]), max(c[1], d[1]))
    outer_x, outer_y = sheet.half_width + sheet.margin, sheet.half_height + sheet.margin
    if x_low > outer_x or x_high < -outer_x or y_low > outer_y or y_high < -outer_y:
        return True
    if x_low < -sheet.half_width or x_high > sheet.half_width:
        return False
    if y_low < -sheet.half_height or y_high > sheet.half_height:
        return False
    column = math.floor((x_low + sheet.half_width) / sheet.pitch)
    row = math.floor((y_low + sheet.half_height) / sheet.pitch)
    return (
        column == math.floor((x_high + sheet.half_width) / sheet.pitch)
        and row == math.floor((y_high + sheet.half_height) / sheet.pitch)
    )  # fmt: skip


@kernel
def paint_things(scene, things, x, y, cell, light, shadow, colour):  # type: ignore[no-untyped-def]
    """Lay the listed things that the ray to a board point meets over its colour, back to front."""
    for k in range(things.shape[0]):
        kind, index = things[k, 0], things[k, 1]
        if kind == BODY:
            _paint_body(scene, x, y, light, colour)
        elif kind == DISC:
            _paint_disc(scene.eye, scene.discs[index], x, y, cell, light, shadow, colour)
        elif kind == TUBE:
            _paint_tube(scene.eye, scene.tubes[index], x, y, cell, light, colour)
        else:
            _paint_box(scene.eye, scene.boxes[index], x, y, cell, light, colour)


@kernel
def _paint_disc(eye, disc, x, y, cell, light, shadow, colour):  # type: ignore[no-untyped-def]
    px, py = at_height(eye, x, y, disc[2])
    cover = soft_step(disc_distance(px, py, disc), cell * (1.0 - disc[2] / eye.centre[2]))
    if cover <= 0.0:
        return
    lit = light * shadow if disc[2] < ON_THE_BOARD_MM else light
    away = math.hypot(px - disc[7], py - disc[8]) / disc[9]
    glint = 1.6 * disc[10] * math.exp(-2.0 * away * away * away * away)
    for channel in range(3):
        colour[channel] += cover * (lit * (disc[4 + channel] + glint) - colour[channel])


@kernel
def _paint_tube(eye, tube, x, y, cell, light, colour):  # type: ignore[no-untyped-def]
    px, py = at_height(eye, x, y, tube[8])
    along, across = tube_place(px, py, tube)
    cover = soft_step(abs(across) - tube[9], cell)
    if cover <= 0.0 or along < tube[4] or along > tube[5]:
        return
    slope = min(1.0, max(-1.0, across / tube[9]))
    shade = 0.35 + 0.65 * math.sqrt(1.0 - 0.96 * slope * slope)
    glint = 0.25 * math.exp(-40.0 * (slope - 0.35) ** 2)
    for channel in range(3):
        colour[channel] += cover * (light * (tube[10 + channel] * shade + glint) - colour[channel])


@kernel
def _paint_box(eye, box, x, y, cell, light, colour):  # type: ignore[no-untyped-def]
    fx, fy = at_height(eye, x, y, box[6])
    cover = soft_step(box_distance(fx, fy, box), cell)
    shade = 1.0
    if cover <= 0.0:
        bx, by = at_height(eye, x, y, box[7])
        if box[6] - box[7] < 0.1 or not segment_meets_box(fx, fy, bx, by, box):
            return
        cover, shade = 1.0, 0.45
    for channel in range(3):
        colour[channel] += cover * (light * shade * box[8 + channel] - colour[channel])


@kernel
def _paint_body(scene, x, y, light, colour):  # type: ignore[no-untyped-def]
    """Find where the ray meets the face or, walking on, a side of the body."""
    body, table = scene.body, scene.body_table
    px, py = at_height(scene.eye, x, y, body.face_z)
    z = body.face_z + body.face_slope * (py - body.base_y)
    px, py = at_height(scene.eye, x, y, z)
    distance = body_distance(body, table, px, py)
    shade = 1.0
    if distance > 0.0:
        slant = lean(scene.eye, x, y)
        if distance > slant * body.thickness:
            return
        walked = 0.0
        while distance > 0.01 and walked < body.thickness:
            walked += max(distance / slant, 0.1)
            px, py = at_height(scene.eye, x, y, z - walked)
            distance = body_distance(body, table, px, py)
        if walked >= body.thickness:
            return
        shade = 0.42 if body_place(body, table, px, py)[1] > 0 else 0.6
    body_colour(body, table, px, py, light * shade, colour)
