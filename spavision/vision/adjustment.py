"""Least-squares adjustment of one camera and its poses to lattice corners, with prior knowledge."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np

from .arrays import FloatArray
from .camera import Camera, Pose, project

N_INTRINSIC = 8
"""log f, cx, cy, k1, k2, p1, p2, k3."""

SMALLEST_SIGMA_PX = 0.01
MOST_STEPS = 40


@dataclass(frozen=True)
class View:
    """Corners seen from one camera position: board points (n, 2) in mm and their pixels (n, 2)."""

    points_mm: FloatArray
    pixels: FloatArray


@dataclass(frozen=True)
class Priors:
    """What is known before the corners speak; each sigma is one standard deviation.

    A near-frontal board cannot tell focal length from distance, nor tilt from principal point: there the
    priors decide, and the covariance of the result says so.

    Parameters
    ----------
    camera : Camera
        Expected intrinsic parameters, also the start of the iteration.
    sigma_log_focal : float
        Relative uncertainty of the focal length; 0 keeps all intrinsic parameters fixed.
    sigma_centre_px : float
        Uncertainty of the principal point.
    sigma_radial, sigma_tangential : float
        Uncertainty of k1, k2, k3 and of p1, p2.
    distance_mm, sigma_distance_mm : float or None
        Measured perpendicular distance from the camera to the board of the first view.
    """

    camera: Camera
    sigma_log_focal: float = 0.5
    sigma_centre_px: float = 30.0
    sigma_radial: float = 0.5
    sigma_tangential: float = 0.01
    distance_mm: float | None = None
    sigma_distance_mm: float | None = None

    def intrinsic_mean(self) -> FloatArray:
        """Return the expected log f, cx, cy, k1, k2, p1, p2, k3."""
        return _values(self.camera, ())

    def intrinsic_weight(self) -> FloatArray:
        """Return the inverse variances of the same."""
        radial, tangential = self.sigma_radial, self.sigma_tangential
        sigma = [self.sigma_log_focal, self.sigma_centre_px, self.sigma_centre_px]
        sigma += [radial, radial, tangential, tangential, radial]
        return 1.0 / np.square(sigma)


@dataclass(frozen=True)
class Adjustment:
    """Result of `adjust`.

    Parameters
    ----------
    camera : Camera
        Adjusted intrinsic parameters.
    poses : tuple of Pose
        One a view.
    residuals_px : tuple of array, shape (n, 2)
        Observed minus projected, one a view.
    sigma_px : float
        Robust standard deviation of one corner coordinate.
    covariance : array, shape (8 + 6 views, 8 + 6 views)
        Of log f, cx, cy, k1, k2, p1, p2, k3 and, for each pose, its rotation vector and the translation's
        x/z, y/z and log z.
    """

    camera: Camera
    poses: tuple[Pose, ...]
    residuals_px: tuple[FloatArray, ...]
    sigma_px: float
    covariance: FloatArray


def first_pose(camera: Camera, view: View) -> Pose:
    """Pose of a flat board from one view, by its homography and OpenCV's iterative solver."""
    points = np.column_stack([view.points_mm, np.zeros(len(view.points_mm))])
    _, rotation, translation = cv2.solvePnP(
        points,
        view.pixels.reshape(-1, 1, 2),
        camera.matrix,
        np.array(camera.distortion),
        flags=cv2.SOLVEPNP_IPPE,
    )
    rx, ry, rz = rotation.ravel().tolist()
    x, y, depth = translation.ravel().tolist()
    return Pose(rotation=(rx, ry, rz), translation_mm=(x, y, depth))


