"""Which candidate is the marker: judged over the whole sequence of photographs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .arrays import FloatArray, IntArray
from .marker import Candidate

COST_OF_MISSING = 7.0
"""A reading that costs more than this is worse than none."""

COST_ON_BOARD = 2.5
"""Cost of a spot that the board's corners surround: the marker's carrier hides them."""

RADIUS_TOLERANCE = 0.15
"""Relative difference of radius that costs one unit."""

STATIC_SQUARES = 0.15
"""Motion within which a spot counts as fixed to the board."""


@dataclass(frozen=True)
class Motion:
    """How a marker moves from photograph to photograph.

    Parameters
    ----------
    usual_step_squares : float
        Motion between neighbouring photographs that costs one unit.
    largest_cost : float
        A jump of any length costs no more than this.
    may_rest : bool
        Whether it may stay put on the board while other spots move.
    """

    usual_step_squares: float
    largest_cost: float
    may_rest: bool


TIP_MOTION = Motion(usual_step_squares=6.0, largest_cost=2.0, may_rest=False)
"""15 mm on 2.5 mm squares, and more where pressures are far apart."""

BASE_MOTION = Motion(usual_step_squares=2.0, largest_cost=np.inf, may_rest=True)
"""A slipping clamp: 5 mm on 2.5 mm squares, and never as far as the tip."""


def select_markers(
    candidates: Sequence[Sequence[Candidate]],
    places: Sequence[FloatArray],
    *,
    radius_squares: float | None,
    motion: Motion = TIP_MOTION,
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
    motion : Motion
        How far the marker is expected to move.
    """
    fixed = [np.zeros(len(place)) for place in places] if motion.may_rest else _static_cost(places)
    radii = [radius_squares] if radius_squares is not None else _radii(candidates)
    # A round bolt has a size of its own: of all sizes seen, the one that explains the series best counts.
    paths = [_cheapest_path(candidates, places, fixed, radius, motion) for radius in radii]
    return min(paths, key=lambda path: path[0])[1] if paths else [None] * len(candidates)


def _cheapest_path(
    candidates: Sequence[Sequence[Candidate]],
    places: Sequence[FloatArray],
    fixed: Sequence[FloatArray],
    radius: float,
    motion: Motion,
) -> tuple[float, list[int | None]]:
    """Return the cost of the best choice for a marker of the given radius, and the choice."""
    cost = np.zeros(0)
    photo = np.zeros(0, dtype=np.intp)
    before: list[int] = []
    spots = np.concatenate([place.reshape(-1, 2) for place in places]) if places else np.zeros((0, 2))
    for now, own in enumerate(candidates):
        # A spot's path comes from one spot of any earlier photograph, or begins here.
        arrival = []
        for k, candidate in enumerate(own):
            step = np.linalg.norm(spots[: len(cost)] - places[now][k], axis=1) / motion.usual_step_squares
            gap = now - photo
            total = cost + (gap - 1) * COST_OF_MISSING + np.minimum(step**2 / gap, motion.largest_cost)
            origin = int(np.argmin(total)) if len(total) else -1
            if origin < 0 or total[origin] >= now * COST_OF_MISSING:
                origin = -1
            before.append(origin)
            way = now * COST_OF_MISSING if origin < 0 else float(total[origin])
            arrival.append(way + _look_cost(candidate, radius) + fixed[now][k])
        cost = np.append(cost, arrival)
        photo = np.append(photo, np.full(len(own), now, dtype=np.intp))
    return _trace(cost, photo, before, len(candidates))


def _trace(cost: FloatArray, photo: IntArray, before: list[int], n: int) -> tuple[float, list[int | None]]:
    """Follow the cheapest path back from its last spot; return its cost and its spot in each photograph."""
    chosen: list[int | None] = [None] * n
    total = cost + (n - 1 - photo) * COST_OF_MISSING
    spot = int(np.argmin(total)) if len(total) and total.min() < n * COST_OF_MISSING else -1
    lowest = float(total[spot]) if spot >= 0 else n * COST_OF_MISSING
    while spot >= 0:
        now = int(photo[spot])
        chosen[now] = spot - int(np.searchsorted(photo, now))
        spot = before[spot]
    return lowest, chosen


def _look_cost(candidate: Candidate, radius: float) -> float:
    cost = (candidate.roundness / 0.04) ** 2 + 4.0 * (1.0 - candidate.coverage)
    cost += (12.0 / max(candidate.contrast, 1.0)) ** 2 + 0.5 * (20.0 / max(candidate.strength, 1.0)) ** 2
    cost += COST_ON_BOARD * candidate.on_board
    cost += (np.log(candidate.radius_squares / radius) / RADIUS_TOLERANCE) ** 2
    return float(cost)


def _radii(candidates: Sequence[Sequence[Candidate]]) -> list[float]:
    """Radii of spots, one for each group of spots of about the same size."""
    logs = np.sort([np.log(candidate.radius_squares) for photo in candidates for candidate in photo])
    groups = np.split(logs, np.flatnonzero(np.diff(logs) > RADIUS_TOLERANCE) + 1) if len(logs) else []
    return [float(np.exp(np.median(group))) for group in groups]


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
