"""A face of a body that stays plane: the unknowns it leaves, and the equations between them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.sparse import csr_array

from spavision.model.elements import FloatArray, IntArray
from spavision.model.equilibrium import Balance, Equilibrium
from spavision.model.hex_mesh import BoolArray, HexMesh
from spavision.model.materials.solid import SolidMaterial
from spavision.model.state import Load, State

IndexArray = NDArray[np.int32]


@dataclass(frozen=True)
class FacePose:
    """Where the plane face is.

    Its nodes are at (s cos θ, h − s sin θ): the face crosses the line x = 0 at y = h, where its axis node is.

    Parameters
    ----------
    angle : float
        θ, by which it is turned towards +x, in rad.
    height_mm : float
        h.
    offsets_mm : array, shape (n_face_nodes,)
        s, the nodes' places along the face; 0 for the axis node.
    """

    angle: float
    height_mm: float
    offsets_mm: FloatArray


class PlaneEndedEquilibrium(Equilibrium):
    """An equilibrium in which the nodes of one face stay on a plane that is free to move and to turn.

    The unknowns are the free displacement components of all nodes, but the face's in-plane ones; for
    those, each node's place s along the face (none for the axis node), the height h, and the angle θ times
    `arm_mm`, a length, so that corrections of all unknowns compare.

    Parameters
    ----------
    mesh : HexMesh
    materials : dict of str to SolidMaterial
    is_fixed : array, shape (n_nodes, 3)
    face_nodes : array, shape (n_face_nodes,)
    axis_node : int
        The one among them that stays at x = 0.
    """

    def __init__(
        self,
        mesh: HexMesh,
        materials: dict[str, SolidMaterial],
        *,
        is_fixed: BoolArray,
        face_nodes: IntArray,
        axis_node: int,
    ) -> None:
        super().__init__(mesh, materials, is_fixed=is_fixed)
        self._face = face_nodes
        self._axis = int(np.flatnonzero(face_nodes == axis_node)[0])
        along = mesh.nodes_mm[face_nodes, 0]
        self._ends = (int(along.argmin()), int(along.argmax()))
        self.arm_mm = float(np.ptp(along))
        self.end_load = np.zeros(2)
        """Tension in N along y and moment in N mm that act on the face."""
        self._map = _FaceMap(self.is_free, face_nodes, self._axis)
        self._reduction = _Reduction(self.pattern.row_starts, self.pattern.columns, self._map)
        self.n_unknowns = self._map.n_unknowns

    def pose(self, state: State) -> FacePose:
        """Return where the face is, taken from its outermost nodes and the axis node."""
        position = (self.mesh.nodes_mm + state.displacement)[self._face, :2]
        first, last = position[list(self._ends)]
        angle = float(np.arctan2(first[1] - last[1], last[0] - first[0]))
        height = float(position[self._axis, 1])
        offsets = position[:, 0] * np.cos(angle) - (position[:, 1] - height) * np.sin(angle)
        offsets[self._axis] = 0.0
        return FacePose(angle, height, offsets)

    def placed(self, state: State, pose: FacePose) -> State:
        """Return the state with the face's nodes put where the pose says."""
        displacement = state.displacement.copy()
        sine, cosine = np.sin(pose.angle), np.cos(pose.angle)
        where = np.column_stack([pose.offsets_mm * cosine, pose.height_mm - pose.offsets_mm * sine])
        displacement[self._face, :2] = where - self.mesh.nodes_mm[self._face, :2]
        return replace(state, displacement=displacement)

    def balance(self, state: State, load: Load) -> Balance | None:
        """Evaluate the forces out of balance, their norm over the unknowns that the face leaves."""
        balance = super().balance(state, load)
        if balance is None:
            return None
        reduced = self._reduced(state, balance.mixed[self.is_free])
        scale = float(np.hypot(balance.load_norm, np.linalg.norm(self.end_load / [1.0, self.arm_mm])))
        return replace(balance, mixed_norm=float(np.linalg.norm(reduced)), load_norm=scale)

    def residual(self, state: State, balance: Balance, tangent_at: Balance) -> FloatArray:
        """Return the forces that a correction has to balance, one for each unknown."""
        return self._reduced(state, super().residual(state, balance, tangent_at))

    def tangent(self, state: State, load: Load, balance: Balance) -> csr_array:
        """Assemble the upper triangle of the tangent in the unknowns that the face leaves."""
        full = super().tangent(state, load, balance)
        pose = self.pose(state)
        curvature = self._curvature(balance.condensed[self._face, :2], pose)
        return self._reduction.assemble(full.data, self._map.values(pose, self.arm_mm), curvature)

    def update(
        self, state: State, balance: Balance, correction: FloatArray, *, tangent_at: Balance | None = None
    ) -> State:
        """Return the state after a correction of the unknowns, the face turned as a whole."""
        pose = self.pose(state)
        change = self._map.matrix(pose, self.arm_mm) @ correction
        linear = super().update(state, balance, change, tangent_at=tangent_at)
        offsets = pose.offsets_mm + np.insert(correction[self._map.offset_unknowns], self._axis, 0.0)
        moved = FacePose(
            pose.angle + float(correction[-1]) / self.arm_mm, pose.height_mm + float(correction[-2]), offsets
        )
        return self.placed(linear, moved)

    def _reduced(self, state: State, free_forces: FloatArray) -> FloatArray:
        reduced = self._map.matrix(self.pose(state), self.arm_mm).T @ free_forces
        reduced[-2:] -= self.end_load / [1.0, self.arm_mm]
        return np.asarray(reduced)

    def _curvature(self, force: FloatArray, pose: FacePose) -> FloatArray:
        """Return forces times second derivatives of positions: (s, θ) of each node but the axis', (θ, θ)."""
        sine, cosine = np.sin(pose.angle), np.cos(pose.angle)
        along_normal = force[:, 0] * sine + force[:, 1] * cosine
        along_face = force[:, 0] * cosine - force[:, 1] * sine
        mixed = np.delete(-along_normal, self._axis) / self.arm_mm
        return np.append(mixed, -float(along_face @ pose.offsets_mm) / self.arm_mm**2)


