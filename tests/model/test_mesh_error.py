"""Numerical uncertainty of the mesh levels: named for each level, and above what a finer mesh shows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from spavision.errors import InputError
from spavision.model.actuator_mesh import MESH_LEVELS, MeshLevel, mesh_at_level
from spavision.model.geometry import ActuatorGeometry
from spavision.model.mesh_error import LARGEST_RELATIVE_ERROR, numerical_uncertainty_mm
from spavision.model.simulate import SimulationSettings, simulate


def test_every_level_has_its_error() -> None:
    assert set(LARGEST_RELATIVE_ERROR) == set(MESH_LEVELS)
    sizes = [numerical_uncertainty_mm(name, np.array([30.0]), np.array([40.0]))[0] for name in MESH_LEVELS]
    assert sizes == sorted(sizes, reverse=True)
    assert sizes[0] == pytest.approx(50.0 * LARGEST_RELATIVE_ERROR["draft"] / 2.0)
    with pytest.raises(InputError, match="expected one of draft, default, fine"):
        numerical_uncertainty_mm("coarse", np.zeros(1), np.zeros(1))


def test_levels_differ_by_no_more_than_their_errors() -> None:
    """The actuator of the study: draft against default, within the sum of the two bounds."""
    short = ActuatorGeometry(void_count=4)
    tips = {}
    for name in ("draft", "default"):
        path = simulate(
            short,
            crimp_ratio=0.2,
            pressures_kPa=np.arange(0.0, 31.0, 10.0),
            settings=SimulationSettings(mesh_level=name),
        ).tip_path
        tips[name] = np.column_stack([path.ux_mm, path.uy_mm])[1:]
    difference = np.linalg.norm(tips["draft"] - tips["default"], axis=1)
    size = np.linalg.norm(tips["default"], axis=1)
    assert np.all(difference < (LARGEST_RELATIVE_ERROR["draft"] + LARGEST_RELATIVE_ERROR["default"]) * size)


def test_grading_narrows_the_elements_at_the_side_wall() -> None:
    geometry = ActuatorGeometry(void_count=1)
    level = MeshLevel(order=1, void_width=3)
    lines = {
        ratio: np.unique(mesh_at_level(geometry, replace(level, void_width_grading=ratio)).nodes_mm[:, 2])
        for ratio in (1.0, 0.5)
    }
    # across: half channel 1 mm, then 4 mm of void in three parts, then the side wall
    np.testing.assert_allclose(np.diff(lines[1.0])[1:4], 4.0 / 3.0)
    np.testing.assert_allclose(np.diff(lines[0.5])[1:4], np.array([4.0, 2.0, 1.0]) * 4.0 / 7.0)
