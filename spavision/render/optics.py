"""The lens, distortion apart: blur, defocus and the loss of light towards the corners."""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from .settings import OpticsSettings

FloatImage = NDArray[np.float32]

DISC_SAMPLES = 9


def through_lens(light: FloatImage, optics: OpticsSettings) -> FloatImage:
    """Return the light on the sensor, shape (height, width, 3)."""
    image: NDArray[Any] = light
    if optics.defocus_px > 0:
        image = cv2.filter2D(image, -1, defocus_disc(optics.defocus_px), borderType=cv2.BORDER_REPLICATE)
    if optics.blur_px > 0:
        image = cv2.GaussianBlur(image, (0, 0), optics.blur_px, borderType=cv2.BORDER_REPLICATE)
    if optics.vignetting > 0:
        image = image * falloff(image.shape[0], image.shape[1], optics.vignetting)[:, :, None]
    return np.asarray(image, dtype=np.float32)


def defocus_disc(radius_px: float) -> FloatImage:
    """Return a disc of unit sum; the share of each tap is the share of its square inside the disc."""
    reach = int(np.ceil(radius_px + 0.5))
    fine = (np.arange(DISC_SAMPLES) + 0.5) / DISC_SAMPLES - 0.5
    steps = (np.arange(-reach, reach + 1)[:, None] + fine).ravel()
    inside = np.hypot(steps[:, None], steps) <= radius_px
    taps = inside.reshape(2 * reach + 1, DISC_SAMPLES, 2 * reach + 1, DISC_SAMPLES).sum(axis=(1, 3))
    return np.asarray(taps / taps.sum(), dtype=np.float32)


def falloff(height: int, width: int, loss: float) -> FloatImage:
    """Return the vignette: 1 in the centre, 1 - loss in the corners, by the fourth power of a cosine."""
    tangent2 = (1.0 - loss) ** -0.5 - 1.0
    y = (np.arange(height) - (height - 1) / 2)[:, None]
    x = np.arange(width) - (width - 1) / 2
    corner2 = (height**2 + width**2) / 4
    return np.asarray((1.0 + tangent2 * (x * x + y * y) / corner2) ** -2.0, dtype=np.float32)
