"""Radial-tangential lens distortion (OpenCV's published formula) and its inverse, compiled."""

from __future__ import annotations

from numba import njit

NEWTON_STEPS = 12
CONVERGED = 1e-13


@njit(cache=True)
def distort(x, y, k):  # type: ignore[no-untyped-def]
    """Distort a normalised image point.

    Parameters
    ----------
    x, y : float
        Point on the plane one unit in front of the camera.
    k : array, shape (5,)
        k1, k2, p1, p2, k3 (OpenCV's order).

    Returns
    -------
    x, y : float
        The distorted point.
    """
    r2 = x * x + y * y
    radial = 1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]))
    dx = 2.0 * k[2] * x * y + k[3] * (r2 + 2.0 * x * x)
    dy = k[2] * (r2 + 2.0 * y * y) + 2.0 * k[3] * x * y
    return x * radial + dx, y * radial + dy


@njit(cache=True)
def undistort(x_distorted, y_distorted, k, x, y):  # type: ignore[no-untyped-def]
    """Invert `distort` by Newton's method, starting from (x, y)."""
    for _ in range(NEWTON_STEPS):
        r2 = x * x + y * y
        radial = 1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]))
        slope = 2.0 * (k[0] + r2 * (2.0 * k[1] + 3.0 * r2 * k[4]))
        fx, fy = distort(x, y, k)
        ex, ey = fx - x_distorted, fy - y_distorted
        if ex * ex + ey * ey < CONVERGED * CONVERGED:
            break
        a = radial + slope * x * x + 2.0 * k[2] * y + 6.0 * k[3] * x
        b = slope * x * y + 2.0 * k[2] * x + 2.0 * k[3] * y
        d = radial + slope * y * y + 6.0 * k[2] * y + 2.0 * k[3] * x
        determinant = a * d - b * b
        if abs(determinant) < 1e-6:
            break
        x -= (d * ex - b * ey) / determinant
        y -= (a * ey - b * ex) / determinant
    return x, y
