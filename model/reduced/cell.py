"""One pitch of the actuator in pure bending and tension: its far face stays plane and turns."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csr_array, triu

from spavision.model.actuator_mesh import actuator_mesh
from spavision.model.actuator_problem import actuator_materials
from spavision.model.elements import FloatArray
from spavision.model.equilibrium import Equilibrium
from spavision.model.geometry import ActuatorGeometry
from spavision.model.linear_solver import SingularTangentError, SuperLUSolver
from spavision.model.newton import NewtonSettings, NotConvergedError
from spavision.model.simulation import SimulationSettings
from spavision.model.state import Load, State, combine

_POINTS_OF_PREDICTION = 3


@dataclass(frozen=True)
class SectionLoad:
    """What acts on a cell, of the whole width.

    Parameters
    ----------
    gas_pressure_MPa : float
    moment_Nmm : float
        About the axis, positive when it bends towards region B (+x).
    tension_N : float
        Along the axis.
    """

    gas_pressure_MPa: float
    moment_Nmm: float
    tension_N: float


@dataclass(frozen=True)
class CellResponse:
    """How a cell deforms under a load, and how that changes with moment and tension.

    Parameters
    ----------
    load : SectionLoad
    angle : float
        By which the far face turns towards +x, in rad.
    distance_mm : float
        Of the far face's plane from the axis point of the near face.
    compliance : array, shape (2, 2)
        Derivatives of (angle, distance) with respect to (moment, tension).
    volume_ratio : float
        Gas volume over its undeformed value.
    """

    load: SectionLoad
    angle: float
    distance_mm: float
    compliance: FloatArray
    volume_ratio: float


@dataclass(frozen=True)
class _Reached:
    """An equilibrium of the cell."""

    gas_pressure_MPa: float
    state: State
    angle: float
    distance_mm: float


class Cell:
    """A cell between the middles of two walls, the channel through them left out.

    By symmetry both faces stay plane in a long row of such cells in pure bending. The near face stays at
    y = 0; the far face's nodes move to d·n + s·t with n = (sin θ, cos θ) and t = (cos θ, −sin θ), where the
    angle θ and the distance d belong to the face and s to each node. Origin is the axis point, a node of the
    near face at half the body's height.

    Parameters
    ----------
    geometry : ActuatorGeometry
        Of the whole actuator.
    crimp_ratio : float
    settings : SimulationSettings
    """

    def __init__(
        self, geometry: ActuatorGeometry, *, crimp_ratio: float, settings: SimulationSettings
    ) -> None:
        one = replace(
            geometry, void_count=1, end_wall_mm=0.5 * geometry.wall_between_voids_mm, marker_from_tip_mm=0.0
        )
        mesh = actuator_mesh(one, level=settings.mesh_level)
        x, y, z = mesh.nodes_mm.T
        near = np.flatnonzero(np.isclose(y, 0.0))
        self.axis_node = int(near[np.hypot(x[near] - one.marker_position_mm[0], z[near]).argmin()])
        self.axis_x_mm = float(x[self.axis_node])
        mesh = replace(mesh, nodes_mm=mesh.nodes_mm - np.array([self.axis_x_mm, 0.0, 0.0]))
        is_fixed = np.zeros((len(x), 3), dtype=bool)
        is_fixed[near, 1] = True
        is_fixed[np.isclose(z, 0.0), 2] = True
        is_fixed[self.axis_node, 0] = True
        materials = actuator_materials(crimp_ratio=crimp_ratio, settings=settings)
        self.problem = Equilibrium(mesh, materials, is_fixed=is_fixed)
        self._far = np.flatnonzero(np.isclose(y, one.pitch_mm))
        self._number = np.full(is_fixed.shape, -1, dtype=np.int64)
        self._number[~is_fixed] = np.arange(np.count_nonzero(~is_fixed))
        self._first_volume = self.problem.enclosed_volume_mm3(self.problem.unloaded())
        self._history = [_Reached(0.0, self.problem.unloaded(), 0.0, one.pitch_mm)]

    @property
    def mass_tonne(self) -> float:
        """Mass of the cell, of the whole width."""
        volume = self.problem.geometry.volumes.sum(axis=1)
        return 2.0 * sum(
            group.material.density_tonne_per_mm3 * float(volume[group.elements].sum())
            for group in self.problem.groups
        )

    def respond(self, load: SectionLoad, settings: NewtonSettings) -> CellResponse:
        """Find the cell's equilibrium, starting from those found last.

        Raises
        ------
        NotConvergedError
            If Newton's method does not converge; the cell is then as before.
        """
        state, angle, distance = self._predicted(load.gas_pressure_MPa)
        # The mesh is one half of the width.
        outer = 0.5 * np.array([load.tension_N, load.moment_Nmm])
        correction_mm = np.inf
        for _ in range(settings.max_iterations + 1):
            balance = self.problem.balance(state, Load(load.gas_pressure_MPa, 0.0))
            if balance is None:
                raise NotConvergedError("an element of the cell was turned inside out")
            map_to_nodes = self._map(state, angle, distance)
            force = map_to_nodes.T @ balance.condensed[self.problem.is_free]
            force[-2:] -= outer
            upper = self.problem.tangent(state, Load(load.gas_pressure_MPa, 0.0), balance)
            full = upper + triu(upper, k=1).T
            tangent = map_to_nodes.T @ full @ map_to_nodes + self._curvature(state, balance.condensed, angle)
            solver = SuperLUSolver()
            try:
                solver.factorise(csr_array(triu(tangent, format="csr")))
            except SingularTangentError as error:
                raise NotConvergedError("the cell's tangent is singular") from error
            if correction_mm < settings.correction_tolerance_mm:
                reached = _Reached(load.gas_pressure_MPa, state, angle, distance)
                earlier = [one for one in self._history if one.gas_pressure_MPa < load.gas_pressure_MPa]
                self._history = [*earlier, reached][-_POINTS_OF_PREDICTION:]
                return self._response(load, reached, solver, len(force))
            step = solver.solve(-force)
            correction_mm = float(np.abs(step).max())
            if not correction_mm < settings.largest_correction_mm:
                raise NotConvergedError(f"a correction of {correction_mm:.3g} mm in the cell")
            offset = self._offsets(state, angle)
            linear = self.problem.update(state, balance, map_to_nodes @ step)
            distance, angle = distance + float(step[-2]), angle + float(step[-1])
            offset = offset + step[self._n_inner : -2]
            state = replace(linear, displacement=self._placed(linear, offset, angle, distance))
        raise NotConvergedError(f"no convergence of the cell in {settings.max_iterations} iteration(s)")

    def _predicted(self, gas_pressure_MPa: float) -> tuple[State, float, float]:
        """Polynomial through the states reached last, the far face kept plane."""
        pressures = np.array([one.gas_pressure_MPa for one in self._history])
        weights = [
            float(np.prod((gas_pressure_MPa - others) / (pressures[k] - others)))
            for k in range(len(pressures))
            for others in [np.delete(pressures, k)]
        ]
        state = combine(weights, [one.state for one in self._history])
        angle = float(np.dot(weights, [one.angle for one in self._history]))
        distance = float(np.dot(weights, [one.distance_mm for one in self._history]))
        placed = self._placed(state, self._offsets(state, angle), angle, distance)
        return replace(state, displacement=placed), angle, distance

    def _response(
        self, load: SectionLoad, reached: _Reached, solver: SuperLUSolver, n_unknowns: int
    ) -> CellResponse:
        compliance = np.empty((2, 2))
        for column, unknown in enumerate((n_unknowns - 1, n_unknowns - 2)):
            unit = np.zeros(n_unknowns)
            unit[unknown] = 0.5
            change = solver.solve(unit)
            compliance[:, column] = change[-1], change[-2]
        return CellResponse(
            load=load,
            angle=reached.angle,
            distance_mm=reached.distance_mm,
            compliance=compliance,
            volume_ratio=self.problem.enclosed_volume_mm3(reached.state) / self._first_volume,
        )

    @property
    def _n_inner(self) -> int:
        """Free components of all nodes but the far face's in-plane ones."""
        return int(self._number.max()) + 1 - 2 * len(self._far)

    def _offsets(self, state: State, angle: float) -> FloatArray:
        """Return the far nodes' coordinates s along the face."""
        position = (self.problem.mesh.nodes_mm + state.displacement)[self._far]
        return np.asarray(position[:, 0] * np.cos(angle) - position[:, 1] * np.sin(angle))

    def _placed(self, state: State, offset: FloatArray, angle: float, distance: float) -> FloatArray:
        """Return the displacement with the far nodes put on the far plane."""
        displacement = state.displacement.copy()
        sine, cosine = np.sin(angle), np.cos(angle)
        displacement[self._far, 0] = distance * sine + offset * cosine
        displacement[self._far, 1] = distance * cosine - offset * sine
        displacement[self._far, :2] -= self.problem.mesh.nodes_mm[self._far, :2]
        return displacement

    def _map(self, state: State, angle: float, distance: float) -> csr_array:
        """Return the derivative of the free components with respect to (inner components, s, d, θ)."""
        far_x, far_y = self._number[self._far, 0], self._number[self._far, 1]
        inner = np.setdiff1d(self._number[self._number >= 0], np.concatenate([far_x, far_y]))
        n_far, n_inner = len(self._far), len(inner)
        sine, cosine = np.sin(angle), np.cos(angle)
        offset = self._offsets(state, angle)
        columns = n_inner + np.arange(n_far)
        d, theta = np.full(n_far, n_inner + n_far), np.full(n_far, n_inner + n_far + 1)
        ones = np.ones(n_far)
        entries = [
            (inner, np.arange(n_inner), np.ones(n_inner)),
            (far_x, columns, cosine * ones),
            (far_y, columns, -sine * ones),
            (far_x, d, sine * ones),
            (far_y, d, cosine * ones),
            (far_x, theta, distance * cosine - offset * sine),
            (far_y, theta, -distance * sine - offset * cosine),
        ]
        row, column, value = (np.concatenate(parts) for parts in zip(*entries, strict=True))
        shape = (n_inner + 2 * n_far, n_inner + n_far + 2)
        return csr_array((value, (row, column)), shape=shape)

    def _curvature(self, state: State, forces: FloatArray, angle: float) -> csr_array:
        """Return the forces on the far face times the second derivatives of its nodes' positions."""
        n_far, n_inner = len(self._far), self._n_inner
        force = forces[self._far, :2]
        position = (self.problem.mesh.nodes_mm + state.displacement)[self._far, :2]
        along_n = force[:, 0] * np.sin(angle) + force[:, 1] * np.cos(angle)
        along_t = force[:, 0] * np.cos(angle) - force[:, 1] * np.sin(angle)
        theta, d = n_inner + n_far + 1, n_inner + n_far
        columns = n_inner + np.arange(n_far)
        row = np.concatenate([columns, np.full(n_far, theta), [d, theta, theta]])
        column = np.concatenate([np.full(n_far, theta), columns, [theta, d, theta]])
        bend = float(along_t.sum())
        value = np.concatenate([-along_n, -along_n, [bend, bend, -float(np.sum(force * position))]])
        return csr_array((value, (row, column)), shape=(theta + 1, theta + 1))
