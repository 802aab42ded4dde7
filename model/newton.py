"""Newton's method for equilibrium at one load."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .equilibrium import Balance, Equilibrium, Load, State
from .linear_solver import LinearSolver, SingularTangentError


@dataclass(frozen=True)
class NewtonSettings:
    """When to stop iterating.

    Parameters
    ----------
    residual_tolerance : float
        Largest forces out of balance, relative to the external forces.
    correction_tolerance_mm : float
        Largest last correction of a displacement component.
    largest_correction_mm : float
        A correction beyond this is taken as divergence.
    max_iterations : int
    """

    residual_tolerance: float = 1e-5
    correction_tolerance_mm: float = 1e-2
    largest_correction_mm: float = 60.0
    max_iterations: int = 9


@dataclass(frozen=True)
class NewtonResult:
    """An equilibrium, and how it was reached.

    Parameters
    ----------
    state : State
    iterations : int
        Tangents factorised.
    residuals : tuple of float
        Relative residual before each iteration and at the end.
    negative_pivots : int or None
        Negative eigenvalues of the last tangent factorised, one correction before the end.
    """

    state: State
    iterations: int
    residuals: tuple[float, ...]
    negative_pivots: int | None


class NotConvergedError(ArithmeticError):
    """Newton's method found no equilibrium; the message says how it failed."""


def find_equilibrium(
    problem: Equilibrium, start: State, load: Load, *, solver: LinearSolver, settings: NewtonSettings
) -> NewtonResult:
    """Find the equilibrium nearest to a start state.

    Raises
    ------
    NotConvergedError
        If the iteration diverges, turns an element inside out or meets a singular tangent.
    """
    state, residuals, correction_mm = start, [], np.inf
    for iteration in range(settings.max_iterations + 1):
        balance = problem.balance(state, load)
        if balance is None:
            raise NotConvergedError("an element was turned inside out")
        residuals.append(balance.relative_residual)
        if not np.isfinite(residuals[-1]):
            raise NotConvergedError("the forces overflowed")
        if residuals[-1] < settings.residual_tolerance and correction_mm < settings.correction_tolerance_mm:
            return NewtonResult(state, iteration, tuple(residuals), solver.negative_pivots)
        if iteration == settings.max_iterations:
            break
        state, correction_mm = _iterate(problem, state, load, balance, solver)
        if not correction_mm < settings.largest_correction_mm:
            raise NotConvergedError(f"a correction of {correction_mm:.3g} mm")
    raise NotConvergedError(f"no convergence in {settings.max_iterations} iteration(s)")


def _iterate(
    problem: Equilibrium, state: State, load: Load, balance: Balance, solver: LinearSolver
) -> tuple[State, float]:
    """One Newton correction: the new state and the largest change of a displacement component."""
    try:
        solver.factorise(problem.tangent(state, load, balance))
        correction = solver.solve(-balance.condensed[problem.is_free])
    except SingularTangentError as error:
        raise NotConvergedError("the tangent is singular") from error
    return problem.update(state, balance, correction), float(np.abs(correction).max())
