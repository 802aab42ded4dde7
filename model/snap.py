"""Past a fold at constant pressure: down the energy to the next stable equilibrium, as a snapping body goes.

Where a corner folds in or a wall buckles, the branch of equilibria turns back in pressure *and* volume, and
neither control finds a next state near the last. The real actuator snaps. Here the potential energy

    Π(u) = W(u) − p V(u) − gravity's work

falls in implicit steps of the viscous flow C u' = −∂Π/∂u, with the stiffness at rest for the damping matrix C
(pseudo-transient continuation, Kelley and Keyes, SIAM J. Numer. Anal. 35 (1998) 508-523),
(K + σ C) Δu = −∂Π/∂u.
The damping σ is raised until the matrix is positive definite and the energy falls, and taken away towards
the end, where the steps become Newton's.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from .elements import FloatArray
from .equilibrium import Balance, Equilibrium, Load, State
from .linear_solver import LinearSolver, SingularTangentError
from .newton import NewtonResult, NewtonSettings, NotConvergedError, find_equilibrium

_FIRST_DAMPING, _LEAST_DAMPING = 0.1, 1e-4
_DAMPING_FACTOR = 4.0
_TRIALS = 12
_ROUNDING = 1e-9
"""Rise of the energy, relative to itself, that is taken for none."""

_LARGEST_GROWTH = 1.5
"""Of the enclosed volume: a body that grows further passes a limit point of the gas pressure, not a fold."""

_NEARLY_THERE_MM = 1e-4
"""After an undamped step below this, Newton's method takes over."""


class NoStableStateError(NotConvergedError):
    """No stable equilibrium was found.

    Parameters
    ----------
    reason : str
    node : int
        That moved farthest.
    balloons : bool
        Whether the enclosed volume grew without end: a limit point of the gas pressure.
    """

    def __init__(self, reason: str, *, node: int, balloons: bool) -> None:
        super().__init__(reason)
        self.node = node
        self.balloons = balloons


@dataclass(frozen=True)
class Snap:
    """The stable equilibrium found.

    Parameters
    ----------
    result : NewtonResult
    released_mJ : float
        Potential energy lost on the way to it.
    """

    result: NewtonResult
    released_mJ: float


def snap(
    problem: Equilibrium,
    start: State,
    load: Load,
    *,
    solver: LinearSolver,
    newton: NewtonSettings,
    max_steps: int,
) -> Snap:
    """Descend to a stable equilibrium.

    Parameters
    ----------
    problem : Equilibrium
    start : State
        An equilibrium at a slightly lower load.
    load : Load
    solver : LinearSolver
    newton : NewtonSettings
        For the last steps.
    max_steps : int

    Raises
    ------
    NoStableStateError
        If the body is not at rest after the steps allowed, its energy cannot be lowered, or it balloons.
    """
    descent = _Descent(problem, start, load, solver)
    first_mJ, largest_mm3 = descent.energy_mJ, _LARGEST_GROWTH * problem.enclosed_volume_mm3(start)
    balloons = False
    try:
        for _ in range(max_steps):
            size_mm = descent.step()
            if descent.damping == 0.0 and size_mm < _NEARLY_THERE_MM:
                result = find_equilibrium(problem, descent.state, load, solver=solver, settings=newton)
                return Snap(result, first_mJ - potential_energy_mJ(problem, result.state, load))
            balloons = problem.enclosed_volume_mm3(descent.state) > largest_mm3
            if balloons:
                raise NotConvergedError("the gas volume grew by half and went on")
        raise NotConvergedError(f"the body was still moving after {max_steps} damped steps")
    except NotConvergedError as error:
        moved = np.linalg.norm(descent.state.displacement - start.displacement, axis=1)
        raise NoStableStateError(str(error), node=int(moved.argmax()), balloons=balloons) from error


def potential_energy_mJ(problem: Equilibrium, state: State, load: Load) -> float:
    """Return strain energy less the work of gas and weight, in N mm."""
    gas = load.gas_pressure_MPa * problem.enclosed_volume_mm3(state)
    return problem.strain_energy(state) - gas - load.gravity * problem.gravity_work(state)


@dataclass(frozen=True)
class _Point:
    """A state on the way down."""

    state: State
    balance: Balance
    energy_mJ: float


class _Descent:
    """Where the body is on its way, and the damping with which it moves on."""

    def __init__(self, problem: Equilibrium, start: State, load: Load, solver: LinearSolver) -> None:
        self._problem, self._load, self._solver = problem, load, solver
        at_rest, no_load = problem.unloaded(), Load(0.0, 0.0)
        self._resistance = problem.tangent(at_rest, no_load, _balance(problem, at_rest, no_load))
        self._at = self._point(start.displacement)
        self.damping = _FIRST_DAMPING

    @property
    def state(self) -> State:
        """The state reached."""
        return self._at.state

    @property
    def energy_mJ(self) -> float:
        """Its potential energy."""
        return self._at.energy_mJ

    def step(self) -> float:
        """Move on; return the largest displacement component of the step, in mm."""
        tangent = self._problem.tangent(self._at.state, self._load, self._at.balance)
        for trial in range(_TRIALS):
            correction = self._correction(tangent)
            further = None if correction is None else self._further(correction)
            if correction is not None and further is not None:
                self._at = further
                if trial == 0:
                    self.damping /= _DAMPING_FACTOR
                    self.damping *= self.damping >= _LEAST_DAMPING
                return float(np.abs(correction).max())
            self.damping = max(_DAMPING_FACTOR * self.damping, _LEAST_DAMPING)
        raise NotConvergedError("the energy could not be lowered")

    def _correction(self, tangent: csr_array) -> FloatArray | None:
        """Solve for a step; None where the damped tangent is not positive definite."""
        try:
            self._solver.factorise(tangent + self.damping * self._resistance if self.damping else tangent)
        except SingularTangentError:
            return None
        if self._solver.negative_pivots:
            return None
        forces = self._at.balance.condensed[self._problem.is_free]
        correction = self._solver.solve(-forces)
        return correction if correction @ forces < 0.0 else None

    def _further(self, correction: FloatArray) -> _Point | None:
        """Return the point after a correction; None if an element turns inside out or the energy rises."""
        moved = self._at.state.displacement.copy()
        moved[self._problem.is_free] += correction
        try:
            point = self._point(moved)
        except NotConvergedError:
            return None
        rises = point.energy_mJ > self._at.energy_mJ + _ROUNDING * abs(self._at.energy_mJ)
        return None if rises else point

    def _point(self, displacement: FloatArray) -> _Point:
        balance = _balance(self._problem, State(displacement, self._problem.unloaded().pressure), self._load)
        state = State(displacement, balance.projected_pressure)
        return _Point(state, balance, potential_energy_mJ(self._problem, state, self._load))


def _balance(problem: Equilibrium, state: State, load: Load) -> Balance:
    balance = problem.balance(state, load)
    if balance is None:
        raise NotConvergedError("an element was turned inside out")
    return balance
