"""How good a list of indexed corners is, whoever found it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from truth import SetTruth

from spavision.vision.camera import project

LARGEST_ERROR_SQUARES = 0.2
"""A corner farther than this from every true one is no corner at all."""

TURNS = [
    np.array(turn) for turn in ([[1, 0], [0, 1]], [[0, 1], [-1, 0]], [[-1, 0], [0, -1]], [[0, -1], [1, 0]])
]


@dataclass(frozen=True)
class CornerScore:
    """Corners of one photograph: how many, their errors (n, 2) in px, and how many are wrongly indexed."""

    number: int
    errors_px: np.ndarray
    wrong: int


NOTHING = CornerScore(0, np.zeros((0, 2)), 0)


def score(truth: SetTruth, photo: int, pixels: np.ndarray, indices: np.ndarray) -> CornerScore:
    """Compare corners with the truth; the origin of their indices and their turn are left open."""
    if len(pixels) == 0:
        return NOTHING
    nodes, expected = truth.nearest_corners(photo, pixels)
    errors = pixels - expected
    pitch = np.median(np.linalg.norm(_step(truth, photo, nodes), axis=1))
    stray = np.linalg.norm(errors, axis=1) > LARGEST_ERROR_SQUARES * pitch
    best = np.zeros(len(nodes), dtype=bool)
    for mirror in (np.eye(2, dtype=int), np.diag([1, -1])):
        for turn in TURNS:
            offset = nodes - indices @ (mirror @ turn)
            values, counts = np.unique(offset, axis=0, return_counts=True)
            agree = (offset == values[counts.argmax()]).all(axis=1)
            best = agree if agree.sum() > best.sum() else best
    return CornerScore(len(pixels), errors[~stray], int((~best | stray).sum()))


def _step(truth: SetTruth, photo: int, nodes: np.ndarray) -> np.ndarray:
    """Pixels from each node to the next one in its row."""
    pose, square = truth.photos[photo].pose, truth.square_mm
    here = project(truth.camera, pose, nodes * square + truth.origin_mm)
    return project(truth.camera, pose, (nodes + np.array([1, 0])) * square + truth.origin_mm) - here
