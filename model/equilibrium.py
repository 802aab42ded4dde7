"""The discrete equilibrium of a pressurised body: residual, tangent, energy."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from .cavity import Cavity
from .constitutive import (
    Deformation,
    MaterialResponse,
    deform,
    evaluate_materials,
    isochoric_energy,
    material_groups,
    per_element,
)
from .element_geometry import ElementGeometry, element_geometry
from .element_integrals import force_integrals, volumetric_energy
from .element_kernels import add_element_tangents
from .elements import FloatArray, IntArray, reference_element
from .hex_mesh import BoolArray, HexMesh
from .materials.solid import SolidMaterial
from .pressure_kernels import add_pressure_forces, pressure_changes
from .sparsity import TangentPattern, add_up, slabs, tangent_pattern
from .state import Load, State, combine
from .stress_measures import linear_change, pull_back, push_forward

__all__ = ["GRAVITY_MM_PER_S2", "Balance", "Equilibrium", "Load", "State"]

GRAVITY_MM_PER_S2 = 9810.0
"""Standard gravity, rounded; in mm/s² it goes with tonne and N."""


@dataclass(frozen=True)
class Balance:
    """Forces out of balance at a state, and what the tangent needs to be formed there.

    Parameters
    ----------
    condensed : array, shape (n_nodes, 3)
        Internal minus external forces, the solid's pressure eliminated as κ(J − 1); at the supports,
        the reactions.
    mixed : array, shape (n_nodes, 3)
        The same under the state's own pressure.
    mixed_norm, load_norm : float
        Norms of the latter, over the free components, and of the external forces.
    projected_pressure : array, shape (n_elements, n_modes)
        κ(J − 1) projected on the pressure modes.
    pressure_operator : array, shape (n_elements, n_modes, 3, n_element_nodes)
    kinematics : Deformation
    response : MaterialResponse
    """

    condensed: FloatArray
    mixed: FloatArray
    mixed_norm: float
    load_norm: float
    projected_pressure: FloatArray
    pressure_operator: FloatArray
    kinematics: Deformation
    response: MaterialResponse

    @property
    def relative_residual(self) -> float:
        """Forces out of balance over external forces."""
        return self.mixed_norm / self.load_norm if self.load_norm > 0.0 else self.mixed_norm


class Equilibrium:
    """A mesh, its materials and supports, ready to be put under load.

    Parameters
    ----------
    mesh : HexMesh
    materials : dict of str to SolidMaterial
        One for each region of the mesh.
    is_fixed : array, shape (n_nodes, 3)
        Displacement components that the supports hold.
    gravity_direction : tuple of float
        Unit vector.
    cavity_axis_weights : tuple of float
        See `Cavity`; the default suits a cavity cut by planes through the origin.
    """

    def __init__(
        self,
        mesh: HexMesh,
        materials: dict[str, SolidMaterial],
        *,
        is_fixed: BoolArray,
        gravity_direction: tuple[float, float, float] = (0.0, 1.0, 0.0),
        cavity_axis_weights: tuple[float, float, float] = (1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0),
    ) -> None:
        self.mesh = mesh
        self.geometry: ElementGeometry = element_geometry(mesh)
        self.cavity = Cavity(mesh.cavity_faces, mesh.order, cavity_axis_weights)
        self.groups = material_groups(mesh, materials)
        self.bulk_modulus_MPa = per_element(self.groups, len(mesh.elements), "bulk_modulus_MPa")
        self.is_free = ~is_fixed
        self.pattern: TangentPattern = tangent_pattern(mesh.elements, mesh.cavity_faces, _numbering(is_fixed))
        centres = mesh.nodes_mm[mesh.elements].mean(axis=1)
        self._slab_order, self._slab_starts = slabs(mesh.elements, centres)
        self._weight = self._body_force(np.asarray(gravity_direction))

    def unloaded(self) -> State:
        """Return the undeformed state."""
        n_modes = self.geometry.pressure_modes.shape[2]
        return State(np.zeros_like(self.mesh.nodes_mm), np.zeros((len(self.mesh.elements), n_modes)))

    def balance(self, state: State, load: Load) -> Balance | None:
        """Evaluate the forces out of balance; None where an element is turned inside out."""
        kinematics = deform(state.displacement, self.mesh.elements, self.geometry)
        if not kinematics.is_admissible:
            return None
        response = evaluate_materials(self.groups, kinematics, tension=state.tension)
        forces, dilatation, operator = force_integrals(self.geometry, kinematics, response.stress)
        projected = self.bulk_modulus_MPa[:, None] * dilatation
        external = load.gravity * self._weight + load.gas_pressure_MPa * self.unit_pressure_forces(state)
        under_pressure = np.empty_like(forces)
        add_pressure_forces(forces, projected, operator, under_pressure)
        condensed = self._scatter(under_pressure) - external
        add_pressure_forces(forces, state.pressure, operator, under_pressure)
        mixed = self._scatter(under_pressure) - external
        return Balance(
            condensed=condensed,
            mixed=mixed,
            mixed_norm=float(np.linalg.norm(mixed[self.is_free])),
            load_norm=float(np.linalg.norm(external[self.is_free])),
            projected_pressure=projected,
            pressure_operator=operator,
            kinematics=kinematics,
            response=response,
        )

    def tangent(self, state: State, load: Load, balance: Balance) -> csr_array:
        """Assemble the upper triangle of the derivative of the condensed forces.

        Exact at a state without predicted stress. With it, the geometric part is formed with the prediction,
        which lets Newton's method take larger steps (Magisano, Leonetti and Garcea, 2017).
        """
        kinematics, geometry = balance.kinematics, self.geometry
        stress = balance.response.stress
        if state.stress is not None:
            stress = np.empty_like(state.stress)
            push_forward(kinematics.F, state.stress, stress)
        data = np.zeros(len(self.pattern.columns))
        add_element_tangents(
            geometry.gradients,
            geometry.volumes,
            geometry.pressure_modes,
            kinematics.F,
            kinematics.J,
            stress,
            balance.response.moduli,
            state.pressure,
            self.bulk_modulus_MPa,
            balance.pressure_operator,
            self._slab_order,
            self._slab_starts,
            self.pattern.element_places,
            data,
        )
        hessians = self.cavity.hessians(self.mesh.nodes_mm + state.displacement)
        add_up(self.pattern.face_places.ravel(), (-load.gas_pressure_MPa * hessians).ravel(), data)
        return self.pattern.matrix(data)

    def residual(self, state: State, balance: Balance, tangent_at: Balance) -> FloatArray:
        """Return the forces that a correction has to balance, shape (n_free,).

        Parameters
        ----------
        state : State
        balance : Balance
            At the state.
        tangent_at : Balance
            Where the tangent was formed. If that was elsewhere, the pressure has to be eliminated as it was
            there: with the bulk modulus in between, the two differ by far more than the forces themselves.
        """
        if tangent_at is balance:
            return balance.condensed[self.is_free]
        lacking = balance.projected_pressure - state.pressure
        forces = np.zeros((len(lacking), *tangent_at.pressure_operator.shape[2:]))
        add_pressure_forces(forces, lacking, tangent_at.pressure_operator, forces)
        return (balance.mixed + self._scatter(forces))[self.is_free]

    def update(
        self, state: State, balance: Balance, correction: FloatArray, *, tangent_at: Balance | None = None
    ) -> State:
        """Return the state after a Newton correction of the free displacement components, shape (n_free,).

        Parameters
        ----------
        state : State
        balance : Balance
            At the state.
        correction : array, shape (n_free,)
        tangent_at : Balance, optional
            Where the tangent was formed, if it was elsewhere.
        """
        step = np.zeros_like(state.displacement)
        step[self.is_free] = correction
        change = self.linear_change(tangent_at or balance, step)
        stress = np.empty_like(balance.response.stress)
        pull_back(balance.kinematics.F, balance.kinematics.J, balance.response.stress, stress)
        tension = [family.response.tension for family in balance.response.fibres]
        here = State(
            state.displacement,
            balance.projected_pressure,
            stress,
            np.concatenate(tension) if tension else None,
        )
        return combine((1.0, 1.0), (here, change))

    def linear_change(self, balance: Balance, displacement: FloatArray) -> State:
        """Return the change of everything with a change of the displacement, shape (n_nodes, 3)."""
        kinematics, elements = balance.kinematics, self.mesh.elements
        pressure = np.empty(balance.projected_pressure.shape)
        pressure_changes(displacement, elements, balance.pressure_operator, self.bulk_modulus_MPa, pressure)
        change_of_F = np.empty_like(kinematics.F)
        stress = np.empty_like(balance.response.stress)
        linear_change(
            displacement,
            elements,
            self.geometry.gradients,
            kinematics.F,
            kinematics.J,
            balance.response.moduli,
            change_of_F,
            stress,
        )
        fibres = balance.response.fibres
        tension = [family.tension_change(change_of_F[family.elements]) for family in fibres]
        return State(
            displacement,
            pressure,
            stress,
            np.concatenate(tension) if tension else None,
        )

    def enclosed_volume_mm3(self, state: State) -> float:
        """Return the cavity's volume (half of it in a half model)."""
        return self.cavity.volume(self.mesh.nodes_mm + state.displacement)

    def unit_pressure_forces(self, state: State) -> FloatArray:
        """Return the nodal forces of a gas pressure of 1 MPa, shape (n_nodes, 3), in N."""
        forces = self.cavity.forces(self.mesh.nodes_mm + state.displacement)
        return _sum_to_nodes(self.mesh.cavity_faces, forces, len(self.mesh.nodes_mm))

    def strain_energy(self, state: State) -> float:
        """Return the energy stored in the solid, in N mm."""
        kinematics = deform(state.displacement, self.mesh.elements, self.geometry)
        volumetric = volumetric_energy(self.geometry, kinematics.J, self.bulk_modulus_MPa)
        return isochoric_energy(self.groups, kinematics, self.geometry.volumes) + volumetric

    def gravity_work(self, state: State) -> float:
        """Return the work of the full weight over the state's displacement, in N mm."""
        return float(np.sum(self._weight * state.displacement))

    def _scatter(self, element_forces: FloatArray) -> FloatArray:
        return _sum_to_nodes(self.mesh.elements, element_forces, len(self.mesh.nodes_mm))

    def _body_force(self, direction: FloatArray) -> FloatArray:
        """Nodal forces of the body's weight, shape (n_nodes, 3), in N."""
        density = per_element(self.groups, len(self.mesh.elements), "density_tonne_per_mm3")
        values = reference_element(self.mesh.order).values
        nodal_mass = np.einsum("e,eq,qa->ea", density, self.geometry.volumes, values)
        return self._scatter(GRAVITY_MM_PER_S2 * nodal_mass[:, None, :] * direction[None, :, None])


def _numbering(is_fixed: BoolArray) -> IntArray:
    """Consecutive numbers for the free components, −1 for the others."""
    number = np.full(is_fixed.shape, -1, dtype=np.int64)
    number[~is_fixed] = np.arange(np.count_nonzero(~is_fixed))
    return number


def _sum_to_nodes(cells: IntArray, values: FloatArray, n_nodes: int) -> FloatArray:
    """Sum cell values, (n_cells, 3, n_cell_nodes), at the nodes, (n_nodes, 3)."""
    nodes = cells.ravel()
    return np.column_stack(
        [np.bincount(nodes, weights=values[:, i].ravel(), minlength=n_nodes) for i in range(3)]
    )
