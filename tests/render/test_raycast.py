"""The ray caster's short cuts leave no trace: against brute-force sampling, and wherever its tiles lie."""

import dataclasses

import cv2
import numpy as np
import pytest

from spavision.render.build import build_scene
from spavision.render.camera import camera_for_photo
from spavision.render.raycast import TILE_PX, cast
from spavision.render.render import render_photo
from spavision.render.scene import FaceState
from spavision.render.settings import Cover

from .scenes import path, settings, without_actuator

SAMPLES_A_SIDE = 24
EVEN_LIGHT = ("light.gradient_x=0", "light.gradient_y=0", "light.shadow=0", "board.tint=#ffffff")


def light_of(scene_settings, move=(0.0, 0.0), covers=()):
    """Cast the light of one photo of the bent actuator, before lens and sensor."""
    truth = render_photo(scene_settings, path(move), 0).truth
    actuator = scene_settings.actuator
    base = (actuator.base_x_mm, actuator.base_y_mm)
    face = FaceState(truth.line, base, truth.dot_mm, np.zeros(3), swelling=1.0)
    scene = build_scene(scene_settings, camera_for_photo(scene_settings, 0), face, covers)
    return cast(scene, scene_settings.image.width_px, scene_settings.image.height_px)


def sampled_board(camera, board, width, height):
    """Average paper and ink over a fine grid in each pixel; rays by OpenCV's inverse of the distortion."""
    fine = (np.arange(SAMPLES_A_SIDE) + 0.5) / SAMPLES_A_SIDE - 0.5
    x = (np.arange(width)[:, None] + fine).ravel()
    y = (np.arange(height)[:, None] + fine).ravel()
    pixels = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 1, 2)
    k1, k2, p1, p2, k3 = camera.distortion
    criteria = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 40, 1e-12)
    rays = cv2.undistortPoints(
        pixels, camera.matrix, np.array([k1, k2, p1, p2, k3]), criteria=criteria
    ).reshape(-1, 2)
    directions = np.column_stack([rays, np.ones(len(rays))]) @ camera.rotation
    centre = -camera.rotation.T @ camera.translation_mm
    points = centre[:2] - directions[:, :2] * (centre[2] / directions[:, 2:])
    column = np.floor(points[:, 0] / board.square_mm + board.columns / 2)
    row = np.floor(points[:, 1] / board.square_mm + board.rows / 2)
    printed = (column >= 0) & (column < board.columns) & (row >= 0) & (row < board.rows)
    ink = printed & ((column + row) % 2 == 0)
    light = np.where(ink, board.black, board.white)
    return light.reshape(height, SAMPLES_A_SIDE, width, SAMPLES_A_SIDE).mean(axis=(1, 3))


@pytest.mark.parametrize("roll_deg", [0.0, 21.0])
def test_each_pixel_is_the_mean_over_its_square(roll_deg):
    scene = without_actuator(
        *("image.width_px=72", "image.height_px=64", "camera.square_px=7", "camera.k1=-0.3"),
        *("camera.aim_x_mm=121", "camera.aim_y_mm=-124", "board.margin_mm=200", "camera.yaw_deg=12"),
        *EVEN_LIGHT,
        f"camera.roll_deg={roll_deg}",
    )
    light = light_of(scene)[:, :, 1]
    expected = sampled_board(camera_for_photo(scene, 0), scene.board, 72, 64)
    contrast = scene.board.white - scene.board.black
    error = (light - expected) / contrast
    # Brute force errs by up to half a sample at an edge along the grid; turned windows are squared up.
    assert np.abs(error).max() < (0.03 if roll_deg == 0 else 0.08)
    assert np.sqrt(np.mean(error**2)) < 0.012
    assert abs(error.mean()) < 1e-3


def test_the_picture_does_not_depend_on_where_tiles_begin():
    """Things and shadows sorted out for a tile too boldly would show as a step at its border."""
    clutter = ("clutter.cable=true", "clutter.red_cable=true", "clutter.red_sticker=true")
    view = ("image.width_px=400", "image.height_px=300", "camera.square_px=3.5", "camera.aim_y_mm=0")
    scene = settings(*view, *clutter, "light.size=0.7", "camera.yaw_deg=12", "camera.k1=-0.3")
    covers = (Cover(photo=0, fraction=0.4),)
    right, down = TILE_PX // 2 + 1, TILE_PX // 4 + 1
    camera = dataclasses.replace(scene.camera, cx_offset_px=float(right), cy_offset_px=float(down))
    shifted = dataclasses.replace(scene, camera=camera)
    here, there = (light_of(s, (45.0, -9.0), covers) for s in (scene, shifted))
    assert there[down:, right:] == pytest.approx(here[:-down, :-right], abs=1e-5)
