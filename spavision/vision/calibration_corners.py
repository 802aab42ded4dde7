"""Corners of a calibration board in one photograph: the tracker's lattice, or OpenCV's own detector."""

from __future__ import annotations

from dataclasses import dataclass, replace

import cv2
import numpy as np

from .arrays import FloatArray, FloatImage, IntArray, blur
from .board import find_board
from .refill import expected_corners
from .saddle_fit import fit_saddles
from .saddles import ring_test

OPENCV_WINDOW_PX = 11
"""Half width of the sub-pixel window in OpenCV's calibration sample, whatever the size of the squares."""

OPENCV_CRITERIA = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 30, 0.1)

REACH_SQUARES = 0.03
REACH_PX = 0.3
"""A corner counts when it lies within the larger of the two from where one photograph's fit expects it."""

COMPLETION_QUALITY = 0.9
"""Least quality of the ring for a corner that the tracker left out."""

LEAST_CONTRAST = 0.5
"""Over the board's typical contrast: the print's outer edge against the wall has less."""

LARGEST_STRAY_SHARE = 0.1
"""Share of corners outside the board asked for above which the photograph shows another board."""


@dataclass(frozen=True)
class BoardCorners:
    """Corners of one photograph.

    Parameters
    ----------
    indices : int array, shape (n, 2)
        Column and row of each corner on the board, from an arbitrary origin.
    pixels : array, shape (n, 2)
        Sub-pixel positions.
    """

    indices: IntArray
    pixels: FloatArray

    @property
    def extent(self) -> tuple[int, int]:
        """Columns and rows that the corners span, the larger first."""
        size = np.ptp(self.indices, axis=0) + 1
        return int(size.max()), int(size.min())


def lattice_corners(gray: FloatImage, corners: tuple[int, int] | None) -> BoardCorners | None:
    """Find a board, whole or in part, by the tracker's lattice; None where there is none.

    Boards of too few corners for a lattice are left to OpenCV's detector when their size is known; the
    sub-pixel fit is scaled to the squares in both cases.

    Parameters
    ----------
    gray : float32 array, shape (height, width)
        Grey levels 0 to 255.
    corners : pair of int or None
        Inner corners of the whole board, in either order; None when unknown.
    """
    found = _lattice(gray)
    if found is None and corners is not None:
        found = _whole_board(gray, corners)
        if found is not None:
            pixels = fit_saddles(gray, found.pixels, *_lattice_vectors(found))
            seen = np.isfinite(pixels).all(axis=1)
            found = BoardCorners(found.indices[seen], pixels[seen])
    return found


def opencv_corners(gray: FloatImage, corners: tuple[int, int]) -> BoardCorners | None:
    """Find a whole board as OpenCV's calibration sample does, window of 11 px included; None where absent.

    The window is kept even where squares are smaller and neighbouring corners pull: this is for comparison
    with calibrations made elsewhere.
    """
    found = _whole_board(gray, corners)
    if found is None:
        return None
    start = found.pixels.astype(np.float32).reshape(-1, 1, 2)
    window = (OPENCV_WINDOW_PX, OPENCV_WINDOW_PX)
    pixels = cv2.cornerSubPix(gray.astype(np.uint8), start, window, (-1, -1), OPENCV_CRITERIA)
    return replace(found, pixels=np.asarray(pixels, dtype=float).reshape(-1, 2))


def within_board(found: BoardCorners, corners: tuple[int, int]) -> BoardCorners | None:
    """Keep what lies on a board of ``corners`` inner corners; None where the photograph shows a larger one.

    Print beside the board can look like a further row: the rectangle that holds most corners is kept, unless
    more than a tenth of the corners lie outside it.
    """
    least = (1.0 - LARGEST_STRAY_SHARE) * len(found.indices)
    if least > corners[0] * corners[1]:
        return None
    best: IntArray = np.zeros(0, dtype=np.intp)
    low, high = found.indices.min(axis=0), found.indices.max(axis=0)
    for size in {corners, corners[::-1]}:
        last = np.maximum(high - np.array(size) + 1, low)
        for column in range(int(low[0]), int(last[0]) + 1):
            for row in range(int(low[1]), int(last[1]) + 1):
                place = found.indices - [column, row]
                rows = np.flatnonzero(((place >= 0) & (place < size)).all(axis=1))
                if len(rows) > len(best):
                    best = rows
    if len(best) < least:
        return None
    return BoardCorners(found.indices[best], found.pixels[best])


def _lattice(gray: FloatImage) -> BoardCorners | None:
    """Find the lattice as the tracker does, measure its corners anew and complete its border.

    The tracker drops what one photograph's fit does not explain; several photographs explain more.
    """
    board = find_board(gray)
    if board is None:
        return None
    known = {tuple(node) for node in board.indices.tolist()}
    (left, top), (right, bottom) = board.indices.min(axis=0) - 1, board.indices.max(axis=0) + 1
    nodes = np.stack(np.meshgrid(np.arange(left, right + 1), np.arange(top, bottom + 1)), axis=-1)
    nodes = nodes.reshape(-1, 2)
    expected, vectors = expected_corners(board.camera, board.pose, nodes)
    pitch = np.minimum(*(np.linalg.norm(vector, axis=1) for vector in vectors))
    pixels = fit_saddles(gray, expected, *vectors)
    parity, quality, contrast = ring_test(
        blur(gray, max(0.1 * board.pitch_px, 0.5)), np.nan_to_num(pixels, nan=-1e3), vectors
    )
    near = np.linalg.norm(pixels - expected, axis=1) < np.maximum(REACH_SQUARES * pitch, REACH_PX)
    new = near & (parity == 1 - 2 * (nodes.sum(axis=1) % 2)) & (quality > COMPLETION_QUALITY)
    new &= contrast > LEAST_CONTRAST * board.contrast
    old = near & np.array([tuple(node) in known for node in nodes.tolist()])
    return BoardCorners(nodes[old | new], pixels[old | new])


def _lattice_vectors(found: BoardCorners) -> tuple[FloatArray, FloatArray]:
    """Lattice vectors at each corner, right and down, from the homography through all of them."""
    plane = found.indices.astype(float)
    homography, _ = cv2.findHomography(plane, found.pixels)

    def place(points: FloatArray) -> FloatArray:
        return np.asarray(cv2.perspectiveTransform(points[None], homography)[0], dtype=float)

    one, other = (place(plane + step) - place(plane - step) for step in ([0.5, 0.0], [0.0, 0.5]))
    if abs(np.median(one[:, 0])) < abs(np.median(other[:, 0])):
        one, other = other, one
    return one * np.sign(np.median(one[:, 0])), other * np.sign(np.median(other[:, 1]))


def _whole_board(gray: FloatImage, corners: tuple[int, int]) -> BoardCorners | None:
    """Corners by OpenCV's detector, before any refinement of ours."""
    flags = cv2.CALIB_CB_ADAPTIVE_THRESH | cv2.CALIB_CB_NORMALIZE_IMAGE | cv2.CALIB_CB_FAST_CHECK
    found, pixels = cv2.findChessboardCorners(gray.astype(np.uint8), corners, flags=flags)
    if not found:
        return None
    columns, rows = corners
    indices = np.stack(np.meshgrid(np.arange(columns), np.arange(rows)), axis=-1).reshape(-1, 2)
    return BoardCorners(indices.astype(np.intp), np.asarray(pixels, dtype=float).reshape(-1, 2))
