"""One pitch of the actuator in pure bending and tension: its end faces stay plane and turn."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from spavision.model.actuator_mesh import MESH_LEVELS, actuator_mesh, mesh_at_level
from spavision.model.actuator_problem import actuator_materials
from spavision.model.elements import FloatArray
from spavision.model.geometry import ActuatorGeometry
from spavision.model.hex_mesh import HexMesh
from spavision.model.linear_solver import LinearSolver, linear_solver
from spavision.model.newton import NewtonSettings, find_equilibrium
from spavision.model.simulation import SimulationSettings
from spavision.model.state import Load, State, combine

from .plane_face import PlaneEndedEquilibrium

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
        Along the cell's chord.
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
        Between the end faces, in rad; positive when the cell bends towards +x.
    chord_mm : float
        Distance between the axis points of the end faces.
    compliance : array, shape (2, 2)
        Derivatives of (angle, chord) with respect to (moment, tension).
    volume_ratio : float
        Gas volume over its undeformed value.
    """

    load: SectionLoad
    angle: float
    chord_mm: float
    compliance: FloatArray
    volume_ratio: float


@dataclass(frozen=True)
class _Reached:
    """An equilibrium of the cell."""

    gas_pressure_MPa: float
    state: State


class Cell:
    """A cell between the middles of two walls, the channel through them left out.

    In a long row of such cells in pure bending the middle planes of walls and voids are planes of
    symmetry. So half a cell is computed: from the middle of the void, which stays at y = 0, to the middle
    of the wall, which stays plane. Origin is the axis point of that plane, a node at half the body's height.

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
        mesh = _upper_half(one, settings.mesh_level)
        x, y, z = mesh.nodes_mm.T
        face = np.flatnonzero(np.isclose(y, 0.5 * one.pitch_mm))
        axis_node = int(face[np.hypot(x[face] - one.marker_position_mm[0], z[face]).argmin()])
        self.axis_x_mm = float(x[axis_node])
        mesh = replace(mesh, nodes_mm=mesh.nodes_mm - np.array([self.axis_x_mm, 0.0, 0.0]))
        is_fixed = np.zeros((len(x), 3), dtype=bool)
        is_fixed[np.isclose(y, 0.0), 1] = True
        is_fixed[np.isclose(z, 0.0), 2] = True
        materials = actuator_materials(crimp_ratio=crimp_ratio, settings=settings)
        self.problem = PlaneEndedEquilibrium(
            mesh, materials, is_fixed=is_fixed, face_nodes=face, axis_node=axis_node
        )
        self._solver: LinearSolver = linear_solver()
        self._first_volume = self.problem.enclosed_volume_mm3(self.problem.unloaded())
        self._history = [_Reached(0.0, self.problem.unloaded())]

    @property
    def mass_tonne(self) -> float:
        """Mass of the cell, of the whole width."""
        volume = self.problem.geometry.volumes.sum(axis=1)
        return 4.0 * sum(
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
        # The mesh is one half of the width; moment and tension act on it by halves.
        self.problem.end_load = 0.5 * np.array([load.tension_N, load.moment_Nmm])
        gas = Load(load.gas_pressure_MPa, 0.0)
        found = find_equilibrium(
            self.problem, self._predicted(load.gas_pressure_MPa), gas, solver=self._solver, settings=settings
        )
        reached = _Reached(load.gas_pressure_MPa, found.state)
        earlier = [one for one in self._history if one.gas_pressure_MPa < load.gas_pressure_MPa]
        self._history = [*earlier, reached][-_POINTS_OF_PREDICTION:]
        pose = self.problem.pose(found.state)
        return CellResponse(
            load=load,
            angle=2.0 * pose.angle,
            chord_mm=2.0 * pose.height_mm,
            compliance=self._compliance(),
            volume_ratio=self.problem.enclosed_volume_mm3(found.state) / self._first_volume,
        )

    def _predicted(self, gas_pressure_MPa: float) -> State:
        """Polynomial through the states reached last, the end face kept plane."""
        pressures = np.array([one.gas_pressure_MPa for one in self._history])
        weights = [
            float(np.prod((gas_pressure_MPa - others) / (pressures[k] - others)))
            for k in range(len(pressures))
            for others in [np.delete(pressures, k)]
        ]
        state = combine(weights, [one.state for one in self._history])
        return self.problem.placed(state, self.problem.pose(state))

    def _compliance(self) -> FloatArray:
        """Return the derivatives of (angle, chord), from the last tangent.

        Two half cells deform, each under half of the load on the width: the factors cancel.
        """
        arm = self.problem.arm_mm
        compliance = np.empty((2, 2))
        for column, (unknown, force) in enumerate(((-1, 1.0 / arm), (-2, 1.0))):
            unit = np.zeros(self.problem.n_unknowns)
            unit[unknown] = force
            change = self._solver.solve(unit)
            compliance[:, column] = change[-1] / arm, change[-2]
        return compliance


def _upper_half(one: ActuatorGeometry, mesh_level: str) -> HexMesh:
    """Mesh the half of a cell from the middle of its void on, that middle at y = 0."""
    if mesh_level not in MESH_LEVELS:
        return actuator_mesh(one, level=mesh_level)
    level = MESH_LEVELS[mesh_level]
    if isinstance(level.void_length, int):
        level = replace(level, void_length=level.void_length + level.void_length % 2)
    whole = mesh_at_level(one, level)
    middle = 0.5 * one.pitch_mm
    y = whole.nodes_mm[:, 1]
    kept = y[whole.elements].mean(axis=1) > middle
    faces = whole.cavity_faces[y[whole.cavity_faces].mean(axis=1) > middle]
    used, elements = np.unique(whole.elements[kept], return_inverse=True)
    number = np.full(len(y), -1, dtype=np.int64)
    number[used] = np.arange(len(used))
    return HexMesh(
        order=whole.order,
        nodes_mm=whole.nodes_mm[used] - np.array([0.0, middle, 0.0]),
        elements=np.ascontiguousarray(elements.reshape(-1, whole.elements.shape[1])),
        region=whole.region[kept],
        region_names=whole.region_names,
        cavity_faces=number[faces],
    )
