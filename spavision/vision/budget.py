"""The budget of a displacement's uncertainty, source by source."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .adjustment import N_INTRINSIC, distance_gradient, perturbed
from .arrays import FloatArray
from .camera import Camera, Pose, to_plane
from .displacement import Place
from .scale import EXIF_SIGMA, CameraFit
from .settings import TrackSettings

RADIUS_SIGMA = 0.03
"""Relative uncertainty of the radius that a partly hidden rim is fitted with: beside a cover, half contrast
lies elsewhere than on the whole rims that the radius is taken from."""

RIM_FLOOR_PX = 0.02
"""Systematic part of a rim's centre: shading, pixel grid, compression."""

BUDGET_NAMES = (
    "marker",
    "corners and camera",
    "distance",
    "calibration",
    "stand-off",
    "print scale",
    "out of plane",
)


@dataclass(frozen=True)
class BudgetEntry:
    """One source of uncertainty.

    Parameters
    ----------
    name : str
        One of `BUDGET_NAMES`, or ``base marker``.
    basis : str
        What the entry rests on, with the stated default where it is one.
    sigma_ux_mm, sigma_uy_mm : array, shape (photographs,)
        Its effect on each displacement, one standard deviation; NaN without a reading.
    """

    name: str
    basis: str
    sigma_ux_mm: FloatArray
    sigma_uy_mm: FloatArray


@dataclass(frozen=True)
class SetUp:
    """What the displacements of one track rest on.

    Parameters
    ----------
    fit : CameraFit
        Camera and poses.
    settings : TrackSettings
        What the user knows, and how well.
    standoff_mm : float
        Height over the board of the plane that displacements are measured in; 0 where uncorrected.
    """

    fit: CameraFit
    settings: TrackSettings
    standoff_mm: float

    @property
    def in_board_plane(self) -> bool:
        """Whether displacements stay in the board's plane, uncorrected."""
        return self.settings.standoff_mm is None or self.fit.source == "none"


def uncertainty_budget(
    places: Sequence[Place | None], reference: Place, set_up: SetUp
) -> tuple[BudgetEntry, ...]:
    """Return the standard uncertainty of each displacement, source by source."""
    n = len(places)
    sigma = {name: np.full((n, 2), np.nan) for name in BUDGET_NAMES}
    for row, place in enumerate(places):
        if place is None:
            continue
        for name, value in _entries(place, reference, set_up).items():
            sigma[name][row] = value
    basis = _basis(places, set_up)
    return tuple(
        BudgetEntry(name, basis[name], sigma[name][:, 0], sigma[name][:, 1]) for name in BUDGET_NAMES
    )


def _basis(places: Sequence[Place | None], set_up: SetUp) -> dict[str, str]:
    """Say what each entry rests on."""
    fit, settings = set_up.fit, set_up.settings
    marker = f"scatter of the marker's edge, and {RIM_FLOOR_PX:g} px of systematic error"
    if any(place is not None and place.by_hand_sigma_px is not None for place in places):
        marker += f"; ±{settings.sigma_by_hand_px:g} px where the centre was given by hand"
    distance = {
        "given": f"±{settings.sigma_distance_mm:g} mm on the measured distance",
        "exif": f"±{100 * EXIF_SIGMA:g} % on the focal length of the EXIF data",
        "calibration": "the distance follows from the calibrated camera",
        "fit": "the distance follows from the corners of the tilted board",
        "none": "no distance is needed in the board's plane",
    }
    calibration = "the camera is not a calibrated one"
    if fit.source == "calibration":
        calibration = "covariance of the camera file"
        if settings.camera_covariance is None:
            calibration = "the camera file holds no covariance: the camera is taken for exact"
    standoff = f"±{settings.sigma_standoff_mm:g} mm on the stand-off"
    return {
        "marker": marker,
        "corners and camera": f"scatter of the board's corners, {fit.adjustment.sigma_px:.3f} px",
        "distance": distance[fit.source],
        "calibration": calibration,
        "stand-off": "no stand-off is needed in the board's plane" if set_up.in_board_plane else standoff,
        "print scale": f"±{100 * settings.sigma_board_scale:g} % on the size of the squares",
        "out of plane": f"±{settings.sigma_out_of_plane_mm:g} mm of motion towards the camera",
    }


