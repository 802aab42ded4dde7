"""Solving the verification problems to rounding."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from spavision.model.elements import FloatArray
from spavision.model.equilibrium import Equilibrium, Load, State
from spavision.model.linear_solver import LinearSolver, linear_solver
from spavision.model.newton import NewtonResult, NewtonSettings, find_equilibrium
from spavision.model.volume_control import VolumePoint, find_equilibrium_at_volume

TIGHT = NewtonSettings(
    residual_tolerance=1e-9, correction_tolerance_mm=1e-6, largest_correction_mm=1e3, max_iterations=20
)

LIGHTLY_LOADED = replace(TIGHT, residual_tolerance=1e-6)
"""For loads so small that rounding, of the bulk modulus times 1e-16, is not far below them."""


def loaded(
    body: Equilibrium,
    *,
    gas_pressures_MPa: Sequence[float] = (0.0,),
    weights: Sequence[float] = (0.0,),
    start: State | None = None,
    settings: NewtonSettings = TIGHT,
) -> State:
    """Return the equilibrium at the last of a sequence of gas pressures, or of weights, from the start."""
    state, solver = start or body.unloaded(), linear_solver()
    for pressure in gas_pressures_MPa:
        for weight in weights:
            load = Load(pressure, weight)
            state = find_equilibrium(body, state, load, solver=solver, settings=settings).state
    return state


def inflated(body: Equilibrium, volume_ratios: Sequence[float]) -> list[VolumePoint]:
    """Return the equilibria at a sequence of enclosed volumes, over the first volume, under no weight."""
    solver: LinearSolver = linear_solver()
    first = body.enclosed_volume_mm3(body.unloaded())
    points = [VolumePoint(first, 0.0, NewtonResult(body.unloaded(), 0, (), None))]
    for ratio in volume_ratios:
        point = find_equilibrium_at_volume(
            body, points[-1], ratio * first, gravity=0.0, solver=solver, settings=TIGHT
        )
        points.append(point)
    return points[1:]


def moved_to(body: Equilibrium, position: FloatArray) -> State:
    """Return the state that puts every node at a position: prescribed at the supports, a guess elsewhere."""
    return State(position - body.mesh.nodes_mm, body.unloaded().pressure)


def reactions(body: Equilibrium, state: State) -> FloatArray:
    """Return the nodal forces that hold a state under no load, shape (n_nodes, 3), in N.

    Raises
    ------
    ValueError
        If the state turns an element inside out.
    """
    balance = body.balance(state, Load(0.0, 0.0))
    if balance is None:
        raise ValueError("an element is turned inside out")
    return balance.condensed


def at(coordinate: FloatArray, value: float) -> np.ndarray:
    """Return which coordinates have a value."""
    return np.isclose(coordinate, value, atol=1e-9)
