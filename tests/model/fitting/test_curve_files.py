"""Reading test data: formats, units, measures, and what is wrong with files."""

import numpy as np
import pytest

from spavision.errors import InputError
from spavision.model.fitting.curve_files import CurveFormat, read_curve
from spavision.model.fitting.measured_curve import in_window

from .curves import shared_data, treloar

STRAIN = np.linspace(0.0, 2.0, 21)
STRESS_MPa = 0.1 * ((1 + STRAIN) - (1 + STRAIN) ** -2)


def write(path, text):
    path.write_text(text, encoding="utf-8")
    return path


def rows(*columns, separator=","):
    lines = (separator.join(f"{cell:.12g}" for cell in row) for row in zip(*columns, strict=True))
    return "\n".join(lines) + "\n"


STRETCH = 1.0 + STRAIN
WRITTEN = {
    "nominal, MPa": "strain,stress_MPa\n" + rows(STRAIN, STRESS_MPa),
    "kilopascals": "Engineering strain,Engineering stress (kPa)\n" + rows(STRAIN, 1e3 * STRESS_MPa),
    "pascals": "strain,nominal stress [Pa]\n" + rows(STRAIN, 1e6 * STRESS_MPa),
    "percent": "Strain (%);Stress (N/mm²)\n" + rows(100 * STRAIN, STRESS_MPa, separator=";"),
    "stretch": "stretch\tnominal_stress_MPa\n" + rows(STRETCH, STRESS_MPa, separator="\t"),
    "true": "True Strain,True Stress (MPa)\n" + rows(np.log(STRETCH), STRESS_MPa * STRETCH),
    "true stress, stretch": "lambda,Cauchy stress kPa\n" + rows(STRETCH, 1e3 * STRESS_MPa * STRETCH),
    "both": "True Stress (MPa),Strain,Stress (MPa)\n" + rows(STRESS_MPa * STRETCH, STRAIN, STRESS_MPa),
    "decimal comma": "Dehnung;strain;stress_MPa\n"
    + rows(STRAIN, STRAIN, STRESS_MPa, separator=";").replace(".", ","),
    "units below names": "Strain,Stress\n(%),(kPa)\n" + rows(100 * STRAIN, 1e3 * STRESS_MPa),
    "preamble": "Machine;X\nDate;2021\n;;\nTime (s);Strain;Stress (MPa)\n"
    + rows(STRAIN, STRAIN, STRESS_MPa, separator=";"),
    "comments, BOM": "\ufeff# measured by hand, 12 of 13\nstrain, stress_MPa\n" + rows(STRAIN, STRESS_MPa),
    "bar": "strain,stress (bar)\n" + rows(STRAIN, 10 * STRESS_MPa),
    "per square metre": "strain,stress (N/m²)\n" + rows(STRAIN, 1e6 * STRESS_MPa),
    "falling": "strain,stress_MPa\n" + rows(STRAIN[::-1], STRESS_MPa[::-1]),
}


@pytest.mark.parametrize("text", WRITTEN.values(), ids=WRITTEN)
def test_one_curve_written_in_many_ways_reads_the_same(tmp_path, text):
    curve = read_curve(write(tmp_path / "tension.csv", text))
    np.testing.assert_allclose(curve.stretch, STRETCH, rtol=1e-9)
    np.testing.assert_allclose(curve.stress_MPa, STRESS_MPa, rtol=1e-9, atol=1e-12)
    assert curve.mode.name == "uniaxial"


def test_a_machine_s_utf_16_file_reads(tmp_path):
    file = tmp_path / "tension.csv"
    file.write_text("strain;stress_MPa\n" + rows(STRAIN, STRESS_MPa, separator=";"), encoding="utf-16")
    np.testing.assert_allclose(read_curve(file).stress_MPa, STRESS_MPa, rtol=1e-9, atol=1e-12)


