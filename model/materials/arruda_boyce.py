"""The eight-chain law of Arruda and Boyce, with the exact inverse Langevin function."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .checks import require_positive
from .invariants import FloatArray, InvariantSlopes, principal_derivatives, reduced_invariants
from .inverse_langevin import inverse_langevin, langevin_slope


@dataclass(frozen=True)
class ArrudaBoyce:
    r"""The eight-chain law in the chain stretch :math:`\lambda_c = \sqrt{\bar I_1/3}`.

    .. math:: W = \mu\lambda_m^2\left(\beta r + \ln\frac{\beta}{\sinh\beta}\right) - W_0,
              \qquad r = \lambda_c/\lambda_m,\; \beta = L^{-1}(r)

    L is Langevin's function coth β − 1/β. Its inverse is solved to machine precision; most programs take the
    first five terms of its series instead, which are softer near locking. Admissible are deformations with
    λ_c < λ_m; beyond, the energy is returned as infinite and its derivatives as NaN.

    Parameters
    ----------
    chain_modulus_MPa : float
        μ = nkT; the initial shear modulus is μ (λ_m/3) L⁻¹(1/λ_m), somewhat above μ.
    locking_stretch : float
        λ_m = √N, the stretch of a chain at which it is straight.

    Raises
    ------
    ValueError
        If μ is not positive or λ_m is not above 1.

    References
    ----------
    E. M. Arruda, M. C. Boyce, J. Mech. Phys. Solids 41 (1993) 389-412.
    """

    chain_modulus_MPa: float
    locking_stretch: float

    def __post_init__(self) -> None:
        require_positive(
            "Arruda-Boyce",
            chain_modulus_MPa=self.chain_modulus_MPa,
            locking_stretch_less_1=self.locking_stretch - 1.0,
        )

    @property
    def shear_modulus_MPa(self) -> float:
        """Initial shear modulus μ (λ_m/3) L⁻¹(1/λ_m)."""
        beta = inverse_langevin(np.array([1.0 / self.locking_stretch]))[0]
        return self.chain_modulus_MPa * self.locking_stretch / 3.0 * float(beta)

    @property
    def largest_invariant(self) -> float:
        """Ī₁ − 3 at which the law locks."""
        return 3.0 * (self.locking_stretch**2 - 1.0)

    def energy(self, log_stretch: FloatArray) -> FloatArray:
        """Return the energy density in MPa for isochoric log stretches, (n, 3) to (n,)."""
        ratio = np.sqrt(1.0 + reduced_invariants(log_stretch)[0] / 3.0) / self.locking_stretch
        within = ratio < 1.0
        rest = 1.0 / self.locking_stretch
        potential = _chain_potential(np.where(within, ratio, rest)) - _chain_potential(np.array([rest]))
        return np.where(within, self.chain_modulus_MPa * self.locking_stretch**2 * potential, np.inf)

    def derivatives(self, log_stretch: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return first and second derivatives in the log stretches, (n, 3) to (n, 3) and (n, 3, 3)."""
        chain, beta, beta_slope = self._chain(log_stretch)
        d1 = self.chain_modulus_MPa * self.locking_stretch * beta / (6.0 * chain)
        d11 = self.chain_modulus_MPa / (36.0 * chain**2) * (beta_slope - self.locking_stretch * beta / chain)
        return principal_derivatives(log_stretch, InvariantSlopes(d1=d1, d11=d11))

    def locking_sensitivity(self, log_stretch: FloatArray) -> FloatArray:
        """Return the derivative of the energy's first derivatives with respect to λ_m, (n, 3) to (n, 3)."""
        chain, beta, beta_slope = self._chain(log_stretch)
        slope = self.chain_modulus_MPa / (6.0 * chain) * (beta - beta_slope * chain / self.locking_stretch)
        return principal_derivatives(log_stretch, InvariantSlopes(d1=slope))[0]

    def _chain(self, log_stretch: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Chain stretch λ_c, β and dβ/d(λ_c/λ_m), each (n,); NaN beyond locking."""
        chain = np.sqrt(1.0 + reduced_invariants(log_stretch)[0] / 3.0)
        ratio = np.where(chain < self.locking_stretch, chain / self.locking_stretch, np.nan)
        beta = inverse_langevin(ratio)
        return chain, beta, 1.0 / langevin_slope(beta)


def _chain_potential(ratio: FloatArray) -> FloatArray:
    """β r + ln(β/sinh β), free of overflow for large β."""
    beta = inverse_langevin(ratio)
    return beta * (ratio - 1.0) + np.log(2.0 * beta / -np.expm1(-2.0 * beta))
