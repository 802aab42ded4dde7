"""From rim pixels to the marker's place in its plane, and the budget of its uncertainty."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .adjustment import N_INTRINSIC, distance_gradient, perturbed
from .arrays import FloatArray
from .camera import to_plane
from .circle import Circle, fit_circle
from .scale import CameraFit
from .settings import TrackSettings

LEAST_COVERAGE_OK = 0.8
LEAST_COVERAGE = 0.3
ROUND_ENOUGH = 0.12
RADIUS_TOLERANCE = 0.06
RADIUS_SIGMA = 0.015
"""Relative uncertainty of the known radius that a partly hidden rim is fitted with."""

RIM_FLOOR_PX = 0.02
"""Systematic part of a rim's centre: shading, pixel grid, compression."""

BUDGET_NAMES = ("marker", "corners and camera", "distance", "stand-off", "print scale", "out of plane")


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


@dataclass(frozen=True)
class BudgetEntry:
    """One source of uncertainty.

    Parameters
    ----------
    name : str
        One of `BUDGET_NAMES`.
    basis : str
        What the entry rests on, with the stated default where it is one.
    sigma_ux_mm, sigma_uy_mm : array, shape (photographs,)
        Its effect on each displacement, one standard deviation; NaN without a reading.
    """

    name: str
    basis: str
    sigma_ux_mm: FloatArray
    sigma_uy_mm: FloatArray


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


def uncertainty_budget(
    places: Sequence[Place | None],
    reference: Place,
    fit: CameraFit,
    settings: TrackSettings,
    standoff_mm: float,
) -> tuple[BudgetEntry, ...]:
    """Return the standard uncertainty of each displacement, source by source."""
    n = len(places)
    sigma = {name: np.full((n, 2), np.nan) for name in BUDGET_NAMES}
    for row, place in enumerate(places):
        if place is None:
            continue
        for name, value in _entries(place, reference, fit, settings, standoff_mm).items():
            sigma[name][row] = value
    marker = f"scatter of the rim's edge points, and {RIM_FLOOR_PX:g} px of systematic error"
    if any(place is not None and place.by_hand_sigma_px is not None for place in places):
        marker += f"; ±{settings.sigma_by_hand_px:g} px where the centre was given by hand"
    basis = {
        "marker": marker,
        "corners and camera": f"scatter of the board's corners, {fit.adjustment.sigma_px:.3f} px",
        "distance": f"±{fit.priors.sigma_distance_mm or 0:g} mm on the measured distance",
        "stand-off": f"±{settings.sigma_standoff_mm:g} mm",
        "print scale": f"±{100 * settings.sigma_board_scale:g} %",
        "out of plane": f"±{settings.sigma_out_of_plane_mm:g} mm of motion towards the camera",
    }
    return tuple(
        BudgetEntry(name, basis[name], sigma[name][:, 0], sigma[name][:, 1]) for name in BUDGET_NAMES
    )


def _whole(rim_mm: FloatArray) -> Circle | None:
    circle = fit_circle(rim_mm)
    if circle is None or circle.coverage < LEAST_COVERAGE_OK or circle.rms > ROUND_ENOUGH * circle.radius:
        return None
    return circle


def _entries(
    place: Place, reference: Place, fit: CameraFit, settings: TrackSettings, standoff_mm: float
) -> dict[str, FloatArray]:
    """Sigma of ux and uy of one reading by each source."""
    zero = np.zeros(2)
    if place is reference:
        return dict.fromkeys(BUDGET_NAMES, zero)
    displacement = place.circle.centre - reference.circle.centre
    slope = _slope(place, reference, fit, standoff_mm)
    covariance = fit.adjustment.covariance
    distance = zero
    if fit.priors.sigma_distance_mm is not None:
        # Share of the adjustment's covariance that comes from the measured distance alone.
        gain = np.zeros(len(covariance))
        gain[N_INTRINSIC : N_INTRINSIC + 6] = distance_gradient(fit.adjustment.poses[0])
        distance = np.abs(slope @ covariance @ gain) / fit.priors.sigma_distance_mm
    total = np.diag(slope @ covariance @ slope.T)
    pose = fit.adjustment.poses[place.station]
    towards = (place.circle.centre - pose.centre_mm[:2]) / (pose.distance_mm - standoff_mm)
    step = 0.1
    moved = _displacement(place, reference, fit, standoff_mm + step)
    return {
        "marker": np.sqrt(
            _marker_variance(place, fit, standoff_mm) + _marker_variance(reference, fit, standoff_mm)
        ),
        "corners and camera": np.sqrt(np.maximum(total - distance**2, 0.0)),
        "distance": distance,
        "stand-off": np.abs(moved - _displacement(place, reference, fit, standoff_mm))
        / step
        * settings.sigma_standoff_mm,
        "print scale": np.abs(displacement) * settings.sigma_board_scale,
        "out of plane": np.abs(towards) * settings.sigma_out_of_plane_mm,
    }


def _marker_variance(place: Place, fit: CameraFit, standoff_mm: float) -> FloatArray:
    pose = fit.adjustment.poses[place.station]
    mm_per_px = (pose.distance_mm - standoff_mm) / fit.adjustment.camera.fx
    if place.by_hand_sigma_px is not None:
        return np.full(2, (place.by_hand_sigma_px * mm_per_px) ** 2)
    if place.disc_sigma_px is not None:
        return np.full(2, (place.disc_sigma_px**2 + RIM_FLOOR_PX**2) * mm_per_px**2)
    by_radius = place.circle.radius_slope * (RADIUS_SIGMA * place.circle.radius)
    return np.diag(place.circle.covariance) * 2.0 + by_radius**2 + (RIM_FLOOR_PX * mm_per_px) ** 2


def _displacement(place: Place, reference: Place, fit: CameraFit, standoff_mm: float) -> FloatArray:
    """Displacement of the rim's centre pixel, for derivatives."""
    ends = []
    for end in (place, reference):
        pose = fit.adjustment.poses[end.station]
        ends.append(to_plane(fit.adjustment.camera, pose, end.centre_px[None], standoff_mm=standoff_mm)[0])
    return ends[0] - ends[1]


def _slope(place: Place, reference: Place, fit: CameraFit, standoff_mm: float) -> FloatArray:
    """Return the derivative of the displacement by the adjustment's parameters, shape (2, parameters)."""
    covariance = fit.adjustment.covariance
    slope = np.zeros((2, len(covariance)))
    used = [*range(N_INTRINSIC)]
    for station in {place.station, reference.station}:
        used += range(N_INTRINSIC + 6 * station, N_INTRINSIC + 6 * station + 6)
    ends = ((place, 1.0), (reference, -1.0))
    for parameter in used:
        step = max(0.05 * float(np.sqrt(covariance[parameter, parameter])), 1e-9)
        for sign in (1.0, -1.0):
            camera, poses = perturbed(fit.adjustment, parameter, sign * step)
            for end, share in ends:
                at = to_plane(camera, poses[end.station], end.centre_px[None], standoff_mm=standoff_mm)[0]
                slope[:, parameter] += sign * share * at / (2.0 * step)
    return slope
