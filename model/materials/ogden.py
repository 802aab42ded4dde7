"""Ogden's hyperelastic law in isochoric principal stretches."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Ogden:
    r"""Ogden's law of any number of terms.

    .. math:: W = \sum_i \frac{\mu_i}{\alpha_i}
              (\bar\lambda_1^{\alpha_i} + \bar\lambda_2^{\alpha_i} + \bar\lambda_3^{\alpha_i} - 3)

    The initial shear modulus is ½ Σ μᵢαᵢ. Abaqus, CalculiX and FElupe write 2μ/α² for μ/α, so that
    their μ is μα/2 here.

    Parameters
    ----------
    mu_MPa, alpha : tuple of float
        One of each a term.

    Raises
    ------
    ValueError
        If the tuples differ in length, an exponent is zero or the initial shear modulus is not positive.

    References
    ----------
    R. W. Ogden, Proc. R. Soc. Lond. A 326 (1972) 565-584.
    """

    mu_MPa: tuple[float, ...]
    alpha: tuple[float, ...]

    def __post_init__(self) -> None:
        if len(self.mu_MPa) != len(self.alpha) or not self.mu_MPa:
            raise ValueError(
                f"Ogden: {len(self.mu_MPa)} mu for {len(self.alpha)} alpha, expected as many of each"
            )
        if any(alpha == 0.0 for alpha in self.alpha):
            raise ValueError("Ogden: an alpha is 0, expected exponents other than 0")
        if not self.shear_modulus_MPa > 0.0:
            raise ValueError(
                f"Ogden: the initial shear modulus ½ Σ mu alpha is {self.shear_modulus_MPa:g} MPa, expected "
                "a positive one; the parameters may follow another convention"
            )

    @property
    def shear_modulus_MPa(self) -> float:
        """Initial shear modulus ½ Σ μᵢαᵢ."""
        return 0.5 * float(np.dot(self.mu_MPa, self.alpha))

    def energy(self, log_stretch: FloatArray) -> FloatArray:
        """Return the energy density, shape (n,), in MPa.

        Parameters
        ----------
        log_stretch : array, shape (n, 3)
            Natural logarithms of the isochoric principal stretches.
        """
        total = np.zeros(len(log_stretch))
        for mu, alpha in zip(self.mu_MPa, self.alpha, strict=True):
            total += mu / alpha * np.expm1(alpha * log_stretch).sum(axis=1)
        return total

    def derivatives(self, log_stretch: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return first and second derivatives of the energy with respect to the log stretches.

        Parameters
        ----------
        log_stretch : array, shape (n, 3)
            Natural logarithms of the isochoric principal stretches.

        Returns
        -------
        first : array, shape (n, 3)
        second : array, shape (n, 3, 3)
        """
        first = np.zeros_like(log_stretch)
        second = np.zeros((len(log_stretch), 3, 3))
        for mu, alpha in zip(self.mu_MPa, self.alpha, strict=True):
            term = mu * np.exp(alpha * log_stretch)
            first += term
            for axis in range(3):
                second[:, axis, axis] += alpha * term[:, axis]
        return first, second
