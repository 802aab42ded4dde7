"""Hexahedral meshes of one order: nodes, elements, regions, node sets and the faces of the cavity."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from skfem import Basis, ElementHex1, ElementHex2, MeshHex

from .elements import FloatArray, IntArray, reference_element, reference_face

BoolArray = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class HexMesh:
    """A mesh of 8- or 27-node hexahedra.

    Parameters
    ----------
    order : int
        1 or 2.
    nodes_mm : array, shape (n_nodes, 3)
    elements : array, shape (n_elements, 8 or 27)
        Nodes of each element, in the order of `reference_element`.
    region : array, shape (n_elements,)
        Index into `region_names`.
    region_names : tuple of str
    cavity_faces : array, shape (n_faces, 4 or 9)
        Nodes of the faces that enclose the gas, in the order of `reference_face`; their normals point
        out of the cavity. Empty where there is none.
    node_sets : dict of str to array
        Named sets of nodes.
    """

    order: int
    nodes_mm: FloatArray
    elements: IntArray
    region: IntArray
    region_names: tuple[str, ...]
    cavity_faces: IntArray
    node_sets: dict[str, IntArray] = field(default_factory=dict)

    @property
    def n_dofs(self) -> int:
        """Number of displacement components, constrained ones included."""
        return 3 * len(self.nodes_mm)


@dataclass(frozen=True)
class TensorGrid:
    """Grid lines of a structured mesh, in mm, increasing.

    Parameters
    ----------
    x_mm, y_mm, z_mm : array, shape (n_lines,)
    """

    x_mm: FloatArray
    y_mm: FloatArray
    z_mm: FloatArray

    def cell_centres(self) -> FloatArray:
        """Return the cells' centres, shape (n_cells, 3), in the order of `MeshHex.init_tensor`."""
        mesh = MeshHex.init_tensor(self.x_mm, self.y_mm, self.z_mm)
        return np.asarray(mesh.p[:, mesh.t].mean(axis=1).T)


def structured_mesh(
    grid: TensorGrid,
    *,
    order: int,
    region: IntArray | None = None,
    region_names: tuple[str, ...] = ("solid",),
    is_cavity_face: Callable[[FloatArray], BoolArray] | None = None,
    mapping: Callable[[FloatArray], FloatArray] | None = None,
) -> HexMesh:
    """Mesh a tensor grid of cells.

    Parameters
    ----------
    grid : TensorGrid
    order : int
        1 or 2.
    region : array, shape (n_cells,), optional
        Index of each cell's region; a negative index leaves the cell out. By default all are region 0.
    region_names : tuple of str
    is_cavity_face : callable, optional
        Told the centres of the boundary faces, shape (n, 3), in grid coordinates; returns which of them
        enclose the gas.
    mapping : callable, optional
        Maps grid coordinates to mm, shape (n, 3) to (n, 3); applied to every node, mid-side ones too.

    Returns
    -------
    HexMesh
    """
    box = MeshHex.init_tensor(grid.x_mm, grid.y_mm, grid.z_mm)
    codes = np.zeros(box.nelements, dtype=np.int64) if region is None else np.asarray(region)
    kept = np.flatnonzero(codes >= 0)
    mesh = box.restrict(kept)
    basis = Basis(mesh, ElementHex1() if order == 1 else ElementHex2(), intorder=1)
    elements = np.asarray(basis.element_dofs.T, dtype=np.int64)
    nodes = np.asarray(basis.doflocs.T)
    faces = _cavity_faces(mesh, elements, nodes, order=order, chosen=is_cavity_face)
    return HexMesh(
        order=order,
        nodes_mm=np.ascontiguousarray(nodes if mapping is None else mapping(nodes)),
        elements=np.ascontiguousarray(elements),
        region=codes[kept],
        region_names=region_names,
        cavity_faces=faces,
    )


def _cavity_faces(
    mesh: MeshHex,
    elements: IntArray,
    nodes: FloatArray,
    *,
    order: int,
    chosen: Callable[[FloatArray], BoolArray] | None,
) -> IntArray:
    """Nodes of the boundary faces picked by `chosen`, normals pointing into the solid."""
    table = reference_face(order)
    if chosen is None:
        return np.empty((0, table.nodes.shape[1]), dtype=np.int64)
    boundary = mesh.boundary_facets()
    picked = boundary[chosen(mesh.p[:, mesh.facets[:, boundary]].mean(axis=1).T)]
    picked_centres = mesh.p[:, mesh.facets[:, picked]].mean(axis=1).T
    owner = elements[mesh.f2t[0, picked]]
    candidates = owner[:, table.nodes]
    distance = np.linalg.norm(nodes[candidates].mean(axis=2) - picked_centres[:, None, :], axis=2)
    faces = candidates[np.arange(len(picked)), distance.argmin(axis=1)]
    inverted = _orientation(nodes[owner], order=order) < 0
    return np.where(inverted[:, None], faces, faces[:, table.flipped])


def _orientation(element_nodes: FloatArray, *, order: int) -> FloatArray:
    """Sign of the map from the unit cube, shape (n_elements,): scikit-fem's may be reflected."""
    gradient = reference_element(order).gradients[0]
    return np.sign(np.linalg.det(np.einsum("eai,ja->eij", element_nodes, gradient)))
