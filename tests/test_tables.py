"""Reading users' tables: what is taken, and how each defect is told."""

import numpy as np
import pytest

from spavision.errors import InputError
from spavision.tables import read_tip_path

GOOD = "pressure_kPa,ux_mm,uy_mm\n0,0,0\n5,1.5,0.2\n10,3,0.5\n"


def write(folder, text, encoding="utf-8"):
    path = folder / "measured.csv"
    path.write_bytes(text.encode(encoding))
    return path


def test_columns_become_a_path_in_order_of_pressure(tmp_path):
    path = read_tip_path(write(tmp_path, "uy_mm,pressure_kPa,ux_mm\n0.5,10,3\n0,0,0\n"))
    assert path.pressure_kPa == pytest.approx([0, 10])
    assert path.ux_mm == pytest.approx([0, 3])
    assert path.uy_mm == pytest.approx([0, 0.5])
    assert np.all(np.isnan(path.sigma_ux_mm))


def test_a_byte_order_mark_and_windows_lines_do_no_harm(tmp_path):
    path = read_tip_path(write(tmp_path, GOOD.replace("\n", "\r\n"), encoding="utf-8-sig"))
    assert path.ux_mm == pytest.approx([0, 1.5, 3])


def test_an_empty_displacement_is_a_missing_reading(tmp_path):
    path = read_tip_path(write(tmp_path, GOOD + "15,,\n"))
    assert path.has_reading.tolist() == [True, True, True, False]


@pytest.mark.parametrize(("unit", "factor"), [("bar", 100.0), ("MPa", 1000.0), ("psi", 6.894757)])
def test_other_pressure_units(tmp_path, unit, factor):
    path = read_tip_path(
        write(tmp_path, f"pressure_{unit},ux_mm,uy_mm\n0,0,0\n0.5,1,1\n"), pressure_unit=unit
    )
    assert path.pressure_kPa[1] == pytest.approx(0.5 * factor)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("pressure_kPa,ux_mm\n0,0\n", "column uy_mm is missing"),
        ("p,ux_mm,uy_mm\n0,0,0\n", "column pressure_kPa is missing"),
        (GOOD.replace("1.5", "about 2"), "'about 2', expected a number"),
        (GOOD + "5,2,2\n", "5 kPa stands 2 times"),
        (GOOD.replace(",", ";"), "separated by semicolons"),
        (GOOD + "15,1\n", "row 5 has 2 cells"),
        (GOOD.replace("10,", "-10,"), "gauge pressures of 0 or more"),
        (GOOD.replace("10,", "inf,"), "'inf', expected a number"),
        ("", "is empty"),
        ("pressure_kPa,ux_mm,uy_mm\n", "header line only"),
        ("ux_mm,ux_mm,pressure_kPa,uy_mm\n0,0,0,0\n", "stands twice"),
    ],
)
def test_each_defect_is_told_in_one_sentence_that_names_the_file(tmp_path, text, said):
    with pytest.raises(InputError, match=r"measured\.csv") as caught:
        read_tip_path(write(tmp_path, text))
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_missing_or_binary_file_is_told(tmp_path):
    with pytest.raises(InputError, match="cannot be read"):
        read_tip_path(tmp_path / "nowhere.csv")
    with pytest.raises(InputError, match="not UTF-8"):
        read_tip_path(write(tmp_path, GOOD, encoding="utf-16"))
