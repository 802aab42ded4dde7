"""Which photographs of a folder can go together, and whether any can be used at all."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

import numpy as np

from spavision.errors import InputError

from .observe import Observation

LARGEST_PITCH_CHANGE = 0.1
"""Relative difference of the squares' size in pixels: a camera 75 mm nearer, of 750 mm."""


LARGEST_FOCAL_CHANGE = 0.03
"""Relative difference of the focal length that EXIF states: its rounding, and focusing, stay below."""


@dataclass(frozen=True)
class _Usual:
    """What most photographs have in common: size, squares and, where EXIF tells it, focal length."""

    size: tuple[int, int]
    pitch_px: float
    focal_px: float | None


def set_aside_strangers(observations: list[Observation]) -> list[Observation]:
    """Take board and spots from photographs of another camera or another set-up.

    Their size differs from that of most photographs, or their squares do by more than a knocked tripod
    explains. One such photograph would spoil the camera that all share.
    """
    seen = [o for o in observations if o.board is not None]
    if not seen:
        return observations
    size = Counter((o.width, o.height) for o in seen).most_common(1)[0][0]
    alike = [o for o in seen if (o.width, o.height) == size]
    focals = [o.focal_px for o in alike if o.focal_px is not None]
    usual = _Usual(
        size,
        float(np.median([o.board.pitch_px for o in alike if o.board])),
        float(np.median(focals)) if focals else None,
    )
    return [o.set_aside(problem) if (problem := _strangeness(o, usual)) else o for o in observations]


def _strangeness(observation: Observation, usual: _Usual) -> str:
    """Return what sets a photograph apart from the others; nothing where it fits."""
    board, width, height = observation.board, observation.width, observation.height
    size, pitch_px, focal_px = usual.size, usual.pitch_px, observation.focal_px
    if board is None:
        return observation.problem
    if (width, height) != size:
        return f"{observation.name} has {width}×{height} px, most photos {size[0]}×{size[1]} px"
    if abs(board.pitch_px / pitch_px - 1.0) > LARGEST_PITCH_CHANGE:
        return (
            f"{observation.name} shows squares of {board.pitch_px:.1f} px, most photos of {pitch_px:.1f} px: "
            "it is from another set-up"
        )
    if usual.focal_px and focal_px and abs(focal_px / usual.focal_px - 1.0) > LARGEST_FOCAL_CHANGE:
        return (
            f"{observation.name} was taken at {focal_px / usual.focal_px:.2f} times the focal length of most "
            "photos (EXIF): with another lens or zoom"
        )
    return ""


def refuse_hopeless(observations: list[Observation], *, given_by_hand: bool) -> None:
    """Refuse a set in which nothing can be measured.

    Parameters
    ----------
    observations : list of Observation
        All photographs.
    given_by_hand : bool
        Whether a person gave the marker in some photograph, so that none need be found.

    Raises
    ------
    InputError
        If no photograph is readable, none shows a board, or none shows a marker.
    """
    if not observations:
        raise InputError("no photograph was given; expected at least one")
    if all(o.width == 0 for o in observations):
        raise InputError(f"no photograph could be read: {observations[0].problem}")
    if all(o.board is None for o in observations):
        raise InputError(
            "no checkerboard was found in any photograph; "
            "the board's squares must measure 7 px or more and be in focus"
        )
    if not given_by_hand and not any(o.candidates for o in observations):
        raise InputError(
            "no marker was found in any photograph; expected a round spot of the marker's colour "
            "(--marker-colour, --marker-diameter-mm) near the tip, of another colour than the actuator"
        )
