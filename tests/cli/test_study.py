"""``spavision study`` from the command line, with the reduced model at a few low pressures."""

from __future__ import annotations

import csv
import json
import tomllib
from dataclasses import replace

import numpy as np
import pytest

from spavision.cli.studies.measured import measured_paths
from spavision.cli.studies.setup import prepare
from spavision.cli.studies.starter import STARTER
from spavision.correlate.study.study_file import StudyFile
from spavision.experiment import Experiment
from spavision.tip_path import TipPath
from spavision.workflow.study_results import read_study_results

STUDY = """
[study]
crimp_ratio = 0.2
cases = 14
pressures_kPa = [0, 10]
[suspects.body_stiffness]
distribution = "normal"
sigma = 0.1
[suspects.side_wall_mm]
distribution = "uniform"
plus_minus = 0.2
[suspects.standoff_mm]
distribution = "normal"
mean = 20
sigma = 1
[update]
parameters = ["body_stiffness"]
steps = 200
"""

MEASURED = ([0, 5, 10], [0, 2.3, 5.2], [0, 0.9, 1.8], [0.05] * 3, [0.05] * 3)
"""Pressure, x, y and their uncertainties."""


@pytest.fixture
def study_file(tmp_path):
    (tmp_path / "study.toml").write_text(STUDY, encoding="utf-8")
    rows = [
        "pressure_kPa,ux_mm,uy_mm,sigma_ux_mm,sigma_uy_mm",
        *(",".join(map(str, row)) for row in zip(*MEASURED, strict=True)),
    ]
    (tmp_path / "measured.csv").write_text("\n".join(rows) + "\n")
    return tmp_path / "study.toml"


def table(path):
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_starter_is_a_valid_study_file(spavision):
    content = tomllib.loads(spavision("study", "starter").out)
    assert content == tomllib.loads(STARTER)
    assert len(StudyFile.model_validate(content).suspects) == 18


def test_study_alone_explains_itself(spavision):
    assert "spavision study starter > study.toml" in spavision("study").out


def test_tolerance_and_attribution_share_a_folder_that_correlate_reads(spavision, study_file, tmp_path):
    out, measured = str(tmp_path / "out"), str(tmp_path / "measured.csv")
    band = json.loads(spavision("study", "tolerance", str(study_file), "-o", out, "--json").out)["band"]
    assert band[0]["u_input_ux_mm"] == 0.0 < band[1]["u_input_ux_mm"]
    assert [row["n_reached"] for row in band] == [14, 14]
    spavision(
        "study",
        "attribute",
        str(study_file),
        "--measured",
        measured,
        "-o",
        out,
        "--full-runs",
        "0",
        "--quiet",
    )
    rows = {row["suspect"]: row for row in table(tmp_path / "out/attribute/attribution.csv")}
    assert float(rows["body_stiffness"]["best"]) < 0.95
    assert float(rows["body_stiffness"]["explained"]) > 0.3
    assert float(rows["standoff_mm"]["explained"]) < 0.05
    assert len(table(tmp_path / "out/tolerance/cases.csv")) == 14
    known = read_study_results(
        tmp_path / "out", Experiment().with_options({"actuator": {"crimp_ratio": 0.2}})
    )
    assert known.inputs_mm(np.array([10.0]))[0] == pytest.approx([band[1]["u_input_ux_mm"]], rel=1e-6)
    between, beyond = known.inputs_mm(np.array([5.0, 99.0]))[0]
    assert between == pytest.approx(0.5 * band[1]["u_input_ux_mm"], rel=1e-6)
    assert np.isnan(beyond)
    assert sorted(row[0] for row in known.rows()[1:]) == ["body_stiffness", "side_wall_mm", "standoff_mm"]
    assert known.chart is not None
    other = spavision(
        "correlate", "--measured", measured, "--crimp", "0.3", "--study", out, "-o", str(tmp_path / "no")
    )  # fmt: skip
    assert other.is_one_sentence_about("its [actuator] crimp_ratio is 0.2, the comparison's 0.3")
    explained = TipPath(*(np.array(column) for column in MEASURED))
    assert known.for_path(explained) is known
    foreign = known.for_path(replace(explained, ux_mm=1.1 * explained.ux_mm))
    assert foreign.attribution == foreign.findings == ()
    assert "explains another measured path (measured.csv)" in foreign.notes[-1]


def test_update_finds_the_softer_body_and_checks_elsewhere(spavision, study_file, tmp_path):
    with study_file.open("a", encoding="utf-8") as file:
        file.write(
            '[[measured]]\npath = "measured.csv"\n[[measured]]\npath = "measured.csv"\ncrimp_ratio = 0.3\n'
        )
    out = tmp_path / "out"
    spavision("study", "update", str(study_file), "-o", str(out), "--full-runs", "0", "--quiet")
    (parameter,) = table(out / "update/update.csv")
    assert 0.75 < float(parameter["least_squares"]) < 0.95
    assert float(parameter["low"]) < float(parameter["median"]) < float(parameter["high"])
    fitted, check = table(out / "update/checks.csv")
    assert float(fitted["rmse_updated_mm"]) < float(fitted["rmse_nominal_mm"])
    assert [fitted["role"], check["role"]] == ["fitted", "check"]
    updated = tomllib.loads((out / "update/updated.toml").read_text(encoding="utf-8"))
    assert updated["actuator"]["body_stiffness"] == pytest.approx(float(parameter["least_squares"]), rel=1e-4)


