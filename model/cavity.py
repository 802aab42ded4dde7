"""The enclosed gas volume, its gradient (the forces of unit pressure) and its exact symmetric Hessian."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from .elements import FloatArray, IntArray, reference_face
from .hex_mesh import HexMesh


@dataclass(frozen=True)
class Cavity:
    """Closed, or cut only by the plane z = 0, surface around the gas.

    The volume is V = ⅓ ∫ x·n da, which needs no face on the cut z = 0: x·n vanishes there.

    Parameters
    ----------
    faces : array, shape (n_faces, n_face_nodes)
        Normals point out of the gas.
    order : int
    """

    faces: IntArray
    order: int

    @classmethod
    def of(cls, mesh: HexMesh) -> Cavity:
        """Return the cavity of a mesh."""
        return cls(faces=mesh.cavity_faces, order=mesh.order)

    def volume(self, position: FloatArray) -> float:
        """Return the enclosed volume in mm³ (half of it in a half model).

        Parameters
        ----------
        position : array, shape (n_nodes, 3)
            Deformed coordinates in mm.
        """
        table = reference_face(self.order)
        points, along, across = self._at_points(position)
        triple = np.einsum("fqi,fqi->fq", points, np.cross(along, across))
        return float(np.einsum("fq,q->", triple, table.weights) / 3.0)

    def forces(self, position: FloatArray) -> FloatArray:
        """Return the derivative of the volume with respect to each face's nodes.

        Returns
        -------
        array, shape (n_faces, 3, n_face_nodes)
            In mm²; multiplied by the pressure, the forces on the walls.
        """
        table = reference_face(self.order)
        points, along, across = self._at_points(position)
        weights = table.weights[None, :, None] / 3.0
        return (
            np.einsum("fqi,qa->fia", np.cross(along, across) * weights, table.values)
            + np.einsum("fqi,qa->fia", np.cross(across, points) * weights, table.tangents[:, 0])
            + np.einsum("fqi,qa->fia", np.cross(points, along) * weights, table.tangents[:, 1])
        )

    def hessians(self, position: FloatArray) -> FloatArray:
        """Return the second derivative of the volume with respect to each face's nodes.

        Returns
        -------
        array, shape (n_faces, 3, n_face_nodes, n_face_nodes)
            The blocks (x, y), (y, z) and (x, z); those of equal components vanish.
        """
        table = reference_face(self.order)
        vectors = np.stack(self._at_points(position), axis=2)
        functions = np.stack([table.values, table.tangents[:, 0], table.tangents[:, 1]], axis=1)
        out = np.empty((len(self.faces), 3, self.faces.shape[1], self.faces.shape[1]))
        _hessians(vectors, functions, table.weights / 3.0, out)
        return out

    def _at_points(self, position: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Position and both tangents at the faces' Gauss points, each (n_faces, n_points, 3)."""
        table = reference_face(self.order)
        corners = position[self.faces]
        points = np.einsum("qa,fai->fqi", table.values, corners)
        tangents = np.einsum("qda,fai->dfqi", table.tangents, corners)
        return points, tangents[0], tangents[1]


@njit(cache=True)
def _hessians(vectors: FloatArray, functions: FloatArray, weights: FloatArray, out: FloatArray) -> None:
    """Second derivatives of det[x, x_s, x_t]: ε_ijk v^m_k for each pair of the three vectors."""
    n_faces, n_points = vectors.shape[:2]
    n_nodes = functions.shape[2]
    out[:] = 0.0
    for f in range(n_faces):
        for q in range(n_points):
            for block in range(3):
                # (x, y), (y, z), (x, z): the component left over and the sign of the permutation
                left = (block + 2) % 3 if block < 2 else 1
                sign = weights[q] if block < 2 else -weights[q]
                for m in range(3):
                    factor = sign * vectors[f, q, m, left]
                    first, second = functions[q, (m + 1) % 3], functions[q, (m + 2) % 3]
                    for a in range(n_nodes):
                        for b in range(n_nodes):
                            out[f, block, a, b] += factor * (first[a] * second[b] - second[a] * first[b])
