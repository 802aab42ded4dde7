"""The half cell of the wave in quadratic quadrilaterals, in the form that the solid's kernels take."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from spavision.model.element_geometry import ElementGeometry
from spavision.model.elements import FloatArray, IntArray

from .geometry import CouponGeometry
from .quadratic import gauss_rule, line_shapes


@dataclass(frozen=True)
class MeshDensity:
    """How many cells there are along half a fold, along a leg, and on each side of the paper.

    Parameters
    ----------
    fold, leg, side : int
    """

    fold: int = 2
    leg: int = 10
    side: int = 4


@dataclass(frozen=True)
class PlaneMesh:
    """Nine-node quadrilaterals over half a wave, with a tenth node that all share.

    The tenth node's third displacement component is the strain along z, which is the same everywhere: its
    «shape function» is z itself. With it plane strain and generalised plane strain need no elements of
    their own.

    Parameters
    ----------
    nodes_mm : array, shape (n_nodes, 2)
        The shared node, last, has no place: NaN.
    elements : array, shape (n_elements, 10)
    paper_nodes : array, shape (2·n_cells + 1,)
        Along the paper from trough to peak.
    left, right : array
        Nodes on the two planes of mirror symmetry.
    """

    nodes_mm: FloatArray
    elements: IntArray
    paper_nodes: IntArray
    left: IntArray
    right: IntArray

    @property
    def shared_node(self) -> int:
        """The node that carries the strain along z."""
        return len(self.nodes_mm) - 1


def plane_mesh(geometry: CouponGeometry, density: MeshDensity) -> PlaneMesh:
    """Mesh half a wave, from a trough to the next peak; the paper runs along element edges."""
    paper = geometry.points(geometry.stations(density.fold, density.leg))
    columns, rows = len(paper), 4 * density.side + 1
    half = 0.5 * geometry.thickness_mm
    share = np.linspace(0.0, 1.0, 2 * density.side + 1)
    below = -half + (paper[:, 1:] + half) * share
    above = paper[:, 1:] + (half - paper[:, 1:]) * share
    y = np.concatenate([below, above[:, 1:]], axis=1)
    x = np.broadcast_to(paper[:, :1], y.shape)
    number = np.arange(columns * rows).reshape(columns, rows)
    nodes = np.column_stack([x.ravel(), y.ravel()])
    corners = number[:-2:2, :-2:2].reshape(-1, 1)
    local = np.array([i * rows + j for i in range(3) for j in range(3)])
    elements = np.column_stack([corners + local, np.full(len(corners), len(nodes))])
    return PlaneMesh(
        nodes_mm=np.vstack([nodes, [[np.nan, np.nan]]]),
        elements=elements,
        paper_nodes=number[:, 2 * density.side],
        left=number[0],
        right=number[-1],
    )


def plane_geometry(mesh: PlaneMesh) -> ElementGeometry:
    """Tabulate gradients, volumes for unit width, and the three linear pressure modes of each element."""
    place, weight = gauss_rule(3)
    value, slope = line_shapes(place)
    values = np.einsum("pi,qj->pqij", value, value).reshape(9, 9)
    local = np.stack(
        [
            np.einsum("pi,qj->pqij", slope, value).reshape(9, 9),
            np.einsum("pi,qj->pqij", value, slope).reshape(9, 9),
        ],
        axis=1,
    )
    corners = mesh.nodes_mm[mesh.elements[:, :9]]
    jacobian = np.einsum("eai,qja->eqij", corners, local)
    determinant = np.linalg.det(jacobian)
    if np.any(determinant <= 0.0):
        raise ValueError("the mesh holds an element that is turned inside out")
    volumes = determinant * np.outer(weight, weight).ravel()
    gradients = np.zeros((*volumes.shape, 3, 10))
    gradients[:, :, :2, :9] = np.einsum("eqji,qja->eqia", np.linalg.inv(jacobian), local)
    gradients[:, :, 2, 9] = 1.0
    return ElementGeometry(gradients, volumes, _pressure_modes(corners, values, volumes))


def _pressure_modes(corners: FloatArray, values: FloatArray, volumes: FloatArray) -> FloatArray:
    """Span of {1, X, Y}, orthonormal in each element's volume."""
    position = np.einsum("qa,eai->eqi", values, corners)
    total = volumes.sum(axis=1)
    centre = np.einsum("eq,eqi->ei", volumes, position) / total[:, None]
    modes = np.ones((*volumes.shape, 3))
    modes[..., 1:] = (position - centre[:, None, :]) / np.sqrt(total)[:, None, None]
    mass = np.einsum("eq,eqa,eqb->eab", volumes, modes, modes)
    inverse_factor = np.linalg.inv(np.linalg.cholesky(mass))
    return np.ascontiguousarray(np.einsum("eba,eqa->eqb", inverse_factor, modes))
