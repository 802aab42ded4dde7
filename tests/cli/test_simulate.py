"""``spavision simulate`` from options to files, and each input it refuses."""

import json

import meshio
import pandas as pd
import pytest


def test_a_short_ramp_writes_path_fields_and_picture(spavision, tmp_path):
    outcome = spavision(
        *("simulate", "--crimp", "0.2", "--mesh", "draft", "--pressures-kpa", "0,5", "-o", "out"),
        *("--write-deck", "actuator.inp"),
    )
    assert outcome.code == 0, outcome.err
    path = pd.read_csv(tmp_path / "out" / "simulation.csv")
    assert path["pressure_kPa"].tolist() == [0, 5]
    assert path["ux_mm"][0] == 0
    assert path["ux_mm"][1] > 0.5  # the first mode bends towards region B, which is positive x
    steps = pd.read_csv(tmp_path / "out" / "steps.csv")
    assert {"residual", "negative_pivots", "energy_imbalance_mJ"} <= set(steps)
    assert steps["pressure_kPa"].iloc[-1] == 5
    fields = sorted((tmp_path / "out" / "fields").glob("*.vtu"))
    assert "displacement_mm" in meshio.read(fields[-1]).point_data
    assert (tmp_path / "out" / "figures" / "deformed_shapes.png").stat().st_size > 10_000
    record = json.loads((tmp_path / "out" / "run.json").read_text())
    assert record["experiment"]["actuator"]["crimp_ratio"] == 0.2
    assert {"fields/ramp.pvd", "figures/ramp.gif"} <= set(record["files"])
    assert record["simulation"]["design"]["volume_ratio"] > 1.0
    assert record["simulation"]["composite"]["transition_factor"] == 0.69
    assert "largest stretch, Ecoflex 00-30" in outcome.out
    assert (tmp_path / "actuator.inp").read_text().count("*STEP") == 2  # the weight, 5 kPa


def test_reduced_model_gives_the_tip_path(spavision, tmp_path):
    outcome = spavision(
        "simulate",
        "--model",
        "reduced",
        "--crimp",
        "0.2",
        "--mesh",
        "draft",
        "--pressures-kpa",
        "0,5",
        "-o",
        "out",
    )
    assert outcome.code == 0, outcome.err
    path = pd.read_csv(tmp_path / "out" / "simulation.csv")
    assert path["ux_mm"][1] > 0.5
    assert json.loads((tmp_path / "out" / "run.json").read_text())["simulation"]["model"] == "reduced"


def test_a_deck_is_not_replaced_unasked(spavision, tmp_path):
    (tmp_path / "actuator.inp").write_text("mine")
    outcome = spavision("simulate", "--crimp", "0.2", "--write-deck", "actuator.inp")
    assert outcome.is_one_sentence_about("--write-deck", "exists already", "--force")
    assert (tmp_path / "actuator.inp").read_text() == "mine"


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ((), ("crimp ratio", "--crimp")),
        (("--crimp", "0.9"), ("crimp_ratio", "0.9")),
        (("--crimp", "0.2", "--mesh", "coarse"), ("mesh", "coarse", "draft")),
        (("--crimp", "0.2", "--control", "force"), ("control", "force", "volume")),
        (("--crimp", "0.2", "--composite", "hooke"), ("hooke", "slack-fibre", "resolved")),
        (
            ("--crimp", "0.2", "--composite", "ogden", "--composite-curve", "no.csv"),
            ("no.csv", "cannot be read"),
        ),
        (("--crimp", "0.2", "--composite", "resolved", "--composite-curve", "no.csv"), ("resolved", "curve")),
        (("--crimp", "0.2", "--pressures-kpa", "0:65"), ("--pressures-kpa",)),
        (("--crimp", "0.2", "--pressures-kpa", "10,5"), ("--pressures-kpa", "increasing")),
        (("--crimp", "0.2", "--pressures-kpa", "0,9000"), ("9000",)),
        (("--crimp", "0.2", "--pressures-kpa=-5,5"), ("-5",)),
    ],
)
def test_bad_options_are_refused(spavision, tmp_path, options, words):
    assert spavision("simulate", *options).is_one_sentence_about(*words)
    assert not (tmp_path / "results").exists()


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('body_material = "Gold"\n', ("Gold", "Mold Star 15")),
        ("side_wall_mm = 8.0\n", ("side_wall_mm", "width_mm")),
        ("void_count = 0\n", ("void_count",)),
    ],
)
def test_a_bad_actuator_is_refused(spavision, tmp_path, text, words):
    (tmp_path / "bad.toml").write_text("[actuator]\ncrimp_ratio = 0.2\n" + text)
    assert spavision("simulate", "--experiment", "bad.toml").is_one_sentence_about(*words)
