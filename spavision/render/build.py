"""Assemble the scene of one photo from its settings."""

from __future__ import annotations

from math import cos, radians, sin, tan

import numpy as np
from numpy.typing import NDArray

from .body import FIELD_STEP_MM, BodyField, tabulate
from .camera import Camera
from .colours import linear_colour
from .furniture import furnish
from .scene import Body, Eye, FaceState, Light, Scene, Sheet
from .settings import ActuatorSettings, Cover, RenderSettings

FloatArray = NDArray[np.float64]

PAPER_WAVELENGTH_MM = 6.0
VOID_PITCH_MM = 10.5


def build_scene(
    settings: RenderSettings, camera: Camera, face: FaceState, covers: tuple[Cover, ...]
) -> Scene:
    """Assemble the scene of one photo."""
    things = furnish(settings, face, covers)
    field = tabulate(face.line)
    return Scene(
        eye=_eye(camera),
        sheet=_sheet(settings),
        body=_body(settings.actuator, face, field),
        body_table=np.stack([field.along_mm, field.across_mm], axis=-1),
        light=_light(settings),
        order=np.array(things.order, dtype=np.int64).reshape(-1, 2),
        discs=np.array(things.discs).reshape(-1, 11),
        tubes=np.array(things.tubes).reshape(-1, 13),
        boxes=np.array(things.boxes).reshape(-1, 11),
    )


def _eye(camera: Camera) -> Eye:
    m = camera.matrix
    fx, fy, cx, cy = m[[0, 1, 0, 1], [0, 1, 2, 2]].tolist()
    rotation = tuple(_triple(row) for row in camera.rotation)
    return Eye(fx, fy, cx, cy, tuple(camera.distortion.tolist()), rotation, _triple(camera.centre_mm))


def _sheet(settings: RenderSettings) -> Sheet:
    board = settings.board
    tint = linear_colour(board.tint)
    return Sheet(
        pitch=board.square_mm,
        half_width=board.columns * board.square_mm / 2,
        half_height=board.rows * board.square_mm / 2,
        margin=board.margin_mm,
        white=_triple(board.white * tint),
        black=(board.black, board.black, board.black),
        wall=_triple(linear_colour(board.wall)),
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


def _body(actuator: ActuatorSettings, face: FaceState, field: BodyField) -> Body:
    depths = [actuator.composite_mm, actuator.interface_mm, actuator.body_mm, actuator.strip_mm]
    half_depth = sum(depths) / 2
    names = [actuator.composite_colour, actuator.body_colour, actuator.body_colour, actuator.strip_colour]
    rise = face.dot_mm[2] - actuator.standoff_mm
    return Body(
        x0=field.x0_mm,
        y0=field.y0_mm,
        step=FIELD_STEP_MM,
        length=actuator.length_mm * face.line.stretch,
        stretch=face.line.stretch,
        half_depth=half_depth,
        bulge=actuator.bulge_mm * face.swelling,
        void_pitch=VOID_PITCH_MM,
        face_z=actuator.standoff_mm,
        face_slope=rise / (face.dot_mm[1] - face.base_mm[1]),
        base_y=face.base_mm[1],
        thickness=actuator.thickness_mm,
        layer_edges=_triple(np.cumsum(depths)[:3] - half_depth),
        layer_colours=tuple(_triple(linear_colour(name)) for name in names),
        composite_side=-1.0 if actuator.first_bend == "right" else 1.0,
        paper_amplitude=min(actuator.crimp_ratio * PAPER_WAVELENGTH_MM, 0.46 * actuator.composite_mm),
        paper_wavelength=PAPER_WAVELENGTH_MM,
    )


def _triple(values: FloatArray) -> tuple[float, float, float]:
    first, second, third = values.tolist()
    return first, second, third
