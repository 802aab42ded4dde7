"""Pictures that show what was measured: an overlay a photograph, and a montage of the series."""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np

from .arrays import FloatArray, IntArray, RgbImage
from .camera import project
from .grid import median_pitch, neighbour_rows
from .result import Reading, Track
from .shape import ActuatorShape, shape_pixels

ENLARGEMENTS = (10, 20, 50, 100, 200, 500, 1000)
"""Enlargements of residual vectors; the same in all photographs of a track, so that they can be compared."""

TYPICAL_VECTOR_SQUARES = 0.5
"""Most length that a typical residual vector is drawn with."""

LATTICE_RGB = (0, 170, 255)
RESIDUAL_RGB = (255, 0, 200)
RIM_RGB = (255, 255, 0)
TIP_RGB = (0, 255, 80)
CENTRE_LINE_RGB = (255, 255, 255)
PATH_RGB = (255, 140, 0)
TEXT_RGB = (255, 255, 255)

MONTAGE_HEIGHT_PX = 420
MONTAGE_COLUMNS = 7
MOST_LARGE_TILES = 42
"""More tiles than these are made smaller, so that a long series fits the same sheet."""


def overlay(photo_rgb: RgbImage, track: Track, row: int, *, shape: ActuatorShape | None = None) -> RgbImage:
    """Draw what was measured in a photograph: lattice, residual vectors, marker's rim, tip path, centre line.

    Parameters
    ----------
    photo_rgb : uint8 array, shape (height, width, 3)
        The upright photograph.
    track : Track
        The whole track.
    row : int
        Which of its readings the photograph is.
    shape : ActuatorShape, optional
        The actuator's shape in it.

    Returns
    -------
    uint8 array, shape (height, width, 3)
        A copy with the drawings.
    """
    picture = photo_rgb.copy()
    reading = track.readings[row]
    line = max(1, round(max(picture.shape) / 1600))
    _draw_lattice(picture, reading, line, enlargement=_enlargement(track))
    _draw_path(picture, track, row, line)
    if shape is not None:
        _polyline(picture, shape_pixels(shape, reading, track), line, CENTRE_LINE_RGB)
    if reading.marker_px is not None:
        for point in reading.rim_px[np.isfinite(reading.rim_px).all(axis=1)]:
            _dot(picture, point, line, RIM_RGB)
        _cross(picture, reading.marker_px, 6 * line, line, TIP_RGB)
    if reading.base_px is not None:
        _cross(picture, reading.base_px, 6 * line, line, TIP_RGB)
    _caption(picture, _headline(track, row), line)
    return picture


def montage_tile(
    photo_rgb: RgbImage, track: Track, row: int, *, height_px: int = MONTAGE_HEIGHT_PX
) -> RgbImage:
    """Cut a photograph to the board, scale it to ``height_px``, mark the tip and write the pressure."""
    left, top, right, bottom = _board_box(track, photo_rgb.shape)
    factor = height_px / (bottom - top)
    size = (max(1, round((right - left) * factor)), height_px)
    cut = cv2.resize(photo_rgb[top:bottom, left:right], size, interpolation=cv2.INTER_AREA)
    tile: RgbImage = np.ascontiguousarray(cut, dtype=np.uint8)
    reading = track.readings[row]
    if reading.marker_px is not None:
        place = (reading.marker_px - [left, top] + 0.5) * factor - 0.5
        _circle(tile, place, max(5, round(height_px / 60)), 2, TIP_RGB)
    text = f"{reading.pressure_kPa:g} kPa" + ("" if reading.status == "ok" else f" ({reading.status})")
    _caption(tile, text, 1)
    return tile


def montage_layout(number: int) -> tuple[int, int]:
    """Return the height in px and the columns for a montage of so many tiles."""
    smaller = max(1.0, number / MOST_LARGE_TILES) ** 0.5
    return round(MONTAGE_HEIGHT_PX / smaller), round(MONTAGE_COLUMNS * smaller)


