"""``spavision correlate``: measured against modelled tip path at the same pressures."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from spavision.table_text import number, records

from .options import experiment_option, model_options, photo_options, results_options

if TYPE_CHECKING:
    from spavision.workflow.comparison import Comparison


@click.command()
@click.option("--photos", type=click.Path(path_type=Path), help="Folder of photographs to track.")
@click.option("--measured", type=click.Path(path_type=Path), help="CSV with pressure_kPa, ux_mm, uy_mm.")
@click.option(
    "--pressure-unit", default="kPa", show_default=True, help="Unit of the pressures in --measured."
)
@click.option(
    "--format",
    "formats",
    type=click.Choice(["html", "md", "json"]),
    multiple=True,
    default=["html"],
    show_default=True,
    help="Format of the report; may be given several times.",
)
@click.option(
    "--study",
    type=click.Path(path_type=Path),
    help="Results folder of spavision study: its u_input, and what each suspect can explain.",
)
@photo_options
@model_options
@experiment_option
@results_options
def correlate(
    photos: Path | None,
    measured: Path | None,
    pressure_unit: str,
    formats: tuple[str, ...],
    study: Path | None,
    **given: Any,
) -> None:
    """Compare the measured with the modelled tip path.

    With --crimp alone the sample photos of that crimp ratio are used. Writes track.csv, simulation.csv,
    discrepancy.csv, figures, report.html and run.json.
    """
    from spavision.results import ResultsFolder
    from spavision.workflow.comparison import compare_with_model, write_comparison
    from spavision.workflow.measured_side import take_measurement

    from . import output
    from .source import choose_source

    source = choose_source(photos, measured, given, pressure_unit=pressure_unit)
    folder = given["output"] or output.default_output("correlate", source.name)
    results = ResultsFolder(folder, force=given["force"])
    studied = None
    if study is not None:
        from spavision.workflow.study_results import read_study_results

        studied = read_study_results(study, source.experiment)
    side = take_measurement(source, results=results, quiet=given["quiet"])
    comparison = compare_with_model(side, quiet=given["quiet"], study=studied)
    reports = write_comparison(results, comparison, formats=tuple(dict.fromkeys(formats)))
    places = [results.path / name for name in reports]
    _report(comparison, places, as_json=given["as_json"], quiet=given["quiet"])


def _report(comparison: Comparison, reports: list[Path], *, as_json: bool, quiet: bool) -> None:
    from . import output

    frame = comparison.summary.discrepancy.table()
    if as_json:
        output.print_json(
            {
                "discrepancy": records(frame),
                "summary": comparison.sentences(),
                "output": str(reports[0].parent),
            }
        )
        return
    for note in comparison.notes:
        output.warn(note)
    if not quiet:
        header = {
            "pressure_kPa": "kPa",
            "measured_ux_mm": "x meas.",
            "modelled_ux_mm": "x model",
            "error_ux_mm": "Δx",
            "measured_uy_mm": "y meas.",
            "modelled_uy_mm": "y model",
            "error_uy_mm": "Δy",
            "distance_mm": "|Δ|",
        }
        rows = [
            [
                f"{row['pressure_kPa']:g}",
                *(number(row[name]) for name in list(header)[1:]),
                row["remark"],
            ]
            for _, row in frame.iterrows()
        ]
        title = f"{comparison.title}: tip in mm, Δ = modelled − measured"
        output.print_table(title, [*header.values(), "remark"], rows)
        output.print_lines(comparison.sentences())
    output.print_lines([f"Report: {report}" for report in reports])