def adjust(
    views: list[View], priors: Priors, *, start: Adjustment | None = None, least_gain: float = 0.01
) -> Adjustment:
    """Fit the shared camera and one pose a view by robust Levenberg-Marquardt.

    Residuals are weighted as Cauchy's, by a scale taken from their own median, so that a few wrong corners
    do not pull; priors enter as further observations.

    Parameters
    ----------
    views : list of View
        At least one; the measured distance of ``priors`` belongs to the first.
    priors : Priors
        Prior knowledge and start values.
    start : Adjustment, optional
        Start values; those of the priors and of the homographies when absent.
    least_gain : float
        Gain in chi-square at which to stop: 0.01 moves no parameter by more than a tenth of its standard
        deviation; far more is enough where only the lattice's pixels matter.
    """
    fixed = priors.sigma_log_focal == 0
    camera = priors.camera if start is None or fixed else start.camera
    poses = start.poses if start is not None else [first_pose(camera, view) for view in views]
    values = _values(camera, poses)
    residuals = _residuals(values, views, priors.camera)
    sigma = _sigma(residuals)
    damping, cost = 1e-7, _cost(values, residuals, priors, sigma)
    for _ in range(MOST_STEPS):
        normal, gradient = _normal_equations(values, views, residuals, priors, sigma)
        while damping < 1e10:
            step = _bounded(_solve(normal, gradient, damping, fixed=fixed))
            trial = values + step
            trial_residuals = _residuals(trial, views, priors.camera)
            trial_cost = _cost(trial, trial_residuals, priors, sigma)
            if trial_cost <= cost:
                break
            damping *= 8.0
        else:
            break
        gained, values, damping = cost - trial_cost, trial, max(damping / 8.0, 1e-12)
        residuals = trial_residuals
        new_sigma = _sigma(residuals)
        settled = gained < least_gain and abs(new_sigma / sigma - 1.0) < 0.01
        sigma = new_sigma
        cost = _cost(values, residuals, priors, sigma)
        if settled:
            break
    normal, _ = _normal_equations(values, views, residuals, priors, sigma)
    return Adjustment(
        camera=priors.camera if fixed else _camera(values, priors.camera),
        poses=tuple(_view_pose(values, number) for number in range(len(views))),
        residuals_px=tuple(residuals),
        sigma_px=sigma,
        covariance=_covariance(normal, fixed=fixed),
    )


def distance_gradient(pose: Pose) -> FloatArray:
    """Return the derivative of the perpendicular distance by the pose's six parameters."""
    base = _pose_values(pose)
    gradient, h = np.empty(6), 1e-6
    for k in range(6):
        shift = np.zeros(6)
        shift[k] = h
        gradient[k] = (_pose(base + shift).distance_mm - _pose(base - shift).distance_mm) / (2.0 * h)
    return gradient


def perturbed(adjustment: Adjustment, parameter: int, step: float) -> tuple[Camera, tuple[Pose, ...]]:
    """Return camera and poses with one parameter (a row of the covariance) moved by ``step``."""
    values = _values(adjustment.camera, adjustment.poses)
    values[parameter] += step
    return _camera(values, adjustment.camera), tuple(
        _view_pose(values, number) for number in range(len(adjustment.poses))
    )


def _pose(values: FloatArray) -> Pose:
    rx, ry, rz, a, b, log_depth = values.tolist()
    depth = float(np.exp(log_depth))
    return Pose(rotation=(rx, ry, rz), translation_mm=(a * depth, b * depth, depth))


def _pose_values(pose: Pose) -> FloatArray:
    """Rotation vector, direction and log depth of the translation.

    Focal length and depth scale each other; in logarithms that valley is straight, and few steps cross it.
    """
    x, y, depth = pose.translation_mm
    return np.array([*pose.rotation, x / depth, y / depth, np.log(depth)])


def _values(camera: Camera, poses: Sequence[Pose]) -> FloatArray:
    intrinsic = [np.log(camera.fx), camera.cx, camera.cy, *camera.distortion]
    return np.concatenate([intrinsic, *[_pose_values(pose) for pose in poses]])


def _camera(values: FloatArray, template: Camera) -> Camera:
    focal = float(np.exp(values[0]))
    k1, k2, p1, p2, k3 = values[3:8].tolist()
    return replace(
        template,
        fx=focal,
        fy=focal * template.fy / template.fx,
        cx=float(values[1]),
        cy=float(values[2]),
        distortion=(k1, k2, p1, p2, k3),
    )


def _view_pose(values: FloatArray, number: int) -> Pose:
    first = N_INTRINSIC + 6 * number
    return _pose(values[first : first + 6])


def _residuals(values: FloatArray, views: list[View], template: Camera) -> list[FloatArray]:
    camera = _camera(values, template)
    return [
        view.pixels - project(camera, _view_pose(values, number), view.points_mm)
        for number, view in enumerate(views)
    ]


def _sigma(residuals: list[FloatArray]) -> float:
    """Robust standard deviation of one coordinate, from the median of the residuals' lengths (Rayleigh)."""
    lengths = np.concatenate([np.linalg.norm(residual, axis=1) for residual in residuals])
    return max(float(np.median(lengths)) / 1.1774, SMALLEST_SIGMA_PX)


def _weights(residual: FloatArray, sigma: float) -> FloatArray:
    return 1.0 / (1.0 + (residual**2).sum(axis=1) / (3.0 * sigma) ** 2)


def _distance_misfit(values: FloatArray, priors: Priors) -> float:
    if priors.distance_mm is None or priors.sigma_distance_mm is None:
        return 0.0
    return (_view_pose(values, 0).distance_mm - priors.distance_mm) / priors.sigma_distance_mm


