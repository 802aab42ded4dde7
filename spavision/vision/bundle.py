"""Bundle adjustment of one camera to many photographs of a board, by OpenCV, with its full covariance."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from .adjustment import View
from .arrays import FloatArray
from .camera import Camera, Pose, project

PARAMETERS = ("fx_px", "fy_px", "cx_px", "cy_px", "k1", "k2", "p1", "p2", "k3")
"""Rows and columns of a camera's covariance."""

CRITERIA = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 100, 1e-14)


def parameter_values(camera: Camera) -> tuple[float, ...]:
    """Return a camera's nine parameters in the order of `PARAMETERS`."""
    return (camera.fx, camera.fy, camera.cx, camera.cy, *camera.distortion)


@dataclass(frozen=True)
class LensModel:
    """What of OpenCV's five-coefficient model is left free.

    Parameters
    ----------
    fix_aspect_ratio : bool
        fx = fy: square pixels.
    fix_principal_point : bool
        cx, cy in the middle of the photograph.
    zero_tangential : bool
        p1 = p2 = 0.
    zero_k3 : bool
        k3 = 0.
    """

    fix_aspect_ratio: bool = False
    fix_principal_point: bool = False
    zero_tangential: bool = False
    zero_k3: bool = False

    def flags(self) -> int:
        """Return OpenCV's flags."""
        flags = 0
        flags |= cv2.CALIB_FIX_ASPECT_RATIO if self.fix_aspect_ratio else 0
        flags |= cv2.CALIB_FIX_PRINCIPAL_POINT if self.fix_principal_point else 0
        flags |= cv2.CALIB_ZERO_TANGENT_DIST if self.zero_tangential else 0
        flags |= cv2.CALIB_FIX_K3 if self.zero_k3 else 0
        return int(flags)

    def free(self) -> FloatArray:
        """Return the derivative of the nine `PARAMETERS` by those that are free, shape (9, free)."""
        columns = np.eye(len(PARAMETERS))
        if self.fix_aspect_ratio:
            columns[1, 0] = 1.0
        fixed = {
            "fy_px": self.fix_aspect_ratio,
            "cx_px": self.fix_principal_point,
            "cy_px": self.fix_principal_point,
            "p1": self.zero_tangential,
            "p2": self.zero_tangential,
            "k3": self.zero_k3,
        }
        return columns[:, [k for k, name in enumerate(PARAMETERS) if not fixed.get(name, False)]]


@dataclass(frozen=True)
class Bundle:
    """Result of `adjust_bundle`.

    Parameters
    ----------
    camera : Camera
        Adjusted intrinsic parameters.
    poses : tuple of Pose
        One a view.
    residuals_px : tuple of array, shape (n, 2)
        Observed minus projected, one a view.
    rms_px : float
        Root mean square length of the residuals, as OpenCV reports it.
    sigma_px : float
        Standard deviation of one corner coordinate, after the degrees of freedom.
    covariance : array, shape (9, 9)
        Of `PARAMETERS`; zero where a parameter is fixed.
    """

    camera: Camera
    poses: tuple[Pose, ...]
    residuals_px: tuple[FloatArray, ...]
    rms_px: float
    sigma_px: float
    covariance: FloatArray


