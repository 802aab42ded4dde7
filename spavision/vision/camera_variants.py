"""Cameras that a calibrated one may be, by its covariance."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .arrays import FloatArray
from .bundle import PARAMETERS, parameter_values
from .camera import Camera

NEGLIGIBLE = 1e-12
"""Share of the variance below which a direction is rounding alone."""


def one_sigma_cameras(camera: Camera, covariance: FloatArray) -> tuple[Camera, ...]:
    """Return cameras one standard deviation off along each principal direction of the covariance.

    The directions are independent: squares of what each changes add up to a variance.

    Parameters
    ----------
    camera : Camera
        The calibrated camera.
    covariance : array, shape (9, 9)
        Of `spavision.vision.bundle.PARAMETERS`; zero where a parameter was held fixed.
    """
    sigma = np.sqrt(np.diag(covariance))
    scale = np.where(sigma > 0, sigma, 1.0)
    variances, directions = np.linalg.eigh(covariance / np.outer(scale, scale))
    steps = (scale[:, None] * directions * np.sqrt(np.maximum(variances, 0.0))).T
    return tuple(
        camera_with(camera, np.array(parameter_values(camera)) + step)
        for step, variance in zip(steps, variances, strict=True)
        if variance > NEGLIGIBLE * len(PARAMETERS)
    )


def camera_with(camera: Camera, values: FloatArray) -> Camera:
    """Return a camera with other values of `PARAMETERS`."""
    fx, fy, cx, cy, k1, k2, p1, p2, k3 = values.tolist()
    return replace(camera, fx=fx, fy=fy, cx=cx, cy=cy, distortion=(k1, k2, p1, p2, k3))