def test_a_large_strain_without_a_unit_is_told(tmp_path):
    text = rows(10 * STRAIN, STRESS_MPa)
    notes = {
        header: " | ".join(read_curve(write(tmp_path / "a.csv", f"{header},stress_MPa\n{text}")).notes)
        for header in ("strain", "strain %")
    }
    assert "up to 2000 %: --strain-unit percent" in notes["strain"]
    assert "--strain-unit" not in notes["strain %"]


def test_options_go_before_what_the_file_says(tmp_path):
    file = write(tmp_path / "a.txt", rows(100 * STRAIN, 1e3 * STRESS_MPa * STRETCH, STRAIN, separator=" "))
    form = CurveFormat(
        mode="planar",
        columns=("strain", "stress", "-"),
        strain_unit="percent",
        stress_unit="kPa",
        stress_measure="true",
    )
    curve = read_curve(file, form)
    np.testing.assert_allclose(curve.stress_MPa, STRESS_MPa, rtol=1e-9, atol=1e-12)
    assert curve.mode.name == "planar"


def test_assumptions_are_told(tmp_path):
    curve = read_curve(write(tmp_path / "a.csv", "strain,stress\n" + rows(STRAIN, STRESS_MPa)))
    told = " | ".join(curve.notes)
    for word in ("uniaxial test assumed", "engineering strain", "nominal stress", "MPa"):
        assert word in told


@pytest.mark.parametrize(
    ("name", "mode"),
    [("equi-biaxial_2.csv", "equibiaxial"), ("pure_shear.csv", "planar"), ("ISO_37.csv", "uniaxial")],
)
def test_mode_is_recognised_from_the_name(tmp_path, name, mode):
    text = "strain,stress_MPa\n" + rows(STRAIN, STRESS_MPa)
    assert read_curve(write(tmp_path / name, text)).mode.name == mode


def test_first_loading_of_a_loop_is_taken_and_told(tmp_path):
    loop = np.concatenate([STRAIN, STRAIN[::-1], STRAIN])
    stress = np.concatenate([STRESS_MPa, 0.8 * STRESS_MPa[::-1], 0.9 * STRESS_MPa])
    curve = read_curve(write(tmp_path / "tension.csv", "strain,stress_MPa\n" + rows(loop, stress)))
    np.testing.assert_allclose(curve.stress_MPa, STRESS_MPa, rtol=1e-9, atol=1e-12)
    assert any("first loading" in note for note in curve.notes)


def test_noise_in_strain_is_no_unloading(tmp_path):
    fine = np.linspace(0.0, 2.0, 400) + 0.003 * (-1.0) ** np.arange(400)
    stress = 0.1 * fine
    curve = read_curve(write(tmp_path / "tension.csv", "strain,stress_MPa\n" + rows(fine, stress)))
    assert len(curve) == 400


def test_offsets_at_zero_are_shifted_and_told(tmp_path):
    header = "strain,stress_MPa\n"
    preload = read_curve(write(tmp_path / "a.csv", header + rows(STRAIN, STRESS_MPa + 0.01)))
    np.testing.assert_allclose(preload.stress_MPa, STRESS_MPa, atol=1e-12)
    assert any("10 kPa at zero strain" in note for note in preload.notes)
    strain = np.concatenate([[-1e-5], STRAIN[1:]])
    noisy = read_curve(write(tmp_path / "c.csv", header + rows(strain, STRESS_MPa + 0.01)))
    np.testing.assert_allclose(noisy.stress_MPa, STRESS_MPa, atol=1e-12)
    slack = read_curve(write(tmp_path / "b.csv", header + rows(STRAIN + 0.05, STRESS_MPa)))
    np.testing.assert_allclose(slack.stretch, (STRETCH + 0.05) / 1.05, rtol=1e-9)
    assert any("5 % at zero stress" in note for note in slack.notes)


@pytest.mark.parametrize(("strain_sign", "stress_sign"), [(1, 1), (-1, 1), (1, -1), (-1, -1)])
def test_compression_with_any_sign_reads_the_same(tmp_path, strain_sign, stress_sign):
    strain = np.linspace(0.0, -0.4, 11)
    stress = 0.1 * ((1 + strain) - (1 + strain) ** -2)
    text = "strain,stress_MPa\n" + rows(-strain_sign * strain, -stress_sign * stress)
    curve = read_curve(write(tmp_path / "compression.csv", text))
    np.testing.assert_allclose(curve.stretch, 1 + strain, rtol=1e-9)
    np.testing.assert_allclose(curve.stress_MPa, stress, rtol=1e-9, atol=1e-12)


