"""Gent's law, which locks at a finite stretch."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .checks import require_positive
from .invariants import FloatArray, InvariantSlopes, principal_derivatives, reduced_invariants


@dataclass(frozen=True)
class Gent:
    r"""Gent's law, :math:`W = -\tfrac{G J_m}{2}\ln\left(1 - \frac{\bar I_1-3}{J_m}\right)`.

    Admissible are deformations with Ī₁ − 3 < J_m: the stress grows without bound as they near it. Beyond it
    the energy is returned as infinite and its derivatives as NaN, so that a solver takes the step back;
    `curves.locking_stretches` tells the stretches at which each test gets there.

    Parameters
    ----------
    shear_modulus_MPa : float
        G.
    limit : float
        J_m, the value of Ī₁ − 3 at which the law locks.

    Raises
    ------
    ValueError
        If a parameter is not positive.

    References
    ----------
    A. N. Gent, Rubber Chem. Technol. 69 (1996) 59-61.
    """

    shear_modulus_MPa: float
    limit: float

    def __post_init__(self) -> None:
        require_positive("Gent", shear_modulus_MPa=self.shear_modulus_MPa, limit=self.limit)

    @property
    def largest_invariant(self) -> float:
        """Ī₁ − 3 at which the law locks."""
        return self.limit

    def energy(self, log_stretch: FloatArray) -> FloatArray:
        """Return the energy density in MPa for isochoric log stretches, (n, 3) to (n,)."""
        ratio = reduced_invariants(log_stretch)[0] / self.limit
        within = ratio < 1.0
        energy = -0.5 * self.shear_modulus_MPa * self.limit * np.log1p(-np.where(within, ratio, 0.0))
        return np.where(within, energy, np.inf)

    def derivatives(self, log_stretch: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return first and second derivatives in the log stretches, (n, 3) to (n, 3) and (n, 3, 3)."""
        room = self._room(log_stretch)
        d1 = 0.5 * self.shear_modulus_MPa * self.limit / room
        return principal_derivatives(log_stretch, InvariantSlopes(d1=d1, d11=d1 / room))

    def limit_sensitivity(self, log_stretch: FloatArray) -> FloatArray:
        """Return the derivative of the energy's first derivatives with respect to J_m, (n, 3) to (n, 3)."""
        room = self._room(log_stretch)
        slope = 0.5 * self.shear_modulus_MPa * (room - self.limit) / room**2
        return principal_derivatives(log_stretch, InvariantSlopes(d1=slope))[0]

    def _room(self, log_stretch: FloatArray) -> FloatArray:
        """J_m − (Ī₁ − 3), NaN beyond the limit."""
        room = self.limit - reduced_invariants(log_stretch)[0]
        return np.where(room > 0.0, room, np.nan)
