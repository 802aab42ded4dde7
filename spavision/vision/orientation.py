"""Which photographs are turned by a quarter, half or three quarters against the others."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import numpy as np

from .arrays import IntArray
from .observe import BoardMap, Observation
from .registration import MAP_ERROR, SMALLEST_CERTAINTY, disagreements, levelled
from .stations import Stations

MUCH_BETTER = 0.8
"""A turned photograph disagrees with the reference by less than this share of what it does as it is."""


def set_aside_turned(
    observations: Sequence[Observation], stations: Stations, reference: int
) -> list[Observation]:
    """Take board and spots from photographs that are turned against most of the others.

    Only those are looked at whose place on the board is uncertain: a turned one's always is.
    """
    turns = {
        k: _quarter_turns(observations[reference], o, stations.shift[k])
        if stations.certainty[k] < SMALLEST_CERTAINTY
        else 0
        for k, o in enumerate(observations)
        if o.board is not None
    }
    usual = Counter(dict.fromkeys(range(4), 0) | Counter(turns.values())).most_common(1)[0][0]
    return [
        o
        if turns.get(k, usual) == usual
        else o.set_aside(
            f"{o.name} is turned by {90 * ((turns[k] - usual) % 4)}° against most photos; turn it back"
        )
        for k, o in enumerate(observations)
    ]


def _quarter_turns(reference: Observation, other: Observation, shift: IntArray) -> int:
    """Return by how many quarters, anticlockwise, a photograph is turned against the reference."""
    assert reference.map is not None
    assert other.map is not None
    still, turning = levelled(reference.map), levelled(other.map)
    middle = np.array(still.origin) + np.array(still.values.shape[::-1]) // 2
    costs = [min(disagreements(still, turning, about=shift).values(), default=np.inf)]
    for quarters in (1, 2, 3):
        values = np.ascontiguousarray(np.rot90(turning.values, -quarters))
        left, top = (middle - np.array(values.shape[::-1]) // 2).tolist()
        turned, centred = BoardMap(values, (left, top)), np.zeros(2, dtype=np.intp)
        costs.append(min(disagreements(still, turned, about=centred).values(), default=np.inf))
    best = int(np.argmin(costs))
    return best if costs[best] < MUCH_BETTER * costs[0] - MAP_ERROR else 0
