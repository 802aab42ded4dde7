"""An interrupted ramp goes on from its file as if it had not been interrupted."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from spavision.model.checkpoint_file import read_checkpoint, write_checkpoint
from spavision.model.geometry import ActuatorGeometry
from spavision.model.journal import Checkpoint
from spavision.model.simulate import Simulation, SimulationSettings, simulate

PRESSURES_KPA = np.array([0.0, 5.0, 10.0, 15.0])


def ramp(**how: object) -> Simulation:
    return simulate(
        ActuatorGeometry(void_count=1),
        crimp_ratio=0.2,
        pressures_kPa=PRESSURES_KPA,
        settings=SimulationSettings(mesh_level="draft"),
        **how,  # type: ignore[arg-type]
    )


def test_interrupted_ramp_goes_on(tmp_path: Path) -> None:
    file = tmp_path / "ramp.npz"
    unbroken = ramp()

    def interrupt(checkpoint: Checkpoint) -> None:
        if checkpoint.steps[-1].pressure_kPa == 10.0:
            write_checkpoint(file, checkpoint, run="this one")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        ramp(keep=interrupt)
    kept = read_checkpoint(file, run="this one")
    assert kept is not None
    assert np.isnan(kept.displacement_mm[3]).all()
    reached: list[float] = []
    resumed = ramp(resume=kept, progress=reached.append)
    assert reached == [15.0]
    np.testing.assert_array_equal(resumed.displacement_mm, unbroken.displacement_mm)
    assert resumed.steps == unbroken.steps


def test_a_checkpoint_of_another_run_or_a_broken_one_is_left(tmp_path: Path) -> None:
    file = tmp_path / "ramp.npz"
    assert read_checkpoint(file, run="this one") is None
    ramp(keep=lambda checkpoint: write_checkpoint(file, checkpoint, run="another"))
    assert read_checkpoint(file, run="this one") is None
    file.write_bytes(file.read_bytes()[:1000])
    assert read_checkpoint(file, run="another") is None
