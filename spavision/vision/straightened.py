"""A photograph as seen from straight ahead, in millimetres of the marker's plane."""

from __future__ import annotations

from typing import cast

import numpy as np

from .arrays import FloatArray, FloatImage, RgbImage, sample
from .camera import project
from .result import Track

BEYOND_RGB = 255.0
"""White where the window reaches beyond the photograph."""


def straightened(
    photo_rgb: RgbImage,
    track: Track,
    row: int,
    *,
    x_range_mm: tuple[float, float],
    y_range_mm: tuple[float, float],
    pixels_a_mm: float,
) -> RgbImage | None:
    """Map a part of a photograph onto the plane of the marker, free of perspective and distortion.

    Parameters
    ----------
    photo_rgb : uint8 array, shape (height, width, 3)
        The upright photograph, or the overlay drawn on it.
    track : Track
    row : int
        Which of its readings the photograph is.
    x_range_mm, y_range_mm : tuple of float
        The part wanted, from the marker's place in the reference photograph, in the board's axes.
    pixels_a_mm : float
        Scale of the result.

    Returns
    -------
    uint8 array, shape (rows, columns, 3), or None
        None where the photograph shows no board, or no photograph shows the marker.
    """
    pose = track.readings[row].pose
    origin = next((reading.marker_mm for reading in track.readings if reading.marker_mm is not None), None)
    if pose is None or origin is None:
        return None
    x, y = (_pixel_centres(*span, pixels_a_mm) for span in (x_range_mm, y_range_mm))
    height_mm = (track.standoff_mm or 0.0) if track.parallax_factor != 1.0 else 0.0
    grid = np.stack(np.meshgrid(x + origin[0], y + origin[1]), axis=-1).reshape(-1, 2)
    points = np.column_stack([grid, np.full(len(grid), -height_mm)])
    places = project(track.camera, pose, points).reshape(len(y), len(x), 2)
    rgb = sample(cast(FloatImage, photo_rgb), places)
    height, width = photo_rgb.shape[:2]
    beyond = ((places < 0) | (places > [width - 1, height - 1])).any(axis=-1)
    rgb[beyond] = BEYOND_RGB
    return np.clip(np.rint(rgb), 0, 255).astype(np.uint8)


def _pixel_centres(low: float, high: float, pixels_a_mm: float) -> FloatArray:
    number = max(1, round((high - low) * pixels_a_mm))
    return np.asarray(low + (np.arange(number) + 0.5) / pixels_a_mm, dtype=np.float64)