def test_compression_told_by_the_columns_alone(tmp_path):
    (tmp_path / "data").mkdir()
    text = "compressive strain,compressive stress MPa\n0,0\n0.1,0.05\n0.2,0.12\n"
    np.testing.assert_allclose(
        read_curve(write(tmp_path / "data" / "a.csv", text)).strain, [0, -0.1, -0.2], atol=1e-12
    )


def test_true_measures_in_compression_with_positive_sign(tmp_path):
    stretch = np.linspace(1.0, 0.5, 11)
    nominal = 0.1 * (stretch - stretch**-2)
    text = "true strain,true stress MPa\n" + rows(-np.log(stretch), -nominal * stretch)
    curve = read_curve(write(tmp_path / "a.csv", text), CurveFormat(mode="compression"))
    np.testing.assert_allclose(curve.stretch, stretch, rtol=1e-9)
    np.testing.assert_allclose(curve.stress_MPa, nominal, rtol=1e-9, atol=1e-12)


def test_positive_strains_that_nothing_names_are_doubted_by_the_shape(tmp_path):
    """Mooney-Rivlin in compression, 2 (C₁₀ + C₀₁/λ)(λ − λ⁻²), written with positive signs."""
    strain = np.linspace(0.0, 0.4, 21)
    stretch = 1.0 - strain
    pressed = -2.0 * (0.04 + 0.01 / stretch) * (stretch - stretch**-2)
    text = "strain,stress_MPa\n" + rows(strain, pressed)
    with pytest.raises(InputError, match="give --mode compression, or --mode uniaxial"):
        read_curve(write(tmp_path / "specimen 3.csv", text))
    told = [
        read_curve(write(tmp_path / "tension.csv", text)),
        read_curve(tmp_path / "specimen 3.csv", CurveFormat(mode="uniaxial")),
        read_curve(tmp_path / "specimen 3.csv", CurveFormat(may_stiffen=True)),
    ]
    for curve in told:
        np.testing.assert_allclose(curve.strain, strain, atol=1e-12)


def test_a_stiffening_composite_in_tension_is_noted_and_rubber_is_not(tmp_path):
    strain = np.linspace(0.0, 0.58, 59)
    rubber = 0.04 * ((1 + strain) - (1 + strain) ** -2)
    composites = [rubber + stiffness * np.maximum(strain - 0.39, 0.0) for stiffness in (0.5, 2.0)]
    for stress, noted in ((rubber, False), (composites[0], True), (composites[1], True)):
        curve = read_curve(write(tmp_path / "a.csv", "strain,stress_MPa\n" + rows(strain, stress)))
        np.testing.assert_allclose(curve.strain, strain, atol=1e-12)
        assert any("--mode compression" in note for note in curve.notes) is noted


def test_a_machine_for_tension_and_compression_does_not_tell_the_mode(tmp_path):
    text = "Machine;for tension and compression\nstrain;stress_MPa\n" + rows(
        STRAIN, STRESS_MPa, separator=";"
    )
    # not beside a folder named after this test
    (tmp_path / "data").mkdir()
    curve = read_curve(write(tmp_path / "data" / "a.csv", text))
    np.testing.assert_allclose(curve.strain, STRAIN, atol=1e-12)
    assert any("uniaxial test assumed" in note for note in curve.notes)


