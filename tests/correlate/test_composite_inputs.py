"""The composite of an experiment: stated, calibrated to a curve, or by a virtual coupon."""

import numpy as np
import pytest

from spavision.correlate.model_inputs import model_inputs
from spavision.errors import InputError
from spavision.experiment import Experiment
from spavision.model.coupon.geometry import CouponGeometry
from spavision.model.materials.curves import UNIAXIAL, nominal_stress
from spavision.model.materials.library import find_material

STRAIN = np.linspace(0.0, 0.6, 121)


@pytest.fixture
def tension_test(tmp_path):
    """Ecoflex 1.5 times as stiff, and paper of 8 MPa that is taut from 40 % strain on."""
    matrix = 1.5 * nominal_stress(find_material("Ecoflex 00-30").law, 1.0 + STRAIN, UNIAXIAL)
    stress = matrix + 8.0 * np.maximum(STRAIN - 0.4, 0.0)
    path = tmp_path / "tension.csv"
    rows = [f"{a:.6f},{b:.9f}" for a, b in zip(STRAIN, stress, strict=True)]
    path.write_text("\n".join(["strain,nominal_stress_MPa", *rows]) + "\n", encoding="utf-8")
    return str(path)


def inputs(**composite):
    return model_inputs(Experiment.model_validate({"actuator": {"crimp_ratio": 0.3}, "composite": composite}))


def test_stated_paper_is_kept():
    found = inputs(paper_length_modulus_MPa=7.0)
    assert found.settings.paper.length_modulus_MPa == 7.0
    assert found.notes == ()


def test_a_curve_calibrates_the_slack_fibre(tension_test):
    """Known slack strain, stiffness and matrix; the secant of the curved matrix costs some per cent."""
    settings = inputs(curve=tension_test).settings
    assert settings.paper.slack_strain(0.3) == pytest.approx(0.4, rel=0.02)
    assert settings.paper.length_modulus_MPa == pytest.approx(8.0, rel=0.02)
    assert settings.matrix_stiffness == pytest.approx(1.5, rel=0.01)
    assert settings.composite is None


def test_a_primary_modulus_beyond_belief_is_told(tmp_path):
    """Ecoflex 30 times as stiff below the knee: ten times is what is taken."""
    matrix = 30.0 * nominal_stress(find_material("Ecoflex 00-30").law, 1.0 + STRAIN, UNIAXIAL)
    rows = [
        f"{a:.6f},{b:.9f}" for a, b in zip(STRAIN, matrix + 80.0 * np.maximum(STRAIN - 0.4, 0), strict=True)
    ]
    path = tmp_path / "tension.csv"
    path.write_text("\n".join(["strain,nominal_stress_MPa", *rows]) + "\n", encoding="utf-8")
    found = inputs(curve=str(path))
    assert found.settings.matrix_stiffness == 10.0
    assert any("30 times the matrix's own" in note for note in found.notes)


def test_a_curve_calibrates_one_ogden_law(tension_test):
    found = inputs(law="ogden", curve=tension_test)
    law = found.settings.composite.law
    fitted = nominal_stress(law, 1.0 + STRAIN, UNIAXIAL)
    assert np.all(np.diff(fitted) > 0.0)
    assert any("R²" in note and "transition" in note for note in found.notes)
    assert any("tension test, by the file's name" in note for note in found.notes)
    assert found.settings.composite.strain_range == pytest.approx((0.0, 0.6))


def test_without_a_curve_a_coupon_is_pulled():
    """Bonded paper stiffens the matrix, and is taut before its wave, blunted at the folds, is straight."""
    settings = inputs(law="resolved", coupon_fold_radius_mm=0.5).settings
    straight = CouponGeometry(0.3, fold_radius_mm=0.5).straight_strain
    assert 0.8 * straight < settings.paper.slack_strain(0.3) < straight
    assert settings.matrix_stiffness > 1.0


def test_what_contradicts_itself_is_refused(tension_test):
    with pytest.raises(ValueError, match="leave the key curve out"):
        inputs(law="resolved", curve=tension_test)
    with pytest.raises(InputError, match="cannot be read"):
        inputs(law="ogden", curve="none.csv")


def test_a_curve_without_transition_is_refused(tmp_path):
    path = tmp_path / "tension.csv"
    rows = [f"{a},{0.1 * a}" for a in STRAIN]
    path.write_text("\n".join(["strain,nominal_stress_MPa", *rows]), encoding="utf-8")
    with pytest.raises(InputError, match="no transition"):
        inputs(curve=str(path))


def test_paper_straight_within_the_primary_modulus_s_strain_is_told():
    """At crimp ratio 0.1 the paper is straight before 8 %, so that the first 10 % hold no slack part."""
    experiment = Experiment.model_validate(
        {"actuator": {"crimp_ratio": 0.1}, "composite": {"law": "resolved"}}
    )
    with pytest.raises(InputError, match="choose slack-fibre or ogden"):
        model_inputs(experiment)
