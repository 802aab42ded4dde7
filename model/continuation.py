"""Adaptive stepping in pressure: extrapolated starts, halving on failure, landing on the asked pressures."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from .elements import FloatArray
from .equilibrium import Equilibrium
from .linear_solver import LinearSolver
from .newton import NewtonResult, NewtonSettings, NotConvergedError, find_equilibrium
from .state import Load, State, combine

_NEAR_KPA = 1.0
"""A limit point foreseen this near to where the ramp stops is taken for the reason."""


@dataclass(frozen=True)
class SteppingSettings:
    """How large the pressure steps are.

    Parameters
    ----------
    first_step_kPa, largest_step_kPa, smallest_step_kPa : float
    easy_iterations, hard_iterations : int
        Up to the first the next step grows by half, from the second on it is halved.
    """

    first_step_kPa: float = 5.0
    largest_step_kPa: float = 5.0
    smallest_step_kPa: float = 0.02
    easy_iterations: int = 4
    hard_iterations: int = 7


@dataclass(frozen=True)
class AcceptedStep:
    """An equilibrium on the way.

    Parameters
    ----------
    pressure_kPa : float
    result : NewtonResult
    place : RampPlace or None
        From where a pressure ramp can go on; None under volume control.
    """

    pressure_kPa: float
    result: NewtonResult
    place: RampPlace | None = None


class RampStoppedError(ArithmeticError):
    """The ramp cannot go on.

    Parameters
    ----------
    pressure_kPa : float
        The last pressure reached.
    reason : str
    """

    def __init__(self, pressure_kPa: float, reason: str) -> None:
        super().__init__(reason)
        self.pressure_kPa = pressure_kPa
        self.reason = reason


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
    return RampPlace((_waypoint(problem, 0.0, hanging, solver),), stepping.first_step_kPa)


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
    """Step through the given pressures.

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
        If no step above the smallest converges.
    """
    history, step = list(start.history), start.step_kPa
    for target in targets_kPa:
        while history[-1].pressure_kPa < target:
            pressure = _next_pressure(history[-1].pressure_kPa, step, float(target))
            load = Load(pressure * 1e-3, float(gravity))
            guess = extrapolate(history, pressure)
            try:
                result = find_equilibrium(problem, guess, load, solver=solver, settings=newton)
            except NotConvergedError as error:
                step = 0.5 * (pressure - history[-1].pressure_kPa)
                if step < stepping.smallest_step_kPa:
                    raise RampStoppedError(history[-1].pressure_kPa, _why(history, error)) from error
                continue
            step = _adapted(step, result.iterations, stepping)
            history = [history[-1], _waypoint(problem, pressure, result, solver)]
            yield AcceptedStep(pressure, result, RampPlace(tuple(history), step))


@dataclass(frozen=True)
class Waypoint:
    """A state on the path and the direction in which the path goes on.

    Parameters
    ----------
    pressure_kPa : float
    state : State
    rate : State or None
        Change per kPa; None where no tangent is at hand.
    """

    pressure_kPa: float
    state: State
    rate: State | None


@dataclass(frozen=True)
class RampPlace:
    """Where a pressure ramp stands: all that it needs to go on.

    Parameters
    ----------
    history : tuple of Waypoint
        The last one or two.
    step_kPa : float
        The step to try next.
    """

    history: tuple[Waypoint, ...]
    step_kPa: float


def extrapolate(history: list[Waypoint], pressure_kPa: float) -> State:
    """Continue the path to a further pressure: Hermite's cubic through two waypoints, a line from one.

    Parameters
    ----------
    history : list of Waypoint
        The last one or two.
    pressure_kPa : float
    """
    first, last = history[0], history[-1]
    if last.rate is None:
        return last.state
    if first is last or first.rate is None:
        return combine((1.0, pressure_kPa - last.pressure_kPa), (last.state, last.rate))
    span = last.pressure_kPa - first.pressure_kPa
    t = (pressure_kPa - first.pressure_kPa) / span
    weights = (
        (1.0 + 2.0 * t) * (1.0 - t) ** 2,
        span * t * (1.0 - t) ** 2,
        t**2 * (3.0 - 2.0 * t),
        span * t**2 * (t - 1.0),
    )
    return combine(weights, (first.state, first.rate, last.state, last.rate))


def _waypoint(
    problem: Equilibrium, pressure_kPa: float, result: NewtonResult, solver: LinearSolver
) -> Waypoint:
    """Find the path's direction with the last tangent, which is a correction or two behind the state."""
    if result.tangent_at is None:
        return Waypoint(pressure_kPa, result.state, None)
    rate = np.zeros_like(result.state.displacement)
    rate[problem.is_free] = solver.solve(1e-3 * problem.unit_pressure_forces(result.state)[problem.is_free])
    return Waypoint(pressure_kPa, result.state, problem.linear_change(result.tangent_at, rate))


def _why(history: list[Waypoint], error: NotConvergedError) -> str:
    """Say why no further step converges, with the limit point if the path turns steep towards one."""
    limit_kPa = limit_point_kPa(history)
    last_kPa = history[-1].pressure_kPa
    if limit_kPa - last_kPa < _NEAR_KPA:
        return (
            f"a limit point, a maximum of the gas pressure, is foreseen at {limit_kPa:.2f} kPa; "
            "volume control passes it"
        )
    return f"no equilibrium was found beyond: {error}"


def limit_point_kPa(history: list[Waypoint]) -> float:
    """Return the pressure of the limit point that the last two waypoints foresee; infinite if none.

    Towards a limit point the path turns steep, its rate growing with one over the root of the pressure
    that is left (a fold): the inverse square of the rate falls linearly to nothing.
    """
    pairs = [(point.pressure_kPa, point.rate) for point in history if point.rate is not None]
    if len(pairs) < 2:
        return np.inf
    (before_kPa, before), (last_kPa, last) = pairs
    left = [1.0 / float(np.sum(rate.displacement**2)) for rate in (before, last)]
    fallen = left[0] - left[1]
    return last_kPa + (last_kPa - before_kPa) * left[1] / fallen if fallen > 0.0 else np.inf


def _next_pressure(current: float, step: float, target: float) -> float:
    """Step towards the target in equal parts no larger than the wanted step."""
    parts = int(np.ceil((target - current) / step - 1e-9))
    return target if parts <= 1 else current + (target - current) / parts


def _adapted(step: float, iterations: int, settings: SteppingSettings) -> float:
    if iterations <= settings.easy_iterations:
        return min(1.5 * step, settings.largest_step_kPa)
    return 0.5 * step if iterations >= settings.hard_iterations else step
