"""Marker candidates of one photograph: right colour, right size, round."""

from __future__ import annotations

from dataclasses import dataclass, replace

import cv2
import numpy as np

from .arrays import FloatArray, FloatImage, RgbImage, blur, shrunk_place
from .board import BoardView
from .camera import project, to_plane
from .circle import Circle
from .colour import colour_chroma, colour_strength, white_balance
from .disc import Disc, fit_disc
from .rim import find_rim

FAINTEST_SHARE = 0.22
"""Chroma along the marker's hue, over the named colour's, below which nothing counts as coloured."""

VIVID_SHARE = 0.5
"""The same share from which a colour is no tint of a square."""

DIAMETER_RANGE_SQUARES = (0.7, 5.0)
"""Plausible marker diameters where none is given: 1.75 to 12.5 mm on 2.5 mm squares."""

MOST_CANDIDATES = 12

OUTLINE_POINTS = 96

SPOT_PITCH_PX = 12.0
"""Squares of this size suffice to see where spots are; larger photographs are scaled down for it."""

SURROUNDINGS_RADII = 4.0
"""Half width of the part of a photograph in which a spot is measured, in its approximate radius."""

SMOOTHING_PX = 0.6

WHOLE = 0.8
"""Share of the rim above which a disc is fitted to its pixels."""


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
    disc_px : array, shape (m, 2), or None
        Outline of the disc fitted to the pixels, where the rim is seen whole.
    disc_sigma_px : float or None
        Standard uncertainty of one coordinate of that disc's centre.
    roundness : float
        Root mean square distance of supporting edge points from the circle, over the radius.
    coverage : float
        Share of the rim that supports the circle.
    strength : float
        Chroma along the marker's hue.
    contrast : float
        Step across the rim over its noise.
    on_board : float
        Share of the lattice's nodes close around that are seen: 0 on the actuator, 1 for a spot on the board.
    """

    centre_px: FloatArray
    place_squares: FloatArray
    radius_squares: float
    rim_px: FloatArray
    disc_px: FloatArray | None
    disc_sigma_px: float | None
    roundness: float
    coverage: float
    strength: float
    contrast: float
    on_board: float


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
    factor = min(1.0, SPOT_PITCH_PX / board.pitch_px)
    pitch = factor * board.pitch_px
    small: RgbImage = part
    if factor < 1.0:
        shrunk = cv2.resize(part, None, fx=factor, fy=factor, interpolation=cv2.INTER_AREA)
        small = np.asarray(shrunk, dtype=np.uint8)
    strength = blur(colour_strength(small, white_balance(rgb, board), colour), max(0.12 * low * pitch, 0.7))
    spots = _spots(small, strength, FAINTEST_SHARE * colour_chroma(colour), low * pitch, high * pitch)
    offset = np.array([left, top], dtype=float)
    found = [_examine(rgb, board, _enlarged(spot, factor, offset)) for spot in spots[:MOST_CANDIDATES]]
    vivid = VIVID_SHARE * colour_chroma(colour)
    return tuple(
        c
        for c in found
        if c is not None and low < 2.0 * c.radius_squares < high and not _is_square(c, vivid=vivid)
    )


def _region(board: BoardView, shape: tuple[int, ...]) -> tuple[int, int, int, int]:
    """Left, top, right, bottom of the part of the photograph in which the marker is looked for."""
    margin = 0.15 * np.ptp(board.pixels, axis=0)
    low = np.maximum(np.floor(board.pixels.min(axis=0) - margin), 0).astype(int)
    high = np.minimum(np.ceil(board.pixels.max(axis=0) + margin) + 1, shape[1::-1]).astype(int)
    return int(low[0]), int(low[1]), int(high[0]), int(high[1])


@dataclass(frozen=True)
class _Spot:
    """A patch of the marker's colour: centre (2,) px, radius px, strength of its colour, and colour (3,)."""

    centre_px: FloatArray
    radius_px: float
    strength: float
    colour: FloatArray


