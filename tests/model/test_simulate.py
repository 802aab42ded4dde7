"""The ramp of a short actuator from end to end, its records, files and pictures."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import meshio
import numpy as np
import pytest

from spavision.errors import InputError
from spavision.model.actuator_problem import actuator_materials
from spavision.model.continuation import SteppingSettings
from spavision.model.element_geometry import element_geometry
from spavision.model.export import write_vtu_series
from spavision.model.fields import element_fields
from spavision.model.figures import _side_faces, deformed_shapes
from spavision.model.geometry import ActuatorGeometry
from spavision.model.linear_solver import SuperLUSolver, linear_solver
from spavision.model.newton import NewtonSettings
from spavision.model.simulate import Simulation, SimulationSettings, simulate

SHORT = ActuatorGeometry(void_count=4)
DRAFT = SimulationSettings(mesh_level="draft")
PRESSURES_KPA = np.arange(0.0, 51.0, 10.0)


@pytest.fixture(scope="module")
def ramp() -> Simulation:
    return simulate(SHORT, crimp_ratio=0.2, pressures_kPa=PRESSURES_KPA, settings=DRAFT)


def test_first_mode_bends_towards_region_b(ramp: Simulation) -> None:
    path = ramp.tip_path
    np.testing.assert_array_equal(path.pressure_kPa, PRESSURES_KPA)
    assert path.status == ("ok",) * len(PRESSURES_KPA)
    assert path.ux_mm[0] == path.uy_mm[0] == 0.0
    assert np.all(np.diff(path.ux_mm[:4]) > 0.0)
    assert path.uy_mm[-1] > 0.0


def test_paper_stops_the_first_mode(ramp: Simulation) -> None:
    """A composite slack for longer (crimp ratio 0.4) bends further at the same pressure."""
    slack = simulate(SHORT, crimp_ratio=0.4, pressures_kPa=PRESSURES_KPA, settings=DRAFT)
    assert slack.tip_path.ux_mm[-1] > 1.2 * ramp.tip_path.ux_mm[-1]
    np.testing.assert_allclose(slack.tip_path.ux_mm[:2], ramp.tip_path.ux_mm[:2], rtol=1e-6)


def test_energy_balance(ramp: Simulation) -> None:
    """Row 24: work of gas and weight is stored; what is missing falls with the square of the step."""
    finer = replace(DRAFT, stepping=SteppingSettings(first_step_kPa=1.25, largest_step_kPa=2.5))
    fine = simulate(SHORT, crimp_ratio=0.2, pressures_kPa=PRESSURES_KPA, settings=finer)
    coarse_loss, fine_loss = (
        one.steps[-1].energy_imbalance_mJ / one.steps[-1].strain_energy_mJ for one in (ramp, fine)
    )
    assert abs(fine_loss) < 2e-3
    assert coarse_loss / fine_loss == pytest.approx(4.0, rel=0.25)


def test_every_step_is_in_equilibrium(ramp: Simulation) -> None:
    assert set(PRESSURES_KPA) <= {step.pressure_kPa for step in ramp.steps}
    assert max(step.residual for step in ramp.steps) < DRAFT.newton.residual_tolerance
    volumes = [step.enclosed_volume_mm3 for step in ramp.steps]
    assert np.all(np.diff(volumes) > 0.0)
    assert volumes[0] == pytest.approx(SHORT.gas_volume_mm3(), rel=0.01)


def test_fast_settings_lose_nothing(ramp: Simulation) -> None:
    """Two or three factorisations a step, and the tip of a fully converged ramp."""
    factorisations = [step.newton_iterations for step in ramp.steps]
    assert sum(factorisations) <= 3.0 * len(factorisations)
    tight = NewtonSettings(residual_tolerance=1e-9, correction_tolerance_mm=1e-7, max_iterations=20)
    converged = simulate(
        SHORT, crimp_ratio=0.2, pressures_kPa=PRESSURES_KPA, settings=replace(DRAFT, newton=tight)
    )
    np.testing.assert_allclose(ramp.tip_path.ux_mm, converged.tip_path.ux_mm, atol=1e-3)
    np.testing.assert_allclose(ramp.tip_path.uy_mm, converged.tip_path.uy_mm, atol=1e-3)


def test_hanging_weight_stretches_as_a_bar() -> None:
    """Small strain of a hanging bar: tip displacement w L²/(2 E A), with w the weight per length.

    All of it Ecoflex 00-30 without paper, the voids filled but for a slit, E = 3 G.
    """
    bar = ActuatorGeometry(
        void_count=15, side_wall_mm=7.0, roof_mm=16.5, channel_height_mm=0.5, channel_width_mm=0.5
    )
    names = dict.fromkeys(("body_material", "strip_a_material", "strip_b_material"), "Ecoflex 00-30")
    settings = replace(
        DRAFT, paper=replace(DRAFT.paper, width_modulus_MPa=0.0, length_modulus_MPa=0.0), **names
    )
    hanging = simulate(bar, crimp_ratio=0.2, pressures_kPa=np.array([0.0]), settings=settings)
    tip = np.isclose(hanging.mesh.nodes_mm[:, 1], bar.length_mm)
    stretch_mm = hanging.displacement_mm[0, tip, 1].mean()
    expected_mm = 1.07e-9 * 9810.0 * bar.length_mm**2 / (2.0 * 3.0 * 0.0373319)
    # The clamp, which holds the base's width over a length of its order, takes some 2 % of it.
    assert stretch_mm == pytest.approx(expected_mm, rel=0.03)


def test_stopped_ramp_keeps_what_it_reached() -> None:
    settings = replace(
        DRAFT,
        newton=NewtonSettings(max_iterations=1),
        stepping=SteppingSettings(smallest_step_kPa=1.0, largest_snap_steps=0),
        gravity=False,
    )
    seen: list[float] = []
    stopped = simulate(
        SHORT, crimp_ratio=0.3, pressures_kPa=np.array([0.0, 60.0]), settings=settings, progress=seen.append
    )
    assert stopped.stopped_at_kPa == seen[-1] < 60.0
    assert stopped.tip_path.status == ("ok", "missing")
    assert "no convergence in 1 iteration" in stopped.tip_path.reason[1]
    assert np.isnan(stopped.tip_path.ux_mm[1])


@pytest.mark.parametrize(
    ("pressures", "message"),
    [
        ([], "at least one"),
        ([0.0, 10.0, 10.0], "increasing"),
        ([10.0, 5.0], "10 kPa is followed by 5 kPa"),
        ([-5.0, 0.0], "expected 0 to 500 kPa"),
        ([0.0, 65000.0], "expected 0 to 500 kPa"),
        ([0.0, float("nan")], "expected 0 to 500 kPa"),
    ],
)
def test_bad_pressures(pressures: list[float], message: str) -> None:
    with pytest.raises(InputError, match=message):
        simulate(SHORT, crimp_ratio=0.2, pressures_kPa=np.array(pressures), settings=DRAFT)


def test_portable_solver_agrees(ramp: Simulation, monkeypatch: pytest.MonkeyPatch) -> None:
    if linear_solver().name == SuperLUSolver.name:
        pytest.skip("the fast solver is not installed, so there is nothing to compare")
    monkeypatch.setattr("spavision.model.simulate.linear_solver", SuperLUSolver)
    portable = simulate(SHORT, crimp_ratio=0.2, pressures_kPa=PRESSURES_KPA[:3], settings=DRAFT)
    assert portable.solver_name == "superlu"
    np.testing.assert_allclose(portable.tip_path.ux_mm, ramp.tip_path.ux_mm[:3], atol=1e-3)


def test_vtu_series(ramp: Simulation, tmp_path: Path) -> None:
    *files, index = write_vtu_series(ramp, tmp_path / "fields")
    assert [path.name for path in files] == [f"ramp_{row:03d}.vtu" for row in range(len(PRESSURES_KPA))]
    assert index.read_text().count("<DataSet") == len(PRESSURES_KPA)
    last = meshio.read(files[-1])
    np.testing.assert_allclose(last.point_data["displacement_mm"], ramp.displacement_mm[-1])
    assert {"region", "largest_stretch", "pressure_MPa", "von_mises_MPa"} <= set(last.cell_data)
    assert last.cell_data["cauchy_stress_MPa"][0].shape == (len(ramp.mesh.elements), 6)
    # VTK's corners 0, 1, 3, 4 span each box, whose volume must come out positive and right.
    corners = last.points[last.cells_dict["hexahedron27"]]
    volume = np.linalg.det(corners[:, [1, 3, 4]] - corners[:, :1])
    np.testing.assert_allclose(volume, element_geometry(ramp.mesh).volumes.sum(axis=1), rtol=1e-9)
    # and its last node is the one inside
    inside = (corners > corners.min(axis=1, keepdims=True)) & (corners < corners.max(axis=1, keepdims=True))
    assert np.all(inside.all(axis=2) == (np.arange(27) == 26))


def test_stress_bears_the_hanging_weight(ramp: Simulation) -> None:
    """Virial theorem: the integral of σ_yy over the body is that of weight times depth below the clamp."""
    stress = element_fields(ramp, 0).cauchy_MPa
    volumes = element_geometry(ramp.mesh).volumes.sum(axis=1)
    materials = actuator_materials(crimp_ratio=ramp.crimp_ratio, settings=ramp.settings)
    densities = np.array([materials[name].density_tonne_per_mm3 for name in ramp.mesh.region_names])
    depth_mm = (ramp.mesh.nodes_mm + ramp.displacement_mm[0])[ramp.mesh.elements][:, :, 1].mean(axis=1)
    weight_N = 9.81e3 * densities[ramp.mesh.region] * volumes
    assert float(volumes @ stress[:, 1]) == pytest.approx(float(weight_N @ depth_mm), rel=0.01)


def test_deformed_shapes(ramp: Simulation) -> None:
    figure = deformed_shapes(ramp, panels=3)
    titles = [axis.get_title() for axis in figure.axes if axis.get_title()]
    assert titles == ["0 kPa", "20 kPa", "50 kPa"]
    figure.canvas.draw()


def test_the_side_face_is_drawn_without_holes(ramp: Simulation) -> None:
    """The polygons at rest cover the side face: its height, base and strips times its length."""
    elements, rims = _side_faces(ramp)
    x, y = np.moveaxis(ramp.mesh.nodes_mm[rims][..., :2], 2, 0)
    areas_mm2 = 0.5 * np.abs(np.sum(x * np.roll(y, -1, axis=1) - y * np.roll(x, -1, axis=1), axis=1))
    extent_mm = np.ptp(ramp.mesh.nodes_mm, axis=0)
    assert areas_mm2.sum() == pytest.approx(extent_mm[0] * extent_mm[1], rel=1e-9)
    assert len(set(elements)) == len(elements)
