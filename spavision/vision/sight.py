"""Lines of sight past the board: planes at a height before it, and which edge of a thick body is seen."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .arrays import BoolArray, FloatArray
from .camera import Pose


@dataclass(frozen=True)
class Sight:
    """Where the camera stands, and where the faces of the actuator lie, in the board's axes.

    Parameters
    ----------
    foot_mm : array, shape (2,)
        Foot of the perpendicular from the camera centre to the board.
    distance_mm : float
        Length of that perpendicular.
    face_mm, rear_mm : float
        Heights over the board of the side face with the marker and of the face behind it. The first is 0
        where displacements stay in the board's plane; then the second is negative.
    """

    foot_mm: FloatArray
    distance_mm: float
    face_mm: float
    rear_mm: float

    def on_board(self, face_mm: FloatArray) -> FloatArray:
        """Return the board points behind points of the side face."""
        return self._drop(face_mm, np.full(face_mm.shape[:-1], self.face_mm))

    def seen_at(self, edge_mm: FloatArray, outward: FloatArray) -> FloatArray:
        """Return the board points that rays touching the body's edge lead to.

        The silhouette of a prism runs along the edge of its front face where the camera looks at that edge
        from inside the outline, and along the rear edge where the side wall faces the camera.

        Parameters
        ----------
        edge_mm : array, shape (..., 2)
            Points of the outline, the same on both faces.
        outward : array, shape (..., 2)
            Normals of the outline there.
        """
        height = np.where(self._wall_is_seen(edge_mm, outward), self.rear_mm, self.face_mm)
        return self._drop(edge_mm, height)

    def touched_at(self, board_mm: FloatArray, outward: FloatArray) -> FloatArray:
        """Return the points of the outline that rays to board points touch: `seen_at` the other way round."""
        height = np.where(self._wall_is_seen(board_mm, outward), self.rear_mm, self.face_mm)
        share = (self.distance_mm - height) / self.distance_mm
        return np.asarray(self.foot_mm + (board_mm - self.foot_mm) * share[..., None])

    def _wall_is_seen(self, edge_mm: FloatArray, outward: FloatArray) -> BoolArray:
        return np.asarray(((self.foot_mm - edge_mm) * outward).sum(axis=-1) > 0)

    def _drop(self, points_mm: FloatArray, height: FloatArray) -> FloatArray:
        share = self.distance_mm / (self.distance_mm - height)
        return np.asarray(self.foot_mm + (points_mm - self.foot_mm) * share[..., None])


def line_of_sight(pose: Pose, *, standoff_mm: float, body_width_mm: float) -> Sight:
    """Return the sight from a pose past an actuator ``body_width_mm`` wide along the line of sight."""
    return Sight(pose.centre_mm[:2], pose.distance_mm, standoff_mm, standoff_mm - body_width_mm)
