"""Lines of sight: where pixels look on the board, and which things they may see, compiled."""

from __future__ import annotations

import math

from .distortion import undistort
from .kernel import kernel
from .primitives import STEEPEST, box_distance, disc_distance, tube_place
from .scene import BODY, BOX, DISC
from .surface import body_distance, body_place

FAR_MM = 1e6

NOTHING, INSIDE, EDGE = 0, 1, 2
"""What a pixel may see of the things before the board: none, plain surface only, or an edge."""

JOINT_CLEARANCE_MM = 0.6
FACE_CLEARANCE_MM = 3.0


@kernel
def board_points(eye, row, column, points):  # type: ignore[no-untyped-def]
    """Fill the board points seen by the corners of a tile's pixels, shape (rows + 1, columns + 1, 2)."""
    r = eye.rotation
    row_x, row_y = (column - 0.5 - eye.cx) / eye.fx, (row - 0.5 - eye.cy) / eye.fy
    for i in range(points.shape[0]):
        yd = (row + i - 0.5 - eye.cy) / eye.fy
        x, y = row_x, row_y
        for j in range(points.shape[1]):
            xd = (column + j - 0.5 - eye.cx) / eye.fx
            x, y = undistort(xd, yd, eye.distortion, x, y)
            if j == 0:
                row_x, row_y = x, y
            dx = r[0][0] * x + r[1][0] * y + r[2][0]
            dy = r[0][1] * x + r[1][1] * y + r[2][1]
            dz = r[0][2] * x + r[1][2] * y + r[2][2]
            reach = eye.centre[2] / dz if dz >= 1e-6 else FAR_MM
            points[i, j, 0] = eye.centre[0] + reach * dx
            points[i, j, 1] = eye.centre[1] + reach * dy


@kernel
def at_height(eye, x, y, z):  # type: ignore[no-untyped-def]
    """Where the ray to a board point passes the plane at height z."""
    share = z / eye.centre[2]
    return x + (eye.centre[0] - x) * share, y + (eye.centre[1] - y) * share


@kernel
def lean(eye, x, y):  # type: ignore[no-untyped-def]
    """How far the ray to a board point moves sideways for each unit of height."""
    return math.hypot(eye.centre[0] - x, eye.centre[1] - y) / eye.centre[2]


@kernel
def find_things(scene, x, y, radius, things):  # type: ignore[no-untyped-def]
    """List, back to front, what rays to a round patch of the board may meet; return the number of things."""
    found = 0
    for k in range(scene.order.shape[0]):
        kind, index = scene.order[k]
        if near_thing(scene, kind, index, x, y, STEEPEST * radius) != NOTHING:
            things[found] = kind, index
            found += 1
    return found


@kernel
def what_is_near(scene, things, x, y, clearance):  # type: ignore[no-untyped-def]
    """Tell what the rays within ``clearance`` of a board point may see of the listed things."""
    near = NOTHING
    for k in range(things.shape[0]):
        near = max(near, near_thing(scene, things[k, 0], things[k, 1], x, y, clearance))
    return near


@kernel
def near_thing(scene, kind, index, x, y, clearance):  # type: ignore[no-untyped-def]
    """Tell what the rays within ``clearance`` of a board point may see of one thing."""
    if kind == BODY:
        return _near_body(scene, x, y, clearance)
    if kind == DISC:
        disc = scene.discs[index]
        px, py = at_height(scene.eye, x, y, disc[2])
        return EDGE if disc_distance(px, py, disc) < clearance else NOTHING
    if kind == BOX:
        return _near_box(scene.eye, scene.boxes[index], x, y, clearance)
    tube = scene.tubes[index]
    px, py = at_height(scene.eye, x, y, tube[8])
    along, across = tube_place(px, py, tube)
    ends = along > tube[4] - clearance and along < tube[5] + clearance
    return EDGE if ends and abs(across) < tube[9] + clearance else NOTHING


@kernel
def _near_box(eye, box, x, y, clearance):  # type: ignore[no-untyped-def]
    """Tell what may be seen of a box: behind its front, up to its depth, its sides come into view."""
    px, py = at_height(eye, x, y, box[6])
    distance = box_distance(px, py, box)
    if distance < -clearance:
        return INSIDE
    depth = box[6] - box[7]
    sideways = depth * (lean(eye, x, y) + clearance / eye.centre[2])
    return EDGE if distance < sideways + clearance else NOTHING


@kernel
def _near_body(scene, x, y, clearance):  # type: ignore[no-untyped-def]
    """Tell what may be seen of the actuator; the composite's fine pattern counts as edges."""
    body = scene.body
    px, py = at_height(scene.eye, x, y, body.face_z)
    distance = body_distance(body, scene.body_table, px, py)
    sideways = body.thickness * (lean(scene.eye, x, y) + clearance / scene.eye.centre[2])
    if distance > sideways + FACE_CLEARANCE_MM + clearance:
        return NOTHING
    # The face may lean towards the camera by a millimetre or so: stay well inside its outline.
    if distance >= -1.0 - clearance:
        return EDGE
    depth = -body_place(body, scene.body_table, px, py)[1] * body.composite_side
    after_composite = depth > body.layer_edges[0] + JOINT_CLEARANCE_MM + clearance
    before_strip = depth < body.layer_edges[2] - JOINT_CLEARANCE_MM - clearance
    return INSIDE if after_composite and before_strip else EDGE
