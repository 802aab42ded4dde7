"""From an energy in the isochoric invariants to its derivatives in the isochoric principal log stretches."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class InvariantSlopes:
    """Derivatives of an energy W(Ī₁, Ī₂) with respect to the invariants, each of shape (n,), in MPa.

    Parameters
    ----------
    d1, d2 : array or float
        ∂W/∂Ī₁ and ∂W/∂Ī₂.
    d11, d12, d22 : array or float
        Second derivatives.
    """

    d1: FloatArray | float
    d2: FloatArray | float = 0.0
    d11: FloatArray | float = 0.0
    d12: FloatArray | float = 0.0
    d22: FloatArray | float = 0.0


def reduced_invariants(log_stretch: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return Ī₁ − 3 = Σ λ̄ᵢ² − 3 and Ī₂ − 3 = Σ λ̄ᵢ⁻² − 3, each of shape (n,).

    Parameters
    ----------
    log_stretch : array, shape (n, 3)
        Natural logarithms of the isochoric principal stretches; each row adds up to zero.
    """
    return np.expm1(2.0 * log_stretch).sum(axis=1), np.expm1(-2.0 * log_stretch).sum(axis=1)


def invariant_gradients(log_stretch: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return ∂Ī₁/∂ ln λ̄ᵢ and ∂Ī₂/∂ ln λ̄ᵢ, each of shape (n, 3)."""
    return 2.0 * np.exp(2.0 * log_stretch), -2.0 * np.exp(-2.0 * log_stretch)


def principal_derivatives(log_stretch: FloatArray, slopes: InvariantSlopes) -> tuple[FloatArray, FloatArray]:
    """Apply the chain rule: first and second derivatives of the energy in the log stretches.

    Parameters
    ----------
    log_stretch : array, shape (n, 3)
    slopes : InvariantSlopes

    Returns
    -------
    first : array, shape (n, 3)
    second : array, shape (n, 3, 3)
        Both hold on the volume-preserving plane Σ ln λ̄ᵢ = 0, which is all that stress and moduli use.
    """
    g1, g2 = invariant_gradients(log_stretch)
    d1, d2 = _column(slopes.d1), _column(slopes.d2)
    first = d1 * g1 + d2 * g2
    second = (
        _column(slopes.d11)[..., None] * g1[:, :, None] * g1[:, None, :]
        + _column(slopes.d22)[..., None] * g2[:, :, None] * g2[:, None, :]
        + _column(slopes.d12)[..., None] * (g1[:, :, None] * g2[:, None, :] + g2[:, :, None] * g1[:, None, :])
    )
    axes = np.arange(3)
    second[:, axes, axes] += 2.0 * (d1 * g1 - d2 * g2)
    return first, second


def _column(slope: FloatArray | float) -> FloatArray:
    return np.atleast_1d(np.asarray(slope, dtype=float))[:, None]
