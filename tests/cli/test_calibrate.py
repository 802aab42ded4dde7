"""``spavision calibrate`` from photos to camera.toml, and its camera in the tracker."""

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from spavision.vision.camera import Camera, Pose, project
from spavision.vision.camera_file import read_camera

REAL = Path(__file__).resolve().parents[3] / "shared" / "data" / "photos" / "opencv_left"

SIZE = (480, 360)
TRUTH = Camera(560.0, 560.0, 239.5, 179.5, (-0.1, 0.0, 0.0, 0.0, 0.0), *SIZE)
SQUARES = (10, 7)


def draw_board(pose, enlarge=4):
    """Draw a board of 10 by 7 squares of 20 mm, each square a polygon; smoothed by scaling down."""
    import cv2

    large = TRUTH.scaled(enlarge)
    picture = np.full((large.height, large.width), 215, np.uint8)
    edge = np.linspace(0, 1, 6)[:-1]
    around = np.concatenate(
        [
            np.column_stack([edge, 0 * edge]),
            np.column_stack([1 + 0 * edge, edge]),
            np.column_stack([1 - edge, 1 + 0 * edge]),
            np.column_stack([0 * edge, 1 - edge]),
        ]
    )
    for column in range(SQUARES[0]):
        for row in range(SQUARES[1]):
            if (column + row) % 2 == 0:
                place = np.array([column, row]) - np.array(SQUARES) / 2
                outline = project(large, pose, (around + place) * 20.0)
                cv2.fillPoly(picture, [np.rint(outline * 16).astype(np.int32)], 35, cv2.LINE_AA, 4)
    small = Image.fromarray(picture).resize(SIZE, Image.Resampling.BOX)
    return small.convert("RGB")


POSES = (
    Pose((0.0, 0.0, 0.05), (0.0, 0.0, 330.0)),
    Pose((0.5, 0.0, 0.0), (30.0, 10.0, 340.0)),
    Pose((-0.5, 0.1, 0.1), (-30.0, -10.0, 340.0)),
    Pose((0.0, 0.5, 0.0), (20.0, 20.0, 340.0)),
    Pose((0.1, -0.5, 0.0), (-20.0, -20.0, 340.0)),
)


@pytest.fixture(scope="module")
def drawn(tmp_path_factory):
    folder = tmp_path_factory.mktemp("boards")
    for number, pose in enumerate(POSES):
        draw_board(pose).save(folder / f"p{number}.png")
    return folder


@pytest.fixture
def boards(drawn, tmp_path):
    """Return a folder of five photos of a board of 9 by 6 inner corners that the test may spoil."""
    folder = tmp_path / "boards"
    folder.mkdir()
    for path in drawn.iterdir():
        (folder / path.name).write_bytes(path.read_bytes())
    return folder


def test_a_run_leaves_camera_map_and_record(spavision, boards, tmp_path):
    outcome = spavision(
        "calibrate", boards, "--corners", "9x6", "--square-mm", "20", "--fix-aspect-ratio", "--zero-k3"
    )
    assert outcome.code == 0, outcome.err
    assert "fx_px" in outcome.out
    assert "5 photos are few" in outcome.out
    folder = tmp_path / "results" / "calibrate-boards"
    written = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}
    assert written == {"camera.toml", "figures/coverage.png", "run.json"}
    found = read_camera(folder / "camera.toml")
    sigma_fx, sigma_k1 = np.sqrt(np.diag(found.covariance))[[0, 4]]
    # Truth: the camera that the board was drawn with.
    assert abs(found.camera.fx - TRUTH.fx) < max(3 * sigma_fx, 0.5)
    assert abs(found.camera.distortion[0] + 0.1) < max(3 * sigma_k1, 0.01)
    record = json.loads((folder / "run.json").read_text(encoding="utf-8"))
    assert record["inputs"].keys() == {f"p{k}.png" for k in range(5)}
    assert record["settings"]["model"]["zero_k3"] is True
    assert record["calibration"]["parameters"]["k3"] == 0
    assert "opencv-python-headless" in record["versions"]


def test_json_gives_the_camera_and_names_what_was_left_out(spavision, boards):
    (boards / "broken.jpg").write_bytes(b"no picture")
    Image.new("RGB", SIZE, (90, 90, 90)).save(boards / "blank.png")
    outcome = spavision("calibrate", boards, "--json")
    assert outcome.code == 0, outcome.err
    result = json.loads(outcome.out)
    assert result["board_corners"] == [9, 6]
    assert {entry["photo"] for entry in result["left_out"]} == {"blank.png", "broken.jpg"}
    assert np.array(result["covariance"]).shape == (9, 9)
    assert len(result["photos"]) == 5


