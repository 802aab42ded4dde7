"""The path of equilibria behind a ramp: its last states and directions, what they foretell."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .equilibrium import Equilibrium
from .linear_solver import LinearSolver
from .newton import NewtonResult
from .state import State, combine


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


def waypoint(
    problem: Equilibrium, pressure_kPa: float, result: NewtonResult, solver: LinearSolver
) -> Waypoint:
    """Find the path's direction with the last tangent, which is a correction or two behind the state."""
    if result.tangent_at is None:
        return Waypoint(pressure_kPa, result.state, None)
    rate = np.zeros_like(result.state.displacement)
    rate[problem.is_free] = solver.solve(1e-3 * problem.unit_pressure_forces(result.state)[problem.is_free])
    return Waypoint(pressure_kPa, result.state, problem.linear_change(result.tangent_at, rate))


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
