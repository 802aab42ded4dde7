"""The marker's disc: placed without bias, and as uncertain as it says, whatever the noise is like."""

import cv2
import numpy as np
import pytest
from scipy.special import erf

from spavision.vision.board import BoardView
from spavision.vision.camera import Camera, Pose, project
from spavision.vision.circle import fit_circle
from spavision.vision.disc import fit_disc

SIZE_PX = 64
PITCH_PX = 10.0
CENTRE_PX = np.array([31.3, 32.6])
RADIUS_PX = 9.0
CAMERA = Camera(1000.0, 1000.0, 31.5, 31.5, (0.0,) * 5, SIZE_PX, SIZE_PX)
BOARD = BoardView(
    indices=np.zeros((0, 2), dtype=np.intp),
    pixels=np.zeros((0, 2)),
    camera=CAMERA,
    pose=Pose((0.0, 0.0, 0.0), (0.0, 0.0, 1000.0 / PITCH_PX)),
    rms_px=0.0,
    pitch_px=PITCH_PX,
    contrast=100.0,
)


def picture(noise):
    """A red disc on green with an edge blurred by one pixel, in the noise that is given."""
    columns, rows = np.meshgrid(np.arange(SIZE_PX), np.arange(SIZE_PX))
    distance = np.hypot(columns - CENTRE_PX[0], rows - CENTRE_PX[1])
    share = 0.5 * (1.0 - erf((distance - RADIUS_PX) / np.sqrt(2.0)))[..., None]
    clean = share * np.array([200.0, 30.0, 30.0]) + (1.0 - share) * np.array([70.0, 150.0, 80.0])
    return (clean + noise).astype(np.float32)


def rough_circle():
    """Points about the disc, a little off, as the rays of a rim would give them."""
    angle = np.linspace(0.0, 2.0 * np.pi, 96, endpoint=False)
    ring = CENTRE_PX + 0.4 + RADIUS_PX * np.column_stack([np.cos(angle), np.sin(angle)])
    return fit_circle((ring - 31.5) / PITCH_PX)


def centre_px(disc):
    return project(CAMERA, BOARD.pose, disc.centre[None])[0]


def test_a_clean_disc_is_where_it_was_put():
    disc = fit_disc(picture(0.0), BOARD, rough_circle())
    assert centre_px(disc) == pytest.approx(CENTRE_PX, abs=1e-3)
    assert disc.radius * PITCH_PX == pytest.approx(RADIUS_PX, abs=0.01)


@pytest.mark.parametrize("correlation_px", [0.0, 1.2])
def test_the_stated_sigma_is_the_scatter_of_the_centre(correlation_px):
    # White noise, and noise that neighbouring pixels share (demosaicing, JPEG), of about the same size.
    random = np.random.default_rng(3)
    centres, stated = [], []
    for _ in range(60):
        noise = random.normal(0.0, 8.0, (SIZE_PX, SIZE_PX, 3))
        if correlation_px:
            noise = 4.0 * cv2.GaussianBlur(noise, (0, 0), correlation_px)
        disc = fit_disc(picture(noise), BOARD, rough_circle())
        centres.append(centre_px(disc))
        stated.append(disc.sigma_px)
    scatter = np.sqrt(np.mean((np.array(centres) - CENTRE_PX) ** 2))
    assert np.sqrt(np.mean(np.square(stated))) == pytest.approx(scatter, rel=0.25)
