"""The camera of a set of photographs, and where its distance comes from."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from spavision.errors import InputError

from .adjustment import N_INTRINSIC, Adjustment, Priors, View, adjust, distance_gradient
from .arrays import FloatArray
from .board import provisional_priors
from .camera import Camera, Pose
from .camera_variants import one_sigma_cameras
from .grid import spread_subset
from .refill import FINAL_CORNERS, FIT_CORNERS
from .settings import TrackSettings
from .stations import Stations

SMALLEST_TILT_DEG = 10.0
LARGEST_FITTED_SIGMA = 0.03
"""Relative uncertainty above which a distance from the fit itself is not used."""

EXIF_SIGMA = 0.07
"""Relative uncertainty of a focal length from EXIF."""


@dataclass(frozen=True)
class Variant:
    """A camera that the calibrated one may be, with the poses that the corners then give."""

    camera: Camera
    poses: tuple[Pose, ...]


@dataclass(frozen=True)
class CameraFit:
    """Camera and poses, in mm, with the source of the distance.

    Parameters
    ----------
    adjustment : Adjustment
        Camera and one pose a camera position.
    distance_mm, sigma_distance_mm : float
        Perpendicular distance of the reference photograph's camera position.
    source : str
        ``calibration``, ``given``, ``fit``, ``exif`` or ``none``.
    priors : Priors
        What entered the adjustment beside the corners.
    variants : tuple of Variant
        Of a calibrated camera: what else the camera may be, one standard deviation off each.
    """

    adjustment: Adjustment
    distance_mm: float
    sigma_distance_mm: float
    source: str
    priors: Priors
    variants: tuple[Variant, ...] = ()


def fit_camera(
    stations: Stations, settings: TrackSettings, size: tuple[int, int], focal_px: float | None
) -> CameraFit:
    """Fit one camera to all positions, with the best knowledge of its distance.

    Sources, in this order: a calibrated camera; a measured distance; the fit itself when the board is tilted;
    the EXIF focal length, enlarged by the magnification because the lens is focused near; none.

    Parameters
    ----------
    stations : Stations
        Corners of each camera position.
    settings : TrackSettings
        What the user knows.
    size : tuple of int
        Width and height of the photographs.
    focal_px : float or None
        Focal length from EXIF, px.

    Raises
    ------
    InputError
        If the calibrated camera belongs to photographs of another size.
    """
    square = settings.true_square_mm
    views = [
        _thinned(indices.astype(float) * square, pixels, FIT_CORNERS)
        for indices, pixels in zip(stations.indices, stations.pixels, strict=True)
    ]
    weak = provisional_priors(*size)
    if settings.camera is not None:
        camera = settings.camera
        if (camera.width, camera.height) != size:
            raise InputError(
                f"the calibrated camera is for {camera.width}×{camera.height} px, the photographs have "
                f"{size[0]}×{size[1]} px; calibrate with photographs of the same size"
            )
        fit = _finish(stations, views, Priors(camera, sigma_log_focal=0.0), square, "calibration")
        return _with_variants(fit, _full_views(stations, square), settings.camera_covariance)
    if settings.distance_mm is not None:
        focal = _pixels_per_mm(views[0]) * settings.distance_mm
        measured = {
            "distance_mm": settings.distance_mm,
            "sigma_distance_mm": max(settings.sigma_distance_mm, 1e-3),
        }
        priors = replace(weak, camera=_with_focal(weak, focal), sigma_log_focal=1.0, **measured)
        return _finish(stations, views, priors, square, "given")
    free = _finish(stations, views, replace(weak, sigma_log_focal=1.0), square, "fit")
    tilt = max(pose.tilt_deg for pose in free.adjustment.poses)
    if tilt > SMALLEST_TILT_DEG and free.sigma_distance_mm < LARGEST_FITTED_SIGMA * free.distance_mm:
        return free
    if focal_px is not None:
        magnification = _pixels_per_mm(views[0]) * 36.0 / max(size)
        camera = _with_focal(weak, focal_px * (1.0 + magnification))
        return _finish(
            stations, views, replace(weak, camera=camera, sigma_log_focal=EXIF_SIGMA), square, "exif"
        )
    return _finish(stations, views, weak, square, "none")


def _finish(stations: Stations, views: list[View], priors: Priors, square: float, source: str) -> CameraFit:
    """Adjust to the thinned views, then once more to all corners."""
    rough = adjust(views, priors, least_gain=1.0)
    adjustment = adjust(_full_views(stations, square), priors, start=rough)
    slope = distance_gradient(adjustment.poses[0])
    place = slice(N_INTRINSIC, N_INTRINSIC + 6)
    variance = float(slope @ adjustment.covariance[place, place] @ slope)
    return CameraFit(
        adjustment, adjustment.poses[0].distance_mm, float(np.sqrt(max(variance, 0.0))), source, priors
    )


def _with_variants(fit: CameraFit, views: list[View], covariance: FloatArray | None) -> CameraFit:
    """Fit the poses to each camera that the calibrated one may be, and widen the distance's uncertainty."""
    if covariance is None:
        return fit
    cameras = one_sigma_cameras(fit.adjustment.camera, covariance)
    variants = []
    for camera in cameras:
        moved = adjust(views, Priors(camera, sigma_log_focal=0.0), start=fit.adjustment)
        variants.append(Variant(camera, moved.poses))
    away = [variant.poses[0].distance_mm - fit.distance_mm for variant in variants]
    sigma = float(np.hypot(fit.sigma_distance_mm, np.linalg.norm(away)))
    return replace(fit, sigma_distance_mm=sigma, variants=tuple(variants))


def _full_views(stations: Stations, square: float) -> list[View]:
    """Return all corners of each position, as many as the last adjustment takes."""
    largest = max(FIT_CORNERS, FINAL_CORNERS // max(1, len(stations.indices) // 4))
    return [
        _thinned(indices.astype(float) * square, pixels, largest)
        for indices, pixels in zip(stations.indices, stations.pixels, strict=True)
    ]


def _thinned(points_mm: FloatArray, pixels: FloatArray, largest: int) -> View:
    rows = spread_subset(points_mm, largest)
    return View(points_mm[rows].astype(float), pixels[rows])


def _pixels_per_mm(view: View) -> float:
    """Mean scale of a view, from an affine fit."""
    design = np.column_stack([np.ones(len(view.points_mm)), view.points_mm])
    coefficients, *_ = np.linalg.lstsq(design, view.pixels, rcond=None)
    return float(np.sqrt(abs(np.linalg.det(coefficients[1:]))))


def _with_focal(priors: Priors, focal_px: float) -> Camera:
    return replace(priors.camera, fx=focal_px, fy=focal_px)
