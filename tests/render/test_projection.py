"""The renderer's arithmetic against OpenCV's, and its pictures against its own projection."""

import cv2
import numpy as np
import pytest

from spavision.render.camera import camera_for_photo
from spavision.render.distortion import distort, undistort
from spavision.render.render import render_photo

from .scenes import path, settings, without_actuator

LENS = (
    "camera.k1=-0.3",
    "camera.k2=0.1",
    "camera.k3=-0.02",
    "camera.p1=0.002",
    "camera.p2=-0.001",
    "camera.yaw_deg=18",
    "camera.pitch_deg=-9",
    "camera.roll_deg=3",
)


def opencv_projection(camera, points_mm):
    """Project by OpenCV: an implementation that shares nothing with the renderer's."""
    right_handed = points_mm * (1.0, 1.0, -1.0)
    rotation, _ = cv2.Rodrigues(camera.rotation)
    k1, k2, p1, p2, k3 = camera.distortion
    pixels, _ = cv2.projectPoints(
        right_handed, rotation, camera.translation_mm, camera.matrix, np.array([k1, k2, p1, p2, k3])
    )
    return pixels.reshape(-1, 2)


def test_projection_is_opencv_s():
    camera = camera_for_photo(settings(*LENS), 0)
    points = np.random.default_rng(1).uniform((-80, -60, 0), (80, 60, 30), (200, 3))
    assert camera.project(points) == pytest.approx(opencv_projection(camera, points), abs=1e-9)


def test_distortion_is_undone():
    k = np.array([-0.45, 0.2, 0.002, -0.001, -0.03])
    for x, y in np.random.default_rng(2).uniform(-0.5, 0.5, (50, 2)):
        assert undistort(*distort(x, y, k), k, 0.9 * x, 0.9 * y) == pytest.approx((x, y), abs=1e-11)


def test_the_camera_stands_at_the_distance_asked_for():
    camera = camera_for_photo(settings(*LENS, "camera.distance_mm=640"), 0)
    assert camera.centre_mm[2] == pytest.approx(640)
    aim = camera.project(np.array([[0.0, 55.0, 0.0]]))
    in_camera = camera.rotation @ np.array([0.0, 55.0, 0.0]) + camera.translation_mm
    assert in_camera[:2] == pytest.approx([0, 0], abs=1e-9)  # the aim lies on the optical axis
    assert aim.shape == (1, 2)


def test_corners_of_the_board_lie_where_the_projection_says():
    scene = without_actuator(*LENS, "optics.blur_px=0.6", "light.shadow=0")
    rendered = render_photo(scene, path(), 0)
    camera, board = rendered.truth.camera, scene.board
    x, y = np.meshgrid(np.arange(-11, 12), np.arange(14, 31))
    points = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)]) * [board.square_mm, board.square_mm, 1]
    truth = opencv_projection(camera, points)
    inside = np.all((truth > 12) & (truth < np.array([388, 288])), axis=1)
    gray = cv2.cvtColor(rendered.pixels, cv2.COLOR_RGB2GRAY)
    start = truth[inside].astype(np.float32).reshape(-1, 1, 2)
    criteria = (cv2.TERM_CRITERIA_EPS | cv2.TERM_CRITERIA_COUNT, 50, 1e-4)
    found = cv2.cornerSubPix(gray, start.copy(), (4, 4), (-1, -1), criteria).reshape(-1, 2)
    error = np.linalg.norm(found - truth[inside], axis=1)
    assert inside.sum() > 150
    assert np.sqrt(np.mean(error**2)) < 0.05
    assert error.max() < 0.2


def test_the_dot_s_centroid_is_the_projection_of_its_outline():
    scene = settings("optics.blur_px=0", "optics.vignetting=0", "camera.yaw_deg=15", "light.shadow=0")
    rendered = render_photo(scene, path((6.0, -2.0)), 0)
    red = rendered.pixels[:, :, 0].astype(float) - rendered.pixels[:, :, 1:].max(axis=2)
    row, column = np.mgrid[: red.shape[0], : red.shape[1]]
    around_dot = np.hypot(column - rendered.truth.dot_px[0], row - rendered.truth.dot_px[1]) < 16
    share = np.where(around_dot, np.clip(red / red.max(), 0, 1), 0)
    centroid = np.array([np.sum(share * column), np.sum(share * row)]) / share.sum()
    # A disc seen obliquely: the centroid of its image is not the image of its centre. Both are compared with
    # the outline projected by OpenCV.
    angle = np.linspace(0, 2 * np.pi, 721)[:-1]
    radius = scene.marker.diameter_mm / 2
    rim = rendered.truth.dot_mm + radius * np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
    outline = opencv_projection(rendered.truth.camera, rim).astype(np.float32)
    moments = cv2.moments(outline.reshape(-1, 1, 2))
    expected = np.array([moments["m10"], moments["m01"]]) / moments["m00"]
    assert centroid == pytest.approx(expected, abs=0.06)
    assert rendered.truth.dot_px == pytest.approx(
        opencv_projection(rendered.truth.camera, rendered.truth.dot_mm[None])[0], abs=1e-9
    )


def test_the_dot_moves_as_the_trajectory_says():
    scene, moves = settings(), path((0, 0), (12.5, -3.0), (-20.0, 4.0))
    dots = np.array([render_photo(scene, moves, photo).truth.dot_mm for photo in range(3)])
    assert dots[:, :2] - dots[0, :2] == pytest.approx(np.column_stack([moves.ux_mm, moves.uy_mm]), abs=1e-6)
    assert dots[:, 2] == pytest.approx(scene.actuator.standoff_mm)


def test_the_centre_line_keeps_the_clamp_and_has_the_stretched_length():
    scene = settings()
    line = render_photo(scene, path((0, 0), (25.0, -4.0)), 1).truth.line
    steps = np.linalg.norm(np.diff(line.points_mm, axis=0), axis=1)
    assert steps.sum() == pytest.approx(line.stretch * scene.actuator.length_mm, rel=1e-4)
    assert line.points_mm[0] == pytest.approx([scene.actuator.base_x_mm, scene.actuator.base_y_mm])
    assert line.tip_angle_deg > 0  # bends to the right
