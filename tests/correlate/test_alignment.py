"""Pressure error against shape error: corrections put in must come out."""

import numpy as np
import pytest

from spavision.correlate.alignment import best_scale, best_shift

from .paths import make_path

PRESSURE = np.arange(0, 70, 5.0)


def tip(pressure):
    return 30 * np.sin(pressure / 18), 0.004 * pressure**2


def test_a_known_shift_is_found():
    alignment = best_shift(make_path(PRESSURE, *tip(PRESSURE + 6.0)), make_path(PRESSURE, *tip(PRESSURE)))
    assert alignment.value == pytest.approx(6.0, abs=0.1)
    assert alignment.explained > 0.99


def test_a_known_scale_is_found():
    alignment = best_scale(make_path(PRESSURE, *tip(PRESSURE * 0.8)), make_path(PRESSURE, *tip(PRESSURE)))
    assert alignment.value == pytest.approx(0.8, abs=0.005)
    assert alignment.explained > 0.99


def test_a_shape_error_is_not_called_a_pressure_error():
    ux, uy = tip(PRESSURE)
    aside = make_path(PRESSURE, ux, uy + 25.0)
    assert best_shift(aside, make_path(PRESSURE, ux, uy)).explained < 0.3


def test_too_few_readings_align_with_nothing():
    assert best_shift(make_path([0, 5], [0, 1], [0, 1]), make_path(PRESSURE, *tip(PRESSURE))) is None
