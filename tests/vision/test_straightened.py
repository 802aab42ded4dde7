"""A straightened photograph shows the dot where the renderer put it, in true millimetres."""

from dataclasses import replace

import cv2
import numpy as np
import pytest
from PIL import Image

from spavision.vision.straightened import straightened
from spavision.vision.track import track

PIXELS_A_MM = 6.0
DOT_MM = 4.5
X_RANGE_MM, Y_RANGE_MM = (-20.0, 75.0), (-30.0, 25.0)


def _red_disc_mm(picture):
    """Centroid of the roundest red patch of the dot's size, in the window's millimetres."""
    hsv = cv2.cvtColor(picture, cv2.COLOR_RGB2HSV)
    hue, saturation = hsv[..., 0].astype(int), hsv[..., 1]
    red = (((hue < 8) | (hue > 172)) & (saturation > 130)).astype(np.uint8)
    _, _, stats, centres = cv2.connectedComponentsWithStats(red)
    side, area = stats[1:, [cv2.CC_STAT_WIDTH, cv2.CC_STAT_HEIGHT]], stats[1:, cv2.CC_STAT_AREA]
    disc_px = DOT_MM * PIXELS_A_MM
    misfit = np.abs(side / disc_px - 1.0).sum(axis=1) + np.abs(area / (np.pi / 4 * disc_px**2) - 1.0)
    return (centres[1 + int(np.argmin(misfit))] + 0.5) / PIXELS_A_MM + [X_RANGE_MM[0], Y_RANGE_MM[0]]


def test_the_dot_lies_at_its_true_displacement_with_tilt_distortion_and_bumps(hard_set):
    found = track(hard_set.paths, hard_set.pressures_kPa, settings=hard_set.track_settings())
    for row in (0, 1):
        photo = np.asarray(Image.open(hard_set.paths[row]).convert("RGB"))
        picture = straightened(
            photo, found, row, x_range_mm=X_RANGE_MM, y_range_mm=Y_RANGE_MM, pixels_a_mm=PIXELS_A_MM
        )
        assert picture.shape == (330, 570, 3)
        # Expected: the renderer's own coordinates of the dot, whose parallax is 3 % of the displacement.
        assert _red_disc_mm(picture) == pytest.approx(hard_set.displacement_mm[row], abs=0.3)


def test_without_a_dot_anywhere_there_is_no_origin(plain_set):
    found = track(plain_set.paths[:1], [0.0], settings=plain_set.track_settings())
    blind = replace(found, readings=tuple(replace(reading, marker_mm=None) for reading in found.readings))
    photo = np.asarray(Image.open(plain_set.paths[0]).convert("RGB"))
    ranges = {"x_range_mm": X_RANGE_MM, "y_range_mm": Y_RANGE_MM, "pixels_a_mm": PIXELS_A_MM}
    assert straightened(photo, blind, 0, **ranges) is None
