"""The neo-Hookean law."""

from __future__ import annotations

from dataclasses import dataclass

from .checks import require_positive
from .invariants import FloatArray, InvariantSlopes, principal_derivatives, reduced_invariants


@dataclass(frozen=True)
class NeoHooke:
    r"""The neo-Hookean law, :math:`W = \tfrac{G}{2}(\bar I_1 - 3)`.

    Parameters
    ----------
    shear_modulus_MPa : float
        G.

    Raises
    ------
    ValueError
        If the modulus is not positive.

    References
    ----------
    L. R. G. Treloar, Trans. Faraday Soc. 39 (1943) 36-41 and 241-246.
    """

    shear_modulus_MPa: float

    def __post_init__(self) -> None:
        require_positive("neo-Hooke", shear_modulus_MPa=self.shear_modulus_MPa)

    def energy(self, log_stretch: FloatArray) -> FloatArray:
        """Return the energy density in MPa for isochoric log stretches, (n, 3) to (n,)."""
        return 0.5 * self.shear_modulus_MPa * reduced_invariants(log_stretch)[0]

    def derivatives(self, log_stretch: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return first and second derivatives in the log stretches, (n, 3) to (n, 3) and (n, 3, 3)."""
        return principal_derivatives(log_stretch, InvariantSlopes(d1=0.5 * self.shear_modulus_MPa))
