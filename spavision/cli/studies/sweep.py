"""``spavision study sweep``: the model over a grid of any parameters."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from spavision.errors import InputError
from spavision.table_text import csv_text, records

from .setup import Setup, prepare, study_options

if TYPE_CHECKING:
    import pandas as pd

    from spavision.correlate.study.parameters import Value


@click.command()
@click.argument("file", required=False, type=click.Path(path_type=Path))
@click.option(
    "--vary",
    multiple=True,
    metavar="NAME=VALUES",
    help="Parameter and its values: 1,2,3 or from:to:step; words are parted by semicolons. May be repeated.",
)
@study_options
def sweep(file: Path | None, vary: tuple[str, ...], **given: Any) -> None:
    """Run the model for every combination of values, of FILE's [grid] and of --vary.

    \b
    spavision study sweep --crimp 0.2 --vary strip_b_mm=1,2,3 --vary crimp_ratio=0.2:0.3:0.05

    Writes cases.csv with the mode change of each case, paths.csv, a figure.
    """  # noqa: D301
    from spavision.correlate.study.case_table import case_table
    from spavision.correlate.study.parameters import MEASUREMENT_KEYS, nominal_value
    from spavision.correlate.study.sampling import grid_values

    setup = prepare("sweep", file, given)
    grid: dict[str, tuple[Value, ...]] = {**setup.study.grid, **_parsed(vary)}
    if not grid:
        raise InputError("sweep: nothing varies; give --vary strip_b_mm=1,2,3, or a [grid] in the study file")
    for name in grid:
        nominal_value(name, setup.nominal, where=setup.source)
        if name in MEASUREMENT_KEYS:
            raise InputError(f"sweep: {name} moves the measured path, not the model; leave it out")
    cases = [setup.case(values) for values in grid_values(grid)]
    results = setup.run(cases, title="sweep")
    setup.write_cases(cases, results)
    _write_paths(setup, cases, results)
    setup.results.write_record({**setup.record(), "grid": {name: list(each) for name, each in grid.items()}})
    frame = case_table(cases, results)
    setup.report({"cases": records(frame)}, lambda: _print(frame, list(grid)))


def _print(frame: pd.DataFrame, varied: list[str]) -> None:
    from spavision.cli import output

    names = [*varied, "first_extremum_mm", "mode_change_kPa", "second_extreme_mm"]
    rows = [[*(_cell(row[name]) for name in names), row["status"]] for row in frame.to_dict(orient="records")]
    output.print_table("Sweep", [*names, "remark"], rows)


def _write_paths(setup: Setup, cases: Any, results: Any) -> None:
    import pandas as pd

    from spavision.correlate.study.figures import sweep_figure

    paths = [result.path(setup.pressures_kPa) for result in results]
    tables = [
        path.table()[["pressure_kPa", "ux_mm", "uy_mm"]].assign(case=case.name, **case.values)
        for path, case in zip(paths, cases, strict=True)
    ]
    setup.results.write_text("paths.csv", csv_text(pd.concat(tables)))
    labels = [", ".join(f"{name} {_cell(value)}" for name, value in case.values.items()) for case in cases]
    figure = sweep_figure(paths, labels, title="Tip paths of the sweep")
    setup.write_figures({"sweep": figure})


def _cell(value: Any) -> str:
    return value if isinstance(value, str) else f"{value:g}" if math.isfinite(value) else "–"


def _parsed(vary: tuple[str, ...]) -> dict[str, tuple[Value, ...]]:
    found: dict[str, tuple[Value, ...]] = {}
    for text in vary:
        name, sign, values = text.partition("=")
        if not sign or not values:
            raise InputError(f"--vary {text}: expected NAME=VALUES such as strip_b_mm=1,2,3")
        found[name.strip()] = _values(values, text)
    return found


def _values(values: str, text: str) -> tuple[Value, ...]:
    import numpy as np

    parts = values.split(":")
    try:
        if len(parts) == 3:
            start, stop, step = (float(part) for part in parts)
            count = int(np.floor((stop - start) / step + 1e-9)) + 1
            if step <= 0.0 or count < 1:
                raise ValueError
            return tuple((start + step * np.arange(count)).round(12).tolist())
        return tuple(float(part) for part in values.split(","))
    except (ValueError, ZeroDivisionError):
        if len(parts) == 3:
            raise InputError(f"--vary {text}: expected from:to:step with a positive step") from None
        return tuple(part.strip() for part in values.split(";"))
