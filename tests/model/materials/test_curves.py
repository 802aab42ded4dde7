"""Nominal stress of every law against closed forms, and against the finite-element kernels."""

import numpy as np
import pytest

from spavision.model.materials.curves import (
    EQUIBIAXIAL,
    MODES,
    PLANAR,
    UNIAXIAL,
    fibre_composite_stress,
    locking_stretches,
    nominal_stiffness,
    nominal_stress,
)
from spavision.model.materials.gent import Gent
from spavision.model.materials.neo_hooke import NeoHooke
from spavision.model.materials.slack_fibre import SlackFibre
from spavision.model.stress_kernels import principal_moduli, principal_stress

from .laws import BODY, INVARIANT_LAWS, LAWS, textbook_stress

STRETCHES = np.array([0.6, 0.85, 1.0001, 1.3, 1.9, 2.5])


@pytest.mark.parametrize(
    ("mode", "stretch", "expected_MPa"),
    [
        # closed-forms.md, rows 1, 3 and 4
        (UNIAXIAL, 1.5, 0.160466435),
        (UNIAXIAL, 2.0, 0.325062500),
        (UNIAXIAL, 3.0, 1.107407407),
        (EQUIBIAXIAL, 1.5, 0.202014807),
        (EQUIBIAXIAL, 2.0, 0.353905884),
        (PLANAR, 1.5, 0.180290852),
        (PLANAR, 2.0, 0.341601563),
    ],
)
def test_ogden_hits_the_closed_forms(mode, stretch, expected_MPa):
    assert nominal_stress(BODY, np.array([stretch]), mode)[0] == pytest.approx(expected_MPa, abs=6e-10)


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("name", INVARIANT_LAWS)
def test_laws_in_invariants_follow_the_textbook(name, mode):
    stress = nominal_stress(LAWS[name], STRETCHES, MODES[mode])
    expected = [textbook_stress(name, stretch, mode) for stretch in STRETCHES]
    np.testing.assert_allclose(stress, expected, rtol=1e-11)


@pytest.mark.parametrize("name", LAWS)
def test_small_strains_give_hookes_moduli(name):
    """E = 3G in tension, 6G in equibiaxial tension, 4G in the planar test of an incompressible solid."""
    law = LAWS[name]
    at_rest = np.array([1.0])
    for mode, modulus in ((UNIAXIAL, 3.0), (EQUIBIAXIAL, 6.0), (PLANAR, 4.0)):
        expected = modulus * law.shear_modulus_MPa
        assert nominal_stiffness(law, at_rest, mode)[0] == pytest.approx(expected, rel=1e-10)


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("name", LAWS)
def test_stress_and_tangent_of_the_elements_agree_with_the_curves(name, mode):
    """Stress and moduli as the elements assemble them, in a turned frame, against the closed forms."""
    log_stretch = MODES[mode].log_stretch(STRETCHES)
    first, second = LAWS[name].derivatives(log_stretch)
    turn, _ = np.linalg.qr(np.arange(9.0).reshape(3, 3) + np.eye(3) * [2.0, -1.0, 3.0])
    # one element, the stretches at its points
    directions = np.tile(turn, (1, len(STRETCHES), 1, 1))
    stress, moduli = np.empty((1, len(STRETCHES), 6)), np.empty((1, len(STRETCHES), 6, 6))
    element = np.array([0])
    principal_stress(element, directions, first[None], stress)
    principal_moduli(element, directions, log_stretch[None], first[None], second[None], moduli)
    stress, moduli = stress[0], moduli[0]
    pull, free = (np.outer(turn[:, axis], turn[:, axis]) for axis in (0, 2))
    kirchhoff = _dot(stress, _voigt(pull - free))
    expected = np.array([textbook_stress(name, stretch, mode) for stretch in STRETCHES])
    np.testing.assert_allclose(kirchhoff / STRETCHES, expected, rtol=1e-8)

    # d(τ₁ − τ₃)/d ln λ = (Lie derivative c : d) + 2 (d₁ τ₁ − d₃ τ₃), τ deviatoric
    rate = np.array(MODES[mode].direction)
    stretching = _voigt(turn @ np.diag(rate) @ turn.T)
    lie = np.einsum("a,nab,b->n", _double_shear(_voigt(pull - free)), moduli, _double_shear(stretching))
    slope = lie + 2.0 * (rate[0] * _dot(stress, _voigt(pull)) - rate[2] * _dot(stress, _voigt(free)))
    step = 1e-5
    ahead, behind = (
        np.array([textbook_stress(name, x * np.exp(sign * step), mode) for x in STRETCHES])
        * STRETCHES
        * np.exp(sign * step)
        for sign in (1.0, -1.0)
    )
    scale = np.abs(slope).max()
    np.testing.assert_allclose(slope, (ahead - behind) / (2.0 * step), atol=1e-8 * scale)


