"""The enclosed gas volume, its gradient (the forces of unit pressure) and its exact symmetric Hessian."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit, prange

from .elements import FloatArray, IntArray, reference_face


@dataclass(frozen=True)
class Cavity:
    """The surface around the gas, closed or cut by planes of symmetry.

    The volume is V = ∫ Σ cᵢ xᵢ nᵢ da with Σ cᵢ = 1. Faces on a cut may be left out where the integrand
    vanishes there: equal weights do for cuts through the origin; for other cuts across an axis that axis
    has to have the weight 0 (a tube between z = 0 and z = h: ½, ½, 0), else the forces are wrong.

    Parameters
    ----------
    faces : array, shape (n_faces, n_face_nodes)
        Normals point out of the gas.
    order : int
    axis_weights : tuple of float
        The cᵢ.
    """

    faces: IntArray
    order: int
    axis_weights: tuple[float, float, float] = (1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0)

    def volume(self, position: FloatArray) -> float:
        """Return the enclosed volume in mm³ (half of it in a half model).

        Parameters
        ----------
        position : array, shape (n_nodes, 3)
            Deformed coordinates in mm.
        """
        table = reference_face(self.order)
        points, along, across = self._at_points(position)
        triple = np.einsum("i,fqi,fqi->fq", self.axis_weights, points, np.cross(along, across))
        return float(np.einsum("fq,q->", triple, table.weights))

    def forces(self, position: FloatArray) -> FloatArray:
        """Return the derivative of the volume with respect to each face's nodes.

        Returns
        -------
        array, shape (n_faces, 3, n_face_nodes)
            In mm²; multiplied by the pressure, the forces on the walls.
        """
        table = reference_face(self.order)
        out = np.empty((len(self.faces), 3, self.faces.shape[1]))
        weights = np.asarray(self.axis_weights)
        _forces(position, self.faces, _functions(self.order), table.weights, weights, out)
        return out

    def hessians(self, position: FloatArray) -> FloatArray:
        """Return the second derivative of the volume with respect to each face's nodes.

        Returns
        -------
        array, shape (n_faces, 3, n_face_nodes, n_face_nodes)
            The blocks (x, y), (y, z) and (x, z); those of equal components vanish.
        """
        table = reference_face(self.order)
        out = np.empty((len(self.faces), 3, self.faces.shape[1], self.faces.shape[1]))
        weights = np.asarray(self.axis_weights)
        _hessians(position, self.faces, _functions(self.order), table.weights, weights, out)
        return out

    def _at_points(self, position: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Position and both tangents at the faces' Gauss points, each (n_faces, n_points, 3)."""
        table = reference_face(self.order)
        corners = position[self.faces]
        points = np.einsum("qa,fai->fqi", table.values, corners)
        tangents = np.einsum("qda,fai->dfqi", table.tangents, corners)
        return points, tangents[0], tangents[1]


def _functions(order: int) -> FloatArray:
    """Shape functions of a face and their derivatives along it, shape (n_points, 3, n_face_nodes)."""
    table = reference_face(order)
    return np.stack([table.values, table.tangents[:, 0], table.tangents[:, 1]], axis=1)


@njit(cache=True)
def _combine_nodes(position: FloatArray, nodes: IntArray, functions: FloatArray, out: FloatArray) -> None:
    """Write the position at a point of a face and the two tangents there, the rows of `out`."""
    out[:] = 0.0
    for a in range(len(nodes)):
        for m in range(3):
            for i in range(3):
                out[m, i] += functions[m, a] * position[nodes[a], i]


@njit(cache=True)
def _forces(
    position: FloatArray,
    faces: IntArray,
    functions: FloatArray,
    weights: FloatArray,
    axis_weights: FloatArray,
    out: FloatArray,
) -> None:
    """First derivatives of det[c x, x_s, x_t]: each function times the product of the other two vectors."""
    n_nodes = faces.shape[1]
    vectors = np.empty((3, 3))
    out[:] = 0.0
    for f in range(len(faces)):
        for q in range(len(weights)):
            _combine_nodes(position, faces[f], functions[q], vectors)
            x, along, across = vectors[0], vectors[1], vectors[2]
            for i in range(3):
                j, k = (i + 1) % 3, (i + 2) % 3
                c, w = axis_weights, weights[q]
                of_position = w * c[i] * (along[j] * across[k] - along[k] * across[j])
                of_along = w * (across[j] * c[k] * x[k] - across[k] * c[j] * x[j])
                of_across = w * (c[j] * x[j] * along[k] - c[k] * x[k] * along[j])
                for a in range(n_nodes):
                    out[f, i, a] += (
                        of_position * functions[q, 0, a]
                        + of_along * functions[q, 1, a]
                        + of_across * functions[q, 2, a]
                    )


@njit(cache=True, parallel=True)
def _hessians(
    position: FloatArray,
    faces: IntArray,
    functions: FloatArray,
    weights: FloatArray,
    axis_weights: FloatArray,
    out: FloatArray,
) -> None:
    """Second derivatives of det[c x, x_s, x_t]: ε_ijk times the vector left over, for each pair."""
    n_nodes = faces.shape[1]
    for f in prange(len(faces)):
        vectors = np.empty((3, 3))
        out[f] = 0.0
        for q in range(len(weights)):
            _combine_nodes(position, faces[f], functions[q], vectors)
            for block in range(3):
                # (x, y), (y, z), (x, z): components i and j, the one left over, the permutation's sign
                i, j, left = (block % 2, block % 2 + 1, (block + 2) % 3) if block < 2 else (0, 2, 1)
                sign = weights[q] if block < 2 else -weights[q]
                for m in range(3):
                    first, second = functions[q, (m + 1) % 3], functions[q, (m + 2) % 3]
                    # The weight goes by the component that the first vector, the position, takes.
                    taken = (left, j, i)[m], (left, i, j)[m]
                    forward = sign * vectors[m, left] * axis_weights[taken[0]]
                    backward = sign * vectors[m, left] * axis_weights[taken[1]]
                    for a in range(n_nodes):
                        for b in range(n_nodes):
                            out[f, block, a, b] += (
                                forward * first[a] * second[b] - backward * second[a] * first[b]
                            )
