"""Pressures from names, tables and steps; each ambiguity refused with the names listed."""

import numpy as np
import pandas as pd
import pytest

from spavision.errors import InputError, InputWarning
from spavision.vision.pressures import (
    pressures_from_list,
    pressures_from_names,
    pressures_from_step,
    pressures_from_table,
)


@pytest.mark.parametrize(
    ("name", "expected_kPa"),
    [
        ("IMG_0003_010kPa.jpg", 10.0),
        ("5kPa.png", 5.0),
        ("p005.jpg", 5.0),
        ("P_12.5.tif", 12.5),
        ("run2_p40.jpeg", 40.0),
        ("0.05bar.jpg", 5.0),
        ("0,05bar.jpg", 5.0),
        ("65 kPa.JPG", 65.0),
        ("crimp0.3_7.5_kpa.png", 7.5),
        ("test-50mbar-2.png", 5.0),
        ("1.5psi.jpg", 10.3421355),
        ("25000Pa.tiff", 25.0),
        ("2024-05-17_IMG0012_30kPa.jpg", 30.0),
        ("20kPa_copy_of_20kPa.jpg", 20.0),
    ],
)
def test_a_pressure_is_read_from_its_name(name, expected_kPa):
    assert pressures_from_names([name]) == pytest.approx([expected_kPa])


@pytest.mark.parametrize(
    "names",
    [
        ["IMG_0001.jpg"],
        ["005.jpg"],
        ["tip12.jpg"],
        ["10kPa_to_20kPa.jpg"],
        ["0p5kPa.jpg"],
        ["p1_5.jpg"],
        ["p0-5.jpg"],
        ["p5_p10.jpg"],
        ["5kPa.jpg", "photo_b.jpg"],
        ["5kPa.jpg", "p010.jpg"],
    ],
)
def test_a_name_that_does_not_tell_is_refused_and_listed(names):
    with pytest.raises(InputError) as refusal:
        pressures_from_names(names)
    assert names[-1] in str(refusal.value)
    assert "--pressures" in str(refusal.value)


def test_two_photos_of_one_pressure_are_refused():
    with pytest.raises(InputError, match=r"a_5kPa\.jpg, b_5kPa\.jpg all claim 5 kPa"):
        pressures_from_names(["a_5kPa.jpg", "b_5kPa.jpg"])


def test_the_table_is_looked_up_by_name():
    table = pd.DataFrame({"photo": ["b.jpg", "a.jpg"], "pressure_kPa": [5, 0]})
    assert list(pressures_from_table(table, ["a.jpg", "b.jpg"])) == [0.0, 5.0]


def test_a_row_without_its_photo_warns():
    table = pd.DataFrame({"photo": ["a.jpg", "b.jpg"], "pressure_kPa": [0, 5]})
    with pytest.warns(InputWarning, match=r"b\.jpg"):
        pressures_from_table(table, ["a.jpg"])


@pytest.mark.parametrize(
    ("columns", "message"),
    [
        ({"photo": ["a.jpg"], "kPa": [0]}, "lacks the column pressure_kPa"),
        ({"photo": ["a.jpg"], "pressure_kPa": ["zero"]}, "'zero'"),
        ({"photo": ["a.jpg"], "pressure_kPa": [np.nan]}, "empty"),
        ({"photo": ["b.jpg"], "pressure_kPa": [0]}, r"no row for a\.jpg"),
        ({"photo": ["a.jpg", "a.jpg"], "pressure_kPa": [0, 5]}, "twice"),
    ],
)
def test_a_bad_table_is_refused(columns, message):
    with pytest.raises(InputError, match=message):
        pressures_from_table(pd.DataFrame(columns), ["a.jpg"])


def test_a_step_counts_along_the_natural_order():
    assert list(pressures_from_step(["p11.jpg", "p10.jpg", "p9.jpg"], 5.0)) == [10.0, 5.0, 0.0]


@pytest.mark.parametrize("step_kPa", [0.0, -5.0, float("nan")])
def test_a_step_must_be_positive(step_kPa):
    with pytest.raises(InputError, match="--pressure-step-kpa"):
        pressures_from_step(["a.jpg"], step_kPa)


def test_a_list_is_laid_over_the_natural_order_when_its_length_fits():
    names = ["a10.jpg", "a9.jpg", "a11.jpg"]
    np.testing.assert_array_equal(pressures_from_list(names, [0, 5, 20]), [5, 0, 20])
    with pytest.raises(InputError, match="gives 2 pressures, but there are 3 photos"):
        pressures_from_list(names, [0, 5])


@pytest.mark.parametrize("more", [[], ["IMG_0007.jpg"]])
def test_a_step_is_refused_where_the_counter_skips(more):
    names = ["IMG_0003.jpg", "IMG_0004.jpg", "IMG_0006.jpg", *more]
    with pytest.raises(InputError, match=r"skips from IMG_0004\.jpg to IMG_0006\.jpg"):
        pressures_from_step(names, 5.0)


@pytest.mark.parametrize(
    "names",
    [
        ["a5.jpg", "a10.jpg", "a15.jpg"],
        ["20240501_101502.jpg", "20240501_101533.jpg", "20240501_101604.jpg"],
        ["first.jpg", "second.jpg"],
    ],
)
def test_a_step_serves_where_no_counter_skips(names):
    np.testing.assert_array_equal(np.sort(pressures_from_step(names, 5.0)), 5.0 * np.arange(len(names)))
