"""From rim pixels to the marker's place in its plane."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .arrays import FloatArray
from .camera import to_plane
from .circle import Circle, fit_circle
from .scale import CameraFit

LEAST_COVERAGE_OK = 0.8
LEAST_COVERAGE = 0.3
ROUND_ENOUGH = 0.12
RADIUS_TOLERANCE = 0.06


@dataclass(frozen=True)
class Place:
    """The marker in one photograph.

    Parameters
    ----------
    circle : Circle
        Circle through its rim in the marker's plane, mm.
    station : int
        Camera position.
    centre_px : array, shape (2,)
        Projection of the circle's centre.
    partial : bool
        Whether too little of the rim is seen for a free radius.
    rim_px : array, shape (n, 2)
        Edge points, NaN where a ray shows no edge; empty where a person gave the centre.
    disc_sigma_px : float or None
        Standard uncertainty of the disc fitted to the marker's pixels; None where edge points alone speak.
    by_hand_sigma_px : float or None
        Standard uncertainty of a centre that a person gave; None for a measured one.
    """

    circle: Circle
    station: int
    centre_px: FloatArray
    partial: bool
    rim_px: FloatArray
    disc_sigma_px: float | None = None
    by_hand_sigma_px: float | None = None


def common_radius_mm(rims: list[FloatArray | None]) -> float | None:
    """Median radius of the rims that are seen whole."""
    whole = [circle.radius for rim in rims if rim is not None and (circle := _whole(rim)) is not None]
    return float(np.median(whole)) if whole else None


def fit_place(rim_mm: FloatArray, radius_mm: float | None) -> tuple[Circle, bool] | None:
    """Fit the marker's circle: free radius for a whole rim, the known one for a part; None if neither fits.

    Returns
    -------
    circle : Circle
    partial : bool
    """
    circle = _whole(rim_mm)
    if circle is not None and (radius_mm is None or abs(circle.radius / radius_mm - 1.0) < RADIUS_TOLERANCE):
        return circle, False
    if radius_mm is None:
        return None
    circle = fit_circle(rim_mm, radius=radius_mm)
    if circle is None or circle.coverage < LEAST_COVERAGE or circle.rms > ROUND_ENOUGH * radius_mm:
        return None
    return circle, True


def rim_in_plane(fit: CameraFit, station: int, rim_px: FloatArray, standoff_mm: float) -> FloatArray:
    """Edge points in the marker's plane, mm; NaN stays NaN."""
    points = np.full_like(rim_px, np.nan)
    found = np.isfinite(rim_px).all(axis=1)
    adjustment = fit.adjustment
    points[found] = to_plane(
        adjustment.camera, adjustment.poses[station], rim_px[found], standoff_mm=standoff_mm
    )
    return points


def _whole(rim_mm: FloatArray) -> Circle | None:
    circle = fit_circle(rim_mm)
    if circle is None or circle.coverage < LEAST_COVERAGE_OK or circle.rms > ROUND_ENOUGH * circle.radius:
        return None
    return circle
