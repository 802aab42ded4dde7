"""Why a ramp stops: the cause found, the place named; folds that it snaps over."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from spavision.model.actuator_mesh import actuator_mesh
from spavision.model.actuator_problem import actuator_problem, region_materials
from spavision.model.continuation import RampStoppedError, SteppingSettings, StopPlace
from spavision.model.geometry import ActuatorGeometry
from spavision.model.newton import NewtonSettings
from spavision.model.places import place_name
from spavision.model.self_contact import self_contact
from spavision.model.simulate import SimulationSettings, simulate
from spavision.model.stop_reason import stop_reason

GEOMETRY = ActuatorGeometry(void_count=3)
DRAFT = SimulationSettings(mesh_level="draft")
SOFTENING = """
name = "softening"
density_g_per_cm3 = 1.1
source = "made up"
[law]
kind = "ogden"
convention = "mu/alpha"
mu_MPa = [0.16, -0.004]
alpha = [2.0, 5.0]
"""


@pytest.mark.parametrize(
    ("position", "name"),
    [
        ((1.0, 31.0, 0.0), "composite at the free end"),
        ((5.5, 5.0, 0.0), "strip A by void 1"),
        ((7.0, 10.5, 0.0), "wall between voids 1 and 2"),
        ((7.0, 15.0, 7.0), "side wall of void 2"),
        ((22.0, 15.0, 0.0), "roof over void 2"),
        ((15.0, 31.0, 0.0), "free end wall"),
        ((15.0, 1.0, 0.0), "end wall at the clamp"),
        ((25.0, 28.0, 0.0), "strip B by void 3"),
    ],
)
def test_places(position: tuple[float, float, float], name: str) -> None:
    """The article's: composite 5, strip A 1, voids 15 deep, roof 2.5, pitch 10.5, walls 2.5 mm."""
    assert place_name(GEOMETRY, np.array(position)).startswith(name + " at (")


def test_place_of_a_floor() -> None:
    closed = replace(GEOMETRY, void_floor_mm=2.0)
    assert place_name(closed, np.array([7.0, 15.0, 0.0])).startswith("floor of void 2 at (")


def test_a_law_unstable_in_range_is_the_cause(tmp_path: Path) -> None:
    """0.32 λ² − 0.02 λ⁵ + (0.32/λ − 0.02 λ^(−5/2))/2 vanishes at λ = 2.538: uniaxial tension."""
    path = tmp_path / "softening.toml"
    path.write_text(SOFTENING, encoding="utf-8")
    result = simulate(
        replace(GEOMETRY, void_count=2),
        crimp_ratio=0.3,
        pressures_kPa=np.array([0.0, 40.0, 65.0]),
        settings=replace(DRAFT, body_material=str(path)),
    )
    assert result.stopped_at_kPa is not None
    assert 45.0 < result.stopped_at_kPa < 65.0
    assert "softening (body) is unstable" in result.stop_reason
    assert "stable up to 2.54" in result.stop_reason
    assert "softening" in result.tip_path.reason[-1]


@pytest.mark.parametrize(
    ("place", "expected"),
    [
        ({"limit_kPa": 40.3}, "maximum of the gas pressure, is foreseen at 40.30 kPa"),
        ({"balloons": True}, "maximum of the gas pressure, is foreseen at 40.00 kPa"),
        ({"node": 0}, "composite at the clamp at (0.0, 0.0, 0.0) mm gives way"),
        ({}, "the solver's words"),
    ],
)
def test_other_causes(place: dict[str, object], expected: str) -> None:
    problem = actuator_problem(GEOMETRY, crimp_ratio=0.3, settings=DRAFT)
    stop = RampStoppedError(40.0, "the solver's words", StopPlace(problem.unloaded(), **place))  # type: ignore[arg-type]
    reason = stop_reason(problem, stop, geometry=GEOMETRY, materials=region_materials(DRAFT))
    assert expected in reason
    assert "nearly inside out" not in reason
    assert "passed through itself" not in reason


@pytest.mark.parametrize(("turn_deg", "touches"), [(180.0, False), (500.0, True)])
def test_an_actuator_curled_through_itself(turn_deg: float, touches: bool) -> None:
    """Bent to an arc about a centre 5 mm outside region B; past 360° base and tip overlap."""
    mesh = actuator_mesh(ActuatorGeometry(), level="draft")
    x, y, z = mesh.nodes_mm.T
    angle = np.deg2rad(turn_deg) * y / y.max()
    radius = x.max() + 5.0 - x
    bent = np.column_stack([x.max() + 5.0 - radius * np.cos(angle), radius * np.sin(angle), z])
    found = self_contact(mesh, bent - mesh.nodes_mm)
    assert (found is not None) == touches
    if found is not None:
        # Base and tip at first lie on one another: the places are a full turn apart.
        apart = abs(found.first_mm[1] - found.second_mm[1]) / y.max() * turn_deg
        assert apart == pytest.approx(360.0, abs=15.0)


def test_snapping_finds_the_equilibrium_that_stepping_finds() -> None:
    """Newton's method allowed one iteration fails at every step; the descent of the energy does not."""
    pressures = np.array([0.0, 30.0])
    geometry = replace(GEOMETRY, void_count=2)
    crippled = replace(
        DRAFT,
        newton=NewtonSettings(max_iterations=1),
        stepping=SteppingSettings(smallest_step_kPa=20.0, snap_step_kPa=10.0),
        gravity=False,
    )
    whole = replace(DRAFT, gravity=False)
    snapped, stepped = (
        simulate(geometry, crimp_ratio=0.3, pressures_kPa=pressures, settings=settings)
        for settings in (crippled, whole)
    )
    assert snapped.tip_path.ux_mm[1] == pytest.approx(stepped.tip_path.ux_mm[1], abs=1e-3)
    # A path without folds gives off what sudden loading does, less than half the work.
    last = snapped.steps[-1]
    assert 0.0 < last.released_mJ < 0.5 * last.gas_work_mJ
    assert abs(stepped.steps[-1].released_mJ) == 0.0
