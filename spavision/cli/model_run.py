"""From an experiment and pressures to a simulation, and from a simulation to files."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from spavision.errors import InputError
from spavision.experiment import Experiment
from spavision.results import ResultsFolder
from spavision.tip_path import FloatArray

from .output import csv_text
from .progress import progress_bar

if TYPE_CHECKING:
    from spavision.model.reduced.ramp import ReducedSimulation
    from spavision.model.simulate import Simulation, SimulationSettings


def run_model(experiment: Experiment, pressure_kPa: FloatArray, *, quiet: bool) -> Simulation:
    """Run the finite-element model of the experiment's actuator at the given pressures.

    Raises
    ------
    InputError
        If the crimp ratio is not known, or geometry, materials or pressures are not valid.
    """
    from spavision.model.geometry import ActuatorGeometry
    from spavision.model.simulate import simulate

    with progress_bar("model", total=float(pressure_kPa.max()), quiet=quiet) as advance:
        return simulate(
            ActuatorGeometry(**experiment.actuator.geometry()),
            crimp_ratio=_crimp_ratio(experiment),
            pressures_kPa=pressure_kPa,
            settings=_settings(experiment),
            progress=lambda reached_kPa: advance(f"{reached_kPa:.0f} kPa", reached_kPa),
        )


def run_reduced_model(experiment: Experiment, pressure_kPa: FloatArray) -> ReducedSimulation:
    """Run the reduced model of the experiment's actuator at the given pressures.

    Raises
    ------
    InputError
        As `run_model`.
    """
    from spavision.model.geometry import ActuatorGeometry
    from spavision.model.reduced.ramp import simulate_reduced

    return simulate_reduced(
        ActuatorGeometry(**experiment.actuator.geometry()),
        crimp_ratio=_crimp_ratio(experiment),
        pressures_kPa=pressure_kPa,
        settings=_settings(experiment),
    )


def write_model_deck(path: Path, experiment: Experiment, pressure_kPa: FloatArray, *, force: bool) -> None:
    """Write the experiment's model as a deck for CalculiX and Abaqus.

    Raises
    ------
    InputError
        If the file exists and ``force`` is off, cannot be written, or the model is not valid.
    """
    from spavision.model.deck import write_deck
    from spavision.model.geometry import ActuatorGeometry

    if path.exists() and not force:
        raise InputError(f"--write-deck {path}: exists already; choose another name or add --force")
    try:
        write_deck(
            path,
            ActuatorGeometry(**experiment.actuator.geometry()),
            crimp_ratio=_crimp_ratio(experiment),
            pressures_kPa=pressure_kPa,
            settings=_settings(experiment),
        )
    except OSError as error:
        raise InputError(
            f"--write-deck {path}: cannot be written ({error.strerror}); choose another name"
        ) from error


def _crimp_ratio(experiment: Experiment) -> float:
    ratio = experiment.actuator.crimp_ratio
    if ratio is None:
        raise InputError("the crimp ratio is not known; give --crimp 0.2, or crimp_ratio under [actuator]")
    return ratio


def _settings(experiment: Experiment) -> SimulationSettings:
    from spavision.model.simulate import SimulationSettings

    actuator = experiment.actuator
    return SimulationSettings(
        mesh_level=experiment.model.mesh,
        body_material=actuator.body_material,
        strip_a_material=actuator.body_material,
        strip_b_material=actuator.strip_b_material,
    )


def write_simulation(results: ResultsFolder, simulation: Simulation) -> None:
    """Write ``simulation.csv``, the fields, the picture and the animation of the deformed shapes."""
    from spavision.model.animation import write_ramp_gif
    from spavision.model.export import write_vtu_series
    from spavision.model.figures import deformed_shapes

    results.write_text("simulation.csv", csv_text(simulation.tip_path.table()))
    results.write(
        "figures/deformed_shapes.png", lambda path: deformed_shapes(simulation).savefig(path, dpi=150)
    )
    results.write("figures/ramp.gif", lambda path: write_ramp_gif(simulation, path))
    fields = results.path / "fields"
    write_vtu_series(simulation, fields)
    results.adopt(fields)


def simulation_record(simulation: Simulation) -> dict[str, Any]:
    """Return what ``run.json`` keeps of the simulation."""
    from spavision.model.outputs import design_outputs

    reached = bool(simulation.tip_path.has_reading.any())
    return {
        "solver": simulation.solver_name,
        "steps": len(simulation.steps),
        "stopped_at_kPa": simulation.stopped_at_kPa,
        "stop_reason": simulation.stop_reason,
        "design": asdict(design_outputs(simulation)) if reached else None,
    }
