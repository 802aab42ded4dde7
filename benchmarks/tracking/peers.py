"""Ready-made chessboard detectors, each as a function from a grey picture to pixels and indices."""

from __future__ import annotations

import time
from collections.abc import Callable

import cv2
import numpy as np
from corners import CornerScore, score
from scenes import BenchmarkSet
from truth import SetTruth

from spavision.vision.photos import read_photo

Detector = Callable[[np.ndarray, tuple[int, int]], tuple[np.ndarray, np.ndarray]]

NOTHING = (np.zeros((0, 2)), np.zeros((0, 2), dtype=int))
SMALLEST_BOARD = (7, 7)
"""Inner corners from which ``CALIB_CB_LARGER`` may grow."""


def opencv_sb(gray: np.ndarray, inner: tuple[int, int]) -> tuple[np.ndarray, np.ndarray]:
    """Find the whole board with OpenCV's sector-based detector."""
    return _opencv_sb(gray, inner, cv2.CALIB_CB_NORMALIZE_IMAGE | cv2.CALIB_CB_ACCURACY)


def opencv_sb_larger(gray: np.ndarray, _inner: tuple[int, int]) -> tuple[np.ndarray, np.ndarray]:
    """Find any grid of at least `SMALLEST_BOARD` with the same detector."""
    flags = cv2.CALIB_CB_NORMALIZE_IMAGE | cv2.CALIB_CB_ACCURACY | cv2.CALIB_CB_LARGER
    return _opencv_sb(gray, SMALLEST_BOARD, flags)


def calib_targets(gray: np.ndarray, _inner: tuple[int, int]) -> tuple[np.ndarray, np.ndarray]:
    """Find a board, whole or in part, with calib-targets."""
    import calib_targets as library

    found = library.detect_chessboard_best(gray, [library.ChessboardParams()])
    if found is None:
        return NOTHING
    pixels = np.array([corner.position for corner in found.corners])
    return pixels, np.array([[corner.grid.u, corner.grid.v] for corner in found.corners])


PEERS: dict[str, Detector] = {
    "findChessboardCornersSB": opencv_sb,
    "findChessboardCornersSB, LARGER": opencv_sb_larger,
    "calib-targets": calib_targets,
}


def measure_peer(
    detector: Detector, benchmark: BenchmarkSet, truth: SetTruth, photo: int
) -> tuple[CornerScore, float]:
    """Return what a detector makes of one photo, and its seconds a megapixel."""
    board = benchmark.settings.board
    gray = np.clip(np.rint(read_photo(truth.photos[photo].path).gray), 0, 255).astype(np.uint8)
    start = time.perf_counter()
    pixels, indices = detector(gray, (board.columns - 1, board.rows - 1))
    seconds = time.perf_counter() - start
    return score(truth, photo, pixels, indices), seconds / truth.megapixels


def _opencv_sb(gray: np.ndarray, inner: tuple[int, int], flags: int) -> tuple[np.ndarray, np.ndarray]:
    found, pixels, meta = cv2.findChessboardCornersSBWithMeta(gray, inner, flags)
    if not found:
        return NOTHING
    rows, columns = meta.shape[:2]
    indices = np.stack(np.meshgrid(np.arange(columns), np.arange(rows)), axis=-1).reshape(-1, 2)
    return pixels.reshape(-1, 2), indices
