"""Volume control: past the limit point of a balloon, and along the stable path of the actuator."""

from __future__ import annotations

import numpy as np
import pytest

from spavision.errors import InputError
from spavision.model.continuation import RampStoppedError, SteppingSettings, pressure_ramp, ramp_at_rest
from spavision.model.elements import FloatArray
from spavision.model.equilibrium import Equilibrium, Load
from spavision.model.geometry import ActuatorGeometry
from spavision.model.linear_solver import linear_solver
from spavision.model.newton import NewtonResult, find_equilibrium
from spavision.model.simulate import SimulationSettings, simulate
from spavision.model.verification.bodies import NEO_HOOKE, solid, sphere
from spavision.model.verification.solving import TIGHT
from spavision.model.volume_control import VolumePoint, VolumeStepping, volume_path, volume_ramp

THICKNESS = 0.01
LIMIT_PRESSURE = 1.239462902
"""Row 12: p R/(μ t) of a thin neo-Hookean balloon at its limit point."""
LIMIT_STRETCH = 7.0 ** (1.0 / 6.0)
TO_ROW_12 = (1.0 + 0.5 * THICKNESS) / THICKNESS
"""From p in MPa to p R/(μ t), R being the mean radius and μ 1 MPa."""


@pytest.fixture(scope="module")
def balloon() -> Equilibrium:
    material = solid(NEO_HOOKE, bulk_modulus_MPa=1e4)
    return sphere(material, order=2, across=1, around=2, outer_radius=1.0 + THICKNESS)


def at_rest(body: Equilibrium) -> NewtonResult:
    return find_equilibrium(body, body.unloaded(), Load(0.0, 0.0), solver=linear_solver(), settings=TIGHT)


def inflated_path(body: Equilibrium) -> list[VolumePoint]:
    return list(
        volume_path(
            body,
            at_rest(body),
            gravity=0.0,
            solver=linear_solver(),
            newton=TIGHT,
            stepping=VolumeStepping(largest_step=0.3, largest_ratio=6.0),
        )
    )


def test_volume_control_passes_the_limit_point(balloon: Equilibrium) -> None:
    """Row 12, pressure and stretch at the limit point; the thickness of 1 % shifts them by about as much."""
    points = inflated_path(balloon)
    first = balloon.enclosed_volume_mm3(balloon.unloaded())
    pressure = np.array([point.gas_pressure_MPa for point in points]) * TO_ROW_12
    stretch = np.cbrt(np.array([point.volume_mm3 for point in points]) / first)
    top = int(pressure.argmax())
    assert 0 < top < len(points) - 1
    assert pressure[top] == pytest.approx(LIMIT_PRESSURE, rel=2e-3)
    assert stretch[top] == pytest.approx(LIMIT_STRETCH, rel=0.06)
    # beyond it too, on the falling branch: 2 (λ⁻¹ − λ⁻⁷)
    np.testing.assert_allclose(pressure, 2.0 * (stretch**-1.0 - stretch**-7.0), rtol=0.03)
    assert pressure[-1] < 0.95 * pressure[top]


def run(body: Equilibrium, targets: FloatArray, *, by_volume: bool) -> None:
    common = {"targets_kPa": targets, "solver": linear_solver(), "newton": TIGHT}
    if by_volume:
        stepping = VolumeStepping(largest_step=0.3, largest_ratio=6.0)
        list(volume_ramp(body, at_rest(body), gravity=0.0, stepping=stepping, **common))  # type: ignore[arg-type]
    else:
        steps = SteppingSettings(smallest_step_kPa=0.05)
        rest = NewtonResult(body.unloaded(), 0, (), None)
        start = ramp_at_rest(body, rest, solver=linear_solver(), stepping=steps)
        list(pressure_ramp(body, start, gravity=False, stepping=steps, **common))  # type: ignore[arg-type]


@pytest.mark.parametrize("by_volume", [False, True])
def test_both_controls_tell_the_limit_pressure(balloon: Equilibrium, by_volume: bool) -> None:
    """Row 12: load control must stop there; volume control goes on, and says that the pressure fell."""
    beyond_kPa = 1.2e3 * LIMIT_PRESSURE / TO_ROW_12
    with pytest.raises(RampStoppedError) as stop:
        run(balloon, np.array([0.5 * beyond_kPa, beyond_kPa]), by_volume=by_volume)
    assert stop.value.pressure_kPa * 1e-3 * TO_ROW_12 == pytest.approx(LIMIT_PRESSURE, rel=0.02)
    place = stop.value.place
    if by_volume:
        assert "did not rise further" in stop.value.reason
    else:
        assert place is not None
        assert place.limit_kPa * 1e-3 * TO_ROW_12 == pytest.approx(LIMIT_PRESSURE, rel=0.02)


def test_asked_pressures_are_met_exactly(balloon: Equilibrium) -> None:
    targets = np.array([3.0, 7.0]) / TO_ROW_12 * 100.0
    steps = list(
        volume_ramp(
            balloon,
            at_rest(balloon),
            targets_kPa=targets,
            gravity=0.0,
            solver=linear_solver(),
            newton=TIGHT,
            stepping=VolumeStepping(),
        )
    )
    assert set(targets) <= {step.pressure_kPa for step in steps}
    last = steps[-1]
    residual = balloon.balance(last.result.state, Load(targets[-1] * 1e-3, 0.0))
    assert residual is not None
    assert residual.relative_residual < 1e-8


def test_actuator_under_either_control() -> None:
    """Where the path is stable, both controls find the same equilibria."""
    paths = [
        simulate(
            ActuatorGeometry(void_count=2),
            crimp_ratio=0.2,
            pressures_kPa=np.array([0.0, 15.0, 40.0]),
            settings=SimulationSettings(mesh_level="draft", control=control),
        ).tip_path
        for control in ("pressure", "volume")
    ]
    assert paths[1].status == ("ok",) * 3
    np.testing.assert_allclose(paths[0].ux_mm, paths[1].ux_mm, atol=1e-3)


def test_unknown_control() -> None:
    with pytest.raises(InputError, match=r"'force'.*pressure, volume"):
        simulate(
            ActuatorGeometry(void_count=2),
            crimp_ratio=0.2,
            pressures_kPa=np.array([0.0]),
            settings=SimulationSettings(control="force"),
        )
