"""From an experiment and pressures to a simulation, and from a simulation to files."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from spavision.errors import InputError
from spavision.experiment import Experiment
from spavision.results import ResultsFolder
from spavision.tip_path import FloatArray

from .output import csv_text
from .pictures import figure_bytes
from .progress import progress_bar

if TYPE_CHECKING:
    from spavision.correlate.report import Picture
    from spavision.model.simulate import Simulation


def run_model(experiment: Experiment, pressure_kPa: FloatArray, *, quiet: bool) -> Simulation:
    """Run the finite-element model of the experiment's actuator at the given pressures.

    Raises
    ------
    InputError
        If the crimp ratio is not known, or geometry, materials or pressures are not valid.
    """
    from spavision.model.geometry import ActuatorGeometry
    from spavision.model.simulate import SimulationSettings, simulate

    actuator = experiment.actuator
    if actuator.crimp_ratio is None:
        raise InputError("the crimp ratio is not known; give --crimp 0.2, or crimp_ratio under [actuator]")
    settings = SimulationSettings(
        mesh_level=experiment.model.mesh,
        body_material=actuator.body_material,
        strip_a_material=actuator.body_material,
        strip_b_material=actuator.strip_b_material,
    )
    with progress_bar("model", total=float(pressure_kPa.max()), quiet=quiet) as advance:
        return simulate(
            ActuatorGeometry(**actuator.geometry()),
            crimp_ratio=actuator.crimp_ratio,
            pressures_kPa=pressure_kPa,
            settings=settings,
            progress=lambda reached_kPa: advance(f"{reached_kPa:.0f} kPa", reached_kPa),
        )


def write_simulation(results: ResultsFolder, simulation: Simulation) -> None:
    """Write ``simulation.csv``, the fields and the picture of the deformed shapes."""
    from spavision.model.export import write_vtu_series
    from spavision.model.figures import deformed_shapes

    results.write_text("simulation.csv", csv_text(simulation.tip_path.table()))
    results.write(
        "figures/deformed_shapes.png", lambda path: deformed_shapes(simulation).savefig(path, dpi=150)
    )
    fields = results.path / "fields"
    write_vtu_series(simulation, fields)
    results.adopt(fields)


def state_pictures(simulation: Simulation) -> dict[float, Picture]:
    """Draw the deformed actuator at each pressure reached, all to one scale."""
    from spavision.correlate.report import Picture
    from spavision.model.figures import deformed_state

    path = simulation.tip_path
    return {
        float(path.pressure_kPa[row]): Picture(
            figure_bytes(deformed_state(simulation, int(row)), "png"),
            "image/png",
            f"The model at {path.pressure_kPa[row]:g} kPa.",
        )
        for row in np.flatnonzero(path.has_reading)
    }


def simulation_record(simulation: Simulation) -> dict[str, Any]:
    """Return what ``run.json`` keeps of the simulation."""
    return {
        "solver": simulation.solver_name,
        "steps": len(simulation.steps),
        "stopped_at_kPa": simulation.stopped_at_kPa,
        "stop_reason": simulation.stop_reason,
    }
