"""Marker candidates of one photograph: right colour, right size, round."""

from __future__ import annotations

from dataclasses import dataclass, replace

import cv2
import numpy as np

from .arrays import FloatArray, FloatImage, RgbImage, blur
from .board import BoardView
from .camera import project, to_plane
from .circle import fit_circle
from .colour import colour_strength, white_balance
from .rim import find_rim

FAINTEST_STRENGTH = 9.0
"""Chroma along the marker's hue, in Lab units, below which nothing counts as coloured."""

DIAMETER_RANGE_SQUARES = (0.7, 5.0)
"""Plausible marker diameters where none is given: 1.75 to 12.5 mm on 2.5 mm squares."""

MOST_CANDIDATES = 12


@dataclass(frozen=True)
class Candidate:
    """A spot that may be the marker.

    Parameters
    ----------
    centre_px : array, shape (2,)
        Centre of the circle through its rim, projected.
    place_squares : array, shape (2,)
        The same in squares of the board's own lattice in this photograph.
    radius_squares : float
        Radius of that circle.
    rim_px : array, shape (n, 2)
        Edge points, NaN where a ray shows no edge.
    roundness : float
        Root mean square distance of supporting edge points from the circle, over the radius.
    coverage : float
        Share of the rim that supports the circle.
    strength : float
        Chroma along the marker's hue.
    contrast : float
        Step across the rim over its noise.
    """

    centre_px: FloatArray
    place_squares: FloatArray
    radius_squares: float
    rim_px: FloatArray
    roundness: float
    coverage: float
    strength: float
    contrast: float


def find_candidates(
    rgb: RgbImage,
    board: BoardView,
    *,
    colour: tuple[int, int, int],
    diameter_squares: float | None,
) -> tuple[Candidate, ...]:
    """Find every spot of the marker's colour and about its size, strongest first.

    Parameters
    ----------
    rgb : uint8 array, shape (height, width, 3)
        The photograph.
    board : BoardView
        Its board.
    colour : tuple of int
        Marker colour, sRGB.
    diameter_squares : float or None
        Marker diameter in squares of the board, where known.
    """
    low, high = DIAMETER_RANGE_SQUARES
    if diameter_squares is not None:
        low, high = 0.45 * diameter_squares, 1.8 * diameter_squares
    left, top, right, bottom = _region(board, rgb.shape)
    part = rgb[top:bottom, left:right]
    strength = colour_strength(part, white_balance(rgb, board), colour)
    strength = blur(strength, max(0.12 * low * board.pitch_px, 0.7))
    smooth = blur(part.astype(np.float32), 0.6)
    spots = _spots(strength, low * board.pitch_px, high * board.pitch_px)
    candidates = []
    for centre, radius_px, peak in spots[:MOST_CANDIDATES]:
        candidate = _examine(
            smooth, board, centre, radius_px, peak, offset=np.array([left, top], dtype=float)
        )
        if candidate is not None and low < 2.0 * candidate.radius_squares < high:
            candidates.append(candidate)
    return tuple(candidates)


def _region(board: BoardView, shape: tuple[int, ...]) -> tuple[int, int, int, int]:
    """Left, top, right, bottom of the part of the photograph in which the marker is looked for."""
    margin = 0.15 * np.ptp(board.pixels, axis=0)
    low = np.maximum(np.floor(board.pixels.min(axis=0) - margin), 0).astype(int)
    high = np.minimum(np.ceil(board.pixels.max(axis=0) + margin) + 1, shape[1::-1]).astype(int)
    return int(low[0]), int(low[1]), int(high[0]), int(high[1])


def _spots(
    strength: FloatImage, smallest_px: float, largest_px: float
) -> list[tuple[FloatArray, float, float]]:
    """Centre, radius and peak strength of coloured spots of a plausible size, strongest first."""
    seeds = strength > FAINTEST_STRENGTH
    number, _, stats, _ = cv2.connectedComponentsWithStats(seeds.astype(np.uint8), connectivity=8)
    spots = []
    for label in range(1, number):
        x, y, width, height, area = stats[label]
        if area < 0.15 * smallest_px**2:
            continue
        box = strength[y : y + height, x : x + width]
        peak = float(np.percentile(box[box > FAINTEST_STRENGTH], 90))
        # Half of its own strength outlines a spot whatever the light.
        inner, _, inner_stats, middles = cv2.connectedComponentsWithStats((box > 0.5 * peak).astype(np.uint8))
        for part in range(1, inner):
            size = inner_stats[part, cv2.CC_STAT_AREA]
            extent = max(inner_stats[part, cv2.CC_STAT_WIDTH], inner_stats[part, cv2.CC_STAT_HEIGHT])
            diameter = max(np.sqrt(4.0 * size / np.pi), 0.8 * extent)
            if smallest_px * 0.8 < diameter < largest_px * 1.2:
                spots.append((middles[part] + [x, y], diameter / 2.0, peak))
    spots.sort(key=lambda spot: -spot[2] * spot[1])
    return spots


def _examine(
    smooth: FloatImage,
    board: BoardView,
    centre: FloatArray,
    radius_px: float,
    peak: float,
    *,
    offset: FloatArray,
) -> Candidate | None:
    """Measure a spot's rim; None when it has none or is no disc."""
    local = _shifted(board, offset)
    across = project(
        local.camera, local.pose, to_plane(local.camera, local.pose, centre[None]) + np.array([[1.0, 0.0]])
    )
    scale = float(np.linalg.norm(across[0] - centre))
    found = find_rim(smooth, local, centre, radius_px / scale)
    if found is None:
        return None
    rim, _, _ = found
    circle = fit_circle(to_plane(local.camera, local.pose, rim.pixels))
    if circle is None:
        return None
    return Candidate(
        centre_px=project(local.camera, local.pose, circle.centre[None])[0] + offset,
        place_squares=circle.centre,
        radius_squares=circle.radius,
        rim_px=rim.pixels + offset,
        roundness=circle.rms / circle.radius,
        coverage=circle.coverage,
        strength=peak,
        contrast=rim.contrast,
    )


def _shifted(board: BoardView, offset: FloatArray) -> BoardView:
    """Return the same board in the pixel coordinates of a part of the photograph."""
    camera = replace(board.camera, cx=board.camera.cx - offset[0], cy=board.camera.cy - offset[1])
    return replace(board, camera=camera)
