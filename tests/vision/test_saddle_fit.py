"""Sub-pixel corners of drawn squares, whose place is known by construction."""

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter

from spavision.vision.saddle_fit import fit_saddles

FINE = 10
"""Samples a pixel and direction: pixels are the mean over their area. Upright edges lie at whole tenths."""


def drawn_corner(place, *, across, down, blur_px=0.0, size=31, levels=(30.0, 210.0)):
    """Pixels of four squares that meet at ``place``; edges along the lattice vectors."""
    steps = (np.arange(size * FINE) + 0.5) / FINE - 0.5
    x, y = np.meshgrid(steps - place[0], steps - place[1])
    inverse = np.linalg.inv(np.column_stack([across, down]))
    a, b = inverse[0, 0] * x + inverse[0, 1] * y, inverse[1, 0] * x + inverse[1, 1] * y
    picture = np.where(np.sign(a) * np.sign(b) > 0, levels[1], levels[0]).astype(float)
    if blur_px:
        picture = gaussian_filter(picture, blur_px * FINE)
    return picture.reshape(size, FINE, size, FINE).mean(axis=(1, 3)).astype(np.float32)


def found(picture, *, across, down, start=(15.0, 15.0)):
    vectors = (np.array([vector], dtype=float) for vector in (across, down))
    return fit_saddles(picture, np.array([start]), *vectors)[0]


@pytest.mark.parametrize("across", [(9.0, 0.0), (8.5, 2.5)])
@pytest.mark.parametrize("blur_px", [0.5, 1.5])
@pytest.mark.parametrize("place", [(15.0, 15.0), (15.2, 14.6), (14.5, 15.4)])
def test_the_place_does_not_depend_on_the_pixel_grid(across, blur_px, place):
    down = (-across[1], across[0])
    picture = drawn_corner(place, across=across, down=down, blur_px=blur_px)
    np.testing.assert_allclose(found(picture, across=across, down=down), place, atol=0.005)


def test_an_oblique_corner_stays_put():
    across, down, place = (10.0, 1.0), (3.0, 7.0), (15.3, 14.7)
    picture = drawn_corner(place, across=across, down=down, blur_px=0.7)
    np.testing.assert_allclose(found(picture, across=across, down=down), place, atol=0.005)


def test_a_tone_curve_does_not_move_the_corner():
    across, down, place = (9.0, 0.0), (0.0, 9.0), (15.3, 14.8)
    linear = drawn_corner(place, across=across, down=down, blur_px=0.8, levels=(0.04, 0.9))
    picture = (255.0 * linear ** (1 / 2.4)).astype(np.float32)
    np.testing.assert_allclose(found(picture, across=across, down=down), place, atol=0.005)


def test_noise_moves_corners_as_the_cramer_rao_bound_says():
    # An edge of contrast C, blur s and length l tells its place to sigma sqrt(2 sqrt(pi) s / l) / C
    # (Gaussian noise sigma a pixel). Each coordinate rests on one edge through the window, about 9 px.
    random, place, sigma, blur = np.random.default_rng(3), (15.2, 14.9), 15.0, 0.8
    across, down = (9.0, 0.0), (0.0, 9.0)
    clean = drawn_corner(place, across=across, down=down, blur_px=blur)
    noisy = (clean + random.normal(0, sigma, (200, *clean.shape))).astype(np.float32)
    error = np.array([found(picture, across=across, down=down) for picture in noisy]) - place
    bound = sigma * np.sqrt(2 * np.sqrt(np.pi) * blur / 9.0) / 180.0
    assert np.isfinite(error).all()
    assert bound < np.sqrt((error**2).mean()) < 1.6 * bound


def test_blank_paper_and_the_pictures_border_give_nothing():
    across, down = (9.0, 0.0), (0.0, 9.0)
    blank = np.full((31, 31), 128.0, np.float32)
    assert np.isnan(found(blank, across=across, down=down)).all()
    picture = drawn_corner((2.0, 15.0), across=across, down=down)
    assert np.isnan(found(picture, across=across, down=down, start=(2.0, 15.0))).all()
