"""The pressure ramp of the bimodal actuator, from geometry and crimp ratio to tip path."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from spavision.errors import InputError
from spavision.tip_path import TipPath

from .actuator_mesh import actuator_mesh
from .composite import PaperLayer, crimped_composite
from .continuation import (
    AcceptedStep,
    RampStoppedError,
    SteppingSettings,
    pressure_ramp,
    settle_under_gravity,
)
from .elements import FloatArray
from .equilibrium import Equilibrium, State
from .geometry import ActuatorGeometry
from .hex_mesh import HexMesh
from .linear_solver import linear_solver
from .materials.library import find_material
from .newton import NewtonResult, NewtonSettings
from .observe import centre_line, locate

LARGEST_PRESSURE_KPA = 500.0
"""Pressures beyond this are taken for a slip of the unit."""


@dataclass(frozen=True)
class SimulationSettings:
    """Everything about a simulation that is not the actuator's shape, crimp ratio or pressure.

    Parameters
    ----------
    mesh_level : str
        ``draft``, ``default`` or ``fine``.
    body_material, strip_a_material, strip_b_material, matrix_material : str
        Names in the material library.
    paper : PaperLayer
    gravity : bool
        Whether the actuator hangs under its own weight.
    bulk_to_shear : float
        Bulk over initial shear modulus of every silicone (assumed: nearly incompressible).
    newton : NewtonSettings
    stepping : SteppingSettings
    """

    mesh_level: str = "default"
    body_material: str = "Mold Star 15"
    strip_a_material: str = "Mold Star 15"
    strip_b_material: str = "Mold Star 15"
    matrix_material: str = "Ecoflex 00-30"
    paper: PaperLayer = field(default_factory=PaperLayer)
    gravity: bool = True
    bulk_to_shear: float = 1000.0
    newton: NewtonSettings = field(default_factory=NewtonSettings)
    stepping: SteppingSettings = field(default_factory=SteppingSettings)


@dataclass(frozen=True)
class StepRecord:
    """One accepted step of the ramp. Volumes, work and energy are the whole actuator's.

    Parameters
    ----------
    pressure_kPa : float
    newton_iterations : int
    residual : float
        Forces out of balance over external forces.
    negative_pivots : int or None
        Negative eigenvalues of the tangent near the step's end (0: stable), where the solver tells.
    enclosed_volume_mm3 : float
    strain_energy_mJ : float
        Gained since the hanging state.
    gas_work_mJ : float
        ∫ p dV since then, by the trapezoidal rule over the steps.
    gravity_work_mJ : float
        Work of the weight since then.
    """

    pressure_kPa: float
    newton_iterations: int
    residual: float
    negative_pivots: int | None
    enclosed_volume_mm3: float
    strain_energy_mJ: float
    gas_work_mJ: float
    gravity_work_mJ: float

    @property
    def energy_imbalance_mJ(self) -> float:
        """Work done less energy stored: the error of the trapezoidal rule, falling with the step squared."""
        return self.gas_work_mJ + self.gravity_work_mJ - self.strain_energy_mJ


@dataclass(frozen=True)
class Simulation:
    """What a simulation found.

    Parameters
    ----------
    geometry : ActuatorGeometry
    crimp_ratio : float
    settings : SimulationSettings
    mesh : HexMesh
        Of the half z ≥ 0.
    tip_path : TipPath
        One row for each asked pressure; status ``missing`` and the reason where it was not reached.
    displacement_mm : array, shape (n_pressures, n_nodes, 3)
        From the unstressed shape (not from the hanging one); NaN where not reached.
    enclosed_volume_mm3 : array, shape (n_pressures,)
        Of the whole actuator; NaN where not reached.
    centre_line_mm : array, shape (n_pressures, n_points, 2)
        Material mid-line in the x-y plane; NaN where not reached.
    steps : tuple of StepRecord
    stopped_at_kPa : float or None
        Last pressure reached, if the ramp had to stop.
    stop_reason : str
        Why; empty if it did not stop.
    solver_name : str
        Linear solver used.
    """

    geometry: ActuatorGeometry
    crimp_ratio: float
    settings: SimulationSettings
    mesh: HexMesh
    tip_path: TipPath
    displacement_mm: FloatArray
    enclosed_volume_mm3: FloatArray
    centre_line_mm: FloatArray
    steps: tuple[StepRecord, ...]
    stopped_at_kPa: float | None
    stop_reason: str
    solver_name: str


def simulate(
    geometry: ActuatorGeometry,
    *,
    crimp_ratio: float,
    pressures_kPa: FloatArray,
    settings: SimulationSettings | None = None,
    progress: Callable[[float], None] | None = None,
) -> Simulation:
    """Inflate the hanging actuator through the given pressures.

    Parameters
    ----------
    geometry : ActuatorGeometry
    crimp_ratio : float
        Amplitude over wavelength of the paper's crimp, 0.1 to 0.4.
    pressures_kPa : array, shape (n,)
        Gauge pressures, increasing, 0 or more. Displacements are relative to the lowest.
    settings : SimulationSettings, optional
    progress : callable, optional
        Told the pressure reached, in kPa, after each accepted step.

    Returns
    -------
    Simulation
        Also where the ramp had to stop: the rows not reached are ``missing``.

    Raises
    ------
    InputError
        If pressures, crimp ratio, material names or mesh level are unusable.
    """
    settings = settings or SimulationSettings()
    pressures = _checked_pressures(pressures_kPa)
    problem = actuator_problem(geometry, crimp_ratio=crimp_ratio, settings=settings)
    solver = linear_solver()
    journal = _Journal(problem, pressures, progress)
    stop: RampStoppedError | None = None
    try:
        hanging = settle_under_gravity(
            problem, gravity=settings.gravity, solver=solver, newton=settings.newton
        )
        journal.begin(hanging)
        for step in pressure_ramp(
            problem,
            hanging.state,
            targets_kPa=pressures[pressures > 0.0],
            gravity=settings.gravity,
            solver=solver,
            newton=settings.newton,
            stepping=settings.stepping,
        ):
            journal.add(step)
    except RampStoppedError as error:
        stop = error
    return Simulation(
        geometry=geometry,
        crimp_ratio=crimp_ratio,
        settings=settings,
        mesh=problem.mesh,
        tip_path=_tip_path(problem.mesh, geometry, pressures, journal.displacement_mm, stop),
        displacement_mm=journal.displacement_mm,
        enclosed_volume_mm3=journal.enclosed_volume_mm3,
        centre_line_mm=centre_line(problem.mesh, geometry, journal.displacement_mm),
        steps=tuple(journal.steps),
        stopped_at_kPa=stop.pressure_kPa if stop else None,
        stop_reason=stop.reason if stop else "",
        solver_name=solver.name,
    )


def actuator_problem(
    geometry: ActuatorGeometry, *, crimp_ratio: float, settings: SimulationSettings
) -> Equilibrium:
    """Set up the half actuator: mesh, materials, clamp at y = 0 and symmetry at z = 0.

    Raises
    ------
    InputError
        If crimp ratio, material names or mesh level are unusable.
    """
    solids = {
        region: find_material(name).solid(bulk_to_shear=settings.bulk_to_shear)
        for region, name in (
            ("composite", settings.matrix_material),
            ("strip A", settings.strip_a_material),
            ("body", settings.body_material),
            ("strip B", settings.strip_b_material),
        )
    }
    solids["composite"] = crimped_composite(
        solids["composite"], crimp_ratio=crimp_ratio, paper=settings.paper
    )
    mesh = actuator_mesh(geometry, level=settings.mesh_level)
    is_fixed = np.zeros((len(mesh.nodes_mm), 3), dtype=bool)
    is_fixed[mesh.node_sets["clamp"]] = True
    is_fixed[mesh.node_sets["symmetry"], 2] = True
    return Equilibrium(mesh, solids, is_fixed=is_fixed)


class _Journal:
    """Collects steps, and fields at the asked pressures, as the ramp goes."""

    def __init__(
        self, problem: Equilibrium, pressures_kPa: FloatArray, progress: Callable[[float], None] | None
    ) -> None:
        self._problem = problem
        self._pressures = pressures_kPa
        self._progress = progress
        self.steps: list[StepRecord] = []
        self.displacement_mm = np.full((len(pressures_kPa), len(problem.mesh.nodes_mm), 3), np.nan)
        self.enclosed_volume_mm3 = np.full(len(pressures_kPa), np.nan)

    def begin(self, hanging: NewtonResult) -> None:
        """Note the state at zero pressure, from which energies are counted."""
        self._first_energy = self._problem.strain_energy(hanging.state)
        self._first_gravity_work = self._problem.gravity_work(hanging.state)
        self.add(AcceptedStep(0.0, hanging))

    def add(self, step: AcceptedStep) -> None:
        """Note an accepted step."""
        state = step.result.state
        # Twice: the model is one half of the actuator.
        volume = 2.0 * self._problem.enclosed_volume_mm3(state)
        self.steps.append(
            StepRecord(
                pressure_kPa=step.pressure_kPa,
                newton_iterations=step.result.iterations,
                residual=step.result.residuals[-1],
                negative_pivots=step.result.negative_pivots,
                enclosed_volume_mm3=volume,
                strain_energy_mJ=2.0 * (self._problem.strain_energy(state) - self._first_energy),
                gas_work_mJ=self._gas_work_mJ(step.pressure_kPa, volume),
                gravity_work_mJ=self._gravity_work_mJ(state),
            )
        )
        for row in np.flatnonzero(self._pressures == step.pressure_kPa):
            self.displacement_mm[row] = state.displacement
            self.enclosed_volume_mm3[row] = volume
        if self._progress is not None:
            self._progress(step.pressure_kPa)

    def _gas_work_mJ(self, pressure_kPa: float, volume_mm3: float) -> float:
        if not self.steps:
            return 0.0
        last = self.steps[-1]
        mean_MPa = 0.5e-3 * (last.pressure_kPa + pressure_kPa)
        return last.gas_work_mJ + mean_MPa * (volume_mm3 - last.enclosed_volume_mm3)

    def _gravity_work_mJ(self, state: State) -> float:
        return 2.0 * (self._problem.gravity_work(state) - self._first_gravity_work)


def _checked_pressures(pressures_kPa: FloatArray) -> FloatArray:
    pressures = np.atleast_1d(np.asarray(pressures_kPa, dtype=float))
    if pressures.ndim != 1 or pressures.size == 0:
        raise InputError("pressures: expected at least one pressure in kPa")
    if not np.all(np.isfinite(pressures)) or pressures.min() < 0.0 or pressures.max() > LARGEST_PRESSURE_KPA:
        raise InputError(
            f"pressures: {pressures.min():g} to {pressures.max():g} kPa, expected 0 to {LARGEST_PRESSURE_KPA:g} kPa"
        )
    if np.any(np.diff(pressures) <= 0.0):
        at = int(np.flatnonzero(np.diff(pressures) <= 0.0)[0])
        raise InputError(
            f"pressures: {pressures[at]:g} kPa is followed by {pressures[at + 1]:g} kPa, expected increasing ones"
        )
    return pressures


def _tip_path(
    mesh: HexMesh,
    geometry: ActuatorGeometry,
    pressures_kPa: FloatArray,
    displacement_mm: FloatArray,
    stop: RampStoppedError | None,
) -> TipPath:
    """Displacement of the marker relative to the lowest pressure."""
    marker = locate(mesh, np.array(geometry.marker_position_mm)).displacement(displacement_mm)
    relative = marker - marker[0]
    reached = np.isfinite(relative[:, 0])
    reason = f"the ramp stopped at {stop.pressure_kPa:.4g} kPa: {stop.reason}" if stop else ""
    unknown = np.full(len(pressures_kPa), np.nan)
    return TipPath(
        pressure_kPa=pressures_kPa,
        ux_mm=relative[:, 0],
        uy_mm=relative[:, 1],
        sigma_ux_mm=unknown,
        sigma_uy_mm=unknown.copy(),
        status=tuple("ok" if one else "missing" for one in reached),
        reason=tuple("" if one else reason for one in reached),
    )
