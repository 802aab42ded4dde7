"""Which cases a study computes: random draws, grids, one parameter at a time."""

from __future__ import annotations

import itertools
import math

import numpy as np
from scipy.stats import qmc

from spavision.tip_path import FloatArray

from .parameters import Value
from .suspects import Suspect

_EDGE = 1e-9
"""Kept from the ends of the unit interval, where unbounded distributions are infinite."""


def draw_shares(n_suspects: int, n_cases: int, *, sampling: str, seed: int) -> FloatArray:
    """Return points of the unit cube, shape (n_cases, n_suspects), the same for the same seed.

    Parameters
    ----------
    n_suspects, n_cases : int
    sampling : str
        ``sobol``: scrambled Sobol sequence (Owen); ``random``: independent draws.
    seed : int
    """
    if sampling == "sobol":
        sequence = qmc.Sobol(n_suspects, rng=np.random.default_rng(seed))
        points = sequence.random_base2(math.ceil(math.log2(n_cases)))[:n_cases]
    else:
        points = np.random.default_rng(seed).random((n_cases, n_suspects))
    return np.asarray(np.clip(points, _EDGE, 1.0 - _EDGE))


def values_at(suspects: tuple[Suspect, ...], points: FloatArray) -> list[dict[str, Value]]:
    """Return the suspects' values at points of the unit cube."""
    return [
        {one.name: one.value(float(share)) for one, share in zip(suspects, point, strict=True)}
        for point in points
    ]


def grid_values(grid: dict[str, tuple[Value, ...]]) -> list[dict[str, Value]]:
    """Return every combination of the values of a grid, the last parameter changing fastest."""
    return [dict(zip(grid, values, strict=True)) for values in itertools.product(*grid.values())]


def one_at_a_time(suspects: tuple[Suspect, ...]) -> list[dict[str, Value]]:
    """Return, for each suspect, the cases with it alone off its nominal value.

    A number is put to both ends of its 95 % interval, a choice to each of its options.
    """
    return [
        {one.name: value} for one in suspects for value in (one.options if one.is_choice else one.interval)
    ]
