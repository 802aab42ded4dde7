"""The barrier against volume lost at single points: its derivatives, and the ramps that it saves."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse import triu

from spavision.model.constitutive import deform
from spavision.model.elements import FloatArray
from spavision.model.equilibrium import Equilibrium, Load, State
from spavision.model.geometry import ActuatorGeometry
from spavision.model.materials.solid import SolidMaterial
from spavision.model.simulate import SimulationSettings, simulate
from spavision.model.volume_guard import GUARDED_BELOW, guard_energy

from .conftest import cube_mesh

WEIGHTLESS = Load(0.0, 0.0)


def dented(body: Equilibrium) -> State:
    """Push one corner of a cube into it: the volume near the corner falls far, on average it does not."""
    corner = np.flatnonzero(np.all(np.isclose(body.mesh.nodes_mm, 1.0), axis=1))
    displacement = np.zeros_like(body.mesh.nodes_mm)
    displacement[corner] = (-0.1, -0.09, -0.11)
    return State(displacement, body.unloaded().pressure)


def cube(solid: SolidMaterial) -> Equilibrium:
    mesh = cube_mesh(order=2)
    return Equilibrium(mesh, {"solid": solid}, is_fixed=np.zeros((len(mesh.nodes_mm), 3), dtype=bool))


def change(body: Equilibrium, state: State, move: FloatArray, what: str) -> FloatArray:
    """Central difference of the energy or the forces along a move."""
    ends = [State(state.displacement + sign * 1e-6 * move, state.pressure) for sign in (1.0, -1.0)]
    if what == "energy":
        high, low = (np.array(body.strain_energy(end)) for end in ends)
    else:
        high, low = (_forces(body, end) for end in ends)
    return (high - low) / 2e-6


def _forces(body: Equilibrium, state: State) -> FloatArray:
    balance = body.balance(state, WEIGHTLESS)
    assert balance is not None
    return balance.condensed


def test_forces_and_tangent_are_derivatives_of_the_energy(body_solid: SolidMaterial) -> None:
    body = cube(body_solid)
    state = dented(body)
    J = deform(state.displacement, body.mesh.elements, body.geometry).J
    assert 0.0 < J.min() < 0.8 * GUARDED_BELOW
    state = State(state.displacement, body.balance(state, WEIGHTLESS).projected_pressure)
    upper = body.tangent(state, WEIGHTLESS, body.balance(state, WEIGHTLESS))
    full = upper + triu(upper, k=1).T
    move = np.random.default_rng(1).standard_normal(state.displacement.shape)
    work = np.sum(_forces(body, state) * move)
    assert work == pytest.approx(change(body, state, move, "energy"), rel=1e-6)
    expected = change(body, state, move, "forces").ravel()
    assert np.linalg.norm(full @ move.ravel() - expected) < 1e-6 * np.linalg.norm(expected)


def test_guard_is_a_barrier_that_begins_smoothly() -> None:
    assert np.all(guard_energy(np.array([GUARDED_BELOW, 1.0, 3.0]), 0.14) == 0.0)
    energy = guard_energy(np.geomspace(GUARDED_BELOW, 1e-6, 50), 0.14)
    assert np.all(np.diff(energy) > 0.0)
    near = guard_energy(GUARDED_BELOW * np.exp([-1e-2, -2e-2]), 0.14)
    assert near[1] / near[0] == pytest.approx(8.0)


def test_thin_walled_actuator_balloons_without_folding_its_corners() -> None:
    """Two voids, 2 mm walls: the corners of the free end fold at 58 kPa unless guarded."""
    walls = {f"{wall}_mm": 2.0 for wall in ("wall_between_voids", "side_wall", "roof", "end_wall")}
    result = simulate(
        ActuatorGeometry(void_count=2, **walls),
        crimp_ratio=0.25,
        pressures_kPa=np.array([0.0, 40.0, 65.0]),
        settings=SimulationSettings(mesh_level="draft"),
    )
    assert result.stopped_at_kPa is None
    assert result.steps[-1].enclosed_volume_mm3 > 9.0 * result.geometry.gas_volume_mm3()
