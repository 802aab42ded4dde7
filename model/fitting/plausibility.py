"""What a fit may be good at and still be wrong about: the unit of stress, the tests that were not made."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from spavision.errors import InputError
from spavision.model.materials.curves import EQUIBIAXIAL, UNIAXIAL, nominal_stress
from spavision.model.materials.neo_hooke import NeoHooke
from spavision.model.materials.solid import IsotropicLaw

from .fit_data import FitData
from .measured_curve import MeasuredCurve

PLAUSIBLE_SHEAR_MODULUS_MPa = (1e-3, 100.0)
"""Outside of this the unit of stress is doubted: softer than any gel that stands, stiffer than any rubber."""

PLAUSIBLE_BIAXIAL_RATIO = 3.0
"""Nominal stress at equibiaxial stretch √x over that at uniaxial stretch x; 0.4 to 0.9 for rubbers."""

_DOUBTED, _REFUSED = 0.5, 0.2
"""Misfit of the neo-Hookean law to a curve read as compression, over that to the curve read as tension."""

_TELLING_MISFIT = 1e-4
"""A curve that fits tension as well as this is not doubted."""

_CLOSE_MISFIT = 0.02
"""A curve that fits compression as well as this is no stiffening composite."""


def refuse_absurd_modulus(data: FitData) -> None:
    """Ask for the unit of stress where the stiffness of the data is no rubber's.

    The shear modulus of the neo-Hookean fit is judged, not that of the law asked for, which can be far off
    where the law does not suit the data.

    Raises
    ------
    InputError
        If it lies outside of `PLAUSIBLE_SHEAR_MODULUS_MPa`.
    """
    unit_stress = data.stress_from(NeoHooke(1.0).derivatives(data.log_stretch)[0])
    weighted = data.weight * unit_stress
    modulus_MPa = abs(float(weighted @ data.stress_MPa)) / float(weighted @ unit_stress)
    low, high = PLAUSIBLE_SHEAR_MODULUS_MPa
    if not low <= modulus_MPa <= high:
        raise InputError(
            f"the shear modulus comes out as {modulus_MPa:.3g} MPa, expected {low:g} to {high:g} for a "
            "rubber; name the unit of stress with --stress-unit (MPa, kPa, Pa), to correct or to confirm it"
        )


def biaxial_notes(law: IsotropicLaw, curves: Sequence[MeasuredCurve]) -> list[str]:
    """Tell when a law fitted to uniaxial tests alone is absurdly stiff in biaxial tension.

    An exponent of Ogden's law cannot be told from its −2nd multiple by tension alone, and the negative one
    locks in biaxial tension.
    """
    if any(curve.mode != UNIAXIAL for curve in curves):
        return []
    stretch = np.array([max(curve.stretch.max() for curve in curves)])
    if not stretch[0] > 1.0:
        return []
    biaxial = np.sqrt(stretch)
    ratio = nominal_stress(law, biaxial, EQUIBIAXIAL)[0] / nominal_stress(law, stretch, UNIAXIAL)[0]
    if not ratio > PLAUSIBLE_BIAXIAL_RATIO:
        return []
    return [
        f"the stress at equibiaxial stretch {biaxial[0]:.3g} is {ratio:.3g} times that at uniaxial stretch "
        f"{stretch[0]:.3g}, which no test supports: add a biaxial test or fit another law"
    ]


def compression_doubts(
    as_tension: MeasuredCurve, read_as_compression: Callable[[], MeasuredCurve], *, source: str
) -> tuple[str, ...]:
    """Doubt that positive strains are tension where nothing tells and the stress rises ever more steeply.

    Up to strains of 100 % rubber softens in tension and stiffens in compression, the neo-Hookean law by
    λ − λ⁻² in both. A stiffening composite in tension lies between.

    Parameters
    ----------
    as_tension : MeasuredCurve
    read_as_compression : callable
        Returns the curve with the strains' sign reversed.
    source : str
        File name for messages.

    Returns
    -------
    notes : tuple of str

    Raises
    ------
    InputError
        If the curve is that of rubber in compression.
    """
    strain = as_tension.strain
    if not (0.0 < strain.max() < 1.0 and strain.min() > -0.02 * strain.max()):
        return ()
    tension = _neo_hookean_misfit(as_tension)
    if tension <= _TELLING_MISFIT:
        return ()
    compression = _neo_hookean_misfit(read_as_compression())
    if compression < min(_REFUSED * tension, _CLOSE_MISFIT):
        raise InputError(
            f"{source}: the strains are positive, but the stress rises as that of rubber in compression; "
            "give --mode compression, or --mode uniaxial if it is tension"
        )
    if compression < _DOUBTED * tension:
        return ("the stress rises ever more steeply: --mode compression if that is the test",)
    return ()


def _neo_hookean_misfit(curve: MeasuredCurve) -> float:
    """1 − R² of the best neo-Hookean law, 0 for a stress that does not vary."""
    unit = nominal_stress(NeoHooke(1.0), curve.stretch, UNIAXIAL)
    residual = curve.stress_MPa - unit * float(unit @ curve.stress_MPa) / float(unit @ unit)
    total = float(np.sum((curve.stress_MPa - curve.stress_MPa.mean()) ** 2))
    return float(residual @ residual) / total if total > 0.0 else 0.0
