"""Adaptive stepping in pressure: extrapolated starts, halving on failure, landing on the asked pressures."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from .elements import FloatArray
from .equilibrium import Equilibrium, Load, State
from .linear_solver import LinearSolver
from .newton import NewtonResult, NewtonSettings, NotConvergedError, find_equilibrium


@dataclass(frozen=True)
class SteppingSettings:
    """How large the pressure steps are.

    Parameters
    ----------
    first_step_kPa, largest_step_kPa, smallest_step_kPa : float
    extrapolation_points : int
        Earlier states through which the start of the next is extrapolated.
    easy_iterations, hard_iterations : int
        Up to the first the next step grows by half, from the second on it is halved.
    """

    first_step_kPa: float = 2.5
    largest_step_kPa: float = 5.0
    smallest_step_kPa: float = 0.02
    extrapolation_points: int = 4
    easy_iterations: int = 4
    hard_iterations: int = 7


@dataclass(frozen=True)
class AcceptedStep:
    """An equilibrium on the way.

    Parameters
    ----------
    pressure_kPa : float
    result : NewtonResult
    """

    pressure_kPa: float
    result: NewtonResult


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


def pressure_ramp(
    problem: Equilibrium,
    start: State,
    *,
    targets_kPa: FloatArray,
    gravity: bool,
    solver: LinearSolver,
    newton: NewtonSettings,
    stepping: SteppingSettings,
) -> Iterator[AcceptedStep]:
    """Step from zero pressure through the given pressures.

    Parameters
    ----------
    problem : Equilibrium
    start : State
        Equilibrium at zero pressure.
    targets_kPa : array, shape (n,)
        Positive and increasing; each of them is met exactly.
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
    history = [(0.0, start)]
    step = stepping.first_step_kPa
    for target in targets_kPa:
        while history[-1][0] < target:
            pressure = _next_pressure(history[-1][0], step, float(target))
            load = Load(pressure * 1e-3, float(gravity))
            guess = extrapolate(history, pressure)
            try:
                result = find_equilibrium(problem, guess, load, solver=solver, settings=newton)
            except NotConvergedError as error:
                step = 0.5 * (pressure - history[-1][0])
                if step < stepping.smallest_step_kPa:
                    raise RampStoppedError(history[-1][0], str(error)) from error
                continue
            step = _adapted(step, result.iterations, stepping)
            history = [*history, (pressure, result.state)][-stepping.extrapolation_points :]
            yield AcceptedStep(pressure, result)


def extrapolate(history: list[tuple[float, State]], pressure_kPa: float) -> State:
    """Return Lagrange's polynomial through earlier states at a further pressure.

    Parameters
    ----------
    history : list of (pressure_kPa, State)
    pressure_kPa : float
    """
    pressures = np.array([pressure for pressure, _ in history])
    weights = [
        float(np.prod((pressure_kPa - np.delete(pressures, k)) / (pressures[k] - np.delete(pressures, k))))
        for k in range(len(history))
    ]
    return State(
        displacement=np.einsum("k,kai->ai", weights, np.stack([state.displacement for _, state in history])),
        pressure=np.einsum("k,kem->em", weights, np.stack([state.pressure for _, state in history])),
    )


def _next_pressure(current: float, step: float, target: float) -> float:
    """Step towards the target in equal parts no larger than the wanted step."""
    parts = int(np.ceil((target - current) / step - 1e-9))
    return target if parts <= 1 else current + (target - current) / parts


def _adapted(step: float, iterations: int, settings: SteppingSettings) -> float:
    if iterations <= settings.easy_iterations:
        return min(1.5 * step, settings.largest_step_kPa)
    return 0.5 * step if iterations >= settings.hard_iterations else step
