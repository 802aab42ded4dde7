"""The pressure ramp of the bimodal actuator, from geometry and crimp ratio to tip path."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from spavision.errors import InputError
from spavision.quiet_threads import quiet_blas
from spavision.tip_path import TipPath

from .actuator_problem import actuator_problem, region_materials
from .continuation import AcceptedStep, RampStoppedError, pressure_ramp, ramp_at_rest, settle_under_gravity
from .elements import FloatArray
from .equilibrium import Equilibrium
from .geometry import ActuatorGeometry
from .hex_mesh import HexMesh
from .journal import Checkpoint, Journal
from .linear_solver import LinearSolver, linear_solver
from .observe import centre_line, locate
from .simulation import Simulation, SimulationSettings, StepRecord
from .stop_reason import stop_reason
from .volume_control import volume_ramp

__all__ = ["Simulation", "SimulationSettings", "StepRecord", "simulate"]

CONTROLS = ("pressure", "volume")

LARGEST_PRESSURE_KPA = 500.0
"""Pressures beyond this are taken for a slip of the unit."""


def simulate(
    geometry: ActuatorGeometry,
    *,
    crimp_ratio: float,
    pressures_kPa: FloatArray,
    settings: SimulationSettings | None = None,
    progress: Callable[[float], None] | None = None,
    resume: Checkpoint | None = None,
    keep: Callable[[Checkpoint], None] | None = None,
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
    resume : Checkpoint, optional
        Of the same ramp, interrupted under pressure control, which then goes on as if it had not been.
    keep : callable, optional
        Given a checkpoint after each accepted step under pressure control.

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
    pressures = checked_pressures(pressures_kPa)
    if settings.control not in CONTROLS:
        raise InputError(f"control is {settings.control!r}, expected one of {', '.join(CONTROLS)}")
    problem = actuator_problem(geometry, crimp_ratio=crimp_ratio, settings=settings)
    solver = linear_solver()
    journal = Journal(problem, pressures, progress)
    stop: RampStoppedError | None = None
    try:
        # A step too far may overflow before it is found to be one.
        with quiet_blas(), np.errstate(over="ignore", invalid="ignore"):
            for step in _ramp(problem, journal, pressures[pressures > 0.0], settings, solver, resume):
                journal.add(step)
                if keep is not None and step.place is not None:
                    keep(journal.checkpoint(step.place))
    except RampStoppedError as error:
        stop = error
    reason = (
        stop_reason(problem, stop, geometry=geometry, materials=region_materials(settings)) if stop else ""
    )
    return Simulation(
        geometry=geometry,
        crimp_ratio=crimp_ratio,
        settings=settings,
        mesh=problem.mesh,
        tip_path=_tip_path(problem.mesh, geometry, pressures, journal.displacement_mm, stop, reason),
        displacement_mm=journal.displacement_mm,
        enclosed_volume_mm3=journal.enclosed_volume_mm3,
        centre_line_mm=centre_line(problem.mesh, geometry, journal.displacement_mm),
        steps=tuple(journal.steps),
        stopped_at_kPa=stop.pressure_kPa if stop else None,
        stop_reason=reason,
        solver_name=solver.name,
    )


def _ramp(
    problem: Equilibrium,
    journal: Journal,
    targets_kPa: FloatArray,
    settings: SimulationSettings,
    solver: LinearSolver,
    resume: Checkpoint | None,
) -> Iterator[AcceptedStep]:
    """Let the actuator hang, or take up an interrupted ramp, and inflate it under the control asked for."""
    newton, gravity = settings.newton, settings.gravity
    if resume is None:
        hanging = settle_under_gravity(problem, gravity=gravity, solver=solver, newton=newton)
        journal.begin(hanging)
        if settings.control == "volume":
            yield from volume_ramp(
                problem,
                hanging,
                targets_kPa=targets_kPa,
                gravity=float(gravity),
                solver=solver,
                newton=newton,
                stepping=settings.volume_stepping,
            )
            return
        start = ramp_at_rest(problem, hanging, solver=solver, stepping=settings.stepping)
    else:
        journal.go_on(resume)
        start = resume.place
    yield from pressure_ramp(
        problem,
        start,
        targets_kPa=targets_kPa,
        gravity=gravity,
        solver=solver,
        newton=newton,
        stepping=settings.stepping,
    )


def checked_pressures(pressures_kPa: FloatArray) -> FloatArray:
    """Return the pressures of a ramp as an array.

    Raises
    ------
    InputError
        If they do not increase, or are outside 0 to `LARGEST_PRESSURE_KPA`.
    """
    pressures = np.atleast_1d(np.asarray(pressures_kPa, dtype=float))
    if pressures.ndim != 1 or pressures.size == 0:
        raise InputError("pressures: expected at least one pressure in kPa")
    if not np.all(np.isfinite(pressures)) or pressures.min() < 0.0 or pressures.max() > LARGEST_PRESSURE_KPA:
        raise InputError(
            f"pressures: {pressures.min():g} to {pressures.max():g} kPa, "
            f"expected 0 to {LARGEST_PRESSURE_KPA:g} kPa"
        )
    if np.any(np.diff(pressures) <= 0.0):
        at = int(np.flatnonzero(np.diff(pressures) <= 0.0)[0])
        raise InputError(
            f"pressures: {pressures[at]:g} kPa is followed by {pressures[at + 1]:g} kPa, "
            "expected increasing ones"
        )
    return pressures


def _tip_path(
    mesh: HexMesh,
    geometry: ActuatorGeometry,
    pressures_kPa: FloatArray,
    displacement_mm: FloatArray,
    stop: RampStoppedError | None,
    cause: str,
) -> TipPath:
    """Displacement of the marker relative to the lowest pressure."""
    marker = locate(mesh, np.array(geometry.marker_position_mm)).displacement(displacement_mm)
    relative = marker - marker[0]
    reached = np.isfinite(relative[:, 0])
    reason = f"the ramp stopped at {stop.pressure_kPa:.4g} kPa: {cause}" if stop else ""
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