@pytest.mark.parametrize("name", LAWS)
def test_derivatives_are_those_of_the_energy(name):
    """Central differences reach 1e-8 of the modulus."""
    law = LAWS[name]
    log_stretch = np.array([[0.5, -0.3, -0.2], [-0.4, 0.2, 0.2], [0.6, 0.0, -0.6]])
    plane = np.array([[1.0, 0.0, -1.0], [0.0, 1.0, -1.0]])
    first, second = law.derivatives(log_stretch)
    step = 1e-5
    for along in plane:
        slope = (law.energy(log_stretch + step * along) - law.energy(log_stretch - step * along)) / (2 * step)
        np.testing.assert_allclose(first @ along, slope, atol=1e-8 * law.shear_modulus_MPa)
        ahead, behind = (law.derivatives(log_stretch + sign * step * along)[0] for sign in (1, -1))
        bend = (ahead - behind) @ plane.T / (2 * step)
        exact = np.einsum("i,nij,bj->nb", along, second, plane)
        np.testing.assert_allclose(exact, bend, atol=1e-8 * np.abs(exact).max())


@pytest.mark.parametrize("name", LAWS)
def test_no_energy_at_rest(name):
    assert LAWS[name].energy(np.zeros((1, 3)))[0] == pytest.approx(0.0, abs=1e-15)


def test_stiffness_is_the_slope_of_the_stress():
    step = 1e-6
    ahead, behind = (nominal_stress(BODY, STRETCHES + sign * step, PLANAR) for sign in (1, -1))
    np.testing.assert_allclose(
        nominal_stiffness(BODY, STRETCHES, PLANAR), (ahead - behind) / (2 * step), rtol=1e-7
    )


def test_gent_locks_where_the_invariant_reaches_its_limit():
    """I₁ − 3 = 5 in equibiaxial tension: 2x² + x⁻⁴ = 8; in uniaxial tension x² + 2/x = 8."""
    law = Gent(0.1, 5.0)
    for mode, coefficients in ((EQUIBIAXIAL, [2, 0, -8, 0, 0, 0, 1]), (UNIAXIAL, [1, 0, -8, 2])):
        roots = np.roots(coefficients)
        positive = np.sort(roots.real[(np.abs(roots.imag) < 1e-9) & (roots.real > 0)])
        assert locking_stretches(law, mode) == pytest.approx(tuple(positive), rel=1e-9)
    beyond = UNIAXIAL.log_stretch(np.array([3.0]))
    assert np.isinf(law.energy(beyond)[0])
    assert np.all(np.isnan(law.derivatives(beyond)[0]))


def test_composite_is_the_matrix_until_its_fibres_are_taut():
    matrix = NeoHooke(0.04)
    fibre = SlackFibre((0.0, 1.0, 0.0), modulus_MPa=10.0, slack_strain=0.3, transition_half_width=0.05)
    stretch = np.array([0.8, 1.1, 1.2, 1.5])
    matrix_alone = 0.04 * (stretch - stretch**-2.0)
    expected = matrix_alone + np.array([0.0, 0.0, 0.0, 10.0 * 0.2])
    np.testing.assert_allclose(fibre_composite_stress(matrix, fibre, stretch, UNIAXIAL), expected, rtol=1e-12)


def _voigt(tensor):
    """Six numbers in the kernels' order 11, 22, 33, 12, 23, 13."""
    return np.array([tensor[0, 0], tensor[1, 1], tensor[2, 2], tensor[0, 1], tensor[1, 2], tensor[0, 2]])


def _double_shear(six):
    return six * np.array([1, 1, 1, 2, 2, 2])


def _dot(stress, six):
    return stress @ _double_shear(six)
