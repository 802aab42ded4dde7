"""Reference hexahedra: shape functions, quadrature and pressure modes, tabulated with scikit-fem."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray
from skfem import ElementHex1, ElementHex2, ElementQuad1, ElementQuad2
from skfem.quadrature import get_quadrature
from skfem.refdom import RefHex, RefQuad

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
IndexArray = NDArray[np.int32]

_ELEMENTS = {1: (ElementHex1, ElementQuad1), 2: (ElementHex2, ElementQuad2)}


@dataclass(frozen=True)
class ReferenceElement:
    """Tabulated shape functions of the linear (8-node) or quadratic (27-node) hexahedron.

    Parameters
    ----------
    order : int
        1 or 2.
    node_locations : array, shape (n_nodes, 3)
        Nodes in the unit cube.
    points : array, shape (n_points, 3)
        Gauss points, ``(order + 1)**3`` of them.
    weights : array, shape (n_points,)
    values : array, shape (n_points, n_nodes)
    gradients : array, shape (n_points, 3, n_nodes)
        Derivatives with respect to the reference coordinates.
    n_pressure_modes : int
        1 (Q1/P0) or 4 (Q2/P1-discontinuous).
    """

    order: int
    node_locations: FloatArray
    points: FloatArray
    weights: FloatArray
    values: FloatArray
    gradients: FloatArray
    n_pressure_modes: int


@dataclass(frozen=True)
class ReferenceFace:
    """Tabulated shape functions of a hexahedron's face.

    Parameters
    ----------
    nodes : array, shape (6, n_face_nodes)
        The element's local nodes on each face; the face's first tangent crossed with its second points
        out of the unit cube.
    weights : array, shape (n_points,)
    values : array, shape (n_points, n_face_nodes)
    tangents : array, shape (n_points, 2, n_face_nodes)
        Derivatives with respect to the two face coordinates.
    flipped : array, shape (n_face_nodes,)
        The permutation that turns the face's normal round.
    """

    nodes: IntArray
    weights: FloatArray
    values: FloatArray
    tangents: FloatArray
    flipped: IntArray


def shape_functions(order: int, points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Evaluate the hexahedron's shape functions.

    Parameters
    ----------
    order : int
    points : array, shape (n, 3)
        Points in the unit cube.

    Returns
    -------
    values : array, shape (n, n_nodes)
    gradients : array, shape (n, 3, n_nodes)
    """
    return _tabulate(_ELEMENTS[order][0](), points)


@cache
def reference_element(order: int) -> ReferenceElement:
    """Return the tables of the hexahedron of the given order (1 or 2)."""
    points, weights = get_quadrature(RefHex, 2 * order + 1)
    values, gradients = shape_functions(order, points.T)
    return ReferenceElement(
        order=order,
        node_locations=np.asarray(_ELEMENTS[order][0].doflocs, dtype=float),
        points=points.T.copy(),
        weights=weights,
        values=values,
        gradients=gradients,
        n_pressure_modes=1 if order == 1 else 4,
    )


@cache
def reference_face(order: int) -> ReferenceFace:
    """Return the tables of a face of the hexahedron of the given order (1 or 2).

    The rule integrates the enclosed volume exactly: its integrand is of degree 3·order − 1 a direction.
    """
    element = _ELEMENTS[order][1]()
    points, weights = get_quadrature(RefQuad, 3 * order - 1)
    values, tangents = _tabulate(element, points.T)
    locations = np.asarray(element.doflocs, dtype=float)
    nodes = np.array(
        [
            _face_nodes(order, axis=axis, side=side, locations=locations)
            for axis in range(3)
            for side in (0.0, 1.0)
        ]
    )
    return ReferenceFace(nodes, weights, values, tangents, _match(locations[:, ::-1], locations))


def _tabulate(element: object, points: FloatArray) -> tuple[FloatArray, FloatArray]:
    n_nodes = len(element.doflocs)  # type: ignore[attr-defined]
    pairs = [element.lbasis(np.ascontiguousarray(points.T), node) for node in range(n_nodes)]  # type: ignore[attr-defined]
    values = np.array([value + np.zeros(len(points)) for value, _ in pairs]).T
    gradients = np.array([gradient + np.zeros((points.shape[1], len(points))) for _, gradient in pairs])
    return np.ascontiguousarray(values), np.ascontiguousarray(gradients.transpose(2, 1, 0))


def _face_nodes(order: int, *, axis: int, side: float, locations: FloatArray) -> IntArray:
    """Local element nodes of one face, in the order of the face element's own nodes."""
    first, second = (axis + 1) % 3, (axis + 2) % 3
    if side == 0.0:
        first, second = second, first
    wanted = np.full((len(locations), 3), side)
    wanted[:, first], wanted[:, second] = locations[:, 0], locations[:, 1]
    return _match(wanted, np.asarray(_ELEMENTS[order][0].doflocs, dtype=float))


def _match(wanted: FloatArray, available: FloatArray) -> IntArray:
    """Index in `available` of each row of `wanted`."""
    distance = np.abs(wanted[:, None, :] - available[None, :, :]).max(axis=2)
    return np.asarray(distance.argmin(axis=1), dtype=np.int64)
