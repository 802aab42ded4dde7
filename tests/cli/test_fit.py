"""``spavision fit`` from files to results folder."""

import json

import numpy as np
import pandas as pd
import pytest

from spavision.model.materials.library import find_material

STRAIN = np.linspace(0.0, 0.6, 61)
KNEE = 0.1 * STRAIN + 2.0 * np.maximum(STRAIN - 0.4, 0.0)
RUBBER = 0.1 * ((1 + STRAIN) - (1 + STRAIN) ** -2)


def write(path, stress=RUBBER, header="strain,nominal_stress_MPa"):
    rows = [f"{a:.6f},{b:.9f}" for a, b in zip(STRAIN, stress, strict=True)]
    path.write_text("\n".join([header, *rows]) + "\n", encoding="utf-8")
    return path


def test_a_fit_leaves_material_figure_table_report_and_record(spavision, tmp_path):
    write(tmp_path / "tension.csv")
    outcome = spavision(
        "fit", "tension.csv", "--law", "yeoh", "--name", "Rubber", "--density-g-per-cm3", "1.2"
    )
    assert outcome.code == 0, outcome.err
    assert "C10" in outcome.out
    folder = tmp_path / "results" / "fit-tension"
    written = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}
    assert written == {
        "material-yeoh.toml",
        "figures/fit.png",
        "figures/fit.svg",
        "curves.csv",
        "report.txt",
        "run.json",
    }
    material = find_material(str(folder / "material-yeoh.toml"))
    # a neo-Hookean curve of G = 0.1 MPa
    assert material.law.shear_modulus_MPa == pytest.approx(0.1, rel=1e-4)
    assert (material.name, material.density_g_per_cm3) == ("Rubber", 1.2)
    assert material.strain_range == pytest.approx((0.0, 0.6))
    table = pd.read_csv(folder / "curves.csv")
    np.testing.assert_allclose(table["yeoh_MPa"], table["stress_MPa"], atol=1e-6)
    record = json.loads((folder / "run.json").read_text(encoding="utf-8"))
    assert record["inputs"].keys() == {"tension.csv"}


def test_all_laws_with_transition_as_json(spavision, tmp_path):
    write(tmp_path / "tension.csv", KNEE)
    outcome = spavision(
        "fit", "tension.csv", "--law", "all", "--transition", "--json", "--stress-unit", "MPa"
    )
    assert outcome.code == 0, outcome.err
    result = json.loads(outcome.out)
    assert result["transition"]["strain"] == pytest.approx(0.4, abs=1e-6)
    assert len(result["fits"]) == 11
    scores = [each["r_squared"] for each in result["fits"]]
    assert scores == sorted(scores, reverse=True)
    first = result["fits"][0]
    assert first["transition_error"] == pytest.approx(abs(first["transition"]["strain"] / 0.4 - 1), rel=1e-4)
    assert len(list((tmp_path / "results" / "fit-tension").glob("material-*.toml"))) == 11


def test_what_was_done_to_the_data_is_told_with_all_laws_too(spavision, tmp_path):
    write(tmp_path / "tension.csv", RUBBER + 0.02)
    outcome = spavision("fit", "tension.csv", "--law", "all")
    assert outcome.code == 0, outcome.err
    assert "stress of 20 kPa at zero strain: the curve is shifted by it" in outcome.out


def test_window_weights_and_modes(spavision, tmp_path):
    write(tmp_path / "a.csv")
    write(tmp_path / "b.csv", 2 * RUBBER)
    options = ("--law", "neo-hooke", "--json", "--window=-0.3:0.3", "--mode", "uniaxial")
    moduli = []
    for number, weights in enumerate(("1,3", "balanced")):
        outcome = spavision("fit", "a.csv", "b.csv", *options, "--weights", weights, "-o", f"out{number}")
        assert outcome.code == 0, outcome.err
        result = json.loads(outcome.out)
        assert [curve["points"] for curve in result["curves"]] == [31, 31]
        moduli.append(result["fits"][0]["shear_modulus_MPa"])
    # the curves share their stretches, so the modulus is the weighted mean
    assert moduli == pytest.approx([0.175, 0.15], rel=1e-6)


