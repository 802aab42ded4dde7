"""camera.toml: what is written is read, and what is wrong with a file is said in one sentence."""

import numpy as np
import pytest

from spavision.errors import InputError
from spavision.vision.bundle import PARAMETERS
from spavision.vision.calibration import Calibration
from spavision.vision.camera import Camera
from spavision.vision.camera_file import read_camera, write_camera
from spavision.vision.coverage import Coverage

CAMERA = Camera(1203.25, 1204.5, 640.125, 478.75, (-0.21, 0.07, 1e-4, -2e-4, 0.013), 1280, 960)


def covariance():
    factors = np.random.default_rng(1).standard_normal((9, 9)) * np.array([1, 1, 1, 1] + [1e-3] * 5)[:, None]
    return factors @ factors.T


def calibration(matrix):
    coverage = Coverage(np.ones((6, 8), dtype=np.intp), {}, np.zeros(3), np.zeros((3, 2)))
    return Calibration(CAMERA, matrix, 0.21, 0.15, (9, 6), (), (), coverage, ())


@pytest.fixture
def camera_file(tmp_path):
    path = tmp_path / "camera.toml"
    write_camera(path, calibration(covariance()))
    return path


def test_what_is_written_is_read(camera_file):
    found = read_camera(camera_file)
    assert found.camera == CAMERA
    assert found.rms_px == 0.21
    np.testing.assert_array_equal(found.covariance, covariance())


def test_a_fixed_parameter_has_no_uncertainty(tmp_path):
    matrix = covariance()
    matrix[8] = matrix[:, 8] = 0.0
    write_camera(tmp_path / "camera.toml", calibration(matrix))
    assert "k3 = 0.013  # fixed" in (tmp_path / "camera.toml").read_text(encoding="utf-8")
    np.testing.assert_array_equal(read_camera(tmp_path / "camera.toml").covariance, matrix)


def test_a_file_by_hand_needs_no_covariance(tmp_path):
    path = tmp_path / "camera.toml"
    path.write_text(
        "[image]\nwidth_px = 640\nheight_px = 480\n"
        "[intrinsics]\nfx_px = 536\nfy_px = 536\ncx_px = 320\ncy_px = 240\n"
        "[distortion]\nk1 = -0.2\nk2 = 0\np1 = 0\np2 = 0\n",
        encoding="utf-8",
    )
    found = read_camera(path)
    assert found.covariance is None
    assert found.camera == Camera(536, 536, 320, 240, (-0.2, 0, 0, 0, 0), 640, 480)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("fx_px = 1203.25", "", ("[intrinsics] fx_px is missing",)),
        ("[distortion]", "[lens]", ("[distortion] is missing",)),
        ("fx_px = 1203.25", 'fx_px = "wide"', ("[intrinsics] fx_px", "wide", "number")),
        ("fx_px = 1203.25", "fx_px = -3.0", ("[intrinsics] fx_px", "-3.0", "greater than 0")),
        ("fx_px = 1203.25", "fx_px = nan", ("[intrinsics] fx_px", "nan", "finite")),
        ("width_px = 1280", "width_px = 1280.5", ("[image] width_px", "integer")),
        ("cx_px = 640.125", "cx_px = 6401.25", ("principal point", "1280×960")),
        ("k3 = 0.013", "k3 = 0.013\nk4 = 0.2", ("unknown key [distortion] k4", "k1, k2, p1, p2, k3")),
        ('"fx_px", "fy_px"', '"fy_px", "fx_px"', ("[covariance] parameters", "in this order")),
        ("matrix = [\n", "matrix = [\n    [1.0, 2.0],\n", ("[covariance] matrix", "9 rows of 9")),
        ("[quality]", "[quality_of_lens]", ("unknown key [quality_of_lens]",)),
        ("[image]", "[image", ("not valid TOML",)),
    ],
)
def test_a_wrong_file_is_refused_in_one_sentence(camera_file, old, new, words):
    text = camera_file.read_text(encoding="utf-8")
    assert old in text
    camera_file.write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(InputError) as refusal:
        read_camera(camera_file)
    assert "\n" not in str(refusal.value)
    assert all(word in str(refusal.value) for word in ("camera.toml", *words)), str(refusal.value)


def test_a_covariance_must_be_symmetric(camera_file, tmp_path):
    matrix = covariance()
    matrix[0, 1] += 0.5 * np.sqrt(matrix[0, 0] * matrix[1, 1])
    write_camera(camera_file, calibration(matrix))
    with pytest.raises(InputError, match="not symmetric"):
        read_camera(camera_file)
    with pytest.raises(InputError, match="cannot be read"):
        read_camera(tmp_path / "absent.toml")


def test_the_parameters_are_opencvs_five_coefficient_model():
    assert PARAMETERS == ("fx_px", "fy_px", "cx_px", "cy_px", "k1", "k2", "p1", "p2", "k3")
