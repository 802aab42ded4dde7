"""The article's comparison of laws on a bilinear curve; its data are not public: the order is asked."""

import numpy as np
import pytest

from spavision.model.composite import PaperLayer
from spavision.model.fitting.fit import fit_law
from spavision.model.fitting.measured_curve import MeasuredCurve
from spavision.model.fitting.transition import strain_transition
from spavision.model.materials.curves import UNIAXIAL, fibre_composite_stress
from spavision.model.materials.library import find_material
from spavision.model.materials.slack_fibre import SlackFibre


@pytest.fixture(scope="module")
def bilinear_curve():
    """Ecoflex matrix and paper taut from 38.8 % strain (the article's transition at 0.3), pulled to 45 %."""
    slack = PaperLayer().slack_strain(0.3)
    fibre = SlackFibre((0.0, 1.0, 0.0), modulus_MPa=10.0, slack_strain=slack, transition_half_width=0.04)
    stretch = np.linspace(1.0, 1.45, 46)
    stress = fibre_composite_stress(find_material("Ecoflex 00-30").law, fibre, stretch, UNIAXIAL)
    return MeasuredCurve("bilinear", UNIAXIAL, stretch, stress)


def test_order_of_merit_is_the_articles(bilinear_curve):
    """Article: R² 0.779 (Ogden), 0.757 (Gent), 0.713 (Yeoh), 0.592 (Mooney-Rivlin)."""
    scores = [
        fit_law(law, [bilinear_curve]).goodness.r_squared for law in ("ogden3", "gent", "yeoh", "mooney3")
    ]
    assert scores == sorted(scores, reverse=True)


def test_ogden_predicts_the_transition_within_some_percent(bilinear_curve):
    """Article: 2.84 %; here the shape of the knee is assumed, so twice that is allowed."""
    curve = bilinear_curve
    measured = strain_transition(curve.strain, curve.stress_MPa, name="bilinear")
    fit = fit_law("ogden3", [curve])
    fitted = strain_transition(curve.strain, fit.stress_of(curve), name="Ogden")
    assert measured.relative_error_of(fitted) < 2 * 0.0284
