"""Surface of the actuator: outline, layers and texture, compiled."""

from __future__ import annotations

import math

from .kernel import kernel
from .primitives import smooth_step, value_noise

TIP_ROUNDING_MM = 2.0
EDGE_MM = 1.3


@kernel
def body_place(body, table, x, y):  # type: ignore[no-untyped-def]
    """Interpolate the coordinates along and across the body; beyond the table's border, its border."""
    u = min(max((x - body.x0) / body.step, 0.0), table.shape[1] - 1.001)
    v = min(max((y - body.y0) / body.step, 0.0), table.shape[0] - 1.001)
    i, j = int(v), int(u)
    fu, fv = u - j, v - i
    a, b, c, d = (1 - fu) * (1 - fv), fu * (1 - fv), (1 - fu) * fv, fu * fv
    along = a * table[i, j, 0] + b * table[i, j + 1, 0] + c * table[i + 1, j, 0] + d * table[i + 1, j + 1, 0]
    across = a * table[i, j, 1] + b * table[i, j + 1, 1] + c * table[i + 1, j, 1] + d * table[i + 1, j + 1, 1]
    return along, across


@kernel
def body_distance(body, table, x, y):  # type: ignore[no-untyped-def]
    """Signed distance to the body's outline in the plane of its face (negative: inside).

    Beyond the table's border it stays what it is there, some 30 mm: too far for sight or shadow.
    """
    along, across = body_place(body, table, x, y)
    return _outline_distance(body, along, across)


@kernel
def _outline_distance(body, along, across):  # type: ignore[no-untyped-def]
    """Signed distance to the outline from the body's own coordinates; the voids make it bulge."""
    wave = 0.5 - 0.5 * math.cos(2.0 * math.pi * along / (body.stretch * body.void_pitch))
    half = body.half_depth + body.bulge * wave
    u = abs(along - 0.5 * body.length) - 0.5 * body.length + TIP_ROUNDING_MM
    v = abs(across) - half + TIP_ROUNDING_MM
    if u > 0.0 and v > 0.0:
        return math.hypot(u, v) - TIP_ROUNDING_MM
    return max(u, v) - TIP_ROUNDING_MM


@kernel
def body_colour(body, table, x, y, light, colour):  # type: ignore[no-untyped-def]
    """Set the colour of the body at a point of its face."""
    stretched, across = body_place(body, table, x, y)
    along = stretched / body.stretch
    depth = -across * body.composite_side
    layer = 0
    while layer < 3 and depth > body.layer_edges[layer]:
        layer += 1
    shade = (
        1.0 + 0.05 * value_noise(0.35 * along, 0.5 * across) + 0.025 * value_noise(2.3 * along, 2.1 * across)
    )
    distance = _outline_distance(body, stretched, across)
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
        base = body.layer_colours[layer][channel]
        colour[channel] = light * shade * (base + paper * (0.92 - base))
