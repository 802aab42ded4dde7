"""Adaptive stepping in pressure: extrapolated starts, halving on failure, landing on the asked pressures."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from .constitutive import deform
from .elements import FloatArray
from .equilibrium import Equilibrium
from .law_use import laws_are_stable
from .linear_solver import LinearSolver
from .newton import NewtonResult, NewtonSettings, NotConvergedError, find_equilibrium
from .ramp_path import RampPlace, Waypoint, extrapolate, limit_point_kPa, waypoint
from .snap import NoStableStateError, snap
from .state import Load, State


@dataclass(frozen=True)
class SteppingSettings:
    """How large the pressure steps are.

    Parameters
    ----------
    first_step_kPa, largest_step_kPa, smallest_step_kPa : float
    easy_iterations, hard_iterations : int
        Up to the first the next step grows by half, from the second on it is halved.
    snap_step_kPa : float
        Step over a fold, beyond which the next stable state is looked for, see `snap`.
    largest_snap_steps : int
        Damped steps allowed for one snap.
    """

    first_step_kPa: float = 5.0
    largest_step_kPa: float = 5.0
    smallest_step_kPa: float = 0.02
    easy_iterations: int = 4
    hard_iterations: int = 7
    snap_step_kPa: float = 0.1
    largest_snap_steps: int = 200


@dataclass(frozen=True)
class AcceptedStep:
    """An equilibrium on the way.

    Parameters
    ----------
    pressure_kPa : float
    result : NewtonResult
    place : RampPlace or None
        From where a pressure ramp can go on; None under volume control.
    released_mJ : float
        Energy given off where the body snapped to this state; 0 where it moved smoothly.
    """

    pressure_kPa: float
    result: NewtonResult
    place: RampPlace | None = None
    released_mJ: float = 0.0


@dataclass(frozen=True)
class StopPlace:
    """Where a ramp stopped, to find the cause in.

    Parameters
    ----------
    state : State
        The last equilibrium.
    node : int or None
        That moved farthest when a further one was looked for.
    balloons : bool
        Whether the enclosed volume then grew without end.
    limit_kPa : float
        Pressure of the limit point that the path before foretells; infinite if none.
    """

    state: State
    node: int | None = None
    balloons: bool = False
    limit_kPa: float = np.inf


class RampStoppedError(ArithmeticError):
    """The ramp cannot go on.

    Parameters
    ----------
    pressure_kPa : float
        The last pressure reached.
    reason : str
        In the solver's words.
    place : StopPlace or None
        None where there is no equilibrium to start from.
    """

    def __init__(self, pressure_kPa: float, reason: str, place: StopPlace | None = None) -> None:
        super().__init__(reason)
        self.pressure_kPa = pressure_kPa
        self.reason = reason
        self.place = place


def settle_under_gravity(
    problem: Equilibrium, *, gravity: bool, solver: LinearSolver, newton: NewtonSettings
) -> NewtonResult:
    """Find the equilibrium under the body's own weight, applied in halves as often as needed.

    Raises
    ------
    RampStoppedError
        If not even a 64th of the weight can be applied.
    """
    if not gravity:
        return NewtonResult(problem.unloaded(), 0, (0.0,), None)
    state, borne, step = problem.unloaded(), 0.0, 1.0
    while True:
        try:
            result = find_equilibrium(problem, state, Load(0.0, borne + step), solver=solver, settings=newton)
        except NotConvergedError as error:
            step *= 0.5
            if step < 1.0 / 64.0:
                raise RampStoppedError(0.0, f"the actuator's own weight: {error}") from error
            continue
        state, borne = result.state, borne + step
        if borne >= 1.0:
            return result


def ramp_at_rest(
    problem: Equilibrium, hanging: NewtonResult, *, solver: LinearSolver, stepping: SteppingSettings
) -> RampPlace:
    """Return the place of a ramp that has not begun, at the equilibrium without gas pressure."""
    return RampPlace((waypoint(problem, 0.0, hanging, solver),), stepping.first_step_kPa)


def pressure_ramp(
    problem: Equilibrium,
    start: RampPlace,
    *,
    targets_kPa: FloatArray,
    gravity: bool,
    solver: LinearSolver,
    newton: NewtonSettings,
    stepping: SteppingSettings,
) -> Iterator[AcceptedStep]:
    """Step through the given pressures, snapping over folds of the path where it has to.

    Parameters
    ----------
    problem : Equilibrium
    start : RampPlace
    targets_kPa : array, shape (n,)
        Increasing; each of them beyond the start is met exactly.
    gravity : bool
        Whether the body bears its weight.
    solver : LinearSolver
    newton : NewtonSettings
    stepping : SteppingSettings

    Yields
    ------
    AcceptedStep

    Raises
    ------
    RampStoppedError
        If no step above the smallest converges, and no stable state is found near by either.
    """
    ramp = _Ramp(problem, start, gravity=gravity, solver=solver, newton=newton, stepping=stepping)
    for target in targets_kPa:
        while ramp.pressure_kPa < target:
            step = ramp.advance(float(target))
            if step is not None:
                yield step


class _Ramp:
    """Where a pressure ramp stands, and how it goes on."""

    def __init__(
        self,
        problem: Equilibrium,
        start: RampPlace,
        *,
        gravity: bool,
        solver: LinearSolver,
        newton: NewtonSettings,
        stepping: SteppingSettings,
    ) -> None:
        self._problem, self._gravity, self._solver = problem, float(gravity), solver
        self._newton, self._stepping = newton, stepping
        self._history, self._step_kPa = list(start.history), start.step_kPa

    @property
    def pressure_kPa(self) -> float:
        """The last pressure reached."""
        return self._history[-1].pressure_kPa

    def advance(self, target_kPa: float) -> AcceptedStep | None:
        """Try a step towards a pressure; None if it failed and the next is to be smaller."""
        pressure = _next_pressure(self.pressure_kPa, self._step_kPa, target_kPa)
        guess = extrapolate(self._history, pressure)
        try:
            result = find_equilibrium(
                self._problem, guess, self._load(pressure), solver=self._solver, settings=self._newton
            )
        except NotConvergedError as error:
            self._step_kPa = 0.5 * (pressure - self.pressure_kPa)
            if self._step_kPa >= self._stepping.smallest_step_kPa:
                return None
            return self._snap(target_kPa, error)
        self._step_kPa = _adapted(self._step_kPa, result.iterations, self._stepping)
        return self._accept(pressure, result, self._history[-1:])

    def _snap(self, target_kPa: float, failure: NotConvergedError) -> AcceptedStep:
        """Look for a stable state beyond the fold at which stepping failed."""
        pressure = min(self.pressure_kPa + self._stepping.snap_step_kPa, target_kPa)
        last = self._history[-1].state
        problem = self._problem
        if not laws_are_stable(
            problem.groups, deform(last.displacement, problem.mesh.elements, problem.geometry)
        ):
            # The energy falls as the material softens, and there is nothing to come to rest at.
            raise RampStoppedError(self.pressure_kPa, str(failure), StopPlace(last)) from failure
        try:
            jump = snap(
                self._problem,
                last,
                self._load(pressure),
                solver=self._solver,
                newton=self._newton,
                max_steps=self._stepping.largest_snap_steps,
            )
        except NoStableStateError as error:
            reason = f"{failure}; beyond, {error}"
            cause = StopPlace(last, error.node, error.balloons, limit_point_kPa(self._history))
            raise RampStoppedError(self.pressure_kPa, reason, cause) from error
        self._step_kPa = self._stepping.snap_step_kPa
        return self._accept(pressure, jump.result, [], jump.released_mJ)

    def _accept(
        self, pressure_kPa: float, result: NewtonResult, before: list[Waypoint], released_mJ: float = 0.0
    ) -> AcceptedStep:
        self._history = [*before, waypoint(self._problem, pressure_kPa, result, self._solver)]
        place = RampPlace(tuple(self._history), self._step_kPa)
        return AcceptedStep(pressure_kPa, result, place, released_mJ)

    def _load(self, pressure_kPa: float) -> Load:
        return Load(pressure_kPa * 1e-3, self._gravity)


def _next_pressure(current: float, step: float, target: float) -> float:
    """Step towards the target in equal parts no larger than the wanted step."""
    parts = int(np.ceil((target - current) / step - 1e-9))
    return target if parts <= 1 else current + (target - current) / parts


def _adapted(step: float, iterations: int, settings: SteppingSettings) -> float:
    if iterations <= settings.easy_iterations:
        return min(1.5 * step, settings.largest_step_kPa)
    return 0.5 * step if iterations >= settings.hard_iterations else step
