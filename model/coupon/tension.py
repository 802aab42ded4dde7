"""Newton's method for the cell at a given lengthening."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from spavision.model.linear_solver import LinearSolver, SingularTangentError

from .cell import Cell, CellBalance, CellState

_RESIDUAL = 1e-7
"""Forces out of balance over the pull, with the pull of a hundredth of a kilopascal at least."""

_CORRECTION = 1e-6
"""Of displacements in mm and rotations in rad."""

_LARGEST_CORRECTION = 2.0
_MOST_ITERATIONS = 25


class NotPulledError(ArithmeticError):
    """No equilibrium was found; the message says how it failed."""


@dataclass(frozen=True)
class Pulled:
    """An equilibrium of the cell.

    Parameters
    ----------
    state : CellState
    balance : CellBalance
    iterations : int
    """

    state: CellState
    balance: CellBalance
    iterations: int


def pull_to(cell: Cell, start: CellState, strain: float, *, solver: LinearSolver) -> Pulled:
    """Find the equilibrium at a strain, starting from one near by.

    Raises
    ------
    NotPulledError
        If Newton's method does not converge.
    """
    half_wave_mm = 0.5 * cell.geometry.wavelength_mm
    floor = 1e-5 * cell.geometry.thickness_mm
    lengthening = strain * half_wave_mm - start.unknowns[-1]
    state, last = start, np.inf
    for iteration in range(_MOST_ITERATIONS):
        balance = cell.balance(state)
        if balance is None:
            raise NotPulledError("an element was turned inside out")
        residual = np.abs(balance.mixed[:-1]).max(initial=0.0) / max(abs(balance.mixed[-1]), floor)
        if not np.isfinite(residual):
            raise NotPulledError("the forces overflowed")
        if iteration > 0 and residual < _RESIDUAL and last < _CORRECTION:
            return Pulled(state, balance, iteration)
        matrix, column = cell.tangent(state, balance)
        try:
            solver.factorise(matrix)
            change = solver.solve(-balance.forces[:-1] - lengthening * column)
        except SingularTangentError as error:
            raise NotPulledError("the tangent is singular") from error
        last = float(np.abs(change).max())
        if not last < _LARGEST_CORRECTION:
            raise NotPulledError(f"a correction of {last:.3g} mm")
        step = np.append(change, lengthening)
        state = CellState(state.unknowns + step, balance.pressure + cell.pressure_change(balance, step))
        lengthening = 0.0
    raise NotPulledError(f"no convergence in {_MOST_ITERATIONS} iterations")