def adjust_bundle(views: Sequence[View], size: tuple[int, int], model: LensModel) -> Bundle | None:
    """Fit a camera and one pose a view by OpenCV's ``calibrateCamera`` (Zhang 2000, then least squares).

    Parameters
    ----------
    views : sequence of View
        Corners of each photograph.
    size : tuple of int
        Width and height of the photographs, px.
    model : LensModel
        What is free.

    Returns
    -------
    Bundle or None
        None where the views do not determine a camera, such as when the board always faces it squarely.
    """
    points = [_with_z(view.points_mm).astype(np.float32) for view in views]
    pixels = [view.pixels.astype(np.float32).reshape(-1, 1, 2) for view in views]
    threads = cv2.getNumThreads()
    # Several threads add up in an order of their own each time: the same photos shall give the same camera.
    cv2.setNumThreads(1)
    try:
        _, matrix, coefficients, rotations, translations = cv2.calibrateCamera(
            points, pixels, size, np.eye(3), np.zeros(5), flags=model.flags(), criteria=CRITERIA
        )
    except cv2.error:
        return None
    finally:
        cv2.setNumThreads(threads)
    if not (np.isfinite(matrix).all() and np.isfinite(coefficients).all() and matrix[0, 0] > 0):
        return None
    k1, k2, p1, p2, k3 = np.asarray(coefficients, dtype=float).ravel()[:5].tolist()
    fx, fy, cx, cy = (float(matrix[place]) for place in ((0, 0), (1, 1), (0, 2), (1, 2)))
    camera = Camera(fx, fy, cx, cy, (k1, k2, p1, p2, k3), *size)
    poses = tuple(
        _pose(np.asarray(rotation, dtype=float), np.asarray(translation, dtype=float))
        for rotation, translation in zip(rotations, translations, strict=True)
    )
    residuals = tuple(
        view.pixels - project(camera, pose, view.points_mm) for view, pose in zip(views, poses, strict=True)
    )
    squares = sum(float((residual**2).sum()) for residual in residuals)
    corners = sum(len(view.pixels) for view in views)
    inverse, unknowns = _inverse_normal(camera, poses, views, model)
    variance = squares / max(2 * corners - unknowns, 1)
    covariance = variance * inverse
    if not np.isfinite(covariance).all():
        return None
    return Bundle(
        camera=_settled(camera, np.sqrt(np.diag(covariance))),
        poses=poses,
        residuals_px=residuals,
        rms_px=round(float(np.sqrt(squares / corners)), 8),
        sigma_px=round(float(np.sqrt(variance)), 8),
        covariance=_six_digits(covariance),
    )


def _settled(camera: Camera, sigma: FloatArray) -> Camera:
    """Round parameters to a hundred-thousandth of their uncertainty.

    OpenCV's sums differ in the last digits from run to run; the same photographs shall give the same file.
    """
    values = parameter_values(camera)
    digits = [0 if s == 0 else 5 - math.floor(math.log10(s)) for s in sigma.tolist()]
    rounded = [v if s == 0 else round(v, d) for v, s, d in zip(values, sigma.tolist(), digits, strict=True)]
    fx, fy, cx, cy, k1, k2, p1, p2, k3 = rounded
    return Camera(fx, fy, cx, cy, (k1, k2, p1, p2, k3), camera.width, camera.height)


def _six_digits(values: FloatArray) -> FloatArray:
    return np.array([float(f"{value:.6g}") for value in values.ravel()]).reshape(values.shape)


def _inverse_normal(
    camera: Camera, poses: Sequence[Pose], views: Sequence[View], model: LensModel
) -> tuple[FloatArray, int]:
    """Return the nine parameters' cofactors, poses eliminated view by view, and the number of unknowns."""
    free = model.free()
    reduced = np.zeros((free.shape[1], free.shape[1]))
    for pose, view in zip(poses, views, strict=True):
        _, full = cv2.projectPoints(
            _with_z(view.points_mm),
            np.array(pose.rotation),
            np.array(pose.translation_mm),
            camera.matrix,
            np.array(camera.distortion),
        )
        # OpenCV's columns: rotation 0-2, translation 3-5, fx fy 6-7, cx cy 8-9, k1 k2 p1 p2 k3 10-14.
        of_pose, of_camera = full[:, :6], full[:, 6:15] @ free
        explained, *_ = np.linalg.lstsq(of_pose, of_camera, rcond=None)
        rest = of_camera - of_pose @ explained
        reduced += rest.T @ rest
    scale = 1.0 / np.sqrt(np.maximum(np.diag(reduced), 1e-300))
    inverse = np.linalg.pinv(reduced * np.outer(scale, scale), hermitian=True) * np.outer(scale, scale)
    return free @ inverse @ free.T, free.shape[1] + 6 * len(views)


def _with_z(points_mm: FloatArray) -> FloatArray:
    return np.column_stack([points_mm, np.zeros(len(points_mm))])


def _pose(rotation: FloatArray, translation: FloatArray) -> Pose:
    rx, ry, rz = rotation.ravel().tolist()
    x, y, z = translation.ravel().tolist()
    return Pose(rotation=(rx, ry, rz), translation_mm=(x, y, z))