def _spots(
    part: RgbImage, strength: FloatImage, faintest: float, smallest_px: float, largest_px: float
) -> list[_Spot]:
    """Patches of the marker's colour and of a plausible size, strongest and largest first."""
    number, _, stats, _ = cv2.connectedComponentsWithStats(
        (strength > faintest).astype(np.uint8), connectivity=8
    )
    spots = []
    for x, y, width, height, area in stats[1:number].tolist():
        if area < 0.15 * smallest_px**2:
            continue
        box = strength[y : y + height, x : x + width]
        peak = float(np.percentile(box[box > faintest], 90))
        # Half of its own strength outlines a spot whatever the light.
        inner, labels, inner_stats, middles = cv2.connectedComponentsWithStats(
            (box > 0.5 * peak).astype(np.uint8)
        )
        for label in range(1, inner):
            extent = max(inner_stats[label, cv2.CC_STAT_WIDTH], inner_stats[label, cv2.CC_STAT_HEIGHT])
            if 0.8 * smallest_px < extent < 1.3 * largest_px:
                core = (labels == label) & (box > 0.8 * peak)
                colours = part[y : y + height, x : x + width][core]
                colour = np.median(colours, axis=0) if len(colours) else np.zeros(3)
                spots.append(_Spot(middles[label] + [x, y], extent / 2.0, peak, colour))
    spots.sort(key=lambda spot: -spot.strength * spot.radius_px)
    return spots


def _enlarged(spot: _Spot, factor: float, offset: FloatArray) -> _Spot:
    """Return a spot of a part that was scaled down, in the photograph's own pixels."""
    centre = shrunk_place(spot.centre_px, 1.0 / factor) + offset
    return replace(spot, centre_px=centre, radius_px=spot.radius_px / factor)


def _examine(rgb: RgbImage, board: BoardView, spot: _Spot) -> Candidate | None:
    """Measure a spot's rim; None when it has none."""
    reach = SURROUNDINGS_RADII * spot.radius_px + 4.0
    left, top = np.maximum(np.floor(spot.centre_px - reach), 0).astype(int)
    right, bottom = np.ceil(spot.centre_px + reach).astype(int) + 1
    smooth = blur(rgb[top:bottom, left:right].astype(np.float32), SMOOTHING_PX)
    offset = np.array([left, top], dtype=float)
    local, centre = _shifted(board, offset), spot.centre_px - offset
    place = to_plane(local.camera, local.pose, centre[None])
    across = project(local.camera, local.pose, place + np.array([[1.0, 0.0]]))
    scale = float(np.linalg.norm(across[0] - centre))
    found = find_rim(smooth, local, centre, spot.radius_px / scale, spot.colour)
    if found is None:
        return None
    rim, circle = found
    disc = fit_disc(smooth, local, circle) if circle.coverage >= WHOLE else None
    return Candidate(
        centre_px=project(local.camera, local.pose, circle.centre[None])[0] + offset,
        place_squares=circle.centre,
        radius_squares=circle.radius,
        rim_px=rim.pixels + offset,
        disc_px=None if disc is None else _outline(local, disc) + offset,
        disc_sigma_px=None if disc is None else disc.sigma_px,
        roundness=circle.rms / circle.radius,
        coverage=circle.coverage,
        strength=spot.strength,
        contrast=rim.contrast,
        on_board=_board_around(board, circle),
    )


def _outline(board: BoardView, disc: Disc) -> FloatArray:
    """Points on the rim of a disc, px."""
    angle = np.linspace(0.0, 2.0 * np.pi, OUTLINE_POINTS, endpoint=False)
    ring = disc.centre + disc.radius * np.column_stack([np.cos(angle), np.sin(angle)])
    return project(board.camera, board.pose, ring)


def _is_square(candidate: Candidate, *, vivid: float) -> bool:
    """Tell a square of the board, tinted by noise or fringes, from a dot."""
    return candidate.on_board > 0.8 and candidate.radius_squares < 0.75 and candidate.strength < vivid


def _board_around(board: BoardView, circle: Circle) -> float:
    """Share of the lattice's nodes in a ring about a spot that are seen."""
    low = board.indices.min(axis=0)
    seen = np.zeros(np.ptp(board.indices, axis=0) + 1, dtype=bool)
    seen[tuple((board.indices - low).T)] = True
    reach = 1.15 * circle.radius + 1.3
    first, last = np.ceil(circle.centre - reach), np.floor(circle.centre + reach)
    columns, rows = np.meshgrid(np.arange(first[0], last[0] + 1), np.arange(first[1], last[1] + 1))
    nodes = np.column_stack([columns.ravel(), rows.ravel()]).astype(np.intp)
    distance = np.linalg.norm(nodes - circle.centre, axis=1)
    nodes = nodes[(distance < reach) & (distance > reach - 1.0)] - low
    within = ((nodes >= 0) & (nodes < seen.shape)).all(axis=1)
    return float(seen[tuple(nodes[within].T)].sum() / max(len(nodes), 1))


def _shifted(board: BoardView, offset: FloatArray) -> BoardView:
    """Return the same board in the pixel coordinates of a part of the photograph."""
    camera = replace(board.camera, cx=board.camera.cx - offset[0], cy=board.camera.cy - offset[1])
    return replace(board, camera=camera)
