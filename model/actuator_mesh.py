"""The structured mesh of one half of the actuator."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from spavision.errors import InputError

from .elements import FloatArray, IntArray
from .geometry import ActuatorGeometry
from .hex_mesh import BoolArray, HexMesh, TensorGrid, structured_mesh

REGIONS = ("composite", "strip A", "body", "strip B")
_VOID = -1


@dataclass(frozen=True)
class MeshLevel:
    """Element order and number of elements in each part of the structure.

    Parameters
    ----------
    order : int
        1 (Q1/P0) or 2 (Q2/P1-discontinuous).
    composite, strip_a, channel, void, roof, strip_b : int
        Across the height: layers of elements; ``void`` counts those between channel and roof.
    channel_width, void_width, side_wall : int
        Across the half width.
    void_length, wall_length : int
        Along the actuator, in each void and each wall.
    void_width_grading : float
        Length of each element across the void over that of the one before, towards the side wall: the
        corner between the two attracts the largest gradients.
    """

    order: int
    composite: int = 1
    strip_a: int = 1
    channel: int = 1
    void: int = 1
    roof: int = 1
    strip_b: int = 1
    channel_width: int = 1
    void_width: int = 1
    side_wall: int = 1
    void_length: int = 1
    wall_length: int = 1
    void_width_grading: float = 1.0


MESH_LEVELS = {
    "draft": MeshLevel(order=2),
    "default": MeshLevel(order=2, void=2, void_length=2),
    "fine": MeshLevel(
        order=2, void=2, void_width=2, void_width_grading=1 / 3, side_wall=2, void_length=2, channel=2
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
        Regions `REGIONS`; node sets ``clamp`` (y = 0) and ``symmetry`` (z = 0).

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
    )
    sets = {
        "clamp": np.flatnonzero(np.isclose(mesh.nodes_mm[:, 1], 0.0)),
        "symmetry": np.flatnonzero(np.isclose(mesh.nodes_mm[:, 2], 0.0)),
    }
    return replace(mesh, node_sets=sets)


def _grid(geometry: ActuatorGeometry, level: MeshLevel) -> TensorGrid:
    across = [
        (geometry.composite_mm, level.composite),
        (geometry.strip_a_mm, level.strip_a),
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
    gradings = (1.0, level.void_width_grading, 1.0)
    along: list[tuple[float, int]] = []
    previous_end = 0.0
    for begin, end in geometry.void_spans_mm():
        along += [(begin - previous_end, level.wall_length), (end - begin, level.void_length)]
        previous_end = end
    along.append((geometry.length_mm - previous_end, level.wall_length))
    return TensorGrid(_lines(across), _lines(along), _lines(wide, gradings))


def _lines(intervals: list[tuple[float, int]], gradings: tuple[float, ...] | None = None) -> FloatArray:
    """Grid lines from 0 of consecutive intervals (length, number of elements), empty ones left out."""
    ratios = gradings or (1.0,) * len(intervals)
    steps = [
        length * _shares(count, ratio)
        for (length, count), ratio in zip(intervals, ratios, strict=True)
        if length > 0.0
    ]
    return np.concatenate([[0.0], np.cumsum(np.concatenate(steps))])


def _shares(count: int, ratio: float) -> FloatArray:
    """Lengths of elements that grow by a ratio and add up to one."""
    sizes = ratio ** np.arange(count)
    return sizes / sizes.sum()


def _regions(geometry: ActuatorGeometry, centres: FloatArray) -> IntArray:
    """Region of each grid cell, `_VOID` for the gas."""
    x, y, z = centres.T
    base = geometry.body_base_mm
    tops = np.array([geometry.composite_mm, base, base + geometry.height_mm])
    region = np.searchsorted(tops, x).astype(np.int64)
    in_void_span = np.zeros(len(y), dtype=bool)
    for begin, end in geometry.void_spans_mm():
        in_void_span |= (y > begin) & (y < end)
    in_voids = in_void_span & (z < 0.5 * geometry.void_width_mm) & (x < base + geometry.void_depth_mm)
    first, last = geometry.void_spans_mm()[0][0], geometry.void_spans_mm()[-1][1]
    in_channel = (
        (y > first)
        & (y < last)
        & (z < 0.5 * geometry.channel_width_mm)
        & (x < base + geometry.channel_height_mm)
    )
    region[(x > base) & (in_voids | in_channel)] = _VOID
    return region
