"""Each nuisance changes the picture as its name says; expected sizes come from its definition."""

import dataclasses

import cv2
import numpy as np
import pytest

from spavision.render.render import render_photo
from spavision.render.settings import Bump, Cover

from .scenes import QUIET, SMALL, path, settings, without_actuator


def pixels(scene, photo=0, trajectory=None):
    return render_photo(scene, trajectory or path(), photo).pixels


def linear(picture):
    """Undo sRGB's transfer curve (IEC 61966-2-1)."""
    v = picture / 255.0
    return np.where(v <= 0.04045, v / 12.92, ((v + 0.055) / 1.055) ** 2.4)


def red_area(picture):
    red = picture[:, :, 0].astype(int) - picture[:, :, 1:].max(axis=2)
    return int((red > 60).sum())


def test_photon_and_read_noise_have_the_asked_variance():
    sheet = (
        "board.columns=2",
        "board.rows=2",
        "board.square_mm=0.1",
        "board.margin_mm=400",
        "optics.blur_px=0",
    )
    quiet = ("board.mottle=0", "sensor.demosaic=none", "sensor.sharpening=0", "optics.vignetting=0")
    flat = (*SMALL, *sheet, *quiet, "light.gradient_x=0", "light.gradient_y=0")
    scene = dataclasses.replace(
        settings("sensor.full_well_e=1000", "sensor.read_noise_e=10", base=flat),
        actuator=without_actuator().actuator,
    )
    corner = linear(pixels(scene)[:60, :60, 1])
    signal_e = corner.mean() * 1000
    assert corner.std() * 1000 == pytest.approx(np.sqrt(signal_e + 100), rel=0.1)


@pytest.mark.parametrize("nuisance", ["optics.defocus_px=3", "optics.blur_px=2.5"])
def test_defocus_softens_the_squares(nuisance):
    sharp, soft = pixels(without_actuator()), pixels(without_actuator(nuisance))
    assert cv2.Laplacian(soft, cv2.CV_64F).std() < 0.3 * cv2.Laplacian(sharp, cv2.CV_64F).std()


def test_vignetting_takes_the_asked_share_in_the_corner():
    plain = linear(pixels(without_actuator("optics.vignetting=0")))
    dim = linear(pixels(without_actuator("optics.vignetting=0.5")))
    assert dim[:12, :12].sum() / plain[:12, :12].sum() == pytest.approx(0.5, abs=0.06)
    middle = np.s_[140:160, 190:210]
    assert dim[middle].sum() / plain[middle].sum() == pytest.approx(1.0, abs=0.02)


def test_white_balance_warm_light_reddens():
    warm, cold = (pixels(without_actuator(f"light.temperature_K={k}")) for k in (3200, 9000))
    ratio = [picture[:, :, 0].mean() / picture[:, :, 2].mean() for picture in (warm, cold)]
    assert ratio[0] > 1.3 * ratio[1]


def test_a_colour_filter_array_leaves_fringes():
    def fringes(method):
        scene = without_actuator()
        scene = dataclasses.replace(scene, sensor=dataclasses.replace(scene.sensor, demosaic=method))
        picture = pixels(scene).astype(float)
        return np.abs(picture[:, :, 0] - picture[:, :, 2]).mean()

    assert fringes("bilinear") > 2 * fringes("none")


def test_shadows_darken_and_a_hard_one_has_a_sharp_edge():
    none, soft = pixels(settings("light.shadow=0")), pixels(settings("light.shadow=0.8"))
    assert soft.mean() < none.mean()
    edge = ("light.edge_shadow=0.7", "light.edge_offset_mm=0", "light.edge_angle_deg=0")
    hard = linear(pixels(without_actuator(*edge, "light.edge_softness_mm=0.2")))
    plain = linear(pixels(without_actuator()))
    ratio = hard.sum(axis=(0, 2)) / plain.sum(axis=(0, 2))
    assert ratio[:150] == pytest.approx(np.ones(150), abs=0.05)
    assert ratio[260:] == pytest.approx(np.full(140, 0.3), abs=0.05)


def test_red_distractors_add_red():
    plain = red_area(pixels(settings()))
    sticker = ("clutter.red_sticker=true", "clutter.sticker_x_mm=30", "clutter.sticker_y_mm=55")
    assert red_area(pixels(settings(*sticker))) > 1.8 * plain
    wide = ("image.width_px=500", "camera.square_px=5", "camera.aim_y_mm=0")
    assert red_area(pixels(settings(*wide, "clutter.red_cable=true"))) > 5 * red_area(pixels(settings(*wide)))


def test_a_cable_crosses_the_board():
    plain = pixels(without_actuator())
    cable = pixels(without_actuator("clutter.cable=true", "clutter.cable_x_mm=-10"))
    changed = np.abs(plain.astype(int) - cable).max(axis=2) > 40
    assert changed.any(axis=1).all()  # from the top of the picture to the bottom


@pytest.mark.parametrize("fraction", [0.3, 0.5, 0.8])
def test_a_cover_hides_the_asked_share_of_the_dot(fraction):
    scene = settings()
    covered = dataclasses.replace(scene, covers=(Cover(photo=0, fraction=fraction, angle_deg=30.0),))
    left = red_area(pixels(covered)) / red_area(pixels(scene))
    assert left == pytest.approx(1 - fraction, abs=0.08)
    assert render_photo(covered, path(), 0).truth.hidden == pytest.approx(fraction)


def test_a_highlight_whitens_a_part_of_the_dot():
    assert red_area(pixels(settings("marker.highlight=1"))) < 0.95 * red_area(pixels(settings()))


def test_a_knock_moves_every_later_photo_and_no_earlier_one():
    scene = settings()
    bumped = dataclasses.replace(scene, bumps=(Bump(photo=1, dx_mm=9.0, yaw_deg=0.3),))
    trajectory = path((0, 0), (0, 0))
    first = [render_photo(s, trajectory, 0).truth.dot_px for s in (scene, bumped)]
    second = [render_photo(s, trajectory, 1).truth.dot_px for s in (scene, bumped)]
    assert first[0] == pytest.approx(first[1])
    assert np.linalg.norm(second[0] - second[1]) > 10


def test_motion_out_of_the_plane_brings_the_dot_nearer():
    flat, out = (render_photo(settings(), path((0, 0), out_of_plane=z), 0).truth for z in (0, 4))
    assert out.dot_mm[2] - flat.dot_mm[2] == pytest.approx(4)


def test_a_second_marker_and_other_colours():
    scene = settings(
        *SMALL, *QUIET, "camera.aim_y_mm=-80", "marker.base_marker=true", "marker.base_marker_colour=blue"
    )
    truth = render_photo(scene, path(), 0)
    x, y = np.rint(truth.truth.base_dot_px).astype(int)
    red, green, blue = truth.pixels[y, x].astype(int)
    assert blue > red + 60
    assert blue > green + 60


def test_a_grey_board_has_the_asked_contrast():
    grey = linear(pixels(without_actuator("board.white=0.45", "board.black=0.25", "optics.blur_px=0")))
    bright, dark = np.percentile(grey[:, :, 1], [95, 5])
    assert bright / dark == pytest.approx(0.45 / 0.25, rel=0.12)
