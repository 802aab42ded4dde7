"""``spavision study tolerance``: the band that uncertain inputs leave around the modelled path."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from spavision.errors import InputError
from spavision.table_text import csv_text, number, records

from .setup import Setup, prepare, study_options

if TYPE_CHECKING:
    from spavision.correlate.study.band import Band
    from spavision.correlate.study.suspects import Suspect

BAND_NAME = "tolerance.csv"


@click.command()
@click.argument("file", type=click.Path(path_type=Path))
@study_options
def tolerance(file: Path, **given: Any) -> None:
    """Draw values for all suspects of FILE at once, many times, and run the model with each.

    Writes tolerance.csv (band and u_input at each pressure), cases.csv, a figure. correlate --study takes
    u_input from the folder.
    """
    from spavision.correlate.study.band import band
    from spavision.correlate.study.plan import refuse_failed
    from spavision.correlate.study.sampling import draw_shares, values_at

    setup = prepare("tolerance", file, given)
    suspects = _inputs(setup)
    study = setup.study.study
    points = draw_shares(len(suspects), study.cases, sampling=study.sampling, seed=study.seed)
    cases = [setup.case({}), *(setup.case(values) for values in values_at(suspects, points))]
    nominal, *results = setup.run(cases, title="tolerance")
    refuse_failed(nominal)
    setup.write_cases(cases[1:], results)
    found = band(nominal.path(setup.pressures_kPa), results)
    _write(setup, found, remark=nominal.reason)
    setup.report({"band": records(found.table())}, lambda: _print(found))


def _inputs(setup: Setup) -> tuple[Suspect, ...]:
    from spavision.cli import output

    suspects = setup.suspects()
    for one in suspects:
        if one.is_form:
            output.warn(
                f"{one.name} chooses the form of the model, which has no scatter: it stays {one.nominal} "
                "here; attribute varies it"
            )
    inputs = tuple(one for one in suspects if one.is_input)
    if not inputs:
        raise InputError(
            f"{setup.source}: no suspect is an input of the model; add one, such as side_wall_mm"
        )
    return inputs


def _write(setup: Setup, found: Band, *, remark: str) -> None:
    from spavision.correlate.study.figures import band_figure

    setup.results.write_text(BAND_NAME, csv_text(found.table()))
    figure = band_figure(found, title=f"{found.n_cases} cases, {setup.study.study.model} model")
    setup.write_figures({"tolerance": figure})
    setup.results.write_record({**setup.record(), "remark": remark})


def _print(found: Band) -> None:
    from spavision.cli import output

    header = ["kPa", "x nominal", "x low", "x high", "u_input x", "y nominal", "y low", "y high", "u_input y"]
    rows = []
    for index, pressure in enumerate(found.nominal.pressure_kPa):
        row = [f"{pressure:g}"]
        for axis, nominal in enumerate((found.nominal.ux_mm, found.nominal.uy_mm)):
            low, _, high = found.quantiles_mm[:, axis, index]
            row += [number(value) for value in (nominal[index], low, high, found.sigma_mm[axis, index])]
        left = found.n_cases - int(found.n_reached[index])
        rows.append([*row, f"{left} of {found.n_cases} cases did not get here" if left else ""])
    output.print_table("Tip in mm: 95 % of the cases lie between low and high", [*header, "remark"], rows)