def test_rows_with_gaps_are_left_out_and_told(tmp_path):
    text = "strain,stress_MPa\n0,0\n0.1,\n,0.02\n0.2,0.03\nnan,0.1\n0.3,0.04\n"
    curve = read_curve(write(tmp_path / "a.csv", text))
    np.testing.assert_allclose(curve.strain, [0.0, 0.2, 0.3], atol=1e-12)
    assert any("3 rows" in note for note in curve.notes)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "no line holds two numbers"),
        ("strain,stress_MPa\n0,\n0.1,\n", "neither of them empty"),
        ("0.1 0.2\n0.2 0.3\n", "has no header line"),
        ("force,extension\n1,2\n2,3\n", "no column is named strain"),
        ("strain,force\n1,2\n2,3\n", "no column is named stress"),
        ("strain,stress_MPa\n0,0\n0.1,0.1,7\n", "line 3 has 3 cells"),
        ("strain,stress_MPa\n0,0\n0.1,abc\n0.2,0.3\n", "line 3 holds 'abc'"),
        ("strain,stress_MPa,x\n0,,1\n0.1,,1\n", "column 'stress_MPa' is empty"),
        ("strain,stress_MPa\n0,0\n0.1,inf\n", "expected a number"),
        ("strain,stress_MPa\n0,0\n", "expected two or more"),
        ("strain,stress_MPa\n0,0\n100,0.1\n200,0.3\n", "--strain-unit percent"),
        ("strain,stress_MPa\n0,0\n-1.5,-0.1\n", "which no body survives"),
        ("strain,stress_MPa\n0,0\n1,-0.1\n", "--mode compression"),
        ("strain,stress_MPa\n1,0\n1.5,0.1\n2,0.2\n", "--strain-measure stretch"),
        ("stretch,stress_MPa\n0,0\n1,0.1\n", "--strain-measure strain"),
        ("PK\0\0", "is not a text file"),
    ],
)
def test_bad_files_are_told(tmp_path, text, sentence):
    with pytest.raises(InputError, match=sentence):
        read_curve(write(tmp_path / "a.csv", text))


def test_missing_file_is_told(tmp_path):
    with pytest.raises(InputError, match="cannot be read"):
        read_curve(tmp_path / "none.csv")


def test_window_keeps_the_strains_inside(tmp_path):
    curve = read_curve(write(tmp_path / "a.csv", "strain,stress_MPa\n" + rows(STRAIN, STRESS_MPa)))
    (cut,) = in_window([curve], (0.5, 1.0))
    np.testing.assert_allclose(cut.strain, [0.5, 0.6, 0.7, 0.8, 0.9, 1.0])
    assert "6 of 21 points" in cut.notes[-1]
    with pytest.raises(InputError, match="no point lies in the strain window"):
        in_window([curve], (3.0, 4.0))
    with pytest.raises(InputError, match="lower end first"):
        in_window([curve], (1.0, 0.5))


def test_marechal_files_read_as_they_are():
    """17 lines above the numbers, true and engineering columns; first and last rows as in the file."""
    curve = read_curve(shared_data("marechal_sorodb/Ecoflex 00-30.csv"))
    assert (len(curve), curve.mode.name) == (705, "uniaxial")
    assert any("crosshead" in note for note in curve.notes)
    assert (curve.strain[0], curve.stress_MPa[0]) == pytest.approx((0.06795, 0.00149))
    assert (curve.strain[-1], curve.stress_MPa[-1]) == pytest.approx((16.06818, 1.35949))


def test_true_and_engineering_columns_of_marechal_agree():
    path = shared_data("marechal_sorodb/Ecoflex 00-30.csv")
    engineering = read_curve(path)
    true = read_curve(path, CurveFormat(strain_measure="true strain", stress_measure="true"))
    np.testing.assert_allclose(true.stretch, engineering.stretch, rtol=2e-4)
    np.testing.assert_allclose(true.stress_MPa, engineering.stress_MPa, rtol=5e-3)


def test_treloar_and_liao_files():
    assert [(curve.mode.name, len(curve)) for curve in treloar()] == [
        ("uniaxial", 24),
        ("equibiaxial", 16),
        ("planar", 13),
    ]
    folder = shared_data("liao_hossain_2021_ecoflex0030")
    modes = [read_curve(path).mode.name for path in sorted(folder.glob("*.csv"))]
    assert modes == ["equibiaxial", "planar", "uniaxial"]
