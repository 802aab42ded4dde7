"""Surface of the actuator: outline, layers and texture; and the shadows that things throw, compiled."""

from __future__ import annotations

import math

from numba import njit

from .primitives import box_distance, smooth_step, tube_distance, value_noise
from .scene import BODY, BOX, TUBE

TIP_ROUNDING_MM = 2.0
EDGE_MM = 1.3
SHADOW_SLICES = 4


@njit(cache=True)
def _table(table, body, x, y):  # type: ignore[no-untyped-def]
    """Interpolate a table of the body's own coordinates; beyond its border, its border."""
    u = min(max((x - body.x0) / body.step, 0.0), table.shape[1] - 1.001)
    v = min(max((y - body.y0) / body.step, 0.0), table.shape[0] - 1.001)
    i, j = int(v), int(u)
    fu, fv = u - j, v - i
    top = table[i, j] * (1 - fu) + table[i, j + 1] * fu
    bottom = table[i + 1, j] * (1 - fu) + table[i + 1, j + 1] * fu
    return top * (1 - fv) + bottom * fv


@njit(cache=True)
def body_across(body, x, y):  # type: ignore[no-untyped-def]
    """Distance to the right of the centre line."""
    return _table(body.across, body, x, y)


@njit(cache=True)
def body_distance(body, x, y):  # type: ignore[no-untyped-def]
    """Signed distance to the body's outline in the plane of its face (negative: inside)."""
    outside = max(body.x0 - x, x - body.x0 - body.step * (body.along.shape[1] - 1))
    outside = max(outside, max(body.y0 - y, y - body.y0 - body.step * (body.along.shape[0] - 1)))
    if outside > 0.0:
        return outside + 5.0
    along = _table(body.along, body, x, y)
    across = abs(_table(body.across, body, x, y))
    rest = along / body.stretch
    wave = 0.5 - 0.5 * math.cos(2.0 * math.pi * rest / body.void_pitch)
    half = body.half_depth + body.bulge * wave
    u = abs(along - 0.5 * body.length) - 0.5 * body.length + TIP_ROUNDING_MM
    v = across - half + TIP_ROUNDING_MM
    return math.hypot(max(u, 0.0), max(v, 0.0)) + min(max(u, v), 0.0) - TIP_ROUNDING_MM


@njit(cache=True)
def body_colour(body, x, y, light, colour):  # type: ignore[no-untyped-def]
    """Set the colour of the body at a point of its face."""
    along = _table(body.along, body, x, y) / body.stretch
    across = _table(body.across, body, x, y)
    depth = -across * body.composite_side
    layer = 0
    while layer < 3 and depth > body.layer_edges[layer]:
        layer += 1
    shade = (
        1.0 + 0.05 * value_noise(0.35 * along, 0.5 * across) + 0.025 * value_noise(2.3 * along, 2.1 * across)
    )
    distance = body_distance(body, x, y)
    shade *= 1.0 - 0.35 * smooth_step(1.0 + distance / EDGE_MM)
    shade *= 1.0 - 0.08 * (across / body.half_depth)
    joint = min(abs(depth - body.layer_edges[0]), abs(depth - body.layer_edges[2]))
    if joint < 0.18:
        shade *= 0.78
    paper = 0.0
    if layer == 0:
        phase = (along / body.paper_wavelength) % 1.0
        wave = body.paper_amplitude * (4.0 * abs(phase - 0.5) - 1.0)
        middle = 0.5 * (body.layer_edges[0] - body.half_depth)
        paper = 0.55 * smooth_step(1.5 - abs(depth - middle - wave) / 0.35)
    for channel in range(3):
        base = body.layer_colours[layer, channel]
        colour[channel] = light * shade * (base + paper * (0.92 - base))


@njit(cache=True)
def shadow_on_board(scene, x, y):  # type: ignore[no-untyped-def]
    """Share of the direct light that is kept from a board point, 0 to 1."""
    light = scene.light
    darkest = 0.0
    for k in range(scene.order.shape[0]):
        kind, index = scene.order[k]
        if kind == BODY:
            for part in range(SHADOW_SLICES):
                z = scene.body.face_z - scene.body.thickness * part / (SHADOW_SLICES - 1)
                away = body_distance(scene.body, x + light.from_x * z, y + light.from_y * z)
                darkest = max(darkest, _dimming(away, light.size, z))
        elif kind == BOX:
            box = scene.boxes[index]
            if box[6] - box[7] < 0.1:
                continue
            for part in range(SHADOW_SLICES):
                z = box[6] - (box[6] - box[7]) * part / (SHADOW_SLICES - 1)
                away = box_distance(x + light.from_x * z, y + light.from_y * z, box)
                darkest = max(darkest, _dimming(away, light.size, z))
        elif kind == TUBE:
            tube = scene.tubes[index]
            z = tube[8]
            away = abs(tube_distance(x + light.from_x * z, y + light.from_y * z, tube)) - tube[9]
            darkest = max(darkest, _dimming(away, light.size, z))
    return darkest


@njit(cache=True)
def _dimming(away, size, z):  # type: ignore[no-untyped-def]
    """Penumbra of an edge: a light of a given size over its distance, an edge at height z."""
    return smooth_step(0.5 - away / (size * z + 0.05))
