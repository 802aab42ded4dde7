"""Whether the deformed actuator passes through itself, which the model, free of contact, does not hinder."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .elements import FloatArray, IntArray
from .hex_mesh import HexMesh

_ROUNDING_MM = 1e-6


@dataclass(frozen=True)
class SelfContact:
    """Two parts of the outline that cross.

    Parameters
    ----------
    first_mm, second_mm : array, shape (3,)
        Their places in the undeformed body.
    """

    first_mm: FloatArray
    second_mm: FloatArray


def self_contact(mesh: HexMesh, displacement_mm: FloatArray) -> SelfContact | None:
    """Find where the outline in the plane of symmetry crosses itself; None if it does not.

    The plane z = 0 holds the bending, so that a part that meets another one does so there, or near.
    Contact beside it, between bulging side walls, is not found.

    Parameters
    ----------
    mesh : HexMesh
        The half z ≥ 0.
    displacement_mm : array, shape (n_nodes, 3)
    """
    line = _outline(mesh)
    position = (mesh.nodes_mm + displacement_mm)[line, :2]
    crossing = _first_crossing(position)
    if crossing is None:
        return None
    first, second = crossing
    return SelfContact(mesh.nodes_mm[line[first]], mesh.nodes_mm[line[second]])


def _outline(mesh: HexMesh) -> IntArray:
    """Nodes at z = 0 along region A's outer face, the end face and region B's face, back to the clamp."""
    x, y, z = mesh.nodes_mm.T
    in_plane = np.abs(z) < _ROUNDING_MM

    def along(on_face: np.ndarray, coordinate: FloatArray) -> IntArray:
        nodes = np.flatnonzero(in_plane & on_face)
        return nodes[np.argsort(coordinate[nodes], kind="stable")]

    outward = along(np.abs(x) < _ROUNDING_MM, y)
    end = along(np.abs(y - y.max()) < _ROUNDING_MM, x)
    back = along(np.abs(x - x.max()) < _ROUNDING_MM, -y)
    return np.concatenate([outward, end[1:-1], back])


def _first_crossing(points: FloatArray) -> tuple[int, int] | None:
    """Find two segments of an open line, (n, 2), that cross, by the signs of four triangles each."""
    begin, end = points[:-1], points[1:]
    begins_at = _side(begin[:, None], end[:, None], begin[None])
    ends_at = _side(begin[:, None], end[:, None], end[None])
    apart = begins_at * ends_at < 0.0
    crosses = np.triu(apart & apart.T, k=2)
    found = np.argwhere(crosses)
    return None if len(found) == 0 else (int(found[0, 0]), int(found[0, 1]))


def _side(begin: FloatArray, end: FloatArray, point: FloatArray) -> FloatArray:
    """Twice the signed area of the triangles begin, end, point."""
    along, across = end - begin, point - begin
    return np.asarray(along[..., 0] * across[..., 1] - along[..., 1] * across[..., 0])
