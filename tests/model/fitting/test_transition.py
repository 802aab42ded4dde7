"""The strain transition point by the article's procedure."""

import numpy as np
import pytest

from spavision.errors import InputError
from spavision.model.fitting.transition import Line, StrainTransition, strain_transition


def bilinear(strain, knee=0.388, primary=0.1, secondary=2.0):
    return primary * strain + (secondary - primary) * np.maximum(strain - knee, 0.0)


def test_knee_of_a_bilinear_curve_is_found_exactly():
    strain = np.linspace(0.0, 0.6, 61)
    found = strain_transition(strain, bilinear(strain), name="test")
    assert found.strain == pytest.approx(0.388, abs=1e-12)
    assert found.primary.modulus_MPa == pytest.approx(0.1)
    assert found.secondary.modulus_MPa == pytest.approx(2.0)
    assert found.stress_MPa == pytest.approx(0.0388)


def test_lines_come_from_the_first_tenth_and_the_last_ten_points():
    """A smooth curve y = x²: worked out by hand from the two regressions."""
    strain = np.linspace(0.0, 1.0, 101)
    found = strain_transition(strain, strain**2, name="test")
    # regression of x² on equally spaced x in [a, b] has the slope a + b
    assert found.primary.modulus_MPa == pytest.approx(0.10)
    assert found.secondary.modulus_MPa == pytest.approx(0.91 + 1.0)
    # intercept: mean of x² less slope times mean of x; variance of n points h apart is h²(n² − 1)/12
    first = 0.05**2 + 1e-4 * 120 / 12 - 0.10 * 0.05
    last = 0.955**2 + 1e-4 * 99 / 12 - 1.91 * 0.955
    assert found.strain == pytest.approx((first - last) / (1.91 - 0.10))


def test_error_is_the_articles():
    """39.9 % for the Ogden law against 38.8 % measured is an error of 2.84 %, to the article's rounding."""
    line = Line(0.1, 0.0)
    measured, fitted = (StrainTransition(strain, line, line) for strain in (0.388, 0.399))
    assert measured.relative_error_of(fitted) == pytest.approx(0.0284, abs=5e-5)


@pytest.mark.parametrize(
    ("strain", "sentence"),
    [
        (np.linspace(0.0, 1.0, 12), "2 points lie below 10%"),
        (np.linspace(0.0, 0.15, 15), "reach into the first 10%"),
        (np.linspace(0.0, 0.6, 61), "the modulus falls"),
    ],
)
def test_curves_without_a_transition_are_told(strain, sentence):
    with pytest.raises(InputError, match=sentence):
        strain_transition(strain, bilinear(strain, primary=1.0, secondary=0.1, knee=0.2), name="test")


def test_lines_that_meet_outside_the_test_are_no_transition():
    """0.5·x below 10 %, then a plateau ten times as high and 1·x on top: the lines meet at −9."""
    strain = np.linspace(0.0, 1.0, 101)
    stress = np.where(strain < 0.5, 0.5 * strain, 4.5 + strain)
    with pytest.raises(InputError, match="outside the test"):
        strain_transition(strain, stress, name="test")
