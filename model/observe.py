"""Readings of a solution: the tracked point, the material mid-line, any point of the undeformed body."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .elements import FloatArray, IntArray, shape_functions
from .geometry import ActuatorGeometry
from .hex_mesh import HexMesh

_LOCATING_STEPS = 5


@dataclass(frozen=True)
class MaterialPoint:
    """A point of the undeformed body as a combination of nodes.

    Parameters
    ----------
    nodes : array, shape (n_element_nodes,)
    weights : array, shape (n_element_nodes,)
    """

    nodes: IntArray
    weights: FloatArray

    def displacement(self, nodal: FloatArray) -> FloatArray:
        """Return the point's displacement, shape (..., 3), from nodal ones, shape (..., n_nodes, 3)."""
        return np.einsum("a,...ai->...i", self.weights, nodal[..., self.nodes, :])


def locate(mesh: HexMesh, position_mm: FloatArray) -> MaterialPoint:
    """Find a point of the undeformed body in a mesh of boxes, nodes graded along their edges.

    Raises
    ------
    ValueError
        If the point lies outside the body.
    """
    return _locate_all(mesh, position_mm[None, :])[0]


def centre_line(mesh: HexMesh, geometry: ActuatorGeometry, displacement_mm: FloatArray) -> FloatArray:
    """Return the deformed mid-line of the whole section in the x-y plane, as a camera sees it.

    The line joins the points of the side face halfway between the composite's and strip B's outer faces,
    from clamp to tip.

    Parameters
    ----------
    mesh : HexMesh
    geometry : ActuatorGeometry
    displacement_mm : array, shape (..., n_nodes, 3)

    Returns
    -------
    array, shape (..., n_points, 2)
    """
    x = 0.5 * (geometry.body_base_mm + geometry.height_mm + geometry.strip_b_mm)
    stations = np.linspace(0.0, geometry.length_mm, 4 * geometry.void_count + 1)
    positions = np.array([(x, y, 0.5 * geometry.width_mm) for y in stations])
    points = _locate_all(mesh, positions)
    moved = np.stack([point.displacement(displacement_mm) for point in points], axis=-2)
    return (moved + positions)[..., :2]


def _locate_all(mesh: HexMesh, positions_mm: FloatArray) -> list[MaterialPoint]:
    """Find points, shape (n, 3), see `locate`."""
    corners = mesh.nodes_mm[mesh.elements]
    low, high = corners.min(axis=1), corners.max(axis=1)
    slack = 1e-9 * (high - low).max()
    owners = []
    for position in positions_mm:
        inside = np.all((position >= low - slack) & (position <= high + slack), axis=1)
        if not inside.any():
            raise ValueError(f"the point {position} lies outside the body")
        owners.append(int(inside.argmax()))
    values = _weights(mesh.order, corners[owners], positions_mm)
    return [MaterialPoint(mesh.elements[owner], row) for owner, row in zip(owners, values, strict=True)]


def _weights(order: int, corners: FloatArray, positions_mm: FloatArray) -> FloatArray:
    """Shape functions at points, one in each element, shape (n, n_element_nodes).

    The points' coordinates in the unit cube by Newton's method: one step for a box, a few where nodes are
    graded.
    """
    local = np.full(positions_mm.shape, 0.5)
    for _ in range(_LOCATING_STEPS):
        values, gradients = shape_functions(order, local)
        jacobian = np.einsum("nai,nja->nij", corners, gradients)
        missing = positions_mm - np.einsum("na,nai->ni", values, corners)
        local = local + np.linalg.solve(jacobian, missing[..., None])[..., 0]
    return shape_functions(order, local)[0]
