"""The periodic cell as a problem of equilibrium: unknowns, forces and tangent of matrix and paper."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from scipy.sparse import csr_array

from spavision.model.constitutive import (
    Deformation,
    MaterialGroup,
    deform,
    evaluate_materials,
    isochoric_energy,
)
from spavision.model.element_integrals import force_integrals, volumetric_energy
from spavision.model.element_kernels import BLOCKS, element_tangents
from spavision.model.elements import FloatArray, IntArray
from spavision.model.materials.solid import SolidMaterial

from .beam import Beam, BeamResponse
from .geometry import CouponGeometry
from .paper import Paper
from .plane_mesh import MeshDensity, PlaneMesh, plane_geometry, plane_mesh

_X, _Y, _THIRD = 0, 1, 2


@dataclass(frozen=True)
class CellSettings:
    """How the cell is held and what the folds do.

    Parameters
    ----------
    lateral : str
        ``plane-strain``, the width held, or ``plane-stress``, generalised: the strain along z is the same
        everywhere and the force along z, matrix and paper together, is zero.
    hinged_folds : bool
        Whether the paper turns freely at the tips of its folds, as if creased through.
    density : MeshDensity
    """

    lateral: str = "plane-strain"
    hinged_folds: bool = False
    density: MeshDensity = field(default_factory=MeshDensity)


@dataclass(frozen=True)
class CellState:
    """A point in the space of solutions.

    Parameters
    ----------
    unknowns : array, shape (n_unknowns,)
        Displacements in mm and rotations in rad; the last one is the lengthening of the half wave.
    pressure : array, shape (n_elements, 3)
        Of the matrix.
    """

    unknowns: FloatArray
    pressure: FloatArray


@dataclass(frozen=True)
class CellBalance:
    """Forces at a state.

    Parameters
    ----------
    forces : array, shape (n_unknowns,)
        Internal forces, the matrix's pressure eliminated; the last is the pull on the half wave in N/mm.
    mixed : array, shape (n_unknowns,)
        The same under the state's own pressure.
    pressure : array, shape (n_elements, 3)
        That belongs to the displacements.
    pressure_operator : array, shape (n_elements, 3, 3, 10)
    kinematics : Deformation
    stress, moduli : array
        Of the matrix, see `MaterialResponse`.
    beam : BeamResponse
    """

    forces: FloatArray
    mixed: FloatArray
    pressure: FloatArray
    pressure_operator: FloatArray
    kinematics: Deformation
    stress: FloatArray
    moduli: FloatArray
    beam: BeamResponse


class Cell:
    """Half a wave of matrix and paper between two planes of mirror symmetry, one of which is moved.

    Top and bottom are free. The paper is bonded: its nodes are the matrix's. It has no thickness in the mesh,
    so there is too much matrix by the paper's volume (3 % at crimp ratio 0.3).

    Parameters
    ----------
    geometry : CouponGeometry
    matrix : SolidMaterial
    paper : Paper
    settings : CellSettings
    """

    def __init__(
        self, geometry: CouponGeometry, *, matrix: SolidMaterial, paper: Paper, settings: CellSettings
    ) -> None:
        self.geometry = geometry
        self.matrix = matrix
        self.mesh: PlaneMesh = plane_mesh(geometry, settings.density)
        self.beam = Beam(self.mesh.nodes_mm[self.mesh.paper_nodes], paper)
        self._has_paper = paper.modulus_MPa > 0.0
        self._tables = plane_geometry(self.mesh)
        self._groups = (MaterialGroup(matrix, np.arange(len(self.mesh.elements))),)
        self._bulk_MPa = np.full(len(self.mesh.elements), matrix.bulk_modulus_MPa)
        self._solid, self._turn, self.n_unknowns = _numbering(
            self.mesh, settings=settings, has_paper=self._has_paper
        )
        # one place behind the unknowns takes what belongs to the supports
        self._solid_places = self._solid[self.mesh.elements].reshape(len(self.mesh.elements), -1)
        self._beam_places = self._beam_numbers()
        self._pattern = _Pattern([self._solid_places, self._beam_places], self.n_unknowns)

    def at_rest(self) -> CellState:
        """Return the undeformed state."""
        return CellState(np.zeros(self.n_unknowns), np.zeros((len(self.mesh.elements), 3)))

    def balance(self, state: CellState) -> CellBalance | None:
        """Evaluate the forces; None where an element is turned inside out."""
        displacement, rotation = self.fields(state)
        solid = displacement.copy()
        solid[:-1, _THIRD] = 0.0
        kinematics = deform(solid, self.mesh.elements, self._tables)
        if not kinematics.is_admissible:
            return None
        response = evaluate_materials(self._groups, kinematics)
        forces, dilatation, operator = force_integrals(self._tables, kinematics, response.stress)
        pressure = self._bulk_MPa[:, None] * dilatation
        beam = self.beam.respond(displacement[self.mesh.paper_nodes, :2], rotation, displacement[-1, _THIRD])
        condensed, mixed = (
            self._sum(forces + np.einsum("em,emia->eia", each, operator), beam.forces)
            for each in (pressure, state.pressure)
        )
        return CellBalance(
            condensed, mixed, pressure, operator, kinematics, response.stress, response.moduli, beam
        )

    def tangent(self, state: CellState, balance: CellBalance) -> tuple[csr_array, FloatArray]:
        """Return the upper triangle over all unknowns but the last, and the last one's column, (n − 1,)."""
        n_elements = len(self.mesh.elements)
        blocks = np.empty((n_elements, 6, 10, 10))
        element_tangents(
            self._tables.gradients,
            self._tables.volumes,
            self._tables.pressure_modes,
            balance.kinematics.F,
            balance.kinematics.J,
            balance.stress,
            balance.moduli,
            state.pressure,
            self._bulk_MPa,
            balance.pressure_operator,
            blocks,
        )
        whole = np.empty((n_elements, 10, 3, 10, 3))
        for block, (i, j) in enumerate(BLOCKS):
            whole[:, :, i, :, j] = blocks[:, block]
            whole[:, :, j, :, i] = blocks[:, block].transpose(0, 2, 1)
        return self._pattern.assemble([whole.reshape(n_elements, 30, 30), balance.beam.tangents])

    def pressure_change(self, balance: CellBalance, change: FloatArray) -> FloatArray:
        """Return the change of the matrix's pressure with the unknowns, (n_unknowns,) to (n_elements, 3)."""
        step = np.append(change, 0.0)[self._solid]
        moved = np.einsum("emia,eai->em", balance.pressure_operator, step[self.mesh.elements], optimize=True)
        return self._bulk_MPa[:, None] * moved

    def energy(self, state: CellState) -> float:
        """Return the strain energy of the half wave, in N mm per mm width."""
        displacement, rotation = self.fields(state)
        solid = displacement.copy()
        solid[:-1, _THIRD] = 0.0
        kinematics = deform(solid, self.mesh.elements, self._tables)
        matrix = isochoric_energy(self._groups, kinematics, self._tables.volumes)
        matrix += volumetric_energy(self._tables, kinematics.J, self._bulk_MPa)
        return matrix + self.beam.energy(
            displacement[self.mesh.paper_nodes, :2], rotation, float(displacement[-1, _THIRD])
        )

    def fields(self, state: CellState) -> tuple[FloatArray, FloatArray]:
        """Return the displacements, (n_nodes, 3), and the paper's rotations, (n_paper_nodes,).

        The third component is the strain along z at the shared node and zero elsewhere.
        """
        padded = np.append(state.unknowns, 0.0)
        return padded[self._solid], padded[self._turn]

    def _sum(self, solid_forces: FloatArray, beam_forces: FloatArray) -> FloatArray:
        places = np.concatenate([self._solid_places.ravel(), self._beam_places.ravel()])
        values = np.concatenate([solid_forces.transpose(0, 2, 1).ravel(), beam_forces.ravel()])
        return _sum_at(places, values, self.n_unknowns + 1)[: self.n_unknowns]

    def _beam_numbers(self) -> IntArray:
        """Unknowns of each beam element in its own order, (n, 10)."""
        nodes = self.mesh.paper_nodes[self.beam.nodes]
        turn = self._turn[self.beam.nodes]
        triples = np.stack([self._solid[nodes, _X], self._solid[nodes, _Y], turn], axis=2)
        across = np.full((len(nodes), 1), self._solid[-1, _THIRD])
        return np.hstack([triples.reshape(len(nodes), 9), across])


