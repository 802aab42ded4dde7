"""The structured mesh of one half of the actuator."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from spavision.errors import InputError

from .elements import FloatArray, IntArray
from .geometry import ActuatorGeometry
from .hex_mesh import BoolArray, HexMesh, TensorGrid, structured_mesh

REGIONS = ("composite", "strip A", "body", "strip B")

Division = int | tuple[float, ...]
"""Number of equal elements, or the fractions of the way at which the lines between unequal ones are."""

_VOID = -1

_SAME_LINE_MM = 0.25
"""Grid lines nearer than this are one: thinner elements would spoil the tangent, moulds are no truer."""


@dataclass(frozen=True)
class MeshLevel:
    """Element order and elements in each part of the structure, see `Division`.

    Parameters
    ----------
    order : int
        1 (Q1/P0) or 2 (Q2/P1-discontinuous).
    composite, strip_a, floor, channel, void, roof, strip_b : int
        Across the height: layers of elements; ``void`` counts those between channel and roof.
    channel_width, void_width, side_wall : int
        Across the half width.
    void_length, wall_length : int
        Along the actuator, in each void and each wall.
    void_middle, void_width_middle : float
        Where the middle of the void's elements is, as a fraction of the way from the channel to the roof
        and to the side wall; beyond 0.5 elements and their middle nodes are drawn towards the corners,
        which attract the largest gradients. Between 0.25 and 0.75, where the map becomes singular.
    """

    order: int
    composite: Division = 1
    strip_a: Division = 1
    floor: Division = 1
    channel: Division = 1
    void: Division = 1
    roof: Division = 1
    strip_b: Division = 1
    channel_width: Division = 1
    void_width: Division = 1
    side_wall: Division = 1
    void_length: Division = 1
    wall_length: Division = 1
    void_middle: float = 0.5
    void_width_middle: float = 0.5


MESH_LEVELS = {
    "draft": MeshLevel(order=2, void_width_middle=0.7),
    "default": MeshLevel(order=2, void=3, void_length=2, void_middle=0.7, void_width_middle=0.73),
    "fine": MeshLevel(
        order=2,
        void=4,
        void_width=2,
        side_wall=2,
        void_length=2,
        wall_length=2,
        void_middle=0.6,
        void_width_middle=0.65,
    ),
}
"""Chosen by `benchmarks/fe_convergence.py`; their errors are in `model.mesh_error`."""


def actuator_mesh(geometry: ActuatorGeometry, *, level: str) -> HexMesh:
    """Mesh the half z ≥ 0 of the actuator.

    Parameters
    ----------
    geometry : ActuatorGeometry
    level : str
        A key of `MESH_LEVELS`.

    Returns
    -------
    HexMesh
        Regions `REGIONS`; node sets ``clamp`` (y = 0, and the outer faces as far as the clamp holds them) and
        ``symmetry`` (z = 0).

    Raises
    ------
    InputError
        If the level is unknown.
    """
    if level not in MESH_LEVELS:
        raise InputError(f"mesh level is {level!r}, expected one of {', '.join(MESH_LEVELS)}")
    return mesh_at_level(geometry, MESH_LEVELS[level])


def mesh_at_level(geometry: ActuatorGeometry, level: MeshLevel) -> HexMesh:
    """Mesh the half z ≥ 0 of the actuator with given numbers of elements."""
    grid = _grid(geometry, level)
    upper = np.array([grid.x_mm[-1], grid.y_mm[-1], grid.z_mm[-1]])

    def is_cavity_face(centres: FloatArray) -> BoolArray:
        on_box = np.isclose(centres, 0.0) | np.isclose(centres, upper)
        return ~on_box.any(axis=1)

    mesh = structured_mesh(
        grid,
        order=level.order,
        region=_regions(geometry, grid.cell_centres()),
        region_names=REGIONS,
        is_cavity_face=is_cavity_face,
        mapping=partial(_drawn_to_corners, geometry=geometry, level=level),
    )
    sets = {
        "clamp": np.flatnonzero(_is_clamped(mesh.nodes_mm, upper, _clamped_to_mm(geometry, grid.y_mm))),
        "symmetry": np.flatnonzero(np.isclose(mesh.nodes_mm[:, 2], 0.0)),
    }
    return replace(mesh, node_sets=sets)


def _grid(geometry: ActuatorGeometry, level: MeshLevel) -> TensorGrid:
    across = [
        (geometry.composite_mm, level.composite),
        (geometry.strip_a_mm, level.strip_a),
        (geometry.void_floor_mm, level.floor),
        (geometry.channel_height_mm, level.channel),
        (geometry.void_depth_mm - geometry.channel_height_mm, level.void),
        (geometry.roof_mm, level.roof),
        (geometry.strip_b_mm, level.strip_b),
    ]
    half_channel = 0.5 * geometry.channel_width_mm
    half_void = 0.5 * geometry.void_width_mm
    wide = [
        (half_channel, level.channel_width),
        (half_void - half_channel, level.void_width),
        (geometry.side_wall_mm, level.side_wall),
    ]
    along: list[tuple[float, Division]] = []
    previous_end = 0.0
    for begin, end in geometry.void_spans_mm():
        along += [(begin - previous_end, level.wall_length), (end - begin, level.void_length)]
        previous_end = end
    along.append((geometry.length_mm - previous_end, level.wall_length))
    return TensorGrid(_lines(across), _with_clamp_line(_lines(along), geometry), _lines(wide))


def _with_clamp_line(lines_mm: FloatArray, geometry: ActuatorGeometry) -> FloatArray:
    """Add a grid line where the clamp ends, unless there is one as near as `_SAME_LINE_MM`."""
    end = geometry.clamp_length_mm
    if np.abs(lines_mm - end).min() <= _SAME_LINE_MM:
        return lines_mm
    return np.sort(np.append(lines_mm, end))


def _clamped_to_mm(geometry: ActuatorGeometry, lines_mm: FloatArray) -> float:
    """Return the grid line that stands for the clamp's end."""
    return float(lines_mm[np.abs(lines_mm - geometry.clamp_length_mm).argmin()])


