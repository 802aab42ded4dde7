"""Newton's method for equilibrium at one load."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .equilibrium import Balance, Equilibrium, Load, State
from .linear_solver import LinearSolver, SingularTangentError

_FAST_SHRINKAGE = 0.3
"""Ratio of corrections, or residuals, up to which a kept tangent costs less than a new one."""

_NEARLY_DONE = 10.0
"""Residual in tolerances, below which a kept tangent does for the rest."""


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
    reuse_below_mm : float
        After a correction below this the factorised tangent is kept, as long as the corrections shrink
        fast, and also where the residual, shrinking fast, has come near its tolerance; 0 forms a new one
        in each iteration.
    """

    residual_tolerance: float = 1e-5
    correction_tolerance_mm: float = 1e-2
    largest_correction_mm: float = 60.0
    max_iterations: int = 9
    reuse_below_mm: float = 0.0


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
        Negative eigenvalues of the last tangent factorised, a correction or two before the end.
    tangent_at : Balance or None
        Where that tangent was formed.
    """

    state: State
    iterations: int
    residuals: tuple[float, ...]
    negative_pivots: int | None
    tangent_at: Balance | None = None


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
    state = start
    residuals: list[float] = []
    corrections = _Corrections(settings)
    tangent_at: Balance | None = None
    tangents = 0
    for iteration in range(settings.max_iterations + 1):
        balance = problem.balance(state, load)
        if balance is None:
            raise NotConvergedError("an element was turned inside out")
        residuals.append(balance.relative_residual)
        if not np.isfinite(residuals[-1]):
            raise NotConvergedError("the forces overflowed")
        if residuals[-1] < settings.residual_tolerance and corrections.are_done:
            return NewtonResult(state, tangents, tuple(residuals), solver.negative_pivots, tangent_at)
        if iteration == settings.max_iterations:
            break
        try:
            is_kept = not corrections.want_new_tangent or _is_nearly_done(residuals, settings)
            if tangent_at is None or not is_kept:
                solver.factorise(problem.tangent(state, load, balance))
                tangent_at, tangents = balance, tangents + 1
            correction = solver.solve(-problem.residual(state, balance, tangent_at))
        except SingularTangentError as error:
            raise NotConvergedError("the tangent is singular") from error
        corrections.add(float(np.abs(correction).max()), with_new_tangent=not is_kept)
        state = problem.update(state, balance, correction, tangent_at=tangent_at)
    raise NotConvergedError(f"no convergence in {settings.max_iterations} iteration(s)")


def _is_nearly_done(residuals: list[float], settings: NewtonSettings) -> bool:
    """Whether the last residual, come down fast, is so small that the kept tangent does for the rest."""
    if settings.reuse_below_mm == 0.0 or len(residuals) < 2:
        return False
    return residuals[-1] < min(_NEARLY_DONE * settings.residual_tolerance, _FAST_SHRINKAGE * residuals[-2])


class _Corrections:
    """How large the corrections were, and what follows from it."""

    def __init__(self, settings: NewtonSettings) -> None:
        self._settings = settings
        self._last_mm = np.inf
        self.want_new_tangent = True

    @property
    def are_done(self) -> bool:
        """Whether the last one was small enough."""
        return self._last_mm < self._settings.correction_tolerance_mm

    def add(self, size_mm: float, *, with_new_tangent: bool) -> None:
        """Note a correction.

        Raises
        ------
        NotConvergedError
            If it is beyond all bounds.
        """
        if not size_mm < self._settings.largest_correction_mm:
            raise NotConvergedError(f"a correction of {size_mm:.3g} mm")
        shrinks = with_new_tangent or size_mm < _FAST_SHRINKAGE * self._last_mm
        self.want_new_tangent = not (shrinks and size_mm < self._settings.reuse_below_mm)
        self._last_mm = size_mm
