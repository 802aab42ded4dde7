"""The comparison at equal pressures, on paths whose differences are known by hand."""

import numpy as np
import pytest

from spavision.correlate.discrepancy import compare, in_bending_axes
from spavision.errors import InputError

from .paths import make_path


def test_errors_are_modelled_minus_measured():
    discrepancy = compare(
        make_path([0, 5, 10], [0, 3, 6], [0, 1, 2]), make_path([0, 5, 10], [0, 6, 2], [0, 5, 2])
    )
    assert discrepancy.error_ux_mm == pytest.approx([0, 3, -4])
    assert discrepancy.error_uy_mm == pytest.approx([0, 4, 0])
    assert discrepancy.distance_mm == pytest.approx([0, 5, 4])
    assert discrepancy.largest == 1
    assert discrepancy.x.rmse_mm == pytest.approx(np.sqrt(25 / 3))
    assert discrepancy.x.nrmse == pytest.approx(np.sqrt(25 / 3) / 6)
    assert discrepancy.x.bias_mm == pytest.approx(-1 / 3)


def test_pressures_are_matched_whatever_their_order_and_never_interpolated():
    discrepancy = compare(
        make_path([10, 0, 7], [1, 0, 5], [1, 0, 5]), make_path([0, 5, 10], [0, 2, 4], [0, 0, 1])
    )
    assert discrepancy.pressure_kPa == pytest.approx([0, 7, 10])
    assert np.isnan(discrepancy.error_ux_mm[1])
    assert discrepancy.error_ux_mm[[0, 2]] == pytest.approx([0, 3])
    assert "not computed at this pressure" in discrepancy.remark(1)


def test_a_gap_in_the_measurement_keeps_its_row_and_its_reason():
    measured = make_path(
        [0, 5, 10],
        [0, np.nan, 2],
        [0, np.nan, 2],
        photo=("a", "b", "c"),
        status=("ok", "missing", "ok"),
        reason=("", "no marker found", ""),
    )
    discrepancy = compare(measured, make_path([0, 5, 10], [0, 1, 2], [0, 1, 2]))
    frame = discrepancy.table()
    assert len(frame) == 3
    assert np.isnan(frame["error_ux_mm"][1])
    assert frame["remark"][1] == "measured: missing (no marker found)"
    assert discrepancy.x.rmse_mm == pytest.approx(0.0)


def test_no_common_pressure_is_refused():
    with pytest.raises(InputError, match="share no pressure"):
        compare(make_path([0, 5], [0, 1], [0, 1]), make_path([1, 6], [0, 1], [0, 1]))


def test_a_first_bend_to_the_left_is_mirrored():
    path = make_path([0, 5], [0, -7], [0, 1])
    assert in_bending_axes(path, first_bend="left").ux_mm == pytest.approx([0, 7])
    assert in_bending_axes(path, first_bend="right") is path
