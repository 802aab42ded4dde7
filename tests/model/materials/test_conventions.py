"""The three ways of writing Ogden's law."""

import numpy as np
import pytest

from spavision.errors import InputError
from spavision.model.materials.conventions import (
    C_OVER_M2,
    CONVENTIONS,
    TWO_MU_OVER_ALPHA2,
    convention_of,
    moduli_in,
    ogden_from,
)
from spavision.model.materials.ogden import Ogden

SMOOTH_SIL = Ogden((-0.30622, 0.0283304, 6.5963e-9), (-3.0594, 4.59654, 17.6852))


@pytest.mark.parametrize("convention", CONVENTIONS.values(), ids=CONVENTIONS)
def test_moduli_survive_the_round_trip(convention):
    back = ogden_from(moduli_in(SMOOTH_SIL, convention), SMOOTH_SIL.alpha, convention)
    np.testing.assert_allclose(back.mu_MPa, SMOOTH_SIL.mu_MPa, rtol=1e-14)
    assert back.alpha == SMOOTH_SIL.alpha


def test_shear_modulus_in_each_convention():
    """G₀ = ½ Σ μα, Σ μ and ½ Σ c (Abaqus theory manual 4.6.1; FEBio user manual, Ogden)."""
    assert sum(moduli_in(SMOOTH_SIL, TWO_MU_OVER_ALPHA2)) == pytest.approx(SMOOTH_SIL.shear_modulus_MPa)
    assert 0.5 * sum(moduli_in(SMOOTH_SIL, C_OVER_M2)) == pytest.approx(SMOOTH_SIL.shear_modulus_MPa)


def test_energy_is_the_formula_of_the_convention():
    stretches = np.array([1.5, 0.8, 1.0 / 1.2])
    log_stretch = np.log(stretches)[None, :]
    for convention, coefficient in ((TWO_MU_OVER_ALPHA2, 2.0), (C_OVER_M2, 1.0)):
        moduli = moduli_in(SMOOTH_SIL, convention)
        written_out = sum(
            coefficient * m / a**2 * ((stretches**a).sum() - 3.0)
            for m, a in zip(moduli, SMOOTH_SIL.alpha, strict=True)
        )
        assert SMOOTH_SIL.energy(log_stretch)[0] == pytest.approx(written_out, rel=1e-12)


def test_wrong_convention_is_told():
    """Smooth-Sil 950 read as Abaqus' parameters has G₀ = Σ μ < 0."""
    with pytest.raises(InputError, match=r"2mu/alpha\^2"):
        ogden_from(SMOOTH_SIL.mu_MPa, SMOOTH_SIL.alpha, TWO_MU_OVER_ALPHA2)
    with pytest.raises(InputError, match="expected one of"):
        convention_of("abaqus")
    with pytest.raises(InputError, match="as many moduli"):
        ogden_from((0.1,), (2.0, 3.0), C_OVER_M2)
