"""What the element kernels need of the undeformed mesh: gradients, volumes and pressure modes."""

from __future__ import annotations

from dataclasses import dataclass
from weakref import WeakKeyDictionary

import numpy as np

from .elements import FloatArray, ReferenceElement, reference_element
from .hex_mesh import HexMesh


@dataclass(frozen=True)
class ElementGeometry:
    """Tables at the Gauss points of every element.

    Parameters
    ----------
    gradients : array, shape (n_elements, n_points, 3, n_nodes)
        Shape function derivatives with respect to the undeformed coordinates, in 1/mm.
    volumes : array, shape (n_elements, n_points)
        Undeformed volume that each point stands for, in mm³.
    pressure_modes : array, shape (n_elements, n_points, n_modes)
        Discontinuous pressure shape functions: the constant and, for quadratic elements, the three
        linear functions of position, orthonormal in the element's volume (1/mm^1.5).
    """

    gradients: FloatArray
    volumes: FloatArray
    pressure_modes: FloatArray


_TABULATED: WeakKeyDictionary[HexMesh, ElementGeometry] = WeakKeyDictionary()


def element_geometry(mesh: HexMesh) -> ElementGeometry:
    """Tabulate a mesh, once in its life: solver, fields and figures of every pressure share the tables.

    Raises
    ------
    ValueError
        If an element is turned inside out.
    """
    if mesh not in _TABULATED:
        _TABULATED[mesh] = _tabulate(mesh)
    return _TABULATED[mesh]


def _tabulate(mesh: HexMesh) -> ElementGeometry:
    table = reference_element(mesh.order)
    corners = mesh.nodes_mm[mesh.elements]
    jacobian = np.einsum("eai,qja->eqij", corners, table.gradients)
    determinant = np.linalg.det(jacobian)
    if np.any(np.sign(determinant) != np.sign(determinant[:, :1])) or np.any(determinant == 0.0):
        raise ValueError("the mesh holds an element that is turned inside out")
    gradients = np.einsum("eqji,qja->eqia", np.linalg.inv(jacobian), table.gradients)
    volumes = np.abs(determinant) * table.weights
    return ElementGeometry(
        gradients=np.ascontiguousarray(gradients),
        volumes=volumes,
        pressure_modes=_orthonormal_modes(table, corners, volumes),
    )


def _orthonormal_modes(table: ReferenceElement, corners: FloatArray, volumes: FloatArray) -> FloatArray:
    """Span of {1, X, Y, Z} (or of {1}), orthonormal so that the pressure's mass matrix is the identity."""
    modes = np.ones((*volumes.shape, table.n_pressure_modes))
    if table.n_pressure_modes == 4:
        position = np.einsum("qa,eai->eqi", table.values, corners)
        centre = np.einsum("eq,eqi->ei", volumes, position) / volumes.sum(axis=1)[:, None]
        size = np.cbrt(volumes.sum(axis=1))[:, None, None]
        modes[..., 1:] = (position - centre[:, None, :]) / size
    mass = np.einsum("eq,eqa,eqb->eab", volumes, modes, modes)
    inverse_factor = np.linalg.inv(np.linalg.cholesky(mass))
    return np.ascontiguousarray(np.einsum("eba,eqa->eqb", inverse_factor, modes))
