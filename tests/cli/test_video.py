"""``spavision track`` of a video with the times and pressures of its holds."""

import json

import cv2
import numpy as np
import pandas as pd
import pytest

from .conftest import A_FEW, SAMPLES


@pytest.fixture(scope="module")
def clip(tmp_path_factory):
    """Two sample photos, held for 2 s each in a video, with half a second of blur between."""
    first, last = (cv2.imread(str(SAMPLES / "crimp-0.20" / name)) for name in (A_FEW[0], A_FEW[2]))
    moving = cv2.addWeighted(first, 0.5, last, 0.5, 0.0)
    path = tmp_path_factory.mktemp("video") / "clip.avi"
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"MJPG"), 4.0, first.shape[1::-1])
    for frame in [first] * 8 + [moving] * 2 + [last] * 8:
        writer.write(frame)
    writer.release()
    return path


def test_a_video_is_read_at_its_holds(spavision, clip, tmp_path):
    (clip.parent / "experiment.toml").write_text((SAMPLES / "crimp-0.20" / "experiment.toml").read_text())
    (tmp_path / "holds.csv").write_text("time_s,pressure_kPa\n0,0\n2.5,40\n")
    outcome = spavision("track", clip, "--pressures", "holds.csv", "-o", "out")
    assert outcome.code == 0, outcome.err
    assert "2 holds found in holds.csv" in outcome.out
    table = pd.read_csv(tmp_path / "out" / "track.csv")
    truth = json.loads((SAMPLES / "crimp-0.20" / "truth.json").read_text())["photos"]
    expected = next(photo["displacement_mm"] for photo in truth if photo["photo"] == A_FEW[2])
    assert table["pressure_kPa"].tolist() == [0, 40]
    # The codec's loss comes on top of the photo's own: the bound for noisy photographs.
    assert np.abs(table[["ux_mm", "uy_mm"]].to_numpy()[1] - expected).max() < 0.1
    frames = sorted(path.name for path in (tmp_path / "out" / "frames").iterdir())
    assert table["photo"].tolist() == frames
    record = json.loads((tmp_path / "out" / "run.json").read_text())
    assert set(record["inputs"]) == {*frames, "clip.avi", "holds.csv", "experiment.toml"}
    assert f"frames/{frames[0]}" in record["files"]


def test_a_video_without_a_table_or_with_another_table_is_refused(spavision, clip, tmp_path):
    assert spavision("track", clip).is_one_sentence_about("clip.avi", "--pressures", "time_s")
    (tmp_path / "wrong.csv").write_text("photo,pressure_kPa\na.jpg,0\n")
    assert spavision("track", clip, "--pressures", "wrong.csv").is_one_sentence_about("wrong.csv", "time_s")
    (tmp_path / "holds.csv").write_text("time_s,pressure_kPa\n0,0\n2.5,40\n")
    assert spavision("track", "absent.mp4", "--pressures", "holds.csv").is_one_sentence_about("absent.mp4")
