"""Which candidate is the marker: judged over the whole sequence of photographs."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .arrays import FloatArray
from .marker import Candidate

COST_OF_MISSING = 7.0
"""A reading that costs more than this is worse than none."""

USUAL_STEP_SQUARES = 6.0
"""Motion between neighbouring photographs that costs one unit: 15 mm on 2.5 mm squares."""

LARGEST_MOTION_COST = 2.0
"""A jump of any length costs no more than this: pressures may be far apart."""

COST_ON_BOARD = 4.0
"""Cost of a spot that the board's corners surround: the marker's carrier hides them."""

STATIC_SQUARES = 0.15
"""Motion within which a spot counts as fixed to the board."""


def select_markers(
    candidates: Sequence[Sequence[Candidate]], places: Sequence[FloatArray], *, radius_squares: float | None
) -> list[int | None]:
    """Choose one candidate, or none, in every photograph, in order of pressure.

    The choice minimises the cost of looks (round, complete, of the expected size, not fixed to the board)
    plus that of motion, by dynamic programming; a spot whose cost exceeds `COST_OF_MISSING` is left out.

    Parameters
    ----------
    candidates : per photograph, its candidates
    places : per photograph, array of shape (candidates, 2)
        Their places in squares, in the reference photograph's lattice.
    radius_squares : float or None
        Expected radius; found from the candidates themselves when absent.
    """
    expected = radius_squares if radius_squares is not None else _common_radius(candidates)
    static = _static_cost(places)
    best: list[list[float]] = []
    back: list[list[tuple[int, int] | None]] = []
    for now, photo in enumerate(candidates):
        best.append([])
        back.append([])
        for k, candidate in enumerate(photo):
            own = _look_cost(candidate, expected) + static[now][k]
            total, origin = now * COST_OF_MISSING, None
            for before in range(now):
                for j in range(len(candidates[before])):
                    gap = now - before
                    motion = float(np.linalg.norm(places[now][k] - places[before][j])) / USUAL_STEP_SQUARES
                    cost = (
                        best[before][j]
                        + (gap - 1) * COST_OF_MISSING
                        + min(motion**2 / gap, LARGEST_MOTION_COST)
                    )
                    if cost < total:
                        total, origin = cost, (before, j)
            best[now].append(total + own)
            back[now].append(origin)
    return _trace(best, back)


def _trace(best: list[list[float]], back: list[list[tuple[int, int] | None]]) -> list[int | None]:
    n = len(best)
    cheapest, state = n * COST_OF_MISSING, None
    for now in range(n):
        for k, cost in enumerate(best[now]):
            total = cost + (n - 1 - now) * COST_OF_MISSING
            if total < cheapest:
                cheapest, state = total, (now, k)
    chosen: list[int | None] = [None] * n
    while state is not None:
        now, k = state
        chosen[now] = k
        state = back[now][k]
    return chosen


def _look_cost(candidate: Candidate, radius: float | None) -> float:
    cost = (candidate.roundness / 0.04) ** 2 + 4.0 * (1.0 - candidate.coverage)
    cost += (12.0 / max(candidate.contrast, 1.0)) ** 2 + 0.5 * (20.0 / max(candidate.strength, 1.0)) ** 2
    cost += COST_ON_BOARD * candidate.on_board
    if radius is not None:
        cost += (np.log(candidate.radius_squares / radius) / 0.15) ** 2
    return float(cost)


def _common_radius(candidates: Sequence[Sequence[Candidate]]) -> float | None:
    """Radius that the roundest candidates of most photographs share."""
    best = [
        min(photo, key=lambda candidate: _look_cost(candidate, None)).radius_squares
        for photo in candidates
        if photo
    ]
    return float(np.median(best)) if best else None


def _static_cost(places: Sequence[FloatArray]) -> list[FloatArray]:
    """Cost of spots that stay put on the board while, in the same photographs, another spot moves."""
    with_spots = [place for place in places if len(place)]
    if len(with_spots) < 3:
        return [np.zeros(len(place)) for place in places]
    counts = []
    for place in places:
        near = [
            (np.linalg.norm(place[:, None] - other[None], axis=2) < STATIC_SQUARES).any(axis=1)
            for other in with_spots
        ]
        counts.append(np.sum(near, axis=0) if len(place) else np.zeros(0))
    fixed = [count >= 0.7 * len(with_spots) for count in counts]
    # Where every photograph's spots are fixed, the marker simply did not move.
    moving = sum(bool((~flags).any()) for flags in fixed if len(flags))
    penalty = 6.0 if moving >= 0.5 * len(with_spots) else 0.0
    return [penalty * flags.astype(float) for flags in fixed]
