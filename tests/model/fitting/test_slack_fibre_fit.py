"""The slack-fibre composite recovered from curves of known parameters."""

import numpy as np
import pytest

from spavision.errors import InputError
from spavision.model.fitting.measured_curve import MeasuredCurve
from spavision.model.fitting.slack_fibre_fit import fit_slack_fibre, slack_fibre_at_transition
from spavision.model.materials.curves import PLANAR, UNIAXIAL, fibre_composite_stress, nominal_stress
from spavision.model.materials.library import find_material
from spavision.model.materials.slack_fibre import SlackFibre

MATRIX = find_material("Ecoflex 00-30").law
FIBRE = SlackFibre((0.0, 1.0, 0.0), modulus_MPa=8.0, slack_strain=0.39, transition_half_width=0.06)


def composite(*, mode=UNIAXIAL, end=0.6, noise=0.0, seed=0, fibre=FIBRE):
    stretch = np.linspace(1.0, 1.0 + end, 90)
    stress = fibre_composite_stress(MATRIX, fibre, stretch, mode)
    scatter = np.random.default_rng(seed).normal(0.0, noise, len(stretch))
    return MeasuredCurve("composite", mode, stretch, stress + scatter)


@pytest.mark.parametrize("mode", [UNIAXIAL, PLANAR])
def test_parameters_are_recovered(mode):
    fit = fit_slack_fibre([composite(mode=mode)], MATRIX)
    assert fit.values == pytest.approx((0.39, 8.0, 0.06), rel=1e-5)
    assert fit.goodness.r_squared > 1.0 - 1e-9
    assert not fit.is_at_end


def test_standard_errors_are_the_scatter_of_the_parameters():
    normed = []
    for seed in range(25):
        fit = fit_slack_fibre([composite(noise=0.02, seed=seed)], MATRIX)
        normed.append((np.array(fit.values) - (0.39, 8.0, 0.06)) / fit.standard_errors)
    rms = np.sqrt(np.mean(np.square(normed), axis=0))
    assert np.all((rms > 0.55) & (rms < 1.5)), rms


def test_at_the_transition_the_article_s_point_is_met():
    """A sharp knee: the transition is the slack strain, the secondary modulus the fibre's and matrix's."""
    sharp = SlackFibre((0.0, 1.0, 0.0), 8.0, 0.39, 0.01)
    fit = slack_fibre_at_transition(composite(fibre=sharp), MATRIX)
    assert fit.fibre.slack_strain == pytest.approx(0.39, rel=0.01)
    assert fit.fibre.modulus_MPa == pytest.approx(8.0, rel=0.01)
    assert fit.goodness.r_squared > 0.999


def test_a_test_that_ends_too_early_is_told():
    assert fit_slack_fibre([composite(end=0.37)], MATRIX).is_at_end
    with pytest.raises(InputError, match="too few"):
        fit_slack_fibre([MeasuredCurve("two", UNIAXIAL, np.array([1.0, 1.1]), np.array([0.0, 0.1]))], MATRIX)


def test_a_curve_of_the_matrix_alone_has_no_fibre():
    stretch = np.linspace(1.0, 1.5, 40)
    soft = MeasuredCurve("soft", UNIAXIAL, stretch, 0.5 * nominal_stress(MATRIX, stretch, UNIAXIAL))
    with pytest.raises(InputError, match="never rises above"):
        fit_slack_fibre([soft], MATRIX)
