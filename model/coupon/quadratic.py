"""Quadratic shape functions on a line and Gauss rules, of which quadrilaterals and beams are made."""

from __future__ import annotations

import numpy as np

from spavision.model.elements import FloatArray


def gauss_rule(points: int) -> tuple[FloatArray, FloatArray]:
    """Return Gauss points and weights on 0 to 1, each (points,)."""
    place, weight = np.polynomial.legendre.leggauss(points)
    return 0.5 * (place + 1.0), 0.5 * weight


def line_shapes(place: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return values and slopes of the three functions with nodes 0, 1/2, 1 at places (n,), each (n, 3)."""
    t = place
    values = np.stack([(2 * t - 1) * (t - 1), 4 * t * (1 - t), t * (2 * t - 1)], axis=1)
    slopes = np.stack([4 * t - 3, 4 - 8 * t, 4 * t - 1], axis=1)
    return values, slopes
