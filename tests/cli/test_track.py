"""``spavision track`` from folder to files, and each input it refuses."""

import hashlib
import json

import numpy as np
import pandas as pd
import pytest
from PIL import Image

from spavision.experiment import Experiment
from spavision.results import ResultsFolder
from spavision.workflow.photo_series import photo_series

from .conftest import A_FEW, SAMPLES


def truth_of(names):
    truth = json.loads((SAMPLES / "crimp-0.20" / "truth.json").read_text())
    return np.array([photo["displacement_mm"] for photo in truth["photos"] if photo["photo"] in names])


def test_a_folder_becomes_a_tip_path_overlays_and_a_montage(spavision, photos, tmp_path):
    outcome = spavision("track", photos, "-o", "out")
    assert outcome.code == 0, outcome.err
    assert "Measured tip path" in outcome.out
    table = pd.read_csv(tmp_path / "out" / "track.csv")
    error = table[["ux_mm", "uy_mm"]].to_numpy() - truth_of(A_FEW)
    assert np.abs(error).max() < 0.1  # what the issue asks of the sample sets
    budget = pd.read_csv(tmp_path / "out" / "budget.csv")
    variance = budget.groupby("pressure_kPa")["sigma_ux_mm"].apply(lambda sigma: (sigma**2).sum())
    assert np.sqrt(variance).to_numpy() == pytest.approx(table["sigma_ux_mm"].to_numpy(), rel=1e-5)
    assert all(basis in outcome.out for basis in ("±0.5 mm", "±5 mm", "±0.05 %", "±0.2 mm"))
    shapes = pd.read_csv(tmp_path / "out" / "shape.csv")
    assert set(shapes["photo"]) == set(A_FEW)
    assert shapes.groupby("photo")["arc_mm"].apply(lambda arc: arc.is_monotonic_increasing).all()
    assert len(list((tmp_path / "out" / "overlays").iterdir())) == 3
    assert Image.open(tmp_path / "out" / "figures" / "montage.jpg").width > 500
    record = json.loads((tmp_path / "out" / "run.json").read_text())
    assert set(record["inputs"]) == {*A_FEW, "experiment.toml"}
    for name, digest in record["inputs"].items():
        assert digest == hashlib.sha256((photos / name).read_bytes()).hexdigest()
    assert record["experiment"]["camera"]["standoff_mm"] == 20.0


def test_json_goes_to_standard_output_alone(spavision, photos):
    outcome = spavision("track", photos, "--json")
    rows = json.loads(outcome.out)["tip_path"]
    assert [row["pressure_kPa"] for row in rows] == [0, 20, 40]


def test_the_same_input_gives_the_same_files(spavision, photos, tmp_path):
    spavision("track", photos, "-o", "first", "-q")
    spavision("track", photos, "-o", "second", "-q")
    for path in sorted((tmp_path / "first").rglob("*.*")):
        twin = tmp_path / "second" / path.relative_to(tmp_path / "first")
        assert path.read_bytes() == twin.read_bytes(), path.name


def test_an_option_goes_before_the_experiment_file(spavision, photos, tmp_path):
    sigmas = ("--sigma-standoff-mm", "2", "--sigma-distance-mm", "20", "--sigma-board-scale", "0")
    spavision("track", photos, "-o", "out", "--standoff-mm", "10", *sigmas, "--sigma-out-of-plane-mm", "1")
    record = json.loads((tmp_path / "out" / "run.json").read_text())["track"]
    assert record["standoff_mm"] == 10
    budget = {entry["source"]: entry for entry in record["budget"]}
    for source, stated in {"stand-off": "±2 mm", "distance": "±20 mm", "out of plane": "±1 mm"}.items():
        assert budget[source]["basis"].startswith(stated)
    # A millimetre of stand-off is a share of 1/750 of the reading in the board's plane.
    furthest = np.abs(truth_of(A_FEW)).max()
    assert budget["stand-off"]["largest_sigma_uy_mm"] < budget["stand-off"]["largest_sigma_ux_mm"]
    assert budget["stand-off"]["largest_sigma_ux_mm"] == pytest.approx(2.0 * furthest / 750.0, rel=0.05)
    assert budget["print scale"]["largest_sigma_ux_mm"] == 0


def test_without_a_standoff_the_reading_is_called_uncorrected(spavision, photos, tmp_path):
    (photos / "experiment.toml").unlink()
    outcome = spavision("track", photos, "-o", "out")
    assert "uncorrected" in outcome.out
    table = pd.read_csv(tmp_path / "out" / "track.csv")
    last = table[["ux_mm", "uy_mm"]].to_numpy()[1]
    # A board-plane reading is D/(D-h) too large: 750/730 here.
    assert np.hypot(*last) / np.hypot(*truth_of(A_FEW)[1]) == pytest.approx(750 / 730, abs=0.004)


def test_a_truncated_photo_among_good_ones_is_named_and_the_rest_go_on(spavision, photos, tmp_path):
    broken = photos / "IMG_0009_045kPa.jpg"
    broken.write_bytes((photos / A_FEW[0]).read_bytes()[:40_000])
    outcome = spavision("track", photos, "-o", "out")
    assert outcome.code == 0
    row = pd.read_csv(tmp_path / "out" / "track.csv").iloc[3]
    assert row["status"] == "missing"
    assert "IMG_0009_045kPa.jpg" in row["reason"]
    assert np.isnan(row["ux_mm"])


