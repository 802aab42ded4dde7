"""Photographs that do not belong to the series: told, and without harm to the others."""

from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from spavision.vision.suitable import set_aside_strangers
from spavision.vision.track import observe_photos, track

from .conftest import SMALL, choose, render_set

SQUARE_FRAME = choose(SMALL, image={"width_px": 560, "height_px": 560})


@pytest.fixture(scope="module")
def series(tmp_path_factory):
    """Three photos in a square frame, whose turned copies have the same size."""
    return render_set(tmp_path_factory.mktemp("series"), SQUARE_FRAME, (0, 20, 40))


def tracked_with(series, stranger, row):
    """Track the series with one photo replaced; the others must be as good as without it."""
    paths = [*series.paths]
    paths[row] = stranger
    result = track(paths, series.pressures_kPa, settings=series.track_settings())
    others = [k for k in range(3) if k != row]
    assert [result.tip_path.status[k] for k in others] == ["ok", "ok"]
    first, last = others
    measured = np.array([result.tip_path.ux_mm[last], result.tip_path.uy_mm[last]])
    assert measured == pytest.approx(series.displacement_mm[last] - series.displacement_mm[first], abs=0.04)
    assert result.tip_path.status[row] == "missing"
    return result.tip_path.reason[row]


@pytest.mark.parametrize(("row", "turn_deg"), [(1, 90), (1, 180), (0, 270)])
def test_a_turned_photo_of_the_same_size_is_told(series, tmp_path, row, turn_deg):
    path = tmp_path / "turned.png"
    with Image.open(series.paths[row]) as image:
        image.rotate(turn_deg, expand=True).save(path)  # anticlockwise
    assert f"turned by {turn_deg}° against most photos" in tracked_with(series, path, row)


def test_a_photo_with_another_board_pitch_is_told(series, tmp_path):
    other = render_set(tmp_path, choose(SQUARE_FRAME, camera={"square_px": 10.0}), (20,))
    reason = tracked_with(series, other.paths[0], 1)
    assert "px, most photos of 8.0 px: it is from another set-up" in reason


def test_a_photo_of_the_same_pitch_through_another_lens_is_told(series):
    seen = observe_photos(series.paths, settings=series.track_settings())
    lenses = [replace(o, focal_px=focal) for o, focal in zip(seen, (2000.0, 2400.0, 2010.0), strict=True)]
    kept, stranger, rounded = set_aside_strangers(lenses)
    assert kept is lenses[0]
    assert rounded is lenses[2]
    assert stranger.board is None
    assert "was taken at 1.19 times the focal length of most photos" in stranger.problem


def test_a_bump_that_nothing_on_the_board_can_tell_gives_no_reading(series, tmp_path):
    # The board fills the frame and the light is even: a shift by whole squares leaves no trace.
    moved = choose(SQUARE_FRAME, camera={"aim_x_mm": 31.0, "aim_y_mm": 12.0, "yaw_deg": 3.3})
    other = render_set(tmp_path, moved, (20,))
    assert "nothing tells by how many squares" in tracked_with(series, other.paths[0], 1)


def test_lengths_that_contradict_the_photos_are_told(series):
    settings = series.track_settings(marker_diameter_mm=3.5)
    notes = track(series.paths[:2], series.pressures_kPa[:2], settings=settings).notes
    assert any("the marker measures 4." in note and "against the 3.5 mm" in note for note in notes)
