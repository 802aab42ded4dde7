"""Light that falls on the board: its gradient, a straight shadow, and the shadows of things, compiled."""

from __future__ import annotations

from .kernel import kernel
from .primitives import STEEPEST, box_distance, smooth_step, tube_place
from .scene import BODY, BOX, DISC
from .surface import body_distance

SHADOW_SLICES = 4
THINNEST_MM = 0.1


@kernel
def light_level(light, x, y):  # type: ignore[no-untyped-def]
    """Light that falls on whatever is seen in front of a board point; even light gives 1."""
    level = 1.0 + light.gradient_x * x + light.gradient_y * y
    level = min(max(level, 0.1), 2.5)
    if light.edge_shadow > 0:
        ahead = x * light.edge_cos + y * light.edge_sin - light.edge_offset
        level *= 1.0 - light.edge_shadow * smooth_step(0.5 + ahead / light.edge_softness)
    return level


@kernel
def find_casters(scene, x, y, radius, casters):  # type: ignore[no-untyped-def]
    """List the things whose shadow may touch a round patch of the board; return their number."""
    found = 0
    for k in range(scene.order.shape[0]):
        kind, index = scene.order[k]
        for part in range(_slice_count(scene, kind, index)):
            z = _slice_height(scene, kind, index, part)
            away = _silhouette_distance(scene, kind, index, x, y, z, radius)
            if away < 0.5 * _penumbra(scene.light, z) + STEEPEST * radius:
                casters[found] = kind, index
                found += 1
                break
    return found


@kernel
def kept_light(scene, casters, x, y):  # type: ignore[no-untyped-def]
    """Share of the light that the listed things let through to a board point, 0 to 1."""
    darkest = 0.0
    for k in range(casters.shape[0]):
        kind, index = casters[k]
        for part in range(_slice_count(scene, kind, index)):
            z = _slice_height(scene, kind, index, part)
            away = _silhouette_distance(scene, kind, index, x, y, z, 0.0)
            darkest = max(darkest, smooth_step(0.5 - away / _penumbra(scene.light, z)))
            if darkest >= 1.0:
                return 1.0 - scene.light.shadow
    return 1.0 - scene.light.shadow * darkest


@kernel
def _penumbra(light, z):  # type: ignore[no-untyped-def]
    """Width of the half-shadow of an edge at height z."""
    return light.size * z + 0.05


@kernel
def _slice_count(scene, kind, index):  # type: ignore[no-untyped-def]
    """In how many slices, front to back, a thing throws its shadow; flat things throw none."""
    if kind == DISC:
        return 0
    if kind == BODY:
        return SHADOW_SLICES
    if kind == BOX:
        return SHADOW_SLICES if scene.boxes[index, 6] - scene.boxes[index, 7] >= THINNEST_MM else 0
    return 1


@kernel
def _slice_height(scene, kind, index, part):  # type: ignore[no-untyped-def]
    """Height of one slice above the board."""
    if kind == BODY:
        return scene.body.face_z - scene.body.thickness * part / (SHADOW_SLICES - 1)
    if kind == BOX:
        front, back = scene.boxes[index, 6], scene.boxes[index, 7]
        return front - (front - back) * part / (SHADOW_SLICES - 1)
    return scene.tubes[index, 8]


@kernel
def _silhouette_distance(scene, kind, index, x, y, z, slack):  # type: ignore[no-untyped-def]
    """Signed distance to a thing's outline of the point, at its height, that a board point's light passes.

    A tube's ends are pushed out by ``slack``, beyond them it throws no shadow.
    """
    px, py = x + scene.light.from_x * z, y + scene.light.from_y * z
    if kind == BODY:
        return body_distance(scene.body, scene.body_table, px, py)
    if kind == BOX:
        return box_distance(px, py, scene.boxes[index])
    tube = scene.tubes[index]
    along, across = tube_place(px, py, tube)
    if along < tube[4] - slack or along > tube[5] + slack:
        return 1e9
    return abs(across) - tube[9]
