"""Which photographs of a folder can go together, and whether any can be used at all."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

from spavision.errors import InputError

from .observe import Observation


def set_aside_strangers(observations: list[Observation]) -> list[Observation]:
    """Set aside photographs whose size differs from that of most: another camera, or turned."""
    sizes = Counter((o.width, o.height) for o in observations if o.board is not None)
    if not sizes:
        return observations
    common = sizes.most_common(1)[0][0]
    return [
        o
        if o.board is None or (o.width, o.height) == common
        else replace(
            o,
            problem=f"{o.name} has {o.width}×{o.height} px, most photos {common[0]}×{common[1]} px",
            board=None,
            candidates=(),
            map=None,
        )
        for o in observations
    ]


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
