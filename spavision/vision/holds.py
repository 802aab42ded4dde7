"""When a pressure was held: from a list of steps, or from the log of a pressure sensor."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from spavision.errors import InputError

from .arrays import FloatArray

PLATEAU_KPA = 0.5
"""Pressures within this count as one and the same."""

SHORTEST_PLATEAU_S = 2.0
"""A log that stays within `PLATEAU_KPA` for less than this only passes by, at 0.25 kPa/s or faster."""


@dataclass(frozen=True)
class Hold:
    """A time during which the pressure was held.

    Parameters
    ----------
    start_s, end_s : float
        From the video's beginning; the end is infinite where the hold lasts to the video's end.
    pressure_kPa : float
    """

    start_s: float
    end_s: float
    pressure_kPa: float


def pressure_holds(time_s: FloatArray, pressure_kPa: FloatArray) -> list[Hold]:
    """Find the times during which the pressure was held.

    Where every row has a pressure of its own, the rows are steps: each pressure is held until the next
    row's time, the last to the end. Where rows repeat a pressure they are a log: a hold is a plateau of it.

    Parameters
    ----------
    time_s, pressure_kPa : array, shape (n,)
        Rows of the table.

    Returns
    -------
    list of Hold
        In order of time; of several holds at one pressure all are returned.

    Raises
    ------
    InputError
        If the times do not increase, or a log holds no plateau.
    """
    early = np.diff(time_s, prepend=-np.finfo(float).tiny) <= 0
    if early.any():
        raise InputError(
            f"time_s in row {int(np.argmax(early)) + 2} of the pressure table is {time_s[early][0]:g}; "
            "expected times from 0 on that increase, in seconds from the video's beginning"
        )
    if np.all(np.abs(np.diff(pressure_kPa)) > PLATEAU_KPA):
        ends = np.append(time_s[1:], np.inf)
        return [Hold(*row) for row in zip(time_s.tolist(), ends.tolist(), pressure_kPa.tolist(), strict=True)]
    holds = _plateaus(time_s, pressure_kPa)
    if not holds:
        raise InputError(
            f"the pressure table holds no pressure that stays within {PLATEAU_KPA:g} kPa for "
            f"{SHORTEST_PLATEAU_S:g} s; expected a log with plateaus, or one row (start, pressure) a hold"
        )
    return holds


def first_holds(holds: list[Hold]) -> tuple[list[Hold], list[float]]:
    """Keep the first hold at each pressure; return the others' pressures too."""
    kept: list[Hold] = []
    repeated: list[float] = []
    for hold in holds:
        if any(abs(hold.pressure_kPa - other.pressure_kPa) <= PLATEAU_KPA for other in kept):
            repeated.append(hold.pressure_kPa)
        else:
            kept.append(hold)
    return kept, repeated


def _plateaus(time_s: FloatArray, pressure_kPa: FloatArray) -> list[Hold]:
    """Longest stretches from left to right that stay within `PLATEAU_KPA`, and last."""
    holds: list[Hold] = []
    start, n = 0, len(time_s)
    while start < n:
        spread = np.maximum.accumulate(pressure_kPa[start:]) - np.minimum.accumulate(pressure_kPa[start:])
        stop = start + int(np.searchsorted(spread, PLATEAU_KPA, side="right"))
        if time_s[stop - 1] - time_s[start] >= SHORTEST_PLATEAU_S:
            held = float(np.median(pressure_kPa[start:stop]))
            follows = holds and holds[-1].end_s == time_s[start - 1]
            if follows and abs(holds[-1].pressure_kPa - held) <= PLATEAU_KPA:
                # A slow leak: one hold whose pressure drifts.
                holds[-1] = Hold(holds[-1].start_s, float(time_s[stop - 1]), holds[-1].pressure_kPa)
            else:
                holds.append(Hold(float(time_s[start]), float(time_s[stop - 1]), held))
            start = stop
        else:
            start += 1
    return holds
