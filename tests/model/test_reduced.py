"""The reduced model: its cell, its rod, and the full model."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from spavision.errors import InputError
from spavision.model.geometry import ActuatorGeometry
from spavision.model.newton import NewtonSettings
from spavision.model.outputs import mode_change
from spavision.model.reduced.cell import Cell, CellResponse, SectionLoad
from spavision.model.reduced.one_thread import one_thread
from spavision.model.reduced.ramp import LARGEST_VOLUME_RATIO, simulate_reduced
from spavision.model.reduced.rod import hang
from spavision.model.simulate import SimulationSettings, simulate

DRAFT = SimulationSettings(mesh_level="draft")
TIGHT = NewtonSettings(correction_tolerance_mm=1e-7, max_iterations=15)
WEIGHT_ON_EARTH = 9810.0


def stiff_cell(angle: float) -> CellResponse:
    return CellResponse(SectionLoad(0.0, 0.0, 0.0), angle, 10.0, np.zeros((2, 2)), 1.0)


def test_row_of_bent_cells_closes_the_circle() -> None:
    """Row 18: a turn of 2π brings the tip back to the root."""
    shape = hang(stiff_cell(2.0 * np.pi / 12), n_cells=12, mass_tonne=0.0, start=None)
    np.testing.assert_allclose(shape.points_mm[-1], 0.0, atol=1e-9)
    assert np.ptp(shape.points_mm[:, 0]) > 30.0


def test_rod_bears_what_hangs_below() -> None:
    """Straight: tension in the middle of cell i of n is (n − i − ½) weights; bent: moments by hand."""
    mass = 0.2 / WEIGHT_ON_EARTH
    straight = hang(stiff_cell(0.0), n_cells=4, mass_tonne=mass, start=None)
    np.testing.assert_allclose(straight.tensions_N, 0.2 * np.array([3.5, 2.5, 1.5, 0.5]))
    np.testing.assert_allclose(straight.moments_Nmm, 0.0, atol=1e-12)
    bent = hang(stiff_cell(0.4), n_cells=2, mass_tonne=mass, start=None)
    middle = 0.5 * (bent.points_mm[:-1] + bent.points_mm[1:])
    assert bent.moments_Nmm == pytest.approx([-0.2 * (middle[1, 0] - middle[0, 0]), 0.0], abs=1e-9)


def test_compliance_of_the_cell_against_differences() -> None:
    with one_thread():
        cell = Cell(ActuatorGeometry(), crimp_ratio=0.2, settings=DRAFT)
        for pressure in (0.005, 0.01, 0.015, 0.02):
            middle = cell.respond(SectionLoad(pressure, 0.0, 0.0), TIGHT)
        bent = cell.respond(SectionLoad(0.02, 0.1, 0.0), TIGHT)
        pulled = cell.respond(SectionLoad(0.02, 0.0, 0.01), TIGHT)
    for other, column, size in ((bent, 0, 0.1), (pulled, 1, 0.01)):
        change = np.array([other.angle - middle.angle, other.chord_mm - middle.chord_mm]) / size
        np.testing.assert_allclose(change, middle.compliance[:, column], rtol=2e-3)
    np.testing.assert_allclose(middle.compliance, middle.compliance.T, rtol=1e-6)


def test_range_is_told() -> None:
    ramp = simulate_reduced(
        ActuatorGeometry(), crimp_ratio=0.2, pressures_kPa=np.arange(0.0, 66.0, 5.0), settings=DRAFT
    )
    beyond = ramp.volume_ratio > LARGEST_VOLUME_RATIO
    assert beyond.any()
    assert [reason.startswith("beyond the reduced model's range") for reason in ramp.tip_path.reason] == list(
        beyond
    )


@pytest.mark.slow
@pytest.mark.parametrize("crimp_ratio", [0.2, 0.3])
def test_first_extremum_is_the_full_model_s(crimp_ratio: float) -> None:
    """Within 4 %, the goal of the reduced model; the full model on the same mesh level is the reference."""
    pressures = np.arange(0.0, 66.0, 5.0)
    given = {"crimp_ratio": crimp_ratio, "pressures_kPa": pressures, "settings": DRAFT}
    reduced = simulate_reduced(ActuatorGeometry(), **given).tip_path  # type: ignore[arg-type]
    full = simulate(ActuatorGeometry(), **given).tip_path  # type: ignore[arg-type]
    (kPa, mm, _), (full_kPa, full_mm, _) = (mode_change(pressures, path.ux_mm) for path in (reduced, full))
    assert mm == pytest.approx(full_mm, rel=0.04)
    assert kPa == pytest.approx(full_kPa, rel=0.04)


def test_leaning_row_is_bent_by_its_weight() -> None:
    """Straight row, the vertical 30° aside: ½ of each weight below bends, cos 30° of it pulls; by hand."""
    mass = 0.2 / WEIGHT_ON_EARTH
    row = hang(stiff_cell(0.0), n_cells=2, mass_tonne=mass, start=None, tilt=np.pi / 6.0)
    assert row.moments_Nmm == pytest.approx([0.5 * 0.2 * 10.0, 0.0])
    assert row.tensions_N == pytest.approx(np.cos(np.pi / 6.0) * 0.2 * np.array([1.5, 0.5]))


def test_weightless_actuator_of_twice_the_stiffness_needs_twice_the_pressure() -> None:
    """Dimensional analysis: nothing else has the unit of a pressure, so a tip path tells only the ratio."""
    soft = SimulationSettings(mesh_level="draft", gravity=False)
    paper = replace(
        soft.paper,
        length_modulus_MPa=2.0 * soft.paper.length_modulus_MPa,
        width_modulus_MPa=2.0 * soft.paper.width_modulus_MPa,
    )
    stiff = replace(soft, body_stiffness=2.0, strip_b_stiffness=2.0, matrix_stiffness=2.0, paper=paper)
    pressures = np.array([0.0, 10.0, 20.0])
    paths = [
        simulate_reduced(
            ActuatorGeometry(), crimp_ratio=0.2, pressures_kPa=factor * pressures, settings=settings
        ).tip_path
        for factor, settings in ((1.0, soft), (2.0, stiff))
    ]
    np.testing.assert_allclose(paths[1].ux_mm, paths[0].ux_mm, atol=1e-4)
    np.testing.assert_allclose(paths[1].uy_mm, paths[0].uy_mm, atol=1e-4)
    assert paths[0].ux_mm[-1] > 5.0


def test_a_clamp_of_some_length_is_refused() -> None:
    with pytest.raises(InputError, match=r"clamp_length_mm is 10.*full model"):
        simulate_reduced(
            ActuatorGeometry(clamp_length_mm=10.0), crimp_ratio=0.2, pressures_kPa=np.array([0.0, 5.0])
        )