def _entries(place: Place, reference: Place, set_up: SetUp) -> dict[str, FloatArray]:
    """Sigma of ux and uy of one reading by each source."""
    if place is reference:
        return dict.fromkeys(BUDGET_NAMES, np.zeros(2))
    fit, settings, standoff_mm = set_up.fit, set_up.settings, set_up.standoff_mm
    slope = _slope(place, reference, set_up)
    known = _share_of_prior(slope, fit)
    total = np.diag(slope @ fit.adjustment.covariance @ slope.T)
    pose = fit.adjustment.poses[place.station]
    towards = (place.circle.centre - pose.centre_mm[:2]) / (pose.distance_mm - standoff_mm)
    return {
        "marker": np.sqrt(_marker_variance(place, set_up) + _marker_variance(reference, set_up)),
        "corners and camera": np.sqrt(np.maximum(total - known**2, 0.0)),
        "distance": known,
        "calibration": _by_calibration(place, reference, set_up),
        "stand-off": _by_standoff(place, reference, set_up),
        "print scale": np.abs(place.circle.centre - reference.circle.centre) * settings.sigma_board_scale,
        "out of plane": np.abs(towards) * settings.sigma_out_of_plane_mm,
    }


def _share_of_prior(slope: FloatArray, fit: CameraFit) -> FloatArray:
    """Share of the adjustment's covariance that comes from the measured distance, or the EXIF data, alone."""
    gain = np.zeros(len(fit.adjustment.covariance))
    if fit.priors.sigma_distance_mm is not None:
        gain[N_INTRINSIC : N_INTRINSIC + 6] = distance_gradient(fit.adjustment.poses[0])
        gain /= fit.priors.sigma_distance_mm
    elif fit.source == "exif":
        gain[0] = 1.0 / fit.priors.sigma_log_focal
    return np.abs(np.asarray(slope @ fit.adjustment.covariance @ gain))


def _by_calibration(place: Place, reference: Place, set_up: SetUp) -> FloatArray:
    """Effect of the calibrated camera's covariance: poses are fitted anew to each camera that may be."""
    fit, standoff_mm = set_up.fit, set_up.standoff_mm
    here = _displacement(fit.adjustment.camera, fit.adjustment.poses, (place, reference), standoff_mm)
    moved = [
        _displacement(variant.camera, variant.poses, (place, reference), standoff_mm) - here
        for variant in fit.variants
    ]
    return np.asarray(np.sqrt(np.sum(np.square(moved), axis=0))) if moved else np.zeros(2)


def _by_standoff(place: Place, reference: Place, set_up: SetUp) -> FloatArray:
    if set_up.in_board_plane:
        return np.zeros(2)
    camera, poses = set_up.fit.adjustment.camera, set_up.fit.adjustment.poses
    step = 0.1
    near, far = (
        _displacement(camera, poses, (place, reference), set_up.standoff_mm + sign * step)
        for sign in (1.0, -1.0)
    )
    return np.abs(near - far) / (2.0 * step) * set_up.settings.sigma_standoff_mm


def _marker_variance(place: Place, set_up: SetUp) -> FloatArray:
    adjustment = set_up.fit.adjustment
    pose = adjustment.poses[place.station]
    mm_per_px = (pose.distance_mm - set_up.standoff_mm) / adjustment.camera.fx
    if place.by_hand_sigma_px is not None:
        return np.full(2, (place.by_hand_sigma_px * mm_per_px) ** 2)
    if place.disc_sigma_px is not None:
        return np.full(2, (place.disc_sigma_px**2 + RIM_FLOOR_PX**2) * mm_per_px**2)
    by_radius = place.circle.radius_slope * (RADIUS_SIGMA * place.circle.radius)
    return np.diag(place.circle.covariance) * 2.0 + by_radius**2 + (RIM_FLOOR_PX * mm_per_px) ** 2


def _displacement(
    camera: Camera, poses: Sequence[Pose], ends: tuple[Place, Place], standoff_mm: float
) -> FloatArray:
    """Displacement of the rim's centre pixel from the second place to the first, for derivatives."""
    here, there = (
        to_plane(camera, poses[end.station], end.centre_px[None], standoff_mm=standoff_mm)[0] for end in ends
    )
    return here - there


def _slope(place: Place, reference: Place, set_up: SetUp) -> FloatArray:
    """Return the derivative of the displacement by the adjustment's parameters, shape (2, parameters)."""
    adjustment = set_up.fit.adjustment
    covariance = adjustment.covariance
    slope = np.zeros((2, len(covariance)))
    used = [*range(N_INTRINSIC)]
    for station in {place.station, reference.station}:
        used += range(N_INTRINSIC + 6 * station, N_INTRINSIC + 6 * station + 6)
    for parameter in used:
        step = max(0.05 * float(np.sqrt(covariance[parameter, parameter])), 1e-9)
        for sign in (1.0, -1.0):
            camera, poses = perturbed(adjustment, parameter, sign * step)
            moved = _displacement(camera, poses, (place, reference), set_up.standoff_mm)
            slope[:, parameter] += sign * moved / (2.0 * step)
    return slope
