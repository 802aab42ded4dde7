"""``spavision study attribute``: how much of the discrepancy each suspect can explain."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from spavision.table_text import csv_text, number, records

from .runner import Runner
from .setup import Setup, prepare, study_options

if TYPE_CHECKING:
    from spavision.correlate.study.attribution import Attribution

    from .measured import MeasuredPath


@click.command()
@click.argument("file", type=click.Path(path_type=Path))
@click.option(
    "--measured", type=click.Path(path_type=Path), help="CSV with pressure_kPa, ux_mm, uy_mm to explain."
)
@click.option(
    "--full-runs",
    type=click.IntRange(0, 100),
    default=2,
    show_default=True,
    help="Held-out cases that are also run with the full model.",
)
@study_options
def attribute(file: Path, measured: Path | None, full_runs: int, **given: Any) -> None:
    """Ask which suspects of FILE could have caused the discrepancy.

    Each suspect alone from end to end (local.csv); all at once for an emulator of the model, which is
    checked against held-out cases, and its Sobol indices (sobol.csv); and what each can explain of the
    distance to the measured path (attribution.csv, figures).
    """
    from .measured import measured_paths

    setup = prepare("attribute", file, given)
    target = measured_paths(setup, measured)[0]
    found = _attribution(setup, target, full_runs)
    _write(setup, found, target)
    setup.report(
        {"attribution": records(found.table()), "findings": found.sentences()}, lambda: _print(found)
    )


def _attribution(setup: Setup, target: MeasuredPath, full_runs: int) -> Attribution:
    from spavision.correlate.study.attribution import attribute
    from spavision.model.reduced.one_thread import one_thread

    runner = Runner(setup, crimp_ratio=target.crimp_ratio)
    # The emulator's matrices are small: one thread is faster.
    with one_thread():
        found = attribute(setup.plan(setup.suspects(), n_full=full_runs), target.path, runner)
    runner.write_cases()
    return found


def _write(setup: Setup, found: Attribution, target: MeasuredPath) -> None:
    from spavision.correlate.study.attribution_figures import attribution_figure, sobol_figure
    from spavision.correlate.study.sensitivity import local_table

    results = setup.results
    results.write_text("attribution.csv", csv_text(found.table()))
    results.write_text("sobol.csv", csv_text(found.sobol.table()))
    results.write_text("local.csv", csv_text(local_table(found.local, found.sobol.pressure_kPa)))
    figures = {
        "attribution": attribution_figure(found.alone, found.together, title="What each suspect can explain"),
        "sobol": sobol_figure(found.sobol),
    }
    setup.write_figures(figures)
    results.write_record(
        {
            **setup.record(crimp_ratio=target.crimp_ratio),
            "findings": found.sentences(),
            "measured": target.record(),
        }
    )


def _print(found: Attribution) -> None:
    from spavision.cli import output

    rows = [
        [
            row["suspect"],
            _cell(row["nominal"]),
            *_interval(row),
            _cell(row["best"]),
            f"{100 * row['explained']:.0f} %",
            number(row["largest_change_ux_mm"], 1),
            number(row["largest_total_index"]),
        ]
        for row in found.table().to_dict(orient="records")
    ]
    header = ["suspect", "nominal", "2.5 %", "97.5 %", "best", "explains", "largest Δx mm", "Sobol"]
    output.print_table("What each suspect can explain of the discrepancy", header, rows)
    output.print_lines(found.sentences())


def _interval(row: dict[Any, Any]) -> tuple[str, str]:
    """Return the ends of a number's interval; what is chosen has none."""
    return ("choice", "") if isinstance(row["low"], str) else (_cell(row["low"]), _cell(row["high"]))


def _cell(value: Any) -> str:
    return value if isinstance(value, str) else f"{value:.4g}"
