"""Corners of real photographs, against OpenCV's detector of wholly visible boards."""

from pathlib import Path

import cv2
import numpy as np
import pytest

from spavision.vision.board import find_board
from spavision.vision.photos import find_photos, read_photo

PHOTOS = Path(__file__).resolve().parents[3] / "shared" / "data" / "photos" / "opencv_left"

pytestmark = pytest.mark.skipif(not PHOTOS.is_dir(), reason="needs ../shared/data/photos/opencv_left")


def photographs():
    return find_photos(PHOTOS) if PHOTOS.is_dir() else []


@pytest.mark.parametrize("path", photographs(), ids=lambda path: path.stem)
def test_real_corners_agree_with_opencvs(path):
    gray = read_photo(path).gray
    board = find_board(gray)
    assert board is not None
    assert len(board.indices) >= 45
    found, corners = cv2.findChessboardCorners(gray.astype(np.uint8), (9, 6))
    assert found
    criteria = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 50, 1e-3)
    expected = cv2.cornerSubPix(gray.astype(np.uint8), corners, (7, 7), (-1, -1), criteria).reshape(-1, 2)
    distance = np.linalg.norm(board.pixels[:, None] - expected[None], axis=2).min(axis=1)
    assert np.median(distance) < 0.15
    # Printed lines of text and the board's border look like corners to neither.
    assert (distance < 1.0).all()