def test_pressures_from_a_table_and_from_a_step(spavision, photos, tmp_path):
    for number, name in enumerate(A_FEW):
        (photos / name).rename(photos / f"shot{number}.jpg")
    (tmp_path / "pressures.csv").write_text("photo,pressure_kPa\nshot0.jpg,0\nshot1.jpg,20\nshot2.jpg,40\n")
    spavision("track", photos, "-o", "table", "--pressures", "pressures.csv")
    spavision("track", photos, "-o", "step", "--pressure-step-kpa", "20")
    assert pd.read_csv(tmp_path / "table" / "track.csv")["pressure_kPa"].tolist() == [0, 20, 40]
    assert (tmp_path / "table" / "track.csv").read_text() == (tmp_path / "step" / "track.csv").read_text()


def test_a_missing_or_empty_folder_is_refused(spavision, tmp_path):
    assert spavision("track", "nowhere").is_one_sentence_about("nowhere")
    (tmp_path / "empty").mkdir()
    assert spavision("track", "empty").is_one_sentence_about("empty", "no photo")


def test_a_folder_of_unreadable_photos_is_refused(spavision, tmp_path):
    (tmp_path / "photos").mkdir()
    (tmp_path / "photos" / "p000.jpg").write_text("not a photo")
    assert spavision("track", "photos").is_one_sentence_about("p000.jpg")
    assert not (tmp_path / "results").exists()


def test_photos_without_a_board_are_refused(spavision, tmp_path):
    (tmp_path / "photos").mkdir()
    noise = np.random.default_rng(1).integers(90, 140, (480, 640, 3), dtype=np.uint8)
    Image.fromarray(noise).save(tmp_path / "photos" / "p000.jpg")
    assert spavision("track", "photos").is_one_sentence_about("checkerboard")


def test_photos_without_a_marker_are_refused(spavision, photos):
    outcome = spavision("track", photos, "--marker-colour", "blue")
    assert outcome.is_one_sentence_about("marker", "--marker-colour")


def test_names_that_tell_no_pressure_are_refused_with_the_list(spavision, photos):
    for number, name in enumerate(A_FEW):
        (photos / name).rename(photos / f"shot{number}.jpg")
    outcome = spavision("track", photos)
    assert outcome.is_one_sentence_about("shot0.jpg", "shot1.jpg", "shot2.jpg", "--pressures")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[board]\nsquare_mm = -2.5\n", ("square_mm", "-2.5")),
        ("[camera]\ndistance_mm = 4000000\n", ("distance_mm",)),
        ("[camera]\nstand_off = 20\n", ("stand_off", "did you mean standoff_mm")),
        ("[board\n", ("not valid TOML",)),
    ],
)
def test_a_bad_experiment_file_is_refused(spavision, photos, text, words):
    (photos / "experiment.toml").write_text(text)
    assert spavision("track", photos).is_one_sentence_about("experiment.toml", *words)


def test_an_output_that_cannot_be_written_or_is_in_use_is_refused_before_the_work(
    spavision, photos, tmp_path
):
    (tmp_path / "file").write_text("")
    assert spavision("track", photos, "-o", "file").is_one_sentence_about("--output", "file")
    assert spavision("track", photos, "-o", "/proc/out").is_one_sentence_about("--output", "written")
    (tmp_path / "used").mkdir()
    (tmp_path / "used" / "notes.txt").write_text("mine")
    assert spavision("track", photos, "-o", "used").is_one_sentence_about("--force")


def test_a_list_of_pressures_must_fit_the_number_of_photos(spavision, photos):
    outcome = spavision("track", photos, "--pressures-kpa", "0:65:5")
    assert outcome.is_one_sentence_about("--pressures-kpa", "14 pressures", "3 photos")


def test_two_ways_of_telling_the_pressures_are_refused(spavision, photos):
    outcome = spavision("track", photos, "--pressures-kpa", "0,5,10", "--pressure-step-kpa", "5")
    assert outcome.is_one_sentence_about("--pressures-kpa", "--pressure-step-kpa", "one of them")
    assert spavision("track", photos, "--pressures-kpa", "ten").is_one_sentence_about("'ten'", "from:to:step")


def test_larger_photos_than_asked_for_are_not_read(spavision, photos):
    outcome = spavision("track", photos, "--largest-megapixels", "0.5")
    assert outcome.is_one_sentence_about(A_FEW[0], "megapixels", "0.5 allowed")


def test_the_same_photo_under_two_names_is_told(photos, tmp_path):
    (photos / "IMG_0009_045kPa.jpg").write_bytes((photos / A_FEW[2]).read_bytes())
    series = photo_series(photos, Experiment(), results=ResultsFolder(tmp_path / "out"))
    assert len(series.notes) == 1
    assert f"{A_FEW[2]} and IMG_0009_045kPa.jpg are the same file" in series.notes[0]
