"""Photographs grouped by camera position, their corners in one index system."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from .arrays import FloatArray, IntArray
from .board import BoardView
from .observe import Observation
from .registration import SMALLEST_CERTAINTY, Registration, register, same_position


@dataclass(frozen=True)
class Stations:
    """Camera positions of a set of photographs.

    Parameters
    ----------
    number : int array, shape (photographs,)
        Camera position of each photograph, counted from the reference photograph's 0; −1 without board.
    shift : int array, shape (photographs, 2)
        What to add to a photograph's indices.
    certainty : array, shape (photographs,)
        Certainty of a shift after a bump (see `Registration`).
    indices, pixels : tuple of arrays
        A position's corners, the mean over its photographs: (n, 2) each.
    """

    number: IntArray
    shift: IntArray
    certainty: FloatArray
    indices: tuple[IntArray, ...]
    pixels: tuple[FloatArray, ...]


@dataclass
class _Group:
    board: BoardView
    shift: IntArray
    members: list[int] = field(default_factory=list)


def group_stations(observations: list[Observation], reference: int) -> Stations:
    """Bring all photographs to the reference's indices and group those taken from one position."""
    n = len(observations)
    number = np.full(n, -1, dtype=np.intp)
    shift, certainty = np.zeros((n, 2), dtype=np.intp), np.zeros(n)
    groups: list[_Group] = []
    for photo, registration in _registrations(observations, reference).items():
        board = observations[photo].board
        assert board is not None
        shift[photo], certainty[photo] = registration.shift, registration.certainty
        for k, group in enumerate(groups):
            if same_position(group.board, board, shift[photo] - group.shift):
                number[photo] = k
                group.members.append(photo)
                break
        else:
            number[photo] = len(groups)
            groups.append(_Group(board, shift[photo], [photo]))
    merged = [_mean_corners(observations, group.members, shift) for group in groups]
    return Stations(number, shift, certainty, tuple(m[0] for m in merged), tuple(m[1] for m in merged))


def _registrations(observations: list[Observation], reference: int) -> dict[int, Registration]:
    """Register every photograph with a board to the reference, the reference first.

    Where that is not certain, a photograph in which the actuator hangs more alike may tell.
    """
    seen = [k for k, o in enumerate(observations) if o.board is not None]
    found = {
        k: register(observations[reference], observations[k])
        for k in sorted(seen, key=lambda k: (k != reference, k))
    }
    certain = {k: r for k, r in found.items() if r.certainty >= SMALLEST_CERTAINTY}
    for photo in sorted(found.keys() - certain.keys()):
        for between, first in certain.items():
            second = register(observations[between], observations[photo])
            certainty = min(first.certainty, second.certainty)
            if certainty > found[photo].certainty:
                found[photo] = Registration(first.shift + second.shift, certainty)
    return found


def _mean_corners(
    observations: list[Observation], members: list[int], shift: IntArray
) -> tuple[IntArray, FloatArray]:
    """Mean position of each corner over photographs from one position, weighted by nothing but presence."""
    boards = [observations[k].board for k in members]
    indices = np.concatenate(
        [board.indices + shift[k] for board, k in zip(boards, members, strict=True) if board]
    )
    pixels = np.concatenate([board.pixels for board in boards if board])
    nodes, inverse, counts = np.unique(indices, axis=0, return_inverse=True, return_counts=True)
    inverse = inverse.ravel()
    mean = np.column_stack([np.bincount(inverse, pixels[:, axis]) / counts for axis in (0, 1)])
    # What an occluder's edge or a passing shadow moved in one photograph is no corner of the mean.
    off = np.linalg.norm(pixels - mean[inverse], axis=1)
    steady = np.bincount(inverse, off > 0.6) == 0
    often = counts >= min(2, len(members))
    return nodes[steady & often], mean[steady & often]
