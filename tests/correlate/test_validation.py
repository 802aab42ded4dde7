"""Error against validation uncertainty, with numbers summed by hand."""

import numpy as np
import pytest

from spavision.correlate.discrepancy import compare
from spavision.correlate.summary import summarise
from spavision.correlate.validation import ModelUncertainty, validate

from .paths import make_path


@pytest.fixture
def discrepancy():
    """Errors in x of 0, 0.05 and 1 mm; the measurement's sigma is 0.02 mm."""
    return compare(
        make_path([0, 5, 10], [0, 3, 6], [0, 0, 0]), make_path([0, 5, 10], [0, 3.05, 7], [0, 0, 0])
    )


def test_parts_add_in_squares(discrepancy):
    model = ModelUncertainty(mesh_x_mm=np.full(3, 0.03), inputs_x_mm=np.full(3, 0.06))
    x, _ = validate(discrepancy, model)
    assert x.u_val_mm == pytest.approx(np.full(3, 0.07))  # 0.02, 0.03, 0.06
    assert x.left_out == ()
    assert x.is_significant.tolist() == [False, False, True]


def test_without_the_model_s_parts_the_verdict_is_called_a_lower_bound(discrepancy):
    x, _ = validate(discrepancy, ModelUncertainty())
    assert x.u_val_mm == pytest.approx(np.full(3, 0.02))
    assert x.left_out == ("mesh", "inputs")
    assert x.is_significant.tolist() == [False, True, True]
    verdict = next(sentence for sentence in summarise(discrepancy).sentences() if "V&V 20" in sentence)
    assert "mesh and inputs not estimated" in verdict
    assert "at 2 in x and 0 in y of 3 pressures" in verdict


def test_part_that_is_known_up_to_a_pressure_is_named(discrepancy):
    """Beyond it the other parts stand alone: 1 mm against twice √(0.02² + 0.03²)."""
    model = ModelUncertainty(mesh_x_mm=np.full(3, 0.03), inputs_x_mm=np.array([0.06, 0.06, np.nan]))
    x, _ = validate(discrepancy, model)
    assert x.u_val_mm == pytest.approx([0.07, 0.07, np.hypot(0.02, 0.03)])
    assert (x.left_out, x.left_out_in_part) == ((), ("inputs",))
    assert x.is_significant.tolist() == [False, False, True]
    verdict = next(one for one in summarise(discrepancy, model).sentences() if "V&V 20" in one)
    assert "(inputs not estimated at every pressure, so it is a lower bound)" in verdict
