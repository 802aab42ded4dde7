"""Material cards of an Abaqus/CalculiX deck."""

from __future__ import annotations

from collections.abc import Sequence

from spavision.errors import InputError

from .materials.conventions import TWO_MU_OVER_ALPHA2, moduli_in
from .materials.mooney_rivlin import MooneyRivlin
from .materials.neo_hooke import NeoHooke
from .materials.ogden import Ogden
from .materials.solid import SolidMaterial
from .materials.yeoh import Yeoh

_NUMBERS_A_LINE = 8
_LARGEST_OGDEN_ORDER = 3
"""Of CalculiX; Abaqus takes six."""


def material_cards(name: str, material: SolidMaterial) -> list[str]:
    """Write a material without its fibres.

    The volumetric part κ/2 (J − 1)² is that of the programs with D₁ = 2/κ and no further terms. Ogden's
    moduli are converted to their convention, μ_theirs = μα/2.

    Raises
    ------
    InputError
        If the law is none of theirs.
    """
    option, constants, orders = _constants(name, material)
    volumetric = [2.0 / material.bulk_modulus_MPa] + [0.0] * (orders - 1)
    return [
        f"*MATERIAL, NAME={name}",
        f"*HYPERELASTIC, {option}",
        *number_lines([*constants, *volumetric]),
        "*DENSITY",
        f"{material.density_tonne_per_mm3:.10g}",
    ]


def number_lines(numbers: Sequence[float]) -> list[str]:
    """Write numbers eight a line, as the programs read them."""
    return [
        ", ".join(f"{number:.10g}" for number in numbers[start : start + _NUMBERS_A_LINE])
        for start in range(0, len(numbers), _NUMBERS_A_LINE)
    ]


def _constants(name: str, material: SolidMaterial) -> tuple[str, list[float], int]:
    """Option, constants of the law, and number of volumetric terms that the option asks for."""
    law = material.law
    if isinstance(law, Ogden) and len(law.alpha) <= _LARGEST_OGDEN_ORDER:
        moduli = moduli_in(law, TWO_MU_OVER_ALPHA2)
        pairs = [number for pair in zip(moduli, law.alpha, strict=True) for number in pair]
        return f"OGDEN, N={len(law.alpha)}", pairs, len(law.alpha)
    if isinstance(law, NeoHooke):
        return "NEO HOOKE", [0.5 * law.shear_modulus_MPa], 1
    if isinstance(law, Yeoh):
        return "YEOH", [law.c10_MPa, law.c20_MPa, law.c30_MPa], 3
    if isinstance(law, MooneyRivlin):
        numbers = [law.c10_MPa, law.c01_MPa, law.c20_MPa, law.c11_MPa, law.c02_MPa]
        return "POLYNOMIAL, N=2", numbers, 2
    raise InputError(
        f"--write-deck: CalculiX and Abaqus do not share the law {type(law).__name__} of region {name}; "
        "choose an Ogden law of up to three terms, neo-Hooke, Mooney-Rivlin or Yeoh for that region"
    )
