"""The things in front of the board, laid out back to front: clutter, hose, dots, clamp, tape."""

from __future__ import annotations

from math import asin, cos, pi, radians, sin, sqrt

from scipy.optimize import brentq

from .colours import linear_colour
from .scene import BODY, BOX, DISC, TUBE, FaceState
from .settings import Cover, RenderSettings

CLAMP_HEIGHT_MM = 24.0
CLAMP_HALF_WIDTH_MM = 23.0
CLAMP_PROUD_MM = 5.0


def furnish(settings: RenderSettings, face: FaceState, covers: tuple[Cover, ...]) -> Things:
    """Return everything that stands before the board in one photo."""
    things = Things()
    _add_board_clutter(things, settings)
    if settings.actuator.visible:
        _add_hose(things, face)
        things.body()
        _add_dots(things, settings, face)
        _add_clamp(things, settings, face)
        for cover in covers:
            _add_cover(things, settings, face, cover)
    return things


class Things:
    """Discs, tubes and boxes as they are added, back to front."""

    def __init__(self) -> None:
        self.order: list[tuple[int, int]] = []
        self.discs: list[list[float]] = []
        self.tubes: list[list[float]] = []
        self.boxes: list[list[float]] = []

    def body(self) -> None:
        """Add the actuator."""
        self.order.append((BODY, 0))

    def disc(
        self,
        centre_mm: tuple[float, float, float],
        radius: float,
        colour: str,
        highlight: tuple[float, float, float, float] = (0, 0, 1, 0),
    ) -> None:
        """Add a flat disc that faces the camera; ``highlight`` is the glint's x, y, radius and strength."""
        self.order.append((DISC, len(self.discs)))
        self.discs.append([*centre_mm, radius, *linear_colour(colour), *highlight])

    def tube(
        self,
        start_mm: tuple[float, float, float],
        angle_deg: float,
        reach_mm: tuple[float, float],
        wave_mm: tuple[float, float],
        radius: float,
        colour: str,
    ) -> None:
        """Add a cable: a point of it, where it leads, its two ends, its waves (height, length)."""
        x, y, z = start_mm
        angle = radians(angle_deg)
        self.order.append((TUBE, len(self.tubes)))
        row = [x, y, cos(angle), sin(angle), *reach_mm, *wave_mm, z, radius, *linear_colour(colour)]
        self.tubes.append(row)

    def box(
        self,
        centre_mm: tuple[float, float],
        half_mm: tuple[float, float],
        angle_deg: float,
        depth_mm: tuple[float, float],
        colour: str,
    ) -> None:
        """Add a turned box; ``depth_mm`` is the z of its front and of its back."""
        angle = radians(angle_deg)
        self.order.append((BOX, len(self.boxes)))
        self.boxes.append([*centre_mm, *half_mm, cos(angle), sin(angle), *depth_mm, *linear_colour(colour)])


def _add_board_clutter(things: Things, settings: RenderSettings) -> None:
    clutter = settings.clutter
    if clutter.red_sticker:
        place = (clutter.sticker_x_mm, clutter.sticker_y_mm, 0.0)
        things.disc(place, clutter.sticker_diameter_mm / 2, "red")
    if clutter.cable:
        radius = clutter.cable_diameter_mm / 2
        place = (clutter.cable_x_mm, 0.0, radius)
        things.tube(place, clutter.cable_angle_deg, (-900, 900), (5, 240), radius, clutter.cable_colour)
    if clutter.red_cable:
        things.tube((78.0, 0.0, 3.0), 97.0, (-900, 900), (7, 190), 1.8, "#b8141c")


def _add_hose(things: Things, face: FaceState) -> None:
    """Hang the air hose from above into the clamp."""
    x, y = face.base_mm
    things.tube((x + 3.0, y - 10.0, 12.0), -84.0, (0, 900), (6, 260), 3.0, "#c9cdc8")


def _add_dots(things: Things, settings: RenderSettings, face: FaceState) -> None:
    marker = settings.marker
    radius = marker.diameter_mm / 2
    angle = radians(marker.highlight_angle_deg)
    away = 0.45 * radius
    x, y, z = face.dot_mm.tolist()
    glint = (x + away * cos(angle), y + away * sin(angle), radius * marker.highlight_size, marker.highlight)
    things.disc((x, y, z), radius, marker.colour, glint)
    if marker.base_marker:
        bx, by, bz = face.base_dot_mm.tolist()
        things.disc((bx, by, bz), radius, marker.base_marker_colour)


def _add_clamp(things: Things, settings: RenderSettings, face: FaceState) -> None:
    """Hold the actuator's base in a printed clamp on a bracket that comes down from above."""
    x, y = face.base_mm
    front = settings.actuator.standoff_mm + CLAMP_PROUD_MM
    things.box((x - 13.0, y - 200.0), (7.0, 190.0), 0.0, (front - 12.0, 2.0), "#8d9196")
    middle = (x, y - CLAMP_HEIGHT_MM / 2)
    things.box(middle, (CLAMP_HALF_WIDTH_MM, CLAMP_HEIGHT_MM / 2), 0.0, (front, 0.5), "#2b2d31")
    left_bolt, right_bolt = (x - 17.0, middle[1], front), (x + 17.0, middle[1], front)
    things.disc(left_bolt, 3.4, "#7c8084")
    things.disc(left_bolt, 1.7, "#26282b")
    things.disc(right_bolt, 3.4, "#b91820" if settings.clutter.red_bolt else "#7c8084")
    things.disc(right_bolt, 1.7, "#8a1016" if settings.clutter.red_bolt else "#26282b")


def _add_cover(things: Things, settings: RenderSettings, face: FaceState, cover: Cover) -> None:
    """Lay a strip of tape over the dot so that it hides the asked share of its area."""
    radius = settings.marker.diameter_mm / 2
    edge = chord_offset(cover.fraction) * radius
    reach = 1.6 * settings.marker.diameter_mm
    x, y, z = face.dot_mm.tolist()
    angle = radians(cover.angle_deg)
    middle = (x + (edge + reach) * cos(angle), y + (edge + reach) * sin(angle))
    things.box(
        middle, (reach, 0.9 * settings.marker.diameter_mm), cover.angle_deg, (z + 0.02, z), cover.colour
    )


def chord_offset(fraction: float) -> float:
    """Return where a straight edge must lie, in radii from the centre, to hide a share of a disc's area."""
    if fraction <= 0:
        return 1.5
    if fraction >= 1:
        return -1.5

    def excess(d: float) -> float:
        return 0.5 - (asin(d) + d * sqrt(1 - d * d)) / pi - fraction

    return float(brentq(excess, -1.0, 1.0))
