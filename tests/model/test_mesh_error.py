"""Numerical uncertainty of the mesh levels: named for each level, and above what a finer mesh shows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from spavision.errors import InputError
from spavision.model.actuator_mesh import MESH_LEVELS, MeshLevel, mesh_at_level
from spavision.model.geometry import ActuatorGeometry
from spavision.model.mesh_error import ERROR_BOUNDS, numerical_uncertainty_mm
from spavision.model.simulate import SimulationSettings, simulate


def test_every_level_has_its_error() -> None:
    assert set(ERROR_BOUNDS) == set(MESH_LEVELS)
    sizes = [
        numerical_uncertainty_mm(name, np.array([3.0, np.nan, 30.0]), np.array([4.0, np.nan, 40.0]))
        for name in MESH_LEVELS
    ]
    assert sizes[0][2] > sizes[1][2] > sizes[2][2]
    # displacements of 5 and 50 mm, bounds of two standard uncertainties
    bound = ERROR_BOUNDS["default"]
    expected = np.array([5.0, np.nan, 50.0]) * bound.of_displacement / 2.0 + 50.0 * bound.of_largest / 2.0
    np.testing.assert_allclose(sizes[1], expected)
    with pytest.raises(InputError, match="expected one of draft, default, fine"):
        numerical_uncertainty_mm("coarse", np.zeros(1), np.zeros(1))


@pytest.mark.parametrize("name", ["draft", "default"])
def test_levels_are_within_their_errors(name: str) -> None:
    """The actuator of the study at crimp ratio 0.2, against the path that a finer mesh converged to."""
    path = simulate(
        ActuatorGeometry(void_count=4),
        crimp_ratio=0.2,
        pressures_kPa=np.array([0.0, 20.0, 40.0]),
        settings=SimulationSettings(mesh_level=name),
    ).tip_path
    # `benchmarks/actuator/references.py`: 98 697 unknowns
    converged = np.array([[0.88138, 1.28375], [2.00054, 3.20683]])
    found = np.column_stack([path.ux_mm, path.uy_mm])[1:]
    bound = 2.0 * numerical_uncertainty_mm(name, path.ux_mm, path.uy_mm)[1:]
    assert np.all(np.linalg.norm(found - converged, axis=1) < bound)


def test_elements_are_drawn_to_the_side_wall_and_refined_within_themselves() -> None:
    geometry = ActuatorGeometry(void_count=1)
    level = MeshLevel(order=1, void_width=2, void_width_middle=0.7)
    once, twice = (
        np.unique(mesh_at_level(geometry, replace(level, void_width=parts)).nodes_mm[:, 2].round(9))
        for parts in (2, 4)
    )
    # across: half channel 1 mm, then 4 mm of void whose middle lies at 0.7 of them, then the side wall
    np.testing.assert_allclose(once, [0.0, 1.0, 1.0 + 0.7 * 4.0, 5.0, 7.5])
    # the parabola through 0, 0.7 and 1 at a quarter and three quarters
    np.testing.assert_allclose(twice, [0.0, 1.0, 1.0 + 0.4 * 4.0, 3.8, 1.0 + 0.9 * 4.0, 5.0, 7.5])
