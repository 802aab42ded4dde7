"""``spavision correlate`` from options to report, and each input it refuses."""

import json
import re

import numpy as np
import pandas as pd
import pytest

from spavision import simulate

GOOD = "pressure_kPa,ux_mm,uy_mm\n0,0,0\n5,1.5,0.2\n10,3.6,-0.1\n"


@pytest.mark.slow
def test_photos_and_model_meet_in_one_report(spavision, photos, tmp_path):
    outcome = spavision("correlate", "--photos", photos, "--mesh", "draft", "-o", "out")
    assert outcome.code == 0, outcome.err
    assert "|Δ|" in outcome.out
    assert outcome.out.strip().endswith("report.html")
    written = {path.relative_to(tmp_path / "out").as_posix() for path in (tmp_path / "out").rglob("*.*")}
    assert {
        "track.csv",
        "simulation.csv",
        "discrepancy.csv",
        "run.json",
        "report.html",
        "figures/path.png",
        "figures/path.svg",
        "figures/pressure.png",
        "figures/montage.jpg",
        "figures/deformed_shapes.png",
    } <= written
    table = pd.read_csv(tmp_path / "out" / "discrepancy.csv")
    tracked = pd.read_csv(tmp_path / "out" / "track.csv")
    simulated = pd.read_csv(tmp_path / "out" / "simulation.csv")
    assert table["pressure_kPa"].tolist() == [0, 20, 40]
    assert table["error_ux_mm"].to_numpy() == pytest.approx(
        simulated["ux_mm"].to_numpy() - tracked["ux_mm"].to_numpy(), abs=1e-4
    )


@pytest.mark.slow
def test_the_report_needs_no_network_and_escapes_names(spavision, photos, tmp_path):
    folder = photos.rename(tmp_path / "a <b> & c")
    spavision("correlate", "--photos", folder, "--mesh", "draft", "-o", "out")
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    own_part = re.sub(r"<script>/\*\*.*?</script>", "", page, flags=re.DOTALL)
    assert "a &lt;b&gt; &amp; c" in own_part
    assert "<b>" not in own_part
    assert not re.findall(r'(?:src|href)="(?!data:)[^"]*"', own_part)


def test_a_measured_table_in_bar_is_compared_as_it_is(spavision, tmp_path):
    (tmp_path / "measured.csv").write_text("pressure_bar,ux_mm,uy_mm\n0,0,0\n0.05,2.0,0.5\n0.08,,\n")
    outcome = spavision(
        "correlate",
        "--measured",
        "measured.csv",
        "--pressure-unit",
        "bar",
        "--crimp",
        "0.3",
        "--mesh",
        "draft",
        *("--format", "md", "--format", "json"),
        "--json",
    )
    assert outcome.code == 0, outcome.err
    rows = json.loads(outcome.out)["discrepancy"]
    assert [row["pressure_kPa"] for row in rows] == [0, 5, 8]
    assert rows[1]["error_ux_mm"] == pytest.approx(rows[1]["modelled_ux_mm"] - 2.0)
    assert rows[2]["measured_ux_mm"] is None
    assert rows[2]["modelled_ux_mm"] is not None
    folder = tmp_path / "results" / "correlate-measured"
    assert json.loads((folder / "report.json").read_text())["discrepancy"][1] == rows[1]
    assert "![" in (folder / "report.md").read_text()
    assert not (folder / "report.html").exists()


