"""Volume control: the enclosed volume is prescribed and the pressure found, which passes limit points."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from .continuation import AcceptedStep, RampStoppedError, StopPlace
from .elements import FloatArray
from .equilibrium import Equilibrium
from .linear_solver import LinearSolver, SingularTangentError
from .newton import NewtonResult, NewtonSettings, NotConvergedError, find_equilibrium
from .state import Load, State, combine

_GROWTH_OF_EASY_STEP = 1.5
_EASY_ITERATIONS = 5


@dataclass(frozen=True)
class VolumeStepping:
    """How the enclosed volume is stepped, in multiples of the volume at zero pressure.

    Parameters
    ----------
    first_step, largest_step, smallest_step : float
    largest_ratio : float
        Volume ratio V/V₀ at which the ramp ends.
    """

    first_step: float = 0.05
    largest_step: float = 0.25
    smallest_step: float = 1e-3
    largest_ratio: float = 25.0


@dataclass(frozen=True)
class VolumePoint:
    """An equilibrium at a prescribed enclosed volume.

    Parameters
    ----------
    volume_mm3 : float
        Of the cavity as modelled (half of it in a half model).
    gas_pressure_MPa : float
    result : NewtonResult
    """

    volume_mm3: float
    gas_pressure_MPa: float
    result: NewtonResult


def find_equilibrium_at_volume(
    problem: Equilibrium,
    start: VolumePoint,
    volume_mm3: float,
    *,
    gravity: float,
    solver: LinearSolver,
    settings: NewtonSettings,
) -> VolumePoint:
    """Find the equilibrium at an enclosed volume by Newton's method on displacement and pressure together.

    The bordered system [K, −f; fᵀ, 0] with f = ∂V/∂u stays regular where K is singular at a limit point;
    it is solved by two solutions with K, which is exactly singular only in passing.

    Parameters
    ----------
    problem : Equilibrium
    start : VolumePoint
        A guess of displacement and pressure.
    volume_mm3 : float
    gravity : float
        Fraction of its own weight that the body bears.
    solver : LinearSolver
    settings : NewtonSettings

    Raises
    ------
    NotConvergedError
        If the iteration diverges, turns an element inside out or meets a singular tangent.
    """
    state, pressure = start.result.state, start.gas_pressure_MPa
    residuals: list[float] = []
    correction_mm = np.inf
    for iteration in range(settings.max_iterations + 1):
        load = Load(pressure, gravity)
        balance = problem.balance(state, load)
        if balance is None:
            raise NotConvergedError("an element was turned inside out")
        missing_mm3 = volume_mm3 - problem.enclosed_volume_mm3(state)
        residuals.append(max(balance.relative_residual, abs(missing_mm3) / volume_mm3))
        if residuals[-1] < settings.residual_tolerance and correction_mm < settings.correction_tolerance_mm:
            result = NewtonResult(state, iteration, tuple(residuals), solver.negative_pivots)
            return VolumePoint(volume_mm3, pressure, result)
        if iteration == settings.max_iterations:
            break
        try:
            solver.factorise(problem.tangent(state, load, balance))
        except SingularTangentError as error:
            raise NotConvergedError("the tangent is singular") from error
        forces = problem.unit_pressure_forces(state)[problem.is_free]
        settled = solver.solve(-balance.condensed[problem.is_free])
        per_MPa = solver.solve(forces)
        change_MPa = float((missing_mm3 - forces @ settled) / (forces @ per_MPa))
        correction = settled + change_MPa * per_MPa
        correction_mm = float(np.abs(correction).max())
        if not correction_mm < settings.largest_correction_mm:
            raise NotConvergedError(f"a correction of {correction_mm:.3g} mm")
        state, pressure = problem.update(state, balance, correction), pressure + change_MPa
    raise NotConvergedError(f"no convergence in {settings.max_iterations} iteration(s)")


def volume_path(
    problem: Equilibrium,
    start: NewtonResult,
    *,
    gravity: float,
    solver: LinearSolver,
    newton: NewtonSettings,
    stepping: VolumeStepping,
) -> Iterator[VolumePoint]:
    """Inflate by volume from an equilibrium without gas pressure.

    Yields
    ------
    VolumePoint
        Pressures need not increase.

    Raises
    ------
    RampStoppedError
        If no volume step above the smallest converges.
    """
    first_mm3 = problem.enclosed_volume_mm3(start.state)
    history = [VolumePoint(first_mm3, 0.0, start)]
    step = stepping.first_step * first_mm3
    while history[-1].volume_mm3 < stepping.largest_ratio * first_mm3:
        volume = min(history[-1].volume_mm3 + step, stepping.largest_ratio * first_mm3)
        try:
            point = find_equilibrium_at_volume(
                problem,
                _extrapolated(history, volume),
                volume,
                gravity=gravity,
                solver=solver,
                settings=newton,
            )
        except NotConvergedError as error:
            step *= 0.5
            if step < stepping.smallest_step * first_mm3:
                last = history[-1]
                place = StopPlace(last.result.state)
                raise RampStoppedError(1e3 * last.gas_pressure_MPa, str(error), place) from error
            continue
        if point.result.iterations <= _EASY_ITERATIONS:
            step = min(_GROWTH_OF_EASY_STEP * step, stepping.largest_step * first_mm3)
        history = [history[-1], point]
        yield point


def volume_ramp(
    problem: Equilibrium,
    start: NewtonResult,
    *,
    targets_kPa: FloatArray,
    gravity: float,
    solver: LinearSolver,
    newton: NewtonSettings,
    stepping: VolumeStepping,
) -> Iterator[AcceptedStep]:
    """Step by volume until the last of the given pressures is passed, meeting each of them on the way.

    A pressure is met where the path first rises through it, so that one above a limit point is met after
    the path has fallen and risen again, if it does.

    Yields
    ------
    AcceptedStep

    Raises
    ------
    RampStoppedError
        If a step fails, or the largest volume is reached first.
    """
    before = VolumePoint(problem.enclosed_volume_mm3(start.state), 0.0, start)
    waiting = [float(target) for target in targets_kPa]
    highest_kPa = 0.0
    if not waiting:
        return
    for point in volume_path(
        problem, start, gravity=gravity, solver=solver, newton=newton, stepping=stepping
    ):
        reached_kPa = 1e3 * point.gas_pressure_MPa
        while waiting and waiting[0] <= reached_kPa:
            target = waiting.pop(0)
            guess = _at_pressure(before, point, target * 1e-3)
            load = Load(target * 1e-3, gravity)
            try:
                result = find_equilibrium(problem, guess, load, solver=solver, settings=newton)
            except NotConvergedError as error:
                raise RampStoppedError(highest_kPa, str(error), StopPlace(before.result.state)) from error
            yield AcceptedStep(target, result)
        if not waiting:
            return
        yield AcceptedStep(reached_kPa, point.result)
        before, highest_kPa = point, max(highest_kPa, reached_kPa)
    falls = before.gas_pressure_MPa * 1e3 < highest_kPa
    reason = "the pressure did not rise further" if falls else "the pressures asked for were not reached"
    raise RampStoppedError(highest_kPa, f"{reason} up to {stepping.largest_ratio:g} times the volume at rest")


def _extrapolated(history: list[VolumePoint], volume_mm3: float) -> VolumePoint:
    """Continue the line through the last two points, at a further volume."""
    last = history[-1]
    if len(history) == 1:
        return last
    span = last.volume_mm3 - history[0].volume_mm3
    return _between(history[0], last, (volume_mm3 - history[0].volume_mm3) / span)


def _at_pressure(low: VolumePoint, high: VolumePoint, pressure_MPa: float) -> State:
    """Return the state between two points where a linear path would have the pressure."""
    rise = high.gas_pressure_MPa - low.gas_pressure_MPa
    return _between(low, high, (pressure_MPa - low.gas_pressure_MPa) / rise).result.state


def _between(first: VolumePoint, second: VolumePoint, fraction: float) -> VolumePoint:
    state = combine((1.0 - fraction, fraction), (first.result.state, second.result.state))
    volume = first.volume_mm3 + fraction * (second.volume_mm3 - first.volume_mm3)
    pressure = first.gas_pressure_MPa + fraction * (second.gas_pressure_MPa - first.gas_pressure_MPa)
    return VolumePoint(volume, pressure, NewtonResult(state, 0, (), None))