class _Pattern:
    """Sums element matrices into the upper triangle of one sparse matrix of fixed pattern."""

    def __init__(self, places: list[IntArray], n_unknowns: int) -> None:
        rows = np.concatenate([np.repeat(each, each.shape[1], axis=1).ravel() for each in places])
        columns = np.concatenate([np.tile(each, (1, each.shape[1])).ravel() for each in places])
        self._size = n_unknowns - 1
        self._inside = (rows <= columns) & (columns < self._size)
        self._on_edge = (rows < self._size) & (columns == self._size)
        self._edge_rows = rows[self._on_edge]
        keys = rows[self._inside] * self._size + columns[self._inside]
        diagonal = np.arange(self._size) * (self._size + 1)
        unique, inverse = np.unique(np.concatenate([keys, diagonal]), return_inverse=True)
        self._slot = inverse[: len(keys)]
        self._columns = (unique % self._size).astype(np.int32)
        starts = np.searchsorted(unique, np.arange(self._size + 1) * self._size)
        self._starts = starts.astype(np.int32)

    def assemble(self, matrices: list[FloatArray]) -> tuple[csr_array, FloatArray]:
        """Return the matrix without the last unknown, and the last one's column."""
        values = np.concatenate([each.ravel() for each in matrices])
        data = _sum_at(self._slot, values[self._inside], len(self._columns))
        edge = _sum_at(self._edge_rows, values[self._on_edge], self._size)
        shape = (self._size, self._size)
        return csr_array((data, self._columns, self._starts), shape=shape), edge


def _sum_at(places: IntArray, values: FloatArray, length: int) -> FloatArray:
    return np.asarray(np.bincount(places, weights=values, minlength=length), dtype=float)


def _numbering(mesh: PlaneMesh, *, settings: CellSettings, has_paper: bool) -> tuple[IntArray, IntArray, int]:
    """Return numbers of displacements, (n_nodes, 3), and rotations, (n_paper_nodes,), and their count.

    The lengthening, one number for all nodes of the moved plane, comes last; supports have the count.
    """
    n_nodes = len(mesh.nodes_mm)
    is_free = np.ones((n_nodes, 3), dtype=bool)
    is_free[:, _THIRD] = False
    is_free[mesh.shared_node] = (False, False, settings.lateral == "plane-stress")
    is_free[mesh.left, _X] = False
    is_free[mesh.right, _X] = False
    is_free[mesh.paper_nodes[0], _Y] = False
    turns = np.full(len(mesh.paper_nodes), has_paper)
    turns[[0, -1]] &= settings.hinged_folds
    count = int(is_free.sum() + turns.sum()) + 1
    number = np.full((n_nodes, 3), count, dtype=np.int64)
    number[is_free] = np.arange(is_free.sum())
    turn = np.full(len(mesh.paper_nodes), count, dtype=np.int64)
    turn[turns] = np.arange(is_free.sum(), count - 1)
    number[mesh.right, _X] = count - 1
    return number, turn, count