def test_a_first_bend_to_the_left_is_turned_into_the_model_s_axes(spavision, tmp_path):
    (tmp_path / "measured.csv").write_text("pressure_kPa,ux_mm,uy_mm\n0,0,0\n5,-2.0,0.5\n")
    (tmp_path / "left.toml").write_text('[actuator]\ncrimp_ratio = 0.3\nfirst_bend = "left"\n')
    outcome = spavision(
        "correlate", "--measured", "measured.csv", "--experiment", "left.toml", "--mesh", "draft", "--json"
    )
    assert json.loads(outcome.out)["discrepancy"][1]["measured_ux_mm"] == 2.0


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("pressure_kPa,ux_mm\n0,0\n", ("measured.csv", "uy_mm", "missing")),
        (GOOD.replace("1.5", "much"), ("measured.csv", "much", "number")),
        (GOOD + "5,2,2\n", ("measured.csv", "5 kPa")),
        (GOOD.replace(",", ";"), ("measured.csv", "semicolons")),
        (GOOD + "900,2,2\n", ("measured.csv", "900", "range")),
        ("pressure_kPa,ux_mm,uy_mm\n0,,\n", ("measured.csv", "no row")),
        ("pressure_kPa,ux_mm,uy_mm\n0,0,0\n5,,\n", ("measured.csv", "one reading", "one more")),
        (GOOD.replace("1.5", "inf"), ("measured.csv", "inf", "number")),
    ],
)
def test_a_bad_table_is_refused(spavision, tmp_path, text, words):
    (tmp_path / "measured.csv").write_text(text)
    outcome = spavision("correlate", "--measured", "measured.csv", "--crimp", "0.2")
    assert outcome.is_one_sentence_about(*words)
    assert not (tmp_path / "results").exists()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ((), ("--crimp", "--photos", "--measured")),
        (("--crimp", "0.5"), ("crimp_ratio", "0.5")),
        (("--photos", "a", "--measured", "b"), ("--photos", "--measured")),
        (("--photos", "nowhere"), ("nowhere",)),
        (("--measured", "nowhere.csv", "--crimp", "0.2"), ("nowhere.csv",)),
        (("--measured", "m.csv", "--crimp", "0.2", "--pressure-unit", "torr"), ("torr", "kPa")),
    ],
)
def test_bad_options_are_refused(spavision, tmp_path, options, words):
    (tmp_path / "m.csv").write_text(GOOD)
    assert spavision("correlate", *options).is_one_sentence_about(*words)


def test_a_crimp_ratio_without_sample_photos_takes_the_nearest_and_says_so():
    from spavision.cli.source import choose_source

    nothing = dict.fromkeys(("experiment", "pressures", "pressure_step_kpa", "mesh"))
    source = choose_source(None, None, {**nothing, "crimp": 0.22}, pressure_unit="kPa")
    assert source.experiment.actuator.crimp_ratio == 0.22
    assert source.photos.name == "crimp-0.20"
    assert any("no sample photos of crimp ratio 0.22" in note for note in source.notes)


def test_sample_sets_pass_through_the_published_values():
    """The article: 71.25 mm at 40 kPa for 0.3; 17.5 mm, then 65 mm the other way for 0.2."""
    from spavision.samples import nearest_sample_set

    def displacement(ratio):
        truth = json.loads((nearest_sample_set(ratio)[0] / "truth.json").read_text())
        return np.array([photo["displacement_mm"] for photo in truth["photos"]])

    high, low, between = displacement(0.3), displacement(0.2), displacement(0.25)
    assert high[8, 0] == pytest.approx(71.25)
    assert high[:, 0].max() == pytest.approx(71.25)
    assert np.all(np.diff(high[8:, 0]) < 0)
    assert np.all(np.diff(high[8:, 1]) > 0)
    assert low[:, 0].max() == pytest.approx(17.5)
    assert low[-1, 0] == pytest.approx(-65)
    assert low[:, 0].max() < between[:, 0].max() < high[:, 0].max()


def test_correlate_sets_the_model_at_true_pressures_beside_the_readings(spavision, tmp_path):
    (tmp_path / "measured.csv").write_text("pressure_kPa,ux_mm,uy_mm\n0,0,0\n2.5,2.0,0.5\n")
    (tmp_path / "gauge.toml").write_text("[actuator]\ncrimp_ratio = 0.3\n[gauge]\npressure_scale = 2\n")
    done = spavision(
        "correlate", "--measured", "measured.csv", "--experiment", "gauge.toml", "--mesh", "draft", "--json",
        "-o", "out",
    )  # fmt: skip
    row = json.loads(done.out)["discrepancy"][1]
    expected = simulate(pressures_kPa=[0, 5], actuator={"crimp_ratio": 0.3}, model={"mesh": "draft"})
    assert row["pressure_kPa"] == 2.5
    assert row["modelled_ux_mm"] == pytest.approx(expected.tip_path.ux_mm[1], abs=1e-9)
    assert "the model ran at 2 times these" in (tmp_path / "out/report.html").read_text(encoding="utf-8")
