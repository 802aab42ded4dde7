"""Reading photographs: order, orientation, bit depth, EXIF, and files that are no photographs."""

import cv2
import numpy as np
import pytest
from PIL import ExifTags, Image

from spavision.errors import InputError, InputWarning
from spavision.vision.photos import find_photos, read_photo

GRADIENT = np.zeros((40, 60, 3), np.uint8)
GRADIENT[..., 0] = np.arange(60) * 4
GRADIENT[..., 1] = np.arange(40)[:, None] * 6


def stored_as(upright, orientation):
    """Pixels as a camera stores them so that EXIF ``orientation`` turns them into ``upright`` (TIFF 6.0)."""
    rot90 = np.rot90
    return {
        1: upright,
        2: upright[:, ::-1],
        3: rot90(upright, 2),
        4: upright[::-1],
        5: upright.transpose(1, 0, 2),
        6: rot90(upright, 1),
        7: rot90(upright, 2).transpose(1, 0, 2),
        8: rot90(upright, -1),
    }[orientation]


@pytest.mark.parametrize("orientation", range(1, 9))
def test_every_exif_orientation_comes_out_upright(tmp_path, orientation):
    exif = Image.Exif()
    exif[ExifTags.Base.Orientation] = orientation
    path = tmp_path / "a.png"
    Image.fromarray(np.ascontiguousarray(stored_as(GRADIENT, orientation))).save(path, exif=exif)
    np.testing.assert_array_equal(read_photo(path).rgb, GRADIENT)


@pytest.mark.parametrize("orientation", range(1, 9))
def test_sixteen_bits_are_turned_upright_too(tmp_path, orientation):
    deep = stored_as(GRADIENT.astype(np.uint16) * 257, orientation)
    exif = Image.Exif()
    exif[ExifTags.Base.Orientation] = orientation
    Image.new("L", (4, 4)).save(tmp_path / "donor.png", exif=exif)
    encoded = cv2.imencode(".png", np.ascontiguousarray(deep[..., ::-1]))[1].tobytes()
    chunk = (tmp_path / "donor.png").read_bytes()
    start = chunk.index(b"eXIf") - 4
    length = int.from_bytes(chunk[start : start + 4], "big") + 12
    header = 8 + 25  # signature and IHDR
    path = tmp_path / "deep.png"
    path.write_bytes(encoded[:header] + chunk[start : start + length] + encoded[header:])
    photo = read_photo(path)
    assert photo.rgb.shape == GRADIENT.shape
    # 236 * 257 needs all sixteen bits, so nothing is stretched.
    np.testing.assert_allclose(photo.rgb, GRADIENT, atol=1)


def test_grey_sixteen_bits_keep_their_depth(tmp_path):
    ramp = np.tile(np.linspace(0, 65535, 500).astype(np.uint16), (20, 1))
    path = tmp_path / "grey.tiff"
    cv2.imwrite(str(path), ramp)
    gray = read_photo(path).gray
    assert len(np.unique(gray)) == 500
    assert gray.max() == pytest.approx(255, abs=0.01)


def test_names_come_in_natural_order_and_other_files_are_left_alone(tmp_path):
    for name in ("p10.png", "p9.png", "p100.png"):
        Image.fromarray(GRADIENT).save(tmp_path / name)
    (tmp_path / "experiment.toml").write_text("")
    (tmp_path / ".hidden.png").write_text("")
    (tmp_path / "folder.png").mkdir()
    assert [path.name for path in find_photos(tmp_path)] == ["p9.png", "p10.png", "p100.png"]


def test_photographs_in_formats_that_are_not_read_are_told(tmp_path):
    Image.fromarray(GRADIENT).save(tmp_path / "p0.png")
    (tmp_path / "p5.HEIC").write_bytes(b"")
    with pytest.warns(InputWarning, match=r"p5\.HEIC .* convert"):
        assert [path.name for path in find_photos(tmp_path)] == ["p0.png"]


def test_a_folder_without_photographs_is_refused(tmp_path):
    with pytest.raises(InputError, match="no photograph"):
        find_photos(tmp_path)
    with pytest.raises(InputError, match="no such folder"):
        find_photos(tmp_path / "absent")


def test_a_truncated_jpeg_is_named(tmp_path):
    path = tmp_path / "cut.jpg"
    Image.fromarray(np.random.default_rng(0).integers(0, 255, (200, 200, 3), np.uint8)).save(path)
    path.write_bytes(path.read_bytes()[:4000])
    with pytest.raises(InputError, match=r"cut\.jpg is corrupt or truncated"):
        read_photo(path)


@pytest.mark.parametrize("content", [b"", b"no image at all", b"\xff\xd8\xff\xe0broken"])
def test_what_is_no_photograph_is_named(tmp_path, content):
    path = tmp_path / "fake.jpg"
    path.write_bytes(content)
    with pytest.raises(InputError, match=r"fake\.jpg"):
        read_photo(path)


def test_an_image_bomb_is_refused_before_it_is_decoded(tmp_path):
    path = tmp_path / "bomb.png"
    Image.new("1", (20000, 15000)).save(path)
    with pytest.raises(InputError, match=r"bomb\.png has 300 megapixels"):
        read_photo(path)


def test_the_focal_length_comes_from_exif(tmp_path):
    exif = Image.Exif()
    exif.get_ifd(ExifTags.IFD.Exif)[ExifTags.Base.FocalLengthIn35mmFilm] = 54
    path = tmp_path / "a.jpg"
    Image.new("RGB", (1200, 800)).save(path, exif=exif)
    # 54 mm on a frame 36 mm wide and 1200 px across.
    assert read_photo(path).focal_px == pytest.approx(54 / 36 * 1200)
