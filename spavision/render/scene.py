"""A scene: what stands where, as flat numbers for the ray caster."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .body import CentreLine

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
Colour = tuple[float, float, float]

DISC, TUBE, BODY, BOX = 0, 1, 2, 3
"""Kinds of things, in the order list of a scene."""


class Eye(NamedTuple):
    """The camera, as the ray caster wants it: ``rotation`` row by row, ``centre`` in the board frame."""

    fx: float
    fy: float
    cx: float
    cy: float
    distortion: tuple[float, ...]
    rotation: tuple[Colour, ...]
    centre: tuple[float, float, float]


class Sheet(NamedTuple):
    """The checkerboard and the wall behind it."""

    pitch: float
    half_width: float
    half_height: float
    margin: float
    white: Colour
    black: Colour
    wall: Colour
    mottle: float


class Body(NamedTuple):
    """The actuator: where the grid of its coordinates starts, its outline, its layers."""

    x0: float
    y0: float
    step: float
    length: float
    stretch: float
    half_depth: float
    bulge: float
    void_pitch: float
    face_z: float
    face_slope: float
    base_y: float
    thickness: float
    layer_edges: tuple[float, float, float]
    layer_colours: tuple[Colour, ...]
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

    ``order`` lists (kind, index) from back to front; ``discs``, ``tubes`` and ``boxes`` hold one thing a row:
    a disc x, y, z, radius, colour (3), highlight x, y, radius, strength; a tube x, y, cos, sin, from, to,
    amplitude, wavelength, z, radius, colour (3); a box x, y, half sizes (2), cos, sin, z front, z back,
    colour (3). ``body_table`` holds the coordinates along and across the body, shape (rows, columns, 2).
    """

    eye: Eye
    sheet: Sheet
    body: Body
    body_table: FloatArray
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
