"""The Mooney-Rivlin law with two, three or five terms."""

from __future__ import annotations

from dataclasses import dataclass

from .checks import require_positive
from .invariants import FloatArray, InvariantSlopes, principal_derivatives, reduced_invariants


@dataclass(frozen=True)
class MooneyRivlin:
    r"""The Mooney-Rivlin law, a polynomial in the invariants.

    .. math:: W = C_{10}x + C_{01}y + C_{11}xy + C_{20}x^2 + C_{02}y^2,
              \qquad x = \bar I_1 - 3,\; y = \bar I_2 - 3

    The law with two terms has C₁₀ and C₀₁; the one with three terms adds C₁₁ (some programs add C₂₀ instead,
    which this class takes as well); the one with five has them all. The initial shear modulus is
    2 (C₁₀ + C₀₁).

    Parameters
    ----------
    c10_MPa, c01_MPa, c11_MPa, c20_MPa, c02_MPa : float

    Raises
    ------
    ValueError
        If the initial shear modulus is not positive.

    References
    ----------
    M. Mooney, J. Appl. Phys. 11 (1940) 582-592. R. S. Rivlin, Phil. Trans. R. Soc. A 241 (1948) 379-397.
    A. G. James, A. Green, G. M. Simpson, J. Appl. Polym. Sci. 19 (1975) 2033-2058 (three terms and more).
    """

    c10_MPa: float
    c01_MPa: float
    c11_MPa: float = 0.0
    c20_MPa: float = 0.0
    c02_MPa: float = 0.0

    def __post_init__(self) -> None:
        require_positive("Mooney-Rivlin", shear_modulus_MPa=self.shear_modulus_MPa)

    @property
    def shear_modulus_MPa(self) -> float:
        """Initial shear modulus 2 (C₁₀ + C₀₁)."""
        return 2.0 * (self.c10_MPa + self.c01_MPa)

    def energy(self, log_stretch: FloatArray) -> FloatArray:
        """Return the energy density in MPa for isochoric log stretches, (n, 3) to (n,)."""
        x, y = reduced_invariants(log_stretch)
        return (
            self.c10_MPa * x
            + self.c01_MPa * y
            + self.c11_MPa * x * y
            + self.c20_MPa * x**2
            + self.c02_MPa * y**2
        )

    def derivatives(self, log_stretch: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return first and second derivatives in the log stretches, (n, 3) to (n, 3) and (n, 3, 3)."""
        x, y = reduced_invariants(log_stretch)
        slopes = InvariantSlopes(
            d1=self.c10_MPa + self.c11_MPa * y + 2.0 * self.c20_MPa * x,
            d2=self.c01_MPa + self.c11_MPa * x + 2.0 * self.c02_MPa * y,
            d11=2.0 * self.c20_MPa,
            d12=self.c11_MPa,
            d22=2.0 * self.c02_MPa,
        )
        return principal_derivatives(log_stretch, slopes)