def _is_clamped(nodes_mm: FloatArray, upper_mm: FloatArray, end_mm: float) -> BoolArray:
    """Nodes of the base's end face, and those of the outer faces up to the clamp's end."""
    x, y, z = nodes_mm.T
    is_outside = np.isclose(x, 0.0) | np.isclose(x, upper_mm[0]) | np.isclose(z, upper_mm[2])
    return np.isclose(y, 0.0) | (is_outside & (y <= end_mm + 1e-9) & (end_mm > 0.0))


def _drawn_to_corners(nodes: FloatArray, *, geometry: ActuatorGeometry, level: MeshLevel) -> FloatArray:
    """Move the nodes beside the voids towards roof and side wall."""
    x, y, z = nodes.T
    base = geometry.void_base_mm
    x = _drawn(x, base + geometry.channel_height_mm, base + geometry.void_depth_mm, level.void_middle)
    z = _drawn(z, 0.5 * geometry.channel_width_mm, 0.5 * geometry.void_width_mm, level.void_width_middle)
    return np.column_stack([x, y, z])


def _drawn(coordinate: FloatArray, begin: float, end: float, middle: float) -> FloatArray:
    """Map an interval onto itself by the parabola that takes its middle to a given fraction of it."""
    local = np.clip((coordinate - begin) / (end - begin), 0.0, 1.0)
    return coordinate + (4.0 * middle - 2.0) * local * (1.0 - local) * (end - begin)


def _lines(intervals: list[tuple[float, Division]]) -> FloatArray:
    """Grid lines from 0 of consecutive intervals (length, division), empty ones left out."""
    steps = [
        length * np.diff(np.linspace(0.0, 1.0, parts + 1) if isinstance(parts, int) else [0.0, *parts, 1.0])
        for length, parts in intervals
        if length > 0.0
    ]
    return np.concatenate([[0.0], np.cumsum(np.concatenate(steps))])


def _regions(geometry: ActuatorGeometry, centres: FloatArray) -> IntArray:
    """Region of each grid cell, `_VOID` for the gas."""
    x, y, z = centres.T
    base = geometry.body_base_mm
    tops = np.array([geometry.composite_mm, base, base + geometry.height_mm])
    region = np.searchsorted(tops, x).astype(np.int64)
    in_void_span = np.zeros(len(y), dtype=bool)
    for begin, end in geometry.void_spans_mm():
        in_void_span |= (y > begin) & (y < end)
    bottom = geometry.void_base_mm
    in_voids = in_void_span & (z < 0.5 * geometry.void_width_mm) & (x < bottom + geometry.void_depth_mm)
    first, last = geometry.void_spans_mm()[0][0], geometry.void_spans_mm()[-1][1]
    in_channel = (
        (y > first)
        & (y < last)
        & (z < 0.5 * geometry.channel_width_mm)
        & (x < bottom + geometry.channel_height_mm)
    )
    region[(x > bottom) & (in_voids | in_channel)] = _VOID
    return region
