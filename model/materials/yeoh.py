"""Yeoh's law."""

from __future__ import annotations

from dataclasses import dataclass

from .checks import require_positive
from .invariants import FloatArray, InvariantSlopes, principal_derivatives, reduced_invariants


@dataclass(frozen=True)
class Yeoh:
    r"""Yeoh's law, :math:`W = C_{10}(\bar I_1-3) + C_{20}(\bar I_1-3)^2 + C_{30}(\bar I_1-3)^3`.

    The initial shear modulus is 2 C₁₀.

    Parameters
    ----------
    c10_MPa, c20_MPa, c30_MPa : float

    Raises
    ------
    ValueError
        If C₁₀ is not positive.

    References
    ----------
    O. H. Yeoh, Rubber Chem. Technol. 66 (1993) 754-771.
    """

    c10_MPa: float
    c20_MPa: float = 0.0
    c30_MPa: float = 0.0

    def __post_init__(self) -> None:
        require_positive("Yeoh", c10_MPa=self.c10_MPa)

    @property
    def shear_modulus_MPa(self) -> float:
        """Initial shear modulus 2 C₁₀."""
        return 2.0 * self.c10_MPa

    def energy(self, log_stretch: FloatArray) -> FloatArray:
        """Return the energy density in MPa for isochoric log stretches, (n, 3) to (n,)."""
        x, _ = reduced_invariants(log_stretch)
        return x * (self.c10_MPa + x * (self.c20_MPa + x * self.c30_MPa))

    def derivatives(self, log_stretch: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return first and second derivatives in the log stretches, (n, 3) to (n, 3) and (n, 3, 3)."""
        x, _ = reduced_invariants(log_stretch)
        slopes = InvariantSlopes(
            d1=self.c10_MPa + x * (2.0 * self.c20_MPa + 3.0 * x * self.c30_MPa),
            d11=2.0 * self.c20_MPa + 6.0 * x * self.c30_MPa,
        )
        return principal_derivatives(log_stretch, slopes)
