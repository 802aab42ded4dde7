"""A dot drawn on a bare board, by numpy and OpenCV alone: nothing but the dot, or its carrier, moves.

Such photographs hold no actuator, no clamp and no shadow by which the camera's place could be told. The true
motion is the one drawn.
"""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from spavision.vision.settings import TrackSettings
from spavision.vision.track import track

HEIGHT_PX, WIDTH_PX = 480, 640
PLACES_PX = ((200.0, 240.0), (232.0, 224.0), (280.5, 200.25), (400.0, 150.0))
"""The second motion is one by whole squares of 16 px."""

UNMOVED = ((0, 0),) * len(PLACES_PX)


def draw(folder, *, square_px=16, radius_px=18.0, rim_px=0, bumps_px=UNMOVED, carrier=False):
    """Write a photograph for each place of the dot; the camera of each is bumped by whole pixels."""
    row, column = np.mgrid[:HEIGHT_PX, :WIDTH_PX]
    board = np.where((row // square_px + column // square_px) % 2, 215, 40)
    paths = []
    for number, ((x, y), (bump_x, bump_y)) in enumerate(zip(PLACES_PX, bumps_px, strict=True)):
        grey = np.full((HEIGHT_PX, WIDTH_PX), 235)
        within = slice(rim_px, HEIGHT_PX - rim_px), slice(rim_px, WIDTH_PX - rim_px)
        grey[within] = board[within]
        if carrier:
            left, top = round(x) - 30, round(y) - 60
            grey[top : top + 90, left : left + 60] = 180
        # Each pixel is the mean over 4 x 4 points.
        fine = np.stack(np.meshgrid(*((np.arange(4 * n) + 0.5) / 4 - 0.5 for n in (WIDTH_PX, HEIGHT_PX))))
        inside = (np.hypot(fine[0] - x, fine[1] - y) < radius_px).astype(np.float32)
        share = cv2.resize(inside, (WIDTH_PX, HEIGHT_PX), interpolation=cv2.INTER_AREA)[..., None]
        picture = (1.0 - share) * grey[..., None] + share * np.array([40.0, 30.0, 200.0])
        picture = np.roll(picture, (bump_y, bump_x), axis=(0, 1))
        path = folder / f"p{5 * number:03d}.png"
        cv2.imwrite(str(path), np.rint(picture).astype(np.uint8))
        paths.append(path)
    return paths


def tip_path(paths):
    return track(paths, 5.0 * np.arange(len(paths)), settings=TrackSettings(square_mm=2.5)).tip_path


def errors_mm(paths, *, square_px=16):
    path = tip_path(paths)
    assert path.status == ("ok",) * len(paths)
    true_mm = (np.array(PLACES_PX) - PLACES_PX[0]) * 2.5 / square_px
    return np.hypot(path.ux_mm - true_mm[:, 0], path.uy_mm - true_mm[:, 1])


@pytest.mark.parametrize("radius_px", [8.0, 18.0, 35.0])
def test_the_dot_is_read_though_black_and_white_lie_about_it(tmp_path, radius_px):
    assert errors_mm(draw(tmp_path, radius_px=radius_px)).max() < 0.01


def test_a_carrier_that_moves_as_a_whole_is_no_bump(tmp_path):
    assert errors_mm(draw(tmp_path, carrier=True)).max() < 0.01


def test_small_squares(tmp_path):
    assert errors_mm(draw(tmp_path, square_px=8, radius_px=9.0), square_px=8).max() < 0.01


@pytest.mark.parametrize(
    "bumps_px", [((0, 0), (21, -9), (-37, 13), (5, 40)), ((0, 0), (32, 0), (16, -16), (0, 64))]
)
def test_the_boards_rim_tells_a_bump_even_one_by_whole_squares(tmp_path, bumps_px):
    assert errors_mm(draw(tmp_path, rim_px=64, bumps_px=bumps_px)).max() < 0.01


def test_where_nothing_tells_a_bump_there_is_no_reading(tmp_path):
    path = tip_path(draw(tmp_path, bumps_px=((0, 0), (21, -9), (-37, 13), (5, 40))))
    assert path.status == ("ok", "missing", "missing", "missing")
    assert "nothing tells by how many squares" in path.reason[1]
