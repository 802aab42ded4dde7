"""What designers ask for, and the animated ramp."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from spavision.cli.design import path_warnings, stretch_warnings
from spavision.model.animation import write_ramp_gif
from spavision.model.geometry import ActuatorGeometry
from spavision.model.materials.material_files import Material
from spavision.model.materials.ogden import Ogden
from spavision.model.outputs import StretchUse, design_outputs, mode_change
from spavision.model.simulate import Simulation, SimulationSettings, simulate

SHORT = ActuatorGeometry(void_count=2)


@pytest.fixture(scope="module")
def ramp() -> Simulation:
    settings = SimulationSettings(mesh_level="draft", body_material="Mold Star 15")
    return simulate(SHORT, crimp_ratio=0.2, pressures_kPa=np.array([0.0, 10.0, 20.0]), settings=settings)


def test_instability_snaps_and_contact_are_told(ramp: Simulation) -> None:
    """Records as a ramp past a bifurcation at 10 kPa and a fold at 20 kPa would have them."""
    assert path_warnings(design_outputs(ramp)) == []
    steps = [
        replace(
            step,
            negative_pivots=int(step.pressure_kPa >= 10.0),
            released_mJ=0.5 * (step.pressure_kPa == 20.0),
        )
        for step in ramp.steps
    ]
    nodes = ramp.mesh.nodes_mm
    pushed = ramp.displacement_mm.copy()
    pushed[-1, :, 0] = 40.0 * (nodes[:, 0] < 1.0) * (nodes[:, 1] > 12.0)
    told = path_warnings(design_outputs(replace(ramp, steps=tuple(steps), displacement_mm=pushed)))
    assert any(text.startswith("from 10 kPa on the path is not stable") for text in told)
    assert any(text.startswith("at 20 kPa the path folds back") and "0.5 mJ" in text for text in told)
    assert any(text.startswith("from 20 kPa on the actuator passes through itself") for text in told)


def test_mode_change_of_a_parabola() -> None:
    """ux = 30 − (p − 42)²/50: top of 30 mm at 42 kPa, whichever pressures are read."""
    pressure = np.arange(0.0, 66.0, 5.0)
    top_kPa, top_mm, way_mm = mode_change(pressure, 30.0 - (pressure - 42.0) ** 2 / 50.0)
    assert top_kPa == pytest.approx(42.0)
    assert top_mm == pytest.approx(30.0)
    assert way_mm == pytest.approx(23.0**2 / 50.0)


def test_ripple_is_no_mode_change() -> None:
    pressure = np.arange(5.0)
    assert mode_change(pressure, np.array([0.0, 2.0, 1.8, 4.0, 6.0])) == (None, 6.0, None)


def test_outputs_of_a_ramp(ramp: Simulation) -> None:
    outputs = design_outputs(ramp)
    assert outputs.mode_change_kPa is None
    assert outputs.first_extremum_mm == pytest.approx(ramp.tip_path.ux_mm.max())
    assert outputs.volume_ratio > 1.0
    assert outputs.enclosed_volume_mm3 == ramp.enclosed_volume_mm3[-1]
    uses = {use.material: use for use in outputs.stretch}
    assert set(uses) == {"Ecoflex 00-30", "Mold Star 15 two-term", "Mold Star 15"}
    body = uses["Mold Star 15"]
    assert body.smallest_stretch < 1.0 < body.largest_stretch
    assert body.pressure_kPa == 20.0
    assert body.calibrated == pytest.approx((0.7, 3.0))  # fitted to strains of −0.3 to 2.0, says its file


@pytest.mark.parametrize(
    ("mu_MPa", "alpha", "is_stable"), [((0.02,), (2.0,), True), ((0.1, -0.02), (2.0, 8.0), False)]
)
def test_an_unstable_composite_is_told(
    ramp: Simulation, mu_MPa: tuple[float, ...], alpha: tuple[float, ...], is_stable: bool
) -> None:
    """Σ μα λ^α falls below zero from a stretch of 1.04 on: 0.2·λ² − 0.16·λ⁸."""
    composite = Material("one law", Ogden(mu_MPa, alpha), 1.07, "assumed")
    changed = replace(ramp, settings=replace(ramp.settings, composite=composite))
    outputs = design_outputs(changed)
    assert (outputs.unstable is None) == is_stable
    assert any("is unstable" in sentence for sentence in stretch_warnings(outputs)) != is_stable


@pytest.mark.parametrize(
    ("largest", "calibrated", "is_beyond"),
    [(2.9, (0.7, 3.0), False), (3.1, (0.7, 3.0), True), (9.0, None, False)],
)
def test_stretch_beyond_the_calibration(
    largest: float, calibrated: tuple[float, float] | None, is_beyond: bool
) -> None:
    assert StretchUse("silicone", largest, 0.5, 60.0, calibrated).is_beyond is is_beyond


def test_animation_has_a_frame_for_each_pressure(ramp: Simulation, tmp_path: Path) -> None:
    write_ramp_gif(ramp, tmp_path / "ramp.gif")
    with Image.open(tmp_path / "ramp.gif") as gif:
        assert gif.n_frames == 3
        first = np.asarray(gif.convert("RGB")).copy()
        gif.seek(2)
        assert np.any(np.asarray(gif.convert("RGB")) != first)