def _cost(values: FloatArray, residuals: list[FloatArray], priors: Priors, sigma: float) -> float:
    reach = 3.0 * sigma
    cost = 0.0
    for residual in residuals:
        if not np.isfinite(residual).all():
            return np.inf
        cost += (reach / sigma) ** 2 * float(np.log1p((residual**2).sum(axis=1) / reach**2).sum())
    if priors.sigma_log_focal > 0:
        cost += float(
            (priors.intrinsic_weight() * (values[:N_INTRINSIC] - priors.intrinsic_mean()) ** 2).sum()
        )
    return cost + _distance_misfit(values, priors) ** 2


def _normal_equations(
    values: FloatArray, views: list[View], residuals: list[FloatArray], priors: Priors, sigma: float
) -> tuple[FloatArray, FloatArray]:
    camera = _camera(values, priors.camera)
    normal = np.zeros((len(values), len(values)))
    gradient = np.zeros(len(values))
    for number, (view, residual) in enumerate(zip(views, residuals, strict=True)):
        jacobian = _jacobian(camera, _view_pose(values, number), view.points_mm)
        weight = np.repeat(_weights(residual, sigma), 2) / sigma**2
        first = N_INTRINSIC + 6 * number
        place = np.r_[0:N_INTRINSIC, first : first + 6]
        weighted = jacobian * weight[:, None]
        normal[np.ix_(place, place)] += jacobian.T @ weighted
        gradient[place] += weighted.T @ residual.ravel()
    if priors.sigma_log_focal > 0:
        own = np.arange(N_INTRINSIC)
        weight = priors.intrinsic_weight()
        normal[own, own] += weight
        gradient[own] += weight * (priors.intrinsic_mean() - values[:N_INTRINSIC])
    if priors.distance_mm is not None and priors.sigma_distance_mm is not None:
        slope = distance_gradient(_view_pose(values, 0)) / priors.sigma_distance_mm
        place = np.arange(N_INTRINSIC, N_INTRINSIC + 6)
        normal[np.ix_(place, place)] += np.outer(slope, slope)
        gradient[place] -= slope * _distance_misfit(values, priors)
    return normal, gradient


def _jacobian(camera: Camera, pose: Pose, points_mm: FloatArray) -> FloatArray:
    """Return the derivative of the projections by intrinsic parameters and pose, shape (2n, 14)."""
    points = np.column_stack([points_mm, np.zeros(len(points_mm))])
    _, full = cv2.projectPoints(
        points,
        np.array(pose.rotation),
        np.array(pose.translation_mm),
        camera.matrix,
        np.array(camera.distortion),
    )
    # OpenCV's columns: rotation 0-2, translation 3-5, fx fy 6-7, cx cy 8-9, k1 k2 p1 p2 k3 10-14.
    log_focal = full[:, 6] * camera.fx + full[:, 7] * camera.fy
    x, y, depth = pose.translation_mm
    log_depth = full[:, 3] * x + full[:, 4] * y + full[:, 5] * depth
    return np.column_stack([log_focal, full[:, 8:15], full[:, 0:3], full[:, 3:5] * depth, log_depth])


def _solve(normal: FloatArray, gradient: FloatArray, damping: float, *, fixed: bool) -> FloatArray:
    """Damped step, in unknowns scaled by the diagonal; intrinsic parameters stay when ``fixed``."""
    free = slice(N_INTRINSIC, None) if fixed else slice(0, None)
    scale = 1.0 / np.sqrt(np.diag(normal)[free])
    scaled = normal[free, free] * np.outer(scale, scale)
    scaled[np.diag_indices_from(scaled)] += damping
    step = np.zeros(len(gradient))
    step[free] = scale * np.linalg.solve(scaled, scale * gradient[free])
    return step


def _bounded(step: FloatArray) -> FloatArray:
    """Shorten a step that would change focal length or a depth more than twofold."""
    logarithms = np.concatenate([step[:1], step[N_INTRINSIC + 5 :: 6]])
    return step * min(1.0, np.log(2.0) / max(float(np.abs(logarithms).max()), 1e-12))


def _covariance(normal: FloatArray, *, fixed: bool) -> FloatArray:
    """Invert the normal equations, scaled by their diagonal; zero for parameters kept ``fixed``."""
    covariance = np.zeros_like(normal)
    free = slice(N_INTRINSIC, None) if fixed else slice(0, None)
    scale = 1.0 / np.sqrt(np.diag(normal)[free])
    covariance[free, free] = np.linalg.pinv(
        normal[free, free] * np.outer(scale, scale), hermitian=True
    ) * np.outer(scale, scale)
    return covariance
