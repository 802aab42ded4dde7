"""The camera: pinhole with radial and tangential distortion, its pose, and rays back to the board."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from .arrays import FloatArray

UNDISTORT_CRITERIA = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 100, 1e-12)


@dataclass(frozen=True)
class Camera:
    """Intrinsic parameters in OpenCV's convention (centre of the top-left pixel is (0, 0)).

    Parameters
    ----------
    fx, fy, cx, cy : float
        Focal lengths and principal point, px.
    distortion : tuple of float
        k1, k2, p1, p2, k3.
    width, height : int
        Size of the photographs the parameters belong to, px.
    """

    fx: float
    fy: float
    cx: float
    cy: float
    distortion: tuple[float, float, float, float, float]
    width: int
    height: int

    @property
    def matrix(self) -> FloatArray:
        """The 3×3 camera matrix."""
        return np.array([[self.fx, 0.0, self.cx], [0.0, self.fy, self.cy], [0.0, 0.0, 1.0]])

    def scaled(self, factor: float) -> Camera:
        """Return the camera of the same photograph resized by ``factor`` (pixel areas averaged)."""
        return Camera(
            fx=self.fx * factor,
            fy=self.fy * factor,
            cx=(self.cx + 0.5) * factor - 0.5,
            cy=(self.cy + 0.5) * factor - 0.5,
            distortion=self.distortion,
            width=round(self.width * factor),
            height=round(self.height * factor),
        )


@dataclass(frozen=True)
class Pose:
    """Position of the board before the camera: ``point_camera = R(rotation) point_board + translation``.

    The board's axes are x to the right, y down along the lattice and z into the board, away from the
    camera; a point that stands off the board towards the camera by h has z = −h.
    """

    rotation: tuple[float, float, float]
    translation_mm: tuple[float, float, float]

    @property
    def matrix(self) -> FloatArray:
        """The 3×3 rotation matrix."""
        return np.asarray(cv2.Rodrigues(np.array(self.rotation))[0], dtype=float)

    @property
    def centre_mm(self) -> FloatArray:
        """Camera centre in the board's axes, shape (3,)."""
        return -self.matrix.T @ np.array(self.translation_mm)

    @property
    def distance_mm(self) -> float:
        """Perpendicular distance of the camera centre from the board's plane."""
        return float(-self.centre_mm[2])

    @property
    def tilt_deg(self) -> float:
        """Angle between the optical axis and the board's normal."""
        return float(np.degrees(np.arccos(np.clip(self.matrix[2, 2], -1.0, 1.0))))


def project(camera: Camera, pose: Pose, points_mm: FloatArray) -> FloatArray:
    """Project board points to pixels.

    Parameters
    ----------
    points_mm : array, shape (n, 2) or (n, 3)
        Points in the board's axes; two columns mean points on the board.

    Returns
    -------
    array, shape (n, 2)
        Pixel coordinates.
    """
    points = np.asarray(points_mm, dtype=float)
    if points.shape[1] == 2:
        points = np.column_stack([points, np.zeros(len(points))])
    if len(points) == 0:
        return np.zeros((0, 2))
    pixels, _ = cv2.projectPoints(
        points,
        np.array(pose.rotation),
        np.array(pose.translation_mm),
        camera.matrix,
        np.array(camera.distortion),
    )
    return np.asarray(pixels, dtype=float).reshape(-1, 2)


def to_plane(camera: Camera, pose: Pose, pixels: FloatArray, *, standoff_mm: float = 0.0) -> FloatArray:
    """Intersect pixel rays with the plane parallel to the board that stands off it by ``standoff_mm``.

    Parameters
    ----------
    pixels : array, shape (n, 2)
        Pixel coordinates.
    standoff_mm : float
        Distance of the plane from the board, positive towards the camera.

    Returns
    -------
    array, shape (n, 2)
        x and y in the board's axes, mm.
    """
    pixels = np.asarray(pixels, dtype=float).reshape(-1, 1, 2)
    if len(pixels) == 0:
        return np.zeros((0, 2))
    normalised = cv2.undistortPoints(
        pixels, camera.matrix, np.array(camera.distortion), criteria=UNDISTORT_CRITERIA
    ).reshape(-1, 2)
    rays = np.column_stack([normalised, np.ones(len(normalised))]) @ pose.matrix  # R.T applied to each ray
    centre = pose.centre_mm
    return centre[:2] + rays[:, :2] * ((-standoff_mm - centre[2]) / rays[:, 2])[:, None]
