"""``spavision render`` from options to a folder that ``track`` reads, and each input it refuses."""

import json

import pytest

SMALL = ("--set", "image.width_px=400", "--set", "image.height_px=300", "--set", "camera.aim_y_mm=55", "-q")


def test_a_trajectory_becomes_photos_with_truth(spavision, tmp_path):
    (tmp_path / "path.csv").write_text("pressure_kPa,ux_mm,uy_mm\n0,0,0\n10,4,-0.5\n")
    outcome = spavision("render", "out", "--trajectory", "path.csv", "--seed", "3", *SMALL)
    assert outcome.code == 0, outcome.err
    truth = json.loads((tmp_path / "out" / "truth.json").read_text())
    assert [photo["photo"] for photo in truth["photos"]] == ["IMG_0000_000kPa.jpg", "IMG_0001_010kPa.jpg"]
    assert truth["photos"][1]["displacement_mm"] == pytest.approx([4, -0.5])
    assert json.loads((tmp_path / "out" / "run.json").read_text())["settings"]["seed"] == 3
    again = spavision("render", "out", "--trajectory", "path.csv", *SMALL)
    assert again.is_one_sentence_about("--output", "--force")


def test_settings_are_listed(spavision):
    outcome = spavision("render", "--list-settings")
    assert outcome.code == 0
    assert "optics.defocus_px" in outcome.out


def test_bad_input_is_refused(spavision, tmp_path):
    (tmp_path / "gap.csv").write_text("pressure_kPa,ux_mm,uy_mm\n0,0,0\n10,,\n")
    (tmp_path / "scene.toml").write_text("[optics]\ndefocus = 2\n")
    assert spavision("render").is_one_sentence_about("OUTPUT")
    assert spavision("render", "out", "--crimp", "0.22").is_one_sentence_about("--crimp", "0.22")
    assert spavision("render", "out", "--trajectory", "gap.csv").is_one_sentence_about("gap.csv", "empty")
    assert spavision("render", "out", "--scene", "scene.toml").is_one_sentence_about(
        "scene.toml", "defocus_px"
    )
    assert spavision("render", "out", "--set", "seed=-1").is_one_sentence_about("seed")
    assert not (tmp_path / "out").exists()