def test_sweep_tells_the_failed_case_and_the_one_beyond_the_range(spavision, tmp_path):
    done = spavision(
        "study",
        "sweep",
        "--crimp",
        "0.2",
        "--vary",
        "side_wall_mm=2.5,8",
        "--vary",
        "mesh=draft",
        "-o",
        str(tmp_path / "out"),
        "--json",
    )
    thin, thick = json.loads(done.out)["cases"]
    assert [thin["status"], thick["status"]] == ["ok", "failed"]
    assert "width_mm is 15 mm" in thick["reason"]
    assert "failed: geometry: 2 × side_wall_mm is 16 mm" in done.err
    assert thin["reason"].startswith("from 60 kPa on beyond the reduced model's range")
    assert "1 of 2 cases leave the reduced model's range" in done.err
    assert [row["side_wall_mm"] for row in table(tmp_path / "out/sweep/failed.csv")] == ["8"]


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("[suspects.side_wal_mm]\ndistribution='uniform'\nplus_minus=1", "did you mean side_wall_mm"),
        ("[suspects.side_wall_mm]\ndistribution='uniform'", "needs plus_minus, or low and high"),
        ("[suspects.side_wall_mm]\ndistribution='uniform'\nplusminus=1", "did you mean plus_minus?"),
        ("[suspects.body_material]\ndistribution='normal'\nsigma=1", 'use distribution = "choice"'),
        ("[suspects.void_count]\ndistribution='uniform'\nplus_minus=1", 'use distribution = "choice"'),
        ("[suspects.strip_b_mm]\ndistribution='uniform'\nplus_minus=4", "allowed are 0 to 20"),
        ("[suspects.roof_mm]\ndistribution='uniform'\nlow=3\nhigh=4", "outside 3 to 4"),
        ("[study]\nmodel='huge'", "[study] model"),
        ("[study]\npressures_kPa=[5, 0]", "5 is followed by 0"),
        ("", "names no suspect"),
        ("[[measured]]\npath='m.csv'\npressure_unit='torr'", "pressure_unit"),
        (
            "[suspects.law]\ndistribution='choice'\noptions=['slack-fibre','ogden']",
            "no suspect is an input of the model",
        ),
    ],
)
def test_each_defect_of_a_study_file_is_told_in_one_sentence(spavision, tmp_path, text, sentence):
    (tmp_path / "study.toml").write_text(text, encoding="utf-8")
    done = spavision("study", "tolerance", str(tmp_path / "study.toml"), "-o", str(tmp_path / "out"))
    assert done.is_one_sentence_about(sentence)


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (("--vary", "strip_b_mm=1,2"), "the crimp ratio is not known; give --crimp 0.2"),
        (("--crimp", "0.2", "--vary", "standoff_mm=10,20"), "standoff_mm moves the measured path"),
        (("--crimp", "0.2", "--vary", "side_wal_mm=2"), "did you mean side_wall_mm"),
        (("--crimp", "0.2", "--vary", "law=ogdn"), "[composite] law is 'ogdn'"),
        (("--crimp", "0.2", "--vary", "strip_b_mm=3:1:0.5"), "expected from:to:step"),
        (("--crimp", "0.2"), "nothing varies"),
    ],
)
def test_sweep_that_makes_no_sense_is_told_in_one_sentence(spavision, options, sentence):
    assert spavision("study", "sweep", *options).is_one_sentence_about(sentence)


def test_measured_paths_are_turned_into_the_model_s_axes(study_file, tmp_path):
    """The experiment file says to which side the first bend goes; a path of its own may say otherwise."""
    (tmp_path / "experiment.toml").write_text("[actuator]\nfirst_bend = 'left'\n")
    text = STUDY.replace("[study]", "[study]\nexperiment = 'experiment.toml'", 1)
    text += "[[measured]]\npath = 'measured.csv'\n[[measured]]\npath = 'measured.csv'\nfirst_bend = 'right'\n"
    study_file.write_text(text, encoding="utf-8")
    given = dict.fromkeys(("cases", "model", "crimp")) | {"force": False, "workers": 1, "scheduler": ""}
    setup = prepare("attribute", study_file, {**given, "output": tmp_path / "out"})
    found = measured_paths(setup, tmp_path / "measured.csv")
    assert [one.path.ux_mm[-1] for one in found] == [-5.2, -5.2, 5.2]
    assert found[0].record()["ux_mm"] == [0.0, -2.3, -5.2]


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("pressures_kPa = [1, 11]", "the measured path and the study share no pressure"),
        ("pressures_kPa = [0, 10]\ncases = 12", "12 cases are too few"),
    ],
)
def test_attribution_that_could_only_fail_is_refused_before_it_runs(
    spavision, study_file, tmp_path, text, sentence
):
    study = STUDY.replace("pressures_kPa = [0, 10]\n", "").replace("cases = 14", text)
    study_file.write_text(study, encoding="utf-8")
    done = spavision("study", "attribute", "study.toml", "--measured", "measured.csv", "-o", "out")
    assert done.is_one_sentence_about(sentence)
    assert not (tmp_path / "out").exists()
