"""What the gauge shows and the pressure behind it; the model runs at the latter, whoever asks."""

import numpy as np
import pytest

from spavision.correlate.gauge import read_pressure_kPa, true_pressure_kPa
from spavision.correlate.study.case import Case
from spavision.correlate.study.evaluate import evaluate
from spavision.errors import InputError
from spavision.experiment import Experiment, GaugeSection

GAUGE = GaugeSection(pressure_scale=1.25, pressure_offset_kPa=-2.0)


def test_true_pressure_is_scale_times_reading_plus_offset_and_zero_at_rest():
    readings = np.array([0.0, 10.0, 40.0])
    assert true_pressure_kPa(readings, GAUGE).tolist() == [0.0, 10.5, 48.0]
    assert read_pressure_kPa(np.array([0.0, 10.5, 48.0]), GAUGE) == pytest.approx(readings)


def test_reading_that_would_be_below_rest_is_refused():
    with pytest.raises(InputError, match=r"pressure_offset_kPa is -2: the reading of 1 kPa would be -0\.75"):
        true_pressure_kPa(np.array([0.0, 1.0, 5.0]), GAUGE)


def test_case_of_a_gauge_that_shows_half_is_the_case_at_twice_the_pressures():
    nominal = Experiment().with_options({"actuator": {"crimp_ratio": 0.2}})
    half = nominal.with_options({"gauge": {"pressure_scale": 2.0}})
    at_readings = evaluate(Case("reduced", half, (0.0, 2.5, 5.0)))
    at_truth = evaluate(Case("reduced", nominal, (0.0, 5.0, 10.0)))
    assert at_readings.ux_mm == at_truth.ux_mm
    assert at_truth.ux_mm[2] > 2.0 * at_truth.ux_mm[1] > 0.0