def test_slack_fibre_is_fitted_beside_a_known_matrix(spavision, tmp_path):
    """Paper of 2 MPa taut from 40 % strain on, the matrix's own stress below."""
    matrix = find_material("Ecoflex 00-30, Marechal 2021").law
    own = matrix.mu_MPa[0] * (
        (1 + STRAIN) ** (matrix.alpha[0] - 1) - (1 + STRAIN) ** (-matrix.alpha[0] / 2 - 1)
    )
    write(tmp_path / "tension.csv", own + 2.0 * np.maximum(STRAIN - 0.4, 0.0))
    options = ("--law", "slack-fibre", "--matrix", "Ecoflex 00-30, Marechal 2021", "--transition")
    outcome = spavision("fit", "tension.csv", *options, "--json")
    assert outcome.code == 0, outcome.err
    found = {each["name"]: each["value"] for each in json.loads(outcome.out)["parameters"]}
    assert found["slack_strain"] == pytest.approx(0.4, abs=1e-3)
    assert found["length_modulus_MPa"] == pytest.approx(2.0, rel=0.01)
    folder = tmp_path / "results" / "fit-tension"
    assert {path.name for path in folder.iterdir()} == {"report.txt", "curves.csv", "figures", "run.json"}


def test_standard_errors_between_replicates(spavision, tmp_path):
    """Two replicates of 100 and 200 kPa: 150 kPa, and with m/(m − 1) = 2 a standard error of 50 kPa."""
    write(tmp_path / "a.csv")
    write(tmp_path / "b.csv", 2 * RUBBER)
    options = ("--law", "neo-hooke", "--errors", "replicates", "--json")
    outcome = spavision("fit", "a.csv", "b.csv", *options)
    assert outcome.code == 0, outcome.err
    (parameter,) = json.loads(outcome.out)["fits"][0]["parameters"]
    assert parameter["value"] == pytest.approx(0.15, rel=1e-6)
    assert parameter["standard_error"] == pytest.approx(0.05, rel=1e-6)


def test_replicates_of_one_name_are_told_apart(spavision, tmp_path):
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
        write(tmp_path / folder / "tension.csv")
    outcome = spavision("fit", "a/tension.csv", "b/tension.csv", "--law", "neo-hooke", "--json")
    assert [curve["name"] for curve in json.loads(outcome.out)["curves"]] == ["a/tension", "b/tension"]


def test_a_unit_told_against_the_column_s_is_noted(spavision, tmp_path):
    write(tmp_path / "tension.csv")
    outcome = spavision("fit", "tension.csv", "--law", "neo-hooke", "--stress-unit", "kPa")
    assert "in kPa as told, though its column says MPa" in outcome.out


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("none.csv",), ("none.csv", "cannot be read")),
        (("tension.csv", "./tension.csv"), ("is given twice", "--weights")),
        (("tension.csv", "--law", "hooke"), ("hooke", "expected one of")),
        (("tension.csv", "--mode", "torsion"), ("--mode", "torsion")),
        (("tension.csv", "--mode", "planar", "--mode", "planar"), ("--mode", "2 times for 1 files")),
        (("tension.csv", "--window", "2"), ("--window", "-0.3:2")),
        (("tension.csv", "--window", "3:4"), ("no point lies",)),
        (("tension.csv", "--weights", "1,2"), ("--weights", "1 files")),
        (("tension.csv", "--weights", "-1"), ("--weights",)),
        (("tension.csv", "--columns", "strain"), ("--columns", "1 columns")),
        (("tension.csv", "--transition"), ("modulus falls",)),
        (("tension.csv", "--mode", "equibiaxial", "--transition"), ("--transition", "tension test")),
        (("tension.csv", "--density-g-per-cm3", "1100"), ("--density-g-per-cm3",)),
        (("kilopascals.csv",), ("--stress-unit",)),
        (("tension.csv", "--errors", "replicates"), ("--errors replicates", "twice")),
        (("tension.csv", "--law", "slack-fibre", "--weights", "1"), ("--weights", "slack-fibre")),
        (("tension.csv", "--law", "slack-fibre", "--matrix", "Gold"), ("Gold", "Ecoflex 00-30")),
    ],
)
def test_bad_input_is_told_and_nothing_is_written(spavision, tmp_path, arguments, words):
    write(tmp_path / "tension.csv")
    write(tmp_path / "kilopascals.csv", 1e4 * RUBBER, header="strain,stress")
    outcome = spavision("fit", *arguments)
    assert outcome.is_one_sentence_about(*words), outcome
    assert not (tmp_path / "results").exists()
