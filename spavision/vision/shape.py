"""The actuator's shape in a photograph: centre line, heading and curvature in the plane of its side face."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .arrays import FloatArray, RgbImage
from .camera import Pose, project
from .limb import UnclearError, silhouette_mask, walk_limb
from .rectified import imagine_bare, rectify
from .result import Reading, Track
from .sight import line_of_sight
from .silhouette import Silhouette, find_silhouette

POINTS = 51
"""Points of a centre line that are handed over."""

NO_BOARD = "no board"
NO_MARKER = "no marker to start from"

LEAST_SEEN = 0.3
LEAST_SEEN_OVERALL = 0.5
"""Shares of the length along which an edge must be seen: on either side, and on both together."""

LARGEST_SCATTER_SQUARES = 0.16
LARGEST_SIGMA_SQUARES = 0.06
"""Median standard uncertainty across the line beyond which there is none: 0.15 mm for 2.5 mm squares."""

LARGEST_TAPER = 0.15
SHORTEST_WIDTHS = 1.5
MARKER_FROM_TIP = 0.35
"""Share of the length within which the marker must lie from the tip."""


@dataclass(frozen=True)
class ActuatorShape:
    """Centre line of the actuator in the plane of its side face.

    Parameters
    ----------
    arc_mm : array, shape (POINTS,)
        Distance along the line from where the body comes out of the clamp.
    points_mm : array, shape (POINTS, 2)
        x and y in the board's axes, as `Reading.marker_mm`.
    heading_deg : array, shape (POINTS,)
        Direction against the board's downward axis, positive to the right.
    curvature_per_mm : array, shape (POINTS,)
        Change of the heading, rad a millimetre.
    width_mm : array, shape (POINTS,)
        Distance between the edges, smoothed.
    sigma_across_mm, sigma_heading_deg : array, shape (POINTS,)
        Standard uncertainty of the line's place across itself and of its heading, as the edges tell them;
        that of stand-off and scale, which stretch the whole line, comes on top.
    scatter_mm : float
        Median distance of the edge points from the smooth edges: noise, and swelling between the walls.
    """

    arc_mm: FloatArray
    points_mm: FloatArray
    heading_deg: FloatArray
    curvature_per_mm: FloatArray
    width_mm: FloatArray
    sigma_across_mm: FloatArray
    sigma_heading_deg: FloatArray
    scatter_mm: float

    @property
    def length_mm(self) -> float:
        """Length of the visible centre line, clamp to tip."""
        return float(self.arc_mm[-1])

    @property
    def tip_angle_deg(self) -> float:
        """Bend angle at the tip, positive to the right."""
        return float(self.heading_deg[-1])

    @property
    def sigma_tip_angle_deg(self) -> float:
        """Standard uncertainty of the bend angle at the tip."""
        return float(self.sigma_heading_deg[-1])


@dataclass(frozen=True)
class ShapeReading:
    """The shape in one photograph, or why there is none.

    Parameters
    ----------
    photo : str
        File name.
    pressure_kPa : float
    shape : ActuatorShape or None
    reason : str
        Why there is no shape; empty where there is one.
    """

    photo: str
    pressure_kPa: float
    shape: ActuatorShape | None
    reason: str


def shape_of(photo_rgb: RgbImage, reading: Reading, track: Track, *, body_width_mm: float) -> ShapeReading:
    """Measure the shape of the actuator in one photograph.

    Rays to the silhouette are intersected with the plane of the side face, at the stand-off, where the front
    edge is what is seen, and with a plane ``body_width_mm`` behind it where the side wall faces the camera.
    Where the track is uncorrected, the side face is taken to lie in the board's plane, as the marker is.

    Parameters
    ----------
    photo_rgb : uint8 array, shape (height, width, 3)
        The upright photograph.
    reading, track
        What the tracker measured in it, and in all.
    body_width_mm : float
        Size of the body along the line of sight.
    """

    def without(reason: str) -> ShapeReading:
        return ShapeReading(reading.photo, reading.pressure_kPa, None, reason)

    if reading.pose is None or len(reading.indices) == 0:
        return without(NO_BOARD)
    if reading.marker_mm is None:
        return without(NO_MARKER)
    try:
        silhouette = _silhouette(photo_rgb, reading, track, reading.pose, reading.marker_mm, body_width_mm)
        shape = _checked(silhouette, reading.marker_mm, track.square_mm)
    except UnclearError as unclear:
        return without(str(unclear))
    return ShapeReading(reading.photo, reading.pressure_kPa, shape, "")


def _silhouette(
    photo_rgb: RgbImage,
    reading: Reading,
    track: Track,
    pose: Pose,
    marker_mm: FloatArray,
    body_width_mm: float,
) -> Silhouette:
    sight = line_of_sight(pose, standoff_mm=_face_height_mm(track), body_width_mm=body_width_mm)
    marker_on_board = sight.on_board(marker_mm)
    board = rectify(
        photo_rgb,
        track.camera,
        pose,
        indices=reading.indices,
        corners_px=reading.corners_px,
        square_mm=track.square_mm,
        around_mm=marker_on_board,
    )
    bare = None if board is None else imagine_bare(board)
    if board is None or bare is None:
        raise UnclearError("the marker does not hide the board, or too little of the board is seen")
    limb = walk_limb(silhouette_mask(bare.strangeness), board.rgb, board.to_pixels(marker_on_board))
    return find_silhouette(board, bare, limb, sight)


def _checked(silhouette: Silhouette, marker_mm: FloatArray, square_mm: float) -> ActuatorShape:
    """Return the shape of a silhouette that can be believed."""
    line, residuals = silhouette.line, silhouette.residuals_mm
    seen = np.isfinite(residuals).mean(axis=1)
    if seen.min() < LEAST_SEEN or seen.mean() < LEAST_SEEN_OVERALL:
        raise UnclearError("too little of the actuator's edges is seen")
    scatter = float(np.nanmedian(np.abs(residuals)))
    if scatter > LARGEST_SCATTER_SQUARES * square_mm:
        raise UnclearError("the edges found do not lie on a smooth outline")
    if float(np.median(silhouette.sigma_across_mm)) > LARGEST_SIGMA_SQUARES * square_mm:
        raise UnclearError("the edges are too blurred or too faint to place the centre line")
    half = line.half_width_mm
    if np.ptp(half) > LARGEST_TAPER * np.median(half):
        raise UnclearError("the outline found is not of even width")
    if line.length_mm < SHORTEST_WIDTHS * 2.0 * np.median(half):
        raise UnclearError("the outline found is too short for an actuator")
    away = marker_mm - line.points_mm
    nearest = int(np.argmin((away**2).sum(axis=1)))
    if abs(away[nearest] @ line.rightward[nearest]) > half[nearest]:
        raise UnclearError("the marker lies outside the outline found")
    if line.length_mm - line.arc_mm[nearest] > MARKER_FROM_TIP * line.length_mm:
        raise UnclearError("the marker is not near the tip of the outline found")
    pick = np.linspace(0, len(half) - 1, POINTS).astype(np.intp)
    return ActuatorShape(
        line.arc_mm[pick],
        line.points_mm[pick],
        np.degrees(line.heading_rad[pick]),
        line.curvature_per_mm[pick],
        2.0 * half[pick],
        silhouette.sigma_across_mm[pick],
        np.degrees(silhouette.sigma_heading_rad[pick]),
        scatter,
    )


def shape_pixels(shape: ActuatorShape, reading: Reading, track: Track) -> FloatArray:
    """Project a centre line into its photograph, shape (POINTS, 2)."""
    assert reading.pose is not None
    height = np.full(len(shape.points_mm), -_face_height_mm(track))
    return project(track.camera, reading.pose, np.column_stack([shape.points_mm, height]))


def _face_height_mm(track: Track) -> float:
    """Height of the side face over the board; 0 where the track is uncorrected."""
    if track.standoff_mm is None or track.parallax_factor == 1.0:
        return 0.0
    return track.standoff_mm
