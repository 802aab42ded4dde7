"""``spavision simulate``: pressures -> tip path and fields of the 3D model."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from spavision.table_text import csv_text, finite_list, number, records

from .options import MODEL_OPTIONS, experiment_option, model_options, results_options

DEFAULT_PRESSURES = "0:65:5"


@click.command()
@click.option(
    "--pressures-kpa",
    default=DEFAULT_PRESSURES,
    show_default=True,
    help="from:to:step, or a list separated by commas.",
)
@click.option(
    "--write-deck",
    type=click.Path(path_type=Path, dir_okay=False),
    help="Also write the model as a deck for CalculiX and Abaqus.",
)
@click.option(
    "--model",
    type=click.Choice(["full", "reduced"]),
    default="full",
    show_default=True,
    help="reduced: a row of alike cells, for sweeps; the tip path alone.",
)
@model_options
@experiment_option
@results_options
def simulate(pressures_kpa: str, write_deck: Path | None, model: str, **given: Any) -> None:
    """Run the 3D finite-element model of the actuator.

    Writes simulation.csv, steps.csv (residual, energy balance and stability of each step), the fields
    as VTU files for ParaView, a picture of the deformed shapes and an animation of the ramp.
    """
    from spavision.results import ResultsFolder
    from spavision.workflow.model_run import run_model, save_simulation, write_model_deck

    from . import output
    from .options import experiment_for, parse_pressures

    experiment = experiment_for(None, given["experiment"], given, MODEL_OPTIONS)
    pressures = parse_pressures(pressures_kpa)
    name = f"crimp-{experiment.actuator.crimp_ratio or 0:.2f}"
    results = ResultsFolder(given["output"] or output.default_output("simulate", name), force=given["force"])
    results.record_inputs([] if given["experiment"] is None else [given["experiment"]])
    if write_deck is not None:
        write_model_deck(write_deck, experiment, pressures, force=given["force"])
    if model == "reduced":
        _simulate_reduced(experiment, pressures, results, given)
        return
    simulation = run_model(experiment, pressures, quiet=given["quiet"], unfinished=results.unfinished)
    save_simulation(results, simulation, experiment)
    _report(simulation, results.path, as_json=given["as_json"], quiet=given["quiet"])


def _simulate_reduced(experiment: Any, pressures: Any, results: Any, given: dict[str, Any]) -> None:
    from spavision.workflow.model_run import run_reduced_model

    from . import output

    reduced = run_reduced_model(experiment, pressures)
    path = reduced.tip_path
    results.write_text("simulation.csv", csv_text(path.table()))
    record = {"model": "reduced", "volume_ratio": finite_list(reduced.volume_ratio.tolist())}
    results.write_record(
        {
            "command": "simulate",
            "experiment": experiment.model_dump(),
            "pressures_kPa": pressures.tolist(),
            "simulation": record,
        }
    )
    if given["as_json"]:
        output.print_json({"tip_path": records(path.table()), **record, "output": str(results.path)})
        return
    if not given["quiet"]:
        _print_path(path)
    output.print_lines([f"Results: {results.path}"])


def _print_path(path: Any) -> None:
    from . import output

    reasons = path.reason or ("",) * len(path)
    remarks = [
        "the same" if reason and reason == before else reason
        for before, reason in zip(("", *reasons), reasons, strict=False)
    ]
    rows = [
        [f"{p:g}", number(x), number(y), remark]
        for p, x, y, remark in zip(path.pressure_kPa, path.ux_mm, path.uy_mm, remarks, strict=True)
    ]
    output.print_table("Modelled tip path", ["pressure kPa", "x mm", "y mm", "remark"], rows)


def _report(simulation: Any, folder: Path, *, as_json: bool, quiet: bool) -> None:
    from spavision.workflow.model_run import simulation_record

    from . import output

    path = simulation.tip_path
    if as_json:
        output.print_json(
            {
                "tip_path": records(path.table()),
                **simulation_record(simulation),
                "output": str(folder),
            }
        )
        return
    if not quiet:
        _print_path(path)
        _report_design(simulation)
    if simulation.stopped_at_kPa is not None:
        output.warn(f"the model stopped at {simulation.stopped_at_kPa:g} kPa: {simulation.stop_reason}")
    output.print_lines([f"Results: {folder}"])


def _report_design(simulation: Any) -> None:
    from spavision.model.outputs import design_outputs

    from . import output
    from .design import design_rows, path_warnings, stretch_warnings

    if not simulation.tip_path.has_reading.any():
        return
    outputs = design_outputs(simulation)
    output.print_table("For the designer", ["quantity", "value", "remark"], design_rows(outputs))
    for warning in path_warnings(outputs) + stretch_warnings(outputs):
        output.warn(warning)