def montage(tiles: Sequence[RgbImage], *, columns: int = MONTAGE_COLUMNS) -> RgbImage:
    """Set tiles side by side, in rows of ``columns``, with a thin white gap.

    Raises
    ------
    ValueError
        If there is no tile.
    """
    if not tiles:
        raise ValueError("a montage needs at least one tile")
    gap, height = 6, max(tile.shape[0] for tile in tiles)
    width = max(tile.shape[1] for tile in tiles)
    columns = min(columns, len(tiles))
    rows = -(-len(tiles) // columns)
    sheet = np.full((rows * (height + gap) - gap, columns * (width + gap) - gap, 3), 255, dtype=np.uint8)
    for number, tile in enumerate(tiles):
        y, x = (number // columns) * (height + gap), (number % columns) * (width + gap)
        sheet[y : y + tile.shape[0], x : x + tile.shape[1]] = tile
    return sheet


def _draw_lattice(picture: RgbImage, reading: Reading, line: int, *, enlargement: int) -> None:
    """Thin lines between neighbouring corners, and enlarged residual vectors."""
    if len(reading.corners_px) == 0:
        return
    for step in ((1, 0), (0, 1)):
        starts, ends = neighbour_rows(reading.indices, step)
        segments = np.stack([reading.corners_px[starts], reading.corners_px[ends]], axis=1)
        cv2.polylines(picture, list(_fixed(segments)), False, LATTICE_RGB, 1, cv2.LINE_AA, shift=SHIFT)
    tips = reading.corners_px + enlargement * reading.residuals_px
    vectors = np.stack([reading.corners_px, tips], axis=1)
    cv2.polylines(picture, list(_fixed(vectors)), False, RESIDUAL_RGB, line, cv2.LINE_AA, shift=SHIFT)


def _enlargement(track: Track) -> int:
    """Return how much residual vectors are enlarged, so that typical ones show and do not overlap."""
    measured = [reading for reading in track.readings if len(reading.corners_px) > 1]
    if not measured:
        return ENLARGEMENTS[0]
    rms_px = float(np.median([reading.rms_px for reading in measured]))
    longest_px = TYPICAL_VECTOR_SQUARES * median_pitch(measured[0].indices, measured[0].corners_px)
    return max((e for e in ENLARGEMENTS if e * rms_px <= longest_px), default=ENLARGEMENTS[0])


def _draw_path(picture: RgbImage, track: Track, row: int, line: int) -> None:
    """Draw the tip's path up to this photograph, seen from this photograph's camera position."""
    pose = track.readings[row].pose
    places = [r.marker_mm for r in track.readings[: row + 1] if r.marker_mm is not None]
    if pose is None or not places:
        return
    standoff = track.standoff_mm if track.parallax_factor != 1.0 else 0.0
    points = np.column_stack([np.array(places), np.full(len(places), -(standoff or 0.0))])
    pixels = project(track.camera, pose, points)
    _polyline(picture, pixels, line, PATH_RGB)
    for pixel in pixels:
        _circle(picture, pixel, 3 * line, line, PATH_RGB)


def _headline(track: Track, row: int) -> str:
    reading, path = track.readings[row], track.tip_path
    text = f"{reading.photo}  {reading.pressure_kPa:g} kPa  {reading.status}"
    if reading.marker_px is not None:
        text += (
            f"  ux {path.ux_mm[row]:.3f} +- {path.sigma_ux_mm[row]:.3f} mm"
            f"  uy {path.uy_mm[row]:.3f} +- {path.sigma_uy_mm[row]:.3f} mm"
        )
    if np.isfinite(reading.rms_px):
        text += f"  corners {len(reading.indices)}, rms {reading.rms_px:.3f} px"
        text += f" (vectors x{_enlargement(track)})"
    return f"{text}  {reading.reason}".rstrip()


def _board_box(track: Track, shape: tuple[int, ...]) -> tuple[int, int, int, int]:
    """Left, top, right, bottom of what all photographs show of the board and the tip."""
    corners = [r.corners_px for r in track.readings if len(r.corners_px)]
    markers = [r.marker_px[None] for r in track.readings if r.marker_px is not None]
    points = np.concatenate([corners[0], *markers])
    margin = 0.03 * np.ptp(points, axis=0)
    low = np.maximum(points.min(axis=0) - margin, 0).astype(int)
    high = np.minimum(points.max(axis=0) + margin + 1, shape[1::-1]).astype(int)
    return int(low[0]), int(low[1]), int(high[0]), int(high[1])


SHIFT = 4
"""Bits of sub-pixel precision in OpenCV's drawing."""


def _fixed(points: FloatArray) -> IntArray:
    return np.rint(np.clip(points, -30000, 30000) * 2**SHIFT).astype(np.int32)


def _dot(picture: RgbImage, point: FloatArray, radius: int, rgb: tuple[int, int, int]) -> None:
    x, y = _fixed(point).tolist()
    cv2.circle(picture, (x, y), radius * 2**SHIFT // 2, rgb, -1, cv2.LINE_AA, SHIFT)


def _polyline(picture: RgbImage, pixels: FloatArray, line: int, rgb: tuple[int, int, int]) -> None:
    cv2.polylines(picture, [_fixed(pixels)], False, rgb, line, cv2.LINE_AA, shift=SHIFT)


def _circle(picture: RgbImage, point: FloatArray, radius: int, line: int, rgb: tuple[int, int, int]) -> None:
    x, y = _fixed(point).tolist()
    cv2.circle(picture, (x, y), radius * 2**SHIFT, rgb, line, cv2.LINE_AA, SHIFT)


def _cross(picture: RgbImage, point: FloatArray, reach: int, line: int, rgb: tuple[int, int, int]) -> None:
    arms = np.array([[[-reach, 0], [reach, 0]], [[0, -reach], [0, reach]]]) + point
    cv2.polylines(picture, list(_fixed(arms)), False, rgb, line, cv2.LINE_AA, shift=SHIFT)


def _caption(picture: RgbImage, text: str, line: int) -> None:
    """White text on a dark band along the upper edge; made smaller where it would not fit."""
    font, scale = cv2.FONT_HERSHEY_SIMPLEX, 0.5 * line + 0.1
    ascii_text = text.encode("ascii", "replace").decode()
    (width, height), _ = cv2.getTextSize(ascii_text, font, scale, line)
    if width > picture.shape[1] - 12:
        scale *= (picture.shape[1] - 12) / width
        (width, height), _ = cv2.getTextSize(ascii_text, font, scale, line)
    band = 2 * height
    picture[:band] = (picture[:band] * 0.35).astype(np.uint8)
    cv2.putText(picture, ascii_text, (6, round(1.5 * height)), font, scale, TEXT_RGB, line, cv2.LINE_AA)
