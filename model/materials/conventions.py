"""The three ways in which programs write Ogden's law, named and converted."""

from __future__ import annotations

from dataclasses import dataclass

from spavision.errors import InputError

from .ogden import Ogden


@dataclass(frozen=True)
class OgdenConvention:
    """One way of writing the coefficient of (λ̄₁^α + λ̄₂^α + λ̄₃^α − 3).

    Parameters
    ----------
    name : str
        As stored in material files.
    coefficient : str
        The coefficient as a formula.
    shear_modulus : str
        The initial shear modulus as a formula.
    used_by : str
    power, factor : float
        The coefficient is factor·m/α^power, where m is the number that the program asks for.
    """

    name: str
    coefficient: str
    shear_modulus: str
    used_by: str
    power: int
    factor: float


MU_OVER_ALPHA = OgdenConvention("mu/alpha", "μ/α", "½ Σ μα", "Ogden 1972, Marc, NX, spavision", 1, 1.0)
TWO_MU_OVER_ALPHA2 = OgdenConvention("2mu/alpha^2", "2μ/α²", "Σ μ", "Abaqus, CalculiX, FElupe", 2, 2.0)
C_OVER_M2 = OgdenConvention("c/m^2", "c/m²", "½ Σ c", "FEBio", 2, 1.0)

CONVENTIONS = {each.name: each for each in (MU_OVER_ALPHA, TWO_MU_OVER_ALPHA2, C_OVER_M2)}


def convention_of(name: str) -> OgdenConvention:
    """Return the convention of that name.

    Raises
    ------
    InputError
        If there is none.
    """
    if name not in CONVENTIONS:
        raise InputError(f"Ogden convention {name!r} is unknown, expected one of {', '.join(CONVENTIONS)}")
    return CONVENTIONS[name]


def ogden_from(moduli_MPa: tuple[float, ...], alpha: tuple[float, ...], convention: OgdenConvention) -> Ogden:
    """Build Ogden's law from moduli that follow a convention.

    Raises
    ------
    InputError
        If the numbers do not make a law in that convention, such as a shear modulus that is not positive.
    """
    if len(moduli_MPa) != len(alpha) or any(exponent == 0.0 for exponent in alpha):
        raise InputError("Ogden: expected as many moduli as exponents alpha, and no exponent 0")
    mu = tuple(
        convention.factor * m * a ** (1 - convention.power) for m, a in zip(moduli_MPa, alpha, strict=True)
    )
    try:
        return Ogden(mu, tuple(alpha))
    except ValueError as error:
        raise InputError(f"{error}; they were read in the convention {convention.name}") from error


def moduli_in(law: Ogden, convention: OgdenConvention) -> tuple[float, ...]:
    """Return the moduli of Ogden's law, one a term, as a program of that convention asks for them."""
    return tuple(
        mu * a ** (convention.power - 1) / convention.factor
        for mu, a in zip(law.mu_MPa, law.alpha, strict=True)
    )
