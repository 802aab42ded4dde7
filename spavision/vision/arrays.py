"""Array types of the vision modules, and the few image operations they share."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.intp]
BoolArray = NDArray[np.bool_]
FloatImage = NDArray[np.float32]
"""Grey levels or colours as float32, 0 to 255: shape (height, width) or (height, width, 3)."""
RgbImage = NDArray[np.uint8]

MOST_REMAP_ROWS = 30_000
"""OpenCV's remap takes at most 32 767 rows."""


def blur(image: FloatImage, sigma_px: float) -> FloatImage:
    """Return the image smoothed by a Gaussian."""
    return np.asarray(cv2.GaussianBlur(image, (0, 0), sigma_px), dtype=np.float32)


def shrink(image: FloatImage, factor: float) -> FloatImage:
    """Return the image scaled by ``factor`` below 1, pixel areas averaged; `shrunk_place` maps positions."""
    if factor >= 1.0:
        return image
    return np.asarray(
        cv2.resize(image, None, fx=factor, fy=factor, interpolation=cv2.INTER_AREA), dtype=np.float32
    )


def shrunk_place(pixels: FloatArray, factor: float) -> FloatArray:
    """Return where pixel positions of an image lie after it has been scaled by ``factor``."""
    return (pixels + 0.5) * factor - 0.5


def sample(image: FloatImage, points: FloatArray) -> FloatImage:
    """Return bilinear samples at points of shape (n, m, 2): shape (n, m) or (n, m, colours).

    Outside the image the nearest border pixel counts.
    """
    places = np.clip(points, -1e6, 1e6).astype(np.float32)
    x, y = np.ascontiguousarray(places[..., 0]), np.ascontiguousarray(places[..., 1])
    parts = [
        cv2.remap(
            image,
            x[k : k + MOST_REMAP_ROWS],
            y[k : k + MOST_REMAP_ROWS],
            cv2.INTER_LINEAR,
            borderMode=cv2.BORDER_REPLICATE,
        )
        for k in range(0, len(x), MOST_REMAP_ROWS)
    ]
    if not parts:
        return np.zeros((*x.shape, *image.shape[2:]), np.float32)
    return np.asarray(np.concatenate(parts), dtype=np.float32)
