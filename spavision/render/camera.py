"""The camera: intrinsics, pose, and the projection of points in front of the board."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, radians, sin

import numpy as np
from numpy.typing import NDArray

from .distortion import distort
from .settings import Bump, CameraSettings, RenderSettings

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Camera:
    """A pinhole camera with distortion, standing in front of the board.

    The board frame has x to the right, y down and z towards the camera, which is left-handed; a point
    enters the camera's frame (x right, y down, z forwards) as ``rotation @ (x, y, -z) + translation``.

    Parameters
    ----------
    matrix : array, shape (3, 3)
        fx, fy, cx, cy; the centre of the top-left pixel is (0, 0).
    distortion : array, shape (5,)
        k1, k2, p1, p2, k3.
    rotation : array, shape (3, 3)
    translation_mm : array, shape (3,)
    """

    matrix: FloatArray
    distortion: FloatArray
    rotation: FloatArray
    translation_mm: FloatArray

    @property
    def centre_mm(self) -> FloatArray:
        """The camera's centre in the board frame, shape (3,)."""
        centre = -self.rotation.T @ self.translation_mm
        return centre * (1.0, 1.0, -1.0)

    def project(self, points_mm: FloatArray) -> FloatArray:
        """Project points of the board frame, shape (n, 3), to pixels, shape (n, 2)."""
        in_camera = (np.atleast_2d(points_mm) * (1.0, 1.0, -1.0)) @ self.rotation.T + self.translation_mm
        normalised = in_camera[:, :2] / in_camera[:, 2:]
        distorted = np.array([distort(x, y, self.distortion) for x, y in normalised])
        return distorted * np.diag(self.matrix)[:2] + self.matrix[:2, 2]


def rotation_from_angles(yaw_deg: float, pitch_deg: float, roll_deg: float) -> FloatArray:
    """Return the rotation board to camera: yaw about y, then pitch about x, then roll about z."""
    yaw, pitch, roll = (radians(angle) for angle in (yaw_deg, pitch_deg, roll_deg))
    about_y = np.array([[cos(yaw), 0, -sin(yaw)], [0, 1, 0], [sin(yaw), 0, cos(yaw)]])
    about_x = np.array([[1, 0, 0], [0, cos(pitch), -sin(pitch)], [0, sin(pitch), cos(pitch)]])
    about_z = np.array([[cos(roll), -sin(roll), 0], [sin(roll), cos(roll), 0], [0, 0, 1]])
    return np.asarray(about_z @ about_x @ about_y)


def focal_px(settings: RenderSettings) -> float:
    """Return fx such that a square seen square-on has the pitch asked for."""
    return settings.camera.square_px * settings.camera.distance_mm / settings.board.square_mm


def camera_for_photo(settings: RenderSettings, photo: int) -> Camera:
    """Return the camera as it stands for one photo, after the knocks up to it."""
    view = settings.camera
    knocks = [bump for bump in settings.bumps if bump.photo <= photo]
    start = rotation_from_angles(view.yaw_deg, view.pitch_deg, view.roll_deg)
    axis = start[2]
    aim = np.array([view.aim_x_mm, view.aim_y_mm, 0.0])
    moved = np.array([_total(knocks, "dx_mm"), _total(knocks, "dy_mm"), -_total(knocks, "dz_mm")])
    centre = aim - axis * view.distance_mm / axis[2] + moved
    rotation = rotation_from_angles(
        view.yaw_deg + _total(knocks, "yaw_deg"),
        view.pitch_deg + _total(knocks, "pitch_deg"),
        view.roll_deg + _total(knocks, "roll_deg"),
    )
    return Camera(_matrix(settings), _coefficients(view), rotation, -rotation @ centre)


def _total(knocks: list[Bump], name: str) -> float:
    return float(sum(getattr(bump, name) for bump in knocks))


def _matrix(settings: RenderSettings) -> FloatArray:
    view, image = settings.camera, settings.image
    fx = focal_px(settings)
    cx = (image.width_px - 1) / 2 + view.cx_offset_px
    cy = (image.height_px - 1) / 2 + view.cy_offset_px
    return np.array([[fx, 0, cx], [0, fx * view.aspect, cy], [0, 0, 1.0]])


def _coefficients(view: CameraSettings) -> FloatArray:
    return np.array([view.k1, view.k2, view.p1, view.p2, view.k3])
