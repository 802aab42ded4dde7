"""Shapes measured in sample photographs and renders against their truth; when there must be none."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from spavision.render.photo_set import photo_set
from spavision.render.scene_file import with_overrides
from spavision.render.settings import RenderSettings
from spavision.render.trajectory import Trajectory, sample_trajectory
from spavision.vision.photos import read_photo
from spavision.vision.result import Track
from spavision.vision.settings import TrackSettings
from spavision.vision.shape import ActuatorShape, ShapeReading, shape_of, shape_pixels
from spavision.vision.shape_series import SHAPE_COLUMNS, agreeing_shapes, shape_notes, shape_table
from spavision.vision.track import track

SAMPLES = Path(__file__).parents[2] / "sample_images" / "crimp-0.30"
BODY_WIDTH_MM = 15.0
REST_LENGTH_MM = 157.5


@cache
def _measured(
    folder: Path, names: tuple[str, ...], square_mm: float = 2.5
) -> tuple[Track, list[ShapeReading]]:
    truth = json.loads((folder / "truth.json").read_text())
    pressures = [photo["pressure_kPa"] for photo in truth["photos"] if photo["photo"] in names]
    settings = TrackSettings(
        square_mm=square_mm,
        standoff_mm=truth["standoff_mm"],
        distance_mm=truth["settings"]["camera"]["distance_mm"],
    )
    found = track([folder / name for name in names], pressures, settings=settings)
    shapes = [
        shape_of(read_photo(folder / r.photo).rgb, r, found, body_width_mm=BODY_WIDTH_MM)
        for r in found.readings
    ]
    return found, shapes


def _samples() -> tuple[Track, list[ShapeReading]]:
    names = ("IMG_0000_000kPa.jpg", "IMG_0008_040kPa.jpg", "IMG_0013_065kPa.jpg")
    return _measured(SAMPLES, names)


def _errors(folder: Path, found: Track, row: int, shape: ActuatorShape) -> tuple[float, float]:
    """Largest distance from the true centre line, mm, and error of the tip's angle, degrees.

    The tracker's origin is an arbitrary corner of the board, so both frames are laid on the dot.
    """
    photos = json.loads((folder / "truth.json").read_text())["photos"]
    true = next(photo for photo in photos if photo["photo"] == found.readings[row].photo)
    line = np.array(true["centre_line_mm"])
    marker = found.readings[row].marker_mm
    assert marker is not None
    points = shape.points_mm[1:-1] - marker + np.array(true["dot_mm"][:2])
    start, step = line[:-1], np.diff(line, axis=0)
    share = ((points[:, None] - start) * step).sum(axis=2) / (step**2).sum(axis=1)
    nearest = start + np.clip(share, 0.0, 1.0)[..., None] * step
    distance = np.linalg.norm(points[:, None] - nearest, axis=2).min(axis=1)
    return float(distance.max()), abs(shape.tip_angle_deg - true["tip_angle_deg"])


def _render(folder: Path, pressure_kPa: float, *overrides: str) -> tuple[Track, ShapeReading]:
    small = ("camera.square_px=7.0", "image.width_px=896", "image.height_px=672")
    settings = with_overrides(RenderSettings(seed=8), [*small, *overrides])
    path = sample_trajectory(0.3, np.array([pressure_kPa]))
    sign = 1.0 if settings.actuator.first_bend == "right" else -1.0
    path = Trajectory(path.pressure_kPa, sign * path.ux_mm, path.uy_mm, path.uz_mm)
    names = []
    for name, content in photo_set(settings, path):
        (folder / name).write_bytes(content)
        names += [name] if name.startswith("IMG") else []
    found, shapes = _measured(folder, tuple(names))
    return found, shapes[0]


@pytest.mark.parametrize("row", [0, 1, 2])
def test_centre_line_and_tip_angle_are_those_of_the_sample_photographs(row: int) -> None:
    found, shapes = _samples()
    shape = shapes[row].shape
    assert shape is not None, shapes[row].reason
    distance, angle = _errors(SAMPLES, found, row, shape)
    assert distance < 0.3
    assert angle < 0.5


def test_a_light_body_that_bends_left_in_a_hard_shadow_is_read(tmp_path: Path) -> None:
    found, reading = _render(
        tmp_path,
        40.0,
        'actuator.first_bend="left"',
        'actuator.body_colour="#9a9a96"',
        "light.size=0.03",
        "light.shadow=0.8",
        "clutter.cable=true",
        "clutter.cable_x_mm=45.0",
    )
    assert reading.shape is not None, reading.reason
    distance, angle = _errors(tmp_path, found, 0, reading.shape)
    assert distance < 0.3
    assert angle < 0.5


def test_no_shape_where_the_clamp_is_out_of_view(tmp_path: Path) -> None:
    _, reading = _render(tmp_path, 0.0, "camera.aim_y_mm=45.0")
    assert reading.shape is None
    assert "clamp" in reading.reason


def test_no_shape_without_a_marker() -> None:
    found, _ = _samples()
    blind = replace(found.readings[0], marker_mm=None, marker_px=None)
    photo = read_photo(SAMPLES / blind.photo).rgb
    assert shape_of(photo, blind, found, body_width_mm=BODY_WIDTH_MM).shape is None


def test_no_shape_where_the_marker_lies_on_bare_board() -> None:
    found, _ = _samples()
    astray = replace(found.readings[0], marker_mm=found.readings[0].marker_mm + np.array([60.0, 0.0]))
    reading = shape_of(read_photo(SAMPLES / astray.photo).rgb, astray, found, body_width_mm=BODY_WIDTH_MM)
    assert reading.shape is None
    assert "marker" in reading.reason


def test_table_is_laid_on_the_marker_of_the_reference_photograph() -> None:
    found, shapes = _samples()
    table = shape_table(shapes, found)
    assert list(table.columns) == SHAPE_COLUMNS
    for reading, ux, uy in zip(shapes, found.tip_path.ux_mm, found.tip_path.uy_mm, strict=True):
        rows = table[table["photo"] == reading.photo]
        away = np.hypot(rows["x_mm"] - ux, rows["y_mm"] - uy)
        # The dot lies 1.5 mm beside the centre line and 5 mm from the tip (truth.json, settings.marker).
        assert away.min() < 2.5
        assert away.idxmin() >= rows.index[-4]


def test_centre_line_is_drawn_through_the_body() -> None:
    found, shapes = _samples()
    shape, reading = shapes[1].shape, found.readings[1]
    assert shape is not None
    pixels = np.rint(shape_pixels(shape, reading, found)).astype(int)[2:-4]
    colours = read_photo(SAMPLES / reading.photo).rgb[pixels[:, 1], pixels[:, 0]].astype(int)
    assert (colours[:, 1] > colours[:, 0] + 20).all()  # The sample's body is green, #4d9a4f.


def test_wrong_square_size_is_given_away_by_the_length() -> None:
    _, right = _samples()
    assert shape_notes(right, expected_length_mm=REST_LENGTH_MM) == ()
    _, wrong = _measured(SAMPLES, ("IMG_0000_000kPa.jpg",), square_mm=3.0)
    notes = shape_notes(wrong, expected_length_mm=REST_LENGTH_MM)
    assert len(notes) == 1
    assert "--square-mm" in notes[0]


def test_a_shape_that_starts_elsewhere_is_taken_back() -> None:
    _, shapes = _samples()
    good = shapes[0].shape
    assert good is not None
    stray = replace(good, points_mm=good.points_mm + np.array([0.0, 12.0]))
    series = [*shapes, ShapeReading("stray.jpg", 70.0, stray, "")]
    agreed = agreeing_shapes(series)
    assert [reading.shape is not None for reading in agreed] == [True, True, True, False]
    assert "starts elsewhere" in agreed[-1].reason
    assert "stray.jpg" in shape_notes(agreed, expected_length_mm=REST_LENGTH_MM)[-1]
