"""The half model against the full actuator."""

from __future__ import annotations

import numpy as np
import pytest

from spavision.model.actuator_mesh import actuator_mesh
from spavision.model.actuator_problem import actuator_materials
from spavision.model.equilibrium import Equilibrium, Load, State
from spavision.model.geometry import ActuatorGeometry
from spavision.model.hex_mesh import HexMesh
from spavision.model.linear_solver import linear_solver
from spavision.model.newton import NewtonSettings, find_equilibrium
from spavision.model.simulation import SimulationSettings
from spavision.model.verification.merging import merged, mirrored

SHORT = ActuatorGeometry(void_count=2)
SETTINGS = SimulationSettings(mesh_level="draft")


def solved(mesh: HexMesh, *, is_half: bool) -> tuple[Equilibrium, State]:
    is_fixed = np.repeat(np.isclose(mesh.nodes_mm[:, 1:2], 0.0), 3, axis=1)
    if is_half:
        is_fixed[:, 2] |= np.isclose(mesh.nodes_mm[:, 2], 0.0)
    body = Equilibrium(mesh, actuator_materials(crimp_ratio=0.2, settings=SETTINGS), is_fixed=is_fixed)
    tight = NewtonSettings(residual_tolerance=1e-9, correction_tolerance_mm=1e-6, max_iterations=15)
    state, solver = body.unloaded(), linear_solver()
    for pressure_MPa in (0.0, 0.015):
        state = find_equilibrium(body, state, Load(pressure_MPa, 1.0), solver=solver, settings=tight).state
    return body, state


def test_half_model_is_half_of_the_full_one() -> None:
    """Two voids under weight and 15 kPa, with nothing but the clamp to hold the full body."""
    half_mesh = actuator_mesh(SHORT, level="draft")
    half, half_state = solved(half_mesh, is_half=True)
    full, full_state = solved(merged([half_mesh, mirrored(half_mesh, axis=2)]), is_half=False)
    order = np.lexsort(np.round(half.mesh.nodes_mm, 6).T)
    kept = np.flatnonzero(full.mesh.nodes_mm[:, 2] > -1e-6)
    kept = kept[np.lexsort(np.round(full.mesh.nodes_mm[kept], 6).T)]
    assert np.abs(half_state.displacement).max() > 1.0
    np.testing.assert_allclose(full_state.displacement[kept], half_state.displacement[order], atol=1e-6)
    half_volume, full_volume = (
        body.enclosed_volume_mm3(state) for body, state in ((half, half_state), (full, full_state))
    )
    assert full_volume == pytest.approx(2.0 * half_volume, rel=1e-8)
    half_energy, full_energy = half.strain_energy(half_state), full.strain_energy(full_state)
    assert full_energy == pytest.approx(2.0 * half_energy, rel=1e-8)