class _FaceMap:
    """Derivative of the free displacement components with respect to the unknowns, of fixed pattern."""

    def __init__(self, is_free: BoolArray, face_nodes: IntArray, axis: int) -> None:
        number = np.full(is_free.shape, -1, dtype=np.int64)
        number[is_free] = np.arange(np.count_nonzero(is_free))
        face_x, face_y = number[face_nodes, 0], number[face_nodes, 1]
        inner = np.setdiff1d(number[number >= 0], np.concatenate([face_x, face_y]))
        self._others = np.delete(np.arange(len(face_nodes)), axis)
        self._n_face = len(face_nodes)
        self.n_unknowns = len(inner) + len(self._others) + 2
        self.offset_unknowns = len(inner) + np.arange(len(self._others))
        height, angle = self.n_unknowns - 2, self.n_unknowns - 1
        row = np.concatenate([inner, face_x[self._others], face_y[self._others], face_y, face_x, face_y])
        column = np.concatenate(
            [np.arange(len(inner)), self.offset_unknowns, self.offset_unknowns]
            + [np.full(self._n_face, unknown) for unknown in (height, angle, angle)]
        )
        self._order = np.lexsort((column, row))
        self.row_starts = np.searchsorted(row[self._order], np.arange(np.count_nonzero(is_free) + 1))
        self.columns = column[self._order]
        self._n_inner = len(inner)

    def values(self, pose: FacePose, arm_mm: float) -> FloatArray:
        """Return the stored entries."""
        sine, cosine = np.sin(pose.angle), np.cos(pose.angle)
        entries = (
            np.ones(self._n_inner),
            np.full(len(self._others), cosine),
            np.full(len(self._others), -sine),
            np.ones(self._n_face),
            -pose.offsets_mm * sine / arm_mm,
            -pose.offsets_mm * cosine / arm_mm,
        )
        return np.asarray(np.concatenate(entries)[self._order])

    def matrix(self, pose: FacePose, arm_mm: float) -> csr_array:
        """Return the derivative as a matrix, shape (n_free, n_unknowns)."""
        shape = (len(self.row_starts) - 1, self.n_unknowns)
        return csr_array((self.values(pose, arm_mm), self.columns, self.row_starts), shape=shape)


class _Reduction:
    """The triple product Mᵀ K M of fixed pattern, upper triangles of K and of the product stored."""

    def __init__(self, row_starts: IndexArray, columns: IndexArray, face_map: _FaceMap) -> None:
        row = np.repeat(np.arange(len(row_starts) - 1), np.diff(row_starts))
        count = np.diff(face_map.row_starts)
        n_products = count[row] * count[columns]
        entry = np.repeat(np.arange(len(row)), n_products)
        within = np.arange(len(entry)) - np.repeat(np.cumsum(n_products) - n_products, n_products)
        first = face_map.row_starts[row[entry]] + within // count[columns[entry]]
        second = face_map.row_starts[columns[entry]] + within % count[columns[entry]]
        a, b = face_map.columns[first], face_map.columns[second]
        on_diagonal = row[entry] == columns[entry]
        kept = ~(on_diagonal & (a > b))
        factor = np.where((a == b) & ~on_diagonal, 2.0, 1.0)
        self._entry, self._first, self._second = (
            each[kept].astype(np.int32) for each in (entry, first, second)
        )
        self._factor = factor[kept]
        n, theta = face_map.n_unknowns, face_map.n_unknowns - 1
        upper = np.concatenate([np.minimum(a, b)[kept], face_map.offset_unknowns, [theta]])
        lower = np.concatenate([np.maximum(a, b)[kept], np.full(len(face_map.offset_unknowns) + 1, theta)])
        stored, places = np.unique(upper * n + lower, return_inverse=True)
        self._places = places.astype(np.int32)
        self._columns = (stored % n).astype(np.int32)
        self._row_starts = np.searchsorted(stored // n, np.arange(n + 1)).astype(np.int32)

    def assemble(self, tangent: FloatArray, face_map: FloatArray, curvature: FloatArray) -> csr_array:
        """Return the upper triangle of Mᵀ K M, the curvature of the face's motion added."""
        data = np.zeros(len(self._columns))
        _add_products(
            self._entry, self._first, self._second, self._factor, self._places, tangent, face_map, data
        )
        np.add.at(data, self._places[len(self._entry) :], curvature)
        n = len(self._row_starts) - 1
        return csr_array((data, self._columns, self._row_starts), shape=(n, n))


@njit(cache=True)
def _add_products(
    entry: IndexArray,
    first: IndexArray,
    second: IndexArray,
    factor: FloatArray,
    places: IndexArray,
    tangent: FloatArray,
    face_map: FloatArray,
    out: FloatArray,
) -> None:
    for k in range(len(entry)):
        out[places[k]] += factor[k] * tangent[entry[k]] * face_map[first[k]] * face_map[second[k]]
