"""``spavision study update``: parameters fitted to a measured path, with their posterior."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from spavision.errors import InputError
from spavision.table_text import csv_text, records

from .runner import Runner
from .setup import Setup, prepare, study_options

if TYPE_CHECKING:
    from spavision.correlate.study.suspects import Suspect
    from spavision.correlate.study.update import Update


@click.command()
@click.argument("file", type=click.Path(path_type=Path))
@click.option(
    "--measured", type=click.Path(path_type=Path), help="CSV to fit, before the study file's measured paths."
)
@click.option(
    "--full-runs",
    type=click.IntRange(0, 1),
    default=1,
    show_default=True,
    help="1: the fit starts from the full model's nominal path; 0: from the reduced one's.",
)
@study_options
def update(file: Path, measured: Path | None, full_runs: int, **given: Any) -> None:
    """Bring the parameters under FILE's [update] to the first measured path; check on the others.

    Bounded least squares, then the posterior under the suspects' distributions, with the measurement's
    uncertainty and an unknown model error. Writes update.csv, checks.csv, correlations.csv, updated.toml,
    figures.
    """
    from spavision.cli import output
    from spavision.correlate.study.update import Measured
    from spavision.correlate.study.update import update as run_update
    from spavision.model.reduced.one_thread import one_thread

    from .measured import measured_paths

    setup = prepare("update", file, given)
    suspects = _parameters(setup)
    paths = [
        Measured(one.file.name, one.path, one.crimp_ratio or setup.nominal.actuator.crimp_ratio)
        for one in measured_paths(setup, measured)
    ]
    runner = Runner(setup, crimp_ratio=paths[0].crimp_ratio)
    steps = setup.study.update.steps if setup.study.update is not None else 0
    # The emulator's matrices are small: one thread is faster.
    with one_thread():
        found = run_update(setup.plan(suspects, n_full=full_runs), paths, runner, steps=steps)
    runner.write_cases()
    _write(setup, found)
    content = {
        "parameters": records(found.table()),
        "paths": records(found.comparison_table()),
        "findings": found.sentences(),
    }
    setup.report(content, lambda: output.print_lines(found.sentences()))


def _parameters(setup: Setup) -> tuple[Suspect, ...]:
    from spavision.checked_settings import did_you_mean

    if setup.study.update is None:
        raise InputError(f'{setup.source}: names no parameters; add [update] with parameters = ["..."]')
    suspects = {one.name: one for one in setup.suspects()}
    for name in setup.study.update.parameters:
        if name not in suspects:
            raise InputError(
                f"{setup.source}: [update] parameter {name!r} is none of the suspects; "
                f"{did_you_mean(name, list(suspects), at_most=3)}"
            )
        if suspects[name].is_choice or suspects[name].moves_the_measurement:
            raise InputError(
                f"{setup.source}: [update] parameter {name} is a choice or belongs to the set-up, expected a "
                "number of the model; leave it out"
            )
    return tuple(suspects[name] for name in setup.study.update.parameters)


def _write(setup: Setup, found: Update) -> None:
    import pandas as pd

    from spavision.correlate.study.update_figures import comparison_figure, posterior_figure

    names = [one.suspect.name for one in found.parameters]
    correlations = pd.DataFrame(found.posterior.correlation, columns=names)
    correlations.insert(0, "parameter", names)
    results = setup.results
    results.write_text("update.csv", csv_text(found.table()))
    results.write_text("checks.csv", csv_text(found.comparison_table()))
    results.write_text("correlations.csv", csv_text(correlations))
    results.write_text("updated.toml", _experiment_text(found))
    figures = {"posterior": posterior_figure(found), "paths": comparison_figure(found)}
    setup.write_figures(figures)
    results.write_record({**setup.record(), "findings": found.sentences()})


def _experiment_text(found: Update) -> str:
    """Return the least-squares values as sections of an experiment file."""
    sections: dict[str, list[str]] = {}
    for one in found.parameters:
        value = found.best[one.suspect.name]
        sections.setdefault(one.suspect.section, []).append(f"{one.suspect.name} = {value:.6g}")
    return "\n".join(line for name, lines in sections.items() for line in (f"[{name}]", *lines, ""))