def test_bad_options_are_refused(spavision, boards):
    def refuses(*words, options):
        outcome = spavision("calibrate", boards, *options)
        assert outcome.is_one_sentence_about(*words), outcome.err

    refuses("--square-mm", "above 0", options=("--square-mm=-25",))
    refuses("--square-mm", options=("--square-mm", "nan"))
    refuses("--corners", "9x6", options=("--corners", "nine"))
    refuses("--corners", "3 to 1000", options=("--corners", "2x6"))
    refuses("--finder opencv", "--corners", options=("--finder", "opencv"))
    refuses("p0.png", "9×6", "8×5", "--corners", options=("--corners", "8x5"))
    refuses("--corners", "10x7", "9×6", options=("--corners", "10x7"))


def test_bad_folders_are_refused(spavision, boards, tmp_path):
    assert spavision("calibrate", tmp_path / "absent").is_one_sentence_about("absent", "no such folder")
    (boards / "p3.png").unlink()
    (boards / "p4.png").unlink()
    (boards / "p2.png").unlink()
    outcome = spavision("calibrate", boards)
    assert outcome.is_one_sentence_about("2 of 2", "3 or more"), outcome.err
    assert not (tmp_path / "results").exists()
    Image.new("RGB", (360, 480)).save(boards / "upright.png")
    outcome = spavision("calibrate", boards)
    assert outcome.is_one_sentence_about("upright.png", "360×480", "480×360"), outcome.err
    for photo in boards.iterdir():
        Image.new("RGB", SIZE, (90, 90, 90)).save(photo)
    assert spavision("calibrate", boards).is_one_sentence_about("no board")


def test_an_output_in_use_is_kept(spavision, boards, tmp_path):
    taken = tmp_path / "taken"
    taken.mkdir()
    (taken / "notes.txt").write_text("mine", encoding="utf-8")
    assert spavision("calibrate", boards, "-o", taken).is_one_sentence_about("--force")
    assert spavision("calibrate", boards, "-o", taken, "--force", "-q").code == 0
    assert (taken / "notes.txt").read_text(encoding="utf-8") == "mine"


SAMPLE_CAMERA = """[image]
width_px = {width}
height_px = 960
[intrinsics]
fx_px = 3000.0
fy_px = 3000.0
cx_px = 639.5
cy_px = 479.5
[distortion]
k1 = -0.12
k2 = 0
p1 = 0
p2 = 0
"""
"""The camera of the sample photos, as their truth.json has it."""


def test_the_tracker_takes_a_calibrated_camera(spavision, photos):
    (photos / "camera.toml").write_text(SAMPLE_CAMERA.format(width=1280), encoding="utf-8")
    text = (photos / "experiment.toml").read_text(encoding="utf-8")
    text = text.replace("distance_mm = 750.0", 'file = "camera.toml"')
    (photos / "experiment.toml").write_text(text, encoding="utf-8")
    outcome = spavision("track", photos, "--json", "-o", "tracked")
    assert outcome.code == 0, outcome.err
    track = json.loads(outcome.out)["track"]
    assert track["camera_distance_source"] == "calibration"
    # Truth: 750 mm from camera to board.
    assert track["camera_distance_mm"] == pytest.approx(750.0, abs=0.5)
    assert track["focal_length_px"] == [3000.0, 3000.0]


def test_a_camera_of_another_size_is_refused_by_the_tracker(spavision, photos, tmp_path):
    other = tmp_path / "other.toml"
    other.write_text(SAMPLE_CAMERA.format(width=1920), encoding="utf-8")
    outcome = spavision("track", photos, "--camera", other)
    assert outcome.is_one_sentence_about("1920×960", "1280×960"), outcome.err
    assert spavision("track", photos, "--camera", "absent.toml").is_one_sentence_about("absent.toml")


@pytest.mark.skipif(not REAL.is_dir(), reason="needs ../shared/data/photos/opencv_left")
def test_real_photos_from_the_command_line(spavision):
    # left_intrinsics.yml beside the photos: fx 535.916, RMS 0.3926 px.
    options = ("--corners", "9x6", "--square-mm", "25", "--fix-aspect-ratio", "--json")
    outcome = spavision("calibrate", REAL, *options)
    assert outcome.code == 0, outcome.err
    result = json.loads(outcome.out)
    assert result["parameters"]["fx_px"] == pytest.approx(535.916, abs=0.3)
    assert result["rms_px"] == pytest.approx(0.3926, abs=0.002)
