"""Photo files: formats, EXIF, determinism; scene files and the command line."""

import io
import json

import cv2
import numpy as np
import pytest
from PIL import ExifTags, Image, ImageOps

from spavision.errors import InputError
from spavision.experiment import read_experiment
from spavision.render.photo_file import photo_bytes
from spavision.render.photo_set import photo_name, photo_set
from spavision.render.render import render_photo
from spavision.render.scene_file import settings_from_table, settings_list, with_overrides
from spavision.render.settings import RenderSettings
from spavision.render.trajectory import sample_trajectory

from .scenes import path, settings


@pytest.mark.parametrize("orientation", range(1, 9))
def test_exif_orientation_turns_the_file_upright_again(orientation):
    scene = settings(f"image.orientation={orientation}", "image.format=png")
    picture = np.random.default_rng(3).integers(0, 256, (300, 400, 3), dtype=np.uint8)
    stored = Image.open(io.BytesIO(photo_bytes(picture, scene, photo=0)))
    assert np.array_equal(np.asarray(ImageOps.exif_transpose(stored)), picture)
    assert (orientation == 1) == np.array_equal(np.asarray(stored), picture)


@pytest.mark.parametrize("image_format", ["png", "tiff"])
def test_sixteen_bits_survive(image_format):
    scene = settings(f"image.format={image_format}", "image.bits=16")
    picture = np.random.default_rng(4).integers(0, 65536, (300, 400, 3), dtype=np.uint16)
    content = np.frombuffer(photo_bytes(picture, scene, photo=0), np.uint8)
    assert np.array_equal(cv2.imdecode(content, cv2.IMREAD_UNCHANGED)[:, :, ::-1], picture)


def test_exif_tells_the_focal_length_of_a_thin_lens():
    scene = settings("camera.square_px=12", "camera.distance_mm=750", "camera.sensor_width_mm=24")
    content = photo_bytes(np.zeros((300, 400, 3), np.uint8), scene, photo=5)
    exif = Image.open(io.BytesIO(content)).getexif()
    details = exif.get_ifd(ExifTags.IFD.Exif)
    # Image distance 12 px / 2.5 mm * 750 mm = 3600 px = 216 mm; 1/f = 1/216 + 1/750.
    assert float(details[ExifTags.Base.FocalLength]) == pytest.approx(1 / (1 / 216 + 1 / 750), abs=0.01)
    assert exif[ExifTags.Base.DateTime] == "2026:01:01 12:05:00"


def test_the_same_settings_give_the_same_bytes_and_another_seed_other_noise():
    scene = settings("sensor.noise=true")
    first, again = (dict(photo_set(scene, path((0, 0), (3, 0)))) for _ in range(2))
    assert first == again
    other = dict(photo_set(with_overrides(scene, ["seed=2"]), path((0, 0), (3, 0))))
    assert other["IMG_0000_000kPa.jpg"] != first["IMG_0000_000kPa.jpg"]


def test_a_set_holds_photos_truth_and_an_experiment_file(tmp_path):
    scene = settings("actuator.crimp_ratio=0.25")
    files = dict(photo_set(scene, path((0, 0), (8, -1))))
    assert list(files) == ["IMG_0000_000kPa.jpg", "IMG_0001_005kPa.jpg", "truth.json", "experiment.toml"]
    truth = json.loads(files["truth.json"])
    assert truth["photos"][1]["displacement_mm"] == pytest.approx([8, -1])
    assert "plane of the side face" in truth["plane"]
    (tmp_path / "experiment.toml").write_bytes(files["experiment.toml"])
    experiment = read_experiment(tmp_path / "experiment.toml")
    assert experiment.actuator.crimp_ratio == 0.25
    assert experiment.camera.standoff_mm == scene.actuator.standoff_mm
    assert photo_name(3, 7.5, "tiff") == "IMG_0003_7.5kPa.tif"


def test_sample_paths_pass_through_their_points():
    published = sample_trajectory(0.3, np.array([0.0, 40.0, 65.0]))
    assert published.ux_mm[:2] == pytest.approx([0, 71.25])  # the article, results
    assert sample_trajectory(0.2).ux_mm.max() == pytest.approx(17.5)  # the article, results
    with pytest.raises(InputError, match=r"--crimp 0\.22"):
        sample_trajectory(0.22)


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ({"optics": {"defocus": 2.0}}, "did you mean optics.defocus_px?"),
        ({"optik": {}}, "did you mean optics?"),
        ({"optics": {"blur_px": "wide"}}, "optics.blur_px: expected float"),
        ({"camera": {"k1": -9.0}}, "camera.k1: -9.0 is not between"),
        ({"image": {"format": "gif"}}, "gif"),
        ({"image": {"bits": 16}}, "JPEG holds 8 bits"),
        ({"bumps": [{"dx": 3.0}]}, "did you mean bumps[].dx_mm?"),
        ({"marker": {"colour": "reddish"}}, "reddish"),
        ({"camera": 3}, "camera is a section"),
    ],
)
def test_a_bad_scene_is_told_in_one_sentence(table, said):
    with pytest.raises(InputError) as caught:
        settings_from_table(table, source="scene.toml")
    assert "scene.toml" in str(caught.value)
    assert said in str(caught.value)


def test_overrides_reach_every_kind_of_setting():
    changed = with_overrides(
        RenderSettings(),
        ["optics.defocus_px=2", "marker.colour=blue", "bumps=[{photo=3, dx_mm=8}]", "seed=7"],
    )
    assert (changed.optics.defocus_px, changed.marker.colour, changed.seed) == (2.0, "blue", 7)
    assert changed.bumps[0].dx_mm == 8.0
    with pytest.raises(InputError, match="expected key=value"):
        with_overrides(RenderSettings(), ["optics.defocus_px"])


def test_every_setting_is_listed_with_its_meaning():
    names = {name for name, _, _, _ in settings_list()}
    assert {"optics.defocus_px", "bumps[].dx_mm", "seed", "sensor.read_noise_e"} <= names
    assert all(meaning for _, _, _, meaning in settings_list())


def test_photos_of_sixteen_bits_are_rendered_so():
    rendered = render_photo(settings("image.format=png", "image.bits=16"), path(), 0)
    assert rendered.pixels.dtype == np.uint16
    assert rendered.pixels.max() > 20_000
