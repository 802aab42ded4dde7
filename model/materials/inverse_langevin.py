"""Langevin's function L(β) = coth β − 1/β and its inverse."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

_SMALL = 0.15
"""Below this β a series replaces the difference of large numbers in L and L′ (there either errs by 1e-12)."""

_NEWTON_STEPS = 5


def langevin(beta: FloatArray) -> FloatArray:
    """Return L(β) for β ≥ 0, shape (n,)."""
    small = beta < _SMALL
    safe = np.where(small, 1.0, beta)
    square = beta**2
    series = beta * (
        1 / 3 - square * (1 / 45 - square * (2 / 945 - square * (1 / 4725 - square * 2 / 93555)))
    )
    return np.where(small, series, 1.0 / np.tanh(safe) - 1.0 / safe)


def langevin_slope(beta: FloatArray) -> FloatArray:
    """Return L′(β) = 1/β² − 1/sinh²β for β ≥ 0, shape (n,)."""
    small = beta < _SMALL
    safe = np.where(small, 1.0, beta)
    square = beta**2
    series = 1 / 3 - square * (1 / 15 - square * (2 / 189 - square * (1 / 675 - square * 2 / 10395)))
    # 1/sinh² written with exp(-2β), which does not overflow
    decay = np.exp(-2.0 * safe)
    return np.where(small, series, 1.0 / safe**2 - 4.0 * decay / (1.0 - decay) ** 2)


def inverse_langevin(ratio: FloatArray) -> FloatArray:
    """Solve L(β) = ratio for 0 ≤ ratio < 1, shape (n,), to machine precision; NaN stays NaN.

    Newton's method on 1/(1 − L(β)), which is nearly linear in β from end to end, started from Cohen's
    approximation r (3 − r²)/(1 − r²), at most 5 % off.

    References
    ----------
    A. Cohen, Rheol. Acta 30 (1991) 270-273.
    """
    beta = ratio * (3.0 - ratio**2) / (1.0 - ratio**2)
    for _ in range(_NEWTON_STEPS):
        value = langevin(beta)
        beta = beta - (value - ratio) * (1.0 - value) / ((1.0 - ratio) * langevin_slope(beta))
    return beta
