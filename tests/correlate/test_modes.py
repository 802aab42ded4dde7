"""Extremum and reversal, on a parabola whose vertex is known."""

import numpy as np
import pytest

from spavision.correlate.modes import find_modes

from .paths import make_path


def test_vertex_of_a_parabola_is_found_between_the_readings():
    pressure = np.arange(0, 70, 5.0)
    modes = find_modes(make_path(pressure, 40 - 0.05 * (pressure - 27) ** 2, 0 * pressure))
    assert modes.first_extremum_kPa == pytest.approx(27.0)
    assert modes.first_extremum_mm == pytest.approx(40.0)
    assert modes.reverses
    assert modes.second_extreme_mm == pytest.approx(40 - 0.05 * 38**2)
    assert modes.sigma_extremum_kPa == pytest.approx(5 / np.sqrt(12))


def test_zero_crossing_is_interpolated():
    modes = find_modes(make_path([0, 10, 20, 30], [0, 20, 10, -10], [0, 0, 0, 0]))
    assert modes.crosses_zero_kPa == pytest.approx(25.0)


def test_a_path_that_never_turns_says_so():
    modes = find_modes(make_path([0, 10, 20], [0, 5, 9], [0, 0, 0]))
    assert not modes.reverses
    assert np.isnan(modes.crosses_zero_kPa)
    assert modes.first_extremum_kPa == 20


def test_gaps_are_passed_over():
    modes = find_modes(make_path([0, 10, 20, 30], [0, np.nan, 9, 3], [0, np.nan, 0, 0]))
    assert modes.first_extremum_kPa == pytest.approx(20, abs=8)
    assert modes.reverses
