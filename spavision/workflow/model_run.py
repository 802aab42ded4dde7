"""From an experiment and pressures to a simulation, and from a simulation to files."""

from __future__ import annotations

import warnings
from collections import deque
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from spavision import __version__
from spavision.errors import InputError, InputWarning
from spavision.experiment import Experiment
from spavision.results import ResultsFolder
from spavision.table_text import csv_text
from spavision.tip_path import FloatArray

from .progress import progress_bar

if TYPE_CHECKING:
    from spavision.model.journal import Checkpoint
    from spavision.model.reduced.ramp import ReducedSimulation
    from spavision.model.simulate import Simulation, SimulationSettings


def run_model(
    experiment: Experiment, pressure_kPa: FloatArray, *, quiet: bool, unfinished: Path | None = None
) -> Simulation:
    """Run the finite-element model of the experiment's actuator at the given pressures.

    Parameters
    ----------
    experiment : Experiment
    pressure_kPa : array, shape (n,)
    quiet : bool
    unfinished : Path, optional
        Folder where an interrupted ramp leaves its steps, and from where the same ramp goes on.

    Raises
    ------
    InputError
        If the crimp ratio is not known, or geometry, materials or pressures are not valid.
    """
    from spavision.correlate.model_inputs import model_inputs
    from spavision.model.checkpoint_file import read_checkpoint, write_checkpoint
    from spavision.model.simulate import simulate

    inputs = model_inputs(experiment)
    run = f"{__version__} {inputs!r} {pressure_kPa.tolist()}"
    file = None if unfinished is None else unfinished / "ramp.npz"
    done = None if file is None else read_checkpoint(file, run=run)
    for note in inputs.notes:
        warnings.warn(note, InputWarning, stacklevel=2)
    with progress_bar("model", total=float(pressure_kPa.max()), quiet=quiet) as advance:
        last: deque[Checkpoint] = deque(maxlen=1)
        try:
            return simulate(
                inputs.geometry,
                crimp_ratio=inputs.crimp_ratio,
                pressures_kPa=pressure_kPa,
                settings=inputs.settings,
                progress=lambda reached_kPa: advance(f"{reached_kPa:.0f} kPa", reached_kPa),
                resume=done,
                keep=last.append,
            )
        except KeyboardInterrupt:
            if file is not None and last:
                write_checkpoint(file, last[0], run=run)
            raise


def run_reduced_model(experiment: Experiment, pressure_kPa: FloatArray) -> ReducedSimulation:
    """Run the reduced model of the experiment's actuator at the given pressures.

    Raises
    ------
    InputError
        As `run_model`.
    """
    from spavision.correlate.model_inputs import model_inputs
    from spavision.model.reduced.ramp import simulate_reduced

    inputs = model_inputs(experiment)
    return simulate_reduced(
        inputs.geometry,
        crimp_ratio=inputs.crimp_ratio,
        pressures_kPa=pressure_kPa,
        settings=inputs.settings,
    )


def write_model_deck(path: Path, experiment: Experiment, pressure_kPa: FloatArray, *, force: bool) -> None:
    """Write the experiment's model as a deck for CalculiX and Abaqus.

    Raises
    ------
    InputError
        If the file exists and ``force`` is off, cannot be written, or the model is not valid.
    """
    from spavision.correlate.model_inputs import model_inputs
    from spavision.model.deck import write_deck

    if path.exists() and not force:
        raise InputError(f"--write-deck {path}: exists already; choose another name or add --force")
    inputs = model_inputs(experiment)
    try:
        write_deck(
            path,
            inputs.geometry,
            crimp_ratio=inputs.crimp_ratio,
            pressures_kPa=pressure_kPa,
            settings=inputs.settings,
        )
    except OSError as error:
        raise InputError(
            f"--write-deck {path}: cannot be written ({error.strerror}); choose another name"
        ) from error


def write_simulation(results: ResultsFolder, simulation: Simulation) -> None:
    """Write ``simulation.csv``, ``steps.csv``, the fields, the picture and the animation of the ramp."""
    from spavision.model.animation import write_ramp_gif
    from spavision.model.export import write_vtu_series
    from spavision.model.figures import deformed_shapes

    results.write_text("simulation.csv", csv_text(simulation.tip_path.table()))
    results.write_text("steps.csv", csv_text(simulation.step_table()))
    results.write(
        "figures/deformed_shapes.png", lambda path: deformed_shapes(simulation).savefig(path, dpi=150)
    )
    results.write("figures/ramp.gif", lambda path: write_ramp_gif(simulation, path))
    fields = results.path / "fields"
    write_vtu_series(simulation, fields)
    results.adopt(fields)


def save_simulation(results: ResultsFolder, simulation: Simulation, experiment: Experiment) -> None:
    """Write everything that ``spavision simulate`` writes, the record last."""
    write_simulation(results, simulation)
    results.write_record(
        {
            "command": "simulate",
            "experiment": experiment.model_dump(),
            "pressures_kPa": simulation.tip_path.pressure_kPa.tolist(),
            "simulation": simulation_record(simulation),
        }
    )


def simulation_record(simulation: Simulation) -> dict[str, Any]:
    """Return what ``run.json`` keeps of the simulation."""
    from spavision.model.outputs import design_outputs

    reached = bool(simulation.tip_path.has_reading.any())
    return {
        "solver": simulation.solver_name,
        "steps": len(simulation.steps),
        "stopped_at_kPa": simulation.stopped_at_kPa,
        "stop_reason": simulation.stop_reason,
        "composite": _composite_record(simulation.settings),
        "design": asdict(design_outputs(simulation)) if reached else None,
    }


def _composite_record(settings: SimulationSettings) -> dict[str, Any]:
    """Return the composite as it was used: stated, or calibrated to a curve."""
    from spavision.model.materials.law_tables import law_to_table

    if settings.composite is not None:
        return {"source": settings.composite.source, **law_to_table(settings.composite.law)}
    return {"matrix_stiffness": settings.matrix_stiffness, **asdict(settings.paper)}
