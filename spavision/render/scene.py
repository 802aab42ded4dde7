"""A scene: what stands where, as flat arrays for the ray caster."""

from __future__ import annotations

from math import asin, cos, pi, radians, sin, sqrt, tan
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from .body import FIELD_STEP_MM, CentreLine, tabulate
from .camera import Camera
from .colours import linear_colour
from .settings import ActuatorSettings, Cover, RenderSettings

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

DISC, TUBE, BODY, BOX = 0, 1, 2, 3
"""Kinds of things, in the order list of a scene."""

CLAMP_HEIGHT_MM = 24.0
CLAMP_HALF_WIDTH_MM = 23.0
CLAMP_PROUD_MM = 5.0
PAPER_WAVELENGTH_MM = 6.0
VOID_PITCH_MM = 10.5


class Eye(NamedTuple):
    """The camera, as the ray caster wants it."""

    fx: float
    fy: float
    cx: float
    cy: float
    distortion: FloatArray
    rotation: FloatArray
    centre: FloatArray


class Sheet(NamedTuple):
    """The checkerboard and the wall behind it."""

    pitch: float
    half_width: float
    half_height: float
    margin: float
    white: FloatArray
    black: FloatArray
    wall: FloatArray
    mottle: float


class Body(NamedTuple):
    """The actuator: its own coordinates on a grid, its outline, its layers."""

    x0: float
    y0: float
    step: float
    along: FloatArray
    across: FloatArray
    length: float
    stretch: float
    half_depth: float
    bulge: float
    void_pitch: float
    face_z: float
    face_slope: float
    base_y: float
    thickness: float
    layer_edges: FloatArray
    layer_colours: FloatArray
    composite_side: float
    paper_amplitude: float
    paper_wavelength: float


class Light(NamedTuple):
    """Illumination and shadows."""

    gradient_x: float
    gradient_y: float
    from_x: float
    from_y: float
    size: float
    shadow: float
    edge_shadow: float
    edge_offset: float
    edge_cos: float
    edge_sin: float
    edge_softness: float


class Scene(NamedTuple):
    """Everything the ray caster needs.

    ``order`` lists (kind, index) from back to front; ``discs``, ``tubes`` and ``boxes`` hold one thing a row.
    """

    eye: Eye
    sheet: Sheet
    body: Body
    light: Light
    order: IntArray
    discs: FloatArray
    tubes: FloatArray
    boxes: FloatArray


class FaceState(NamedTuple):
    """Where the side face and its dots are in one photo."""

    line: CentreLine
    base_mm: tuple[float, float]
    dot_mm: FloatArray
    base_dot_mm: FloatArray
    swelling: float


def build_scene(
    settings: RenderSettings, camera: Camera, face: FaceState, covers: tuple[Cover, ...]
) -> Scene:
    """Assemble the scene of one photo."""
    things = _Things()
    _add_board_clutter(things, settings)
    if settings.actuator.visible:
        _add_hose(things, face)
        things.order.append((BODY, 0))
        _add_dots(things, settings, face)
        _add_clamp(things, settings, face)
        for cover in covers:
            _add_cover(things, settings, face, cover)
    return Scene(
        eye=_eye(camera),
        sheet=_sheet(settings),
        body=_body(settings.actuator, face),
        light=_light(settings),
        order=np.array(things.order, dtype=np.int64).reshape(-1, 2),
        discs=np.array(things.discs).reshape(-1, 11),
        tubes=np.array(things.tubes).reshape(-1, 13),
        boxes=np.array(things.boxes).reshape(-1, 11),
    )


class _Things:
    """Discs, tubes and boxes as they are added, back to front."""

    def __init__(self) -> None:
        self.order: list[tuple[int, int]] = []
        self.discs: list[list[float]] = []
        self.tubes: list[list[float]] = []
        self.boxes: list[list[float]] = []

    def disc(
        self,
        centre_mm: tuple[float, float, float],
        radius: float,
        colour: str,
        highlight: tuple[float, float, float, float] = (0, 0, 1, 0),
    ) -> None:
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
        angle = radians(angle_deg)
        self.order.append((BOX, len(self.boxes)))
        self.boxes.append([*centre_mm, *half_mm, cos(angle), sin(angle), *depth_mm, *linear_colour(colour)])


def _add_board_clutter(things: _Things, settings: RenderSettings) -> None:
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


def _add_hose(things: _Things, face: FaceState) -> None:
    """Hang the air hose from above into the clamp."""
    x, y = face.base_mm
    things.tube((x + 3.0, y - 10.0, 12.0), -84.0, (0, 900), (6, 260), 3.0, "#c9cdc8")


def _add_dots(things: _Things, settings: RenderSettings, face: FaceState) -> None:
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


def _add_clamp(things: _Things, settings: RenderSettings, face: FaceState) -> None:
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


def _add_cover(things: _Things, settings: RenderSettings, face: FaceState, cover: Cover) -> None:
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


def _eye(camera: Camera) -> Eye:
    m = camera.matrix
    rotation = np.ascontiguousarray(camera.rotation)
    return Eye(m[0, 0], m[1, 1], m[0, 2], m[1, 2], camera.distortion, rotation, camera.centre_mm)


def _sheet(settings: RenderSettings) -> Sheet:
    board = settings.board
    tint = linear_colour(board.tint)
    return Sheet(
        pitch=board.square_mm,
        half_width=board.columns * board.square_mm / 2,
        half_height=board.rows * board.square_mm / 2,
        margin=board.margin_mm,
        white=board.white * tint,
        black=board.black * np.ones(3),
        wall=linear_colour(board.wall),
        mottle=board.mottle,
    )


def _light(settings: RenderSettings) -> Light:
    light = settings.light
    angle = radians(light.edge_angle_deg)
    return Light(
        gradient_x=light.gradient_x / 100,
        gradient_y=light.gradient_y / 100,
        from_x=light.from_x,
        from_y=light.from_y,
        size=tan(light.size),
        shadow=light.shadow,
        edge_shadow=light.edge_shadow,
        edge_offset=light.edge_offset_mm,
        edge_cos=cos(angle),
        edge_sin=sin(angle),
        edge_softness=light.edge_softness_mm,
    )


def _body(actuator: ActuatorSettings, face: FaceState) -> Body:
    field = tabulate(face.line)
    depths = [actuator.composite_mm, actuator.interface_mm, actuator.body_mm, actuator.strip_mm]
    half_depth = sum(depths) / 2
    names = [actuator.composite_colour, actuator.body_colour, actuator.body_colour, actuator.strip_colour]
    rise = face.dot_mm[2] - actuator.standoff_mm
    return Body(
        x0=field.x0_mm,
        y0=field.y0_mm,
        step=FIELD_STEP_MM,
        along=field.along_mm,
        across=field.across_mm,
        length=actuator.length_mm * face.line.stretch,
        stretch=face.line.stretch,
        half_depth=half_depth,
        bulge=actuator.bulge_mm * face.swelling,
        void_pitch=VOID_PITCH_MM,
        face_z=actuator.standoff_mm,
        face_slope=rise / (face.dot_mm[1] - face.base_mm[1]),
        base_y=face.base_mm[1],
        thickness=actuator.thickness_mm,
        layer_edges=np.cumsum(depths)[:3] - half_depth,
        layer_colours=np.array([linear_colour(name) for name in names]),
        composite_side=-1.0 if actuator.first_bend == "right" else 1.0,
        paper_amplitude=min(actuator.crimp_ratio * PAPER_WAVELENGTH_MM, 0.46 * actuator.composite_mm),
        paper_wavelength=PAPER_WAVELENGTH_MM,
    )
