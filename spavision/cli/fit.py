"""``spavision fit``: test data -> hyperelastic law with uncertainty, stability and transition point."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from spavision.errors import InputError

from .options import results_options

if TYPE_CHECKING:
    from .fit_results import FitRun

DEFAULT_DENSITY_G_PER_CM3 = 1.1
"""Of silicones, 1.07 to 1.24 by their data sheets."""


@click.command()
@click.argument("data", type=click.Path(path_type=Path), nargs=-1, required=True)
@click.option(
    "--law",
    default="ogden",
    show_default=True,
    help="neo-hooke, mooney2, mooney3, mooney5, yeoh, gent, arruda-boyce, ogden1 to ogden4 (ogden: three "
    "terms), all of these; or slack-fibre, the composite of a known matrix and paper.",
)
@click.option(
    "--matrix", default="Ecoflex 00-30", show_default=True, help="Material round the fibres of slack-fibre."
)
@click.option(
    "--mode",
    multiple=True,
    help="uniaxial, compression, equibiaxial or planar: once for all files, or once for each "
    "[default: by the names and preambles of the files].",
)
@click.option(
    "--columns", help="Names for the files' columns, such as strain_%,stress_kPa; - leaves one out."
)
@click.option("--strain-measure", type=click.Choice(["strain", "stretch", "true strain"]))
@click.option("--strain-unit", type=click.Choice(["fraction", "percent"]))
@click.option("--stress-measure", type=click.Choice(["nominal", "true"]))
@click.option(
    "--stress-unit",
    type=click.Choice(["MPa", "kPa", "Pa", "GPa", "N/mm2", "N/cm2", "N/m2", "bar", "kgf/cm2", "psi"]),
)
@click.option("--window", help="Engineering strains to fit, such as -0.3:2 (the article's) [default: all].")
@click.option("--weights", help="Weight of each file, such as 1,1,0.5, or balanced: as much for each file.")
@click.option("--transition", is_flag=True, help="Strain transition point by the article's procedure.")
@click.option(
    "--allow-unstable", is_flag=True, help="Let the law lose stability within the range of the data."
)
@click.option(
    "--errors",
    type=click.Choice(["points", "replicates"]),
    default="points",
    show_default=True,
    help="Standard errors from points taken as independent, or from the scatter between replicates.",
)
@click.option("--name", help="Name of the material in the file that is written [default: the first file's].")
@click.option(
    "--density-g-per-cm3",
    type=float,
    default=DEFAULT_DENSITY_G_PER_CM3,
    show_default=True,
    help="For that file.",
)
@results_options
def fit(data: tuple[Path, ...], **given: Any) -> None:
    """Fit a hyperelastic law to the curves in DATA, files of one material: several modes, replicates.

    Columns, units and modes are recognised from headers and names; options go before them. Writes a material
    file that simulate takes for each law, a figure, the curves as a table, and a report. Viscosity (Prony)
    and softening in the first cycles (Mullins) are out of scope: the first loading is fitted.
    """
    from spavision.model.materials.material_files import checked_density
    from spavision.results import ResultsFolder

    from . import output
    from .fit_results import fit_run, write_fit_run

    density = checked_density(given["density_g_per_cm3"], source="--density-g-per-cm3")
    folder = given["output"] or output.default_output("fit", data[0].stem)
    results = ResultsFolder(folder, force=given["force"])
    curves = _curves(data, given)
    if given["law"] == "slack-fibre":
        _fit_composite(results, curves, data, given)
        return
    run = fit_run(
        given["law"],
        curves,
        settings=_settings(given, [len(curve) for curve in curves]),
        transition=given["transition"],
    )
    write_fit_run(
        results,
        run,
        inputs=data,
        options=given,
        name=given["name"] or curves[0].name,
        density_g_per_cm3=density,
    )
    _report(run, results.path, as_json=given["as_json"], quiet=given["quiet"])


def _fit_composite(results: Any, curves: Any, data: tuple[Path, ...], given: dict[str, Any]) -> None:
    from . import output
    from .fit_composite import composite_lines, composite_record, composite_run, write_composite_run

    for option in ("weights", "allow_unstable"):
        if given[option]:
            raise InputError(f"--{option.replace('_', '-')}: does not go with slack-fibre; leave it out")
    run = composite_run(curves, matrix=given["matrix"], transition=given["transition"])
    write_composite_run(results, run, inputs=data, options=given)
    if given["as_json"]:
        output.print_json({**composite_record(run), "output": str(results.path)})
        return
    if not given["quiet"]:
        output.print_lines(composite_lines(run))
    output.print_lines([f"Results: {results.path}"])


def _curves(data: tuple[Path, ...], given: dict[str, Any]) -> tuple[Any, ...]:
    """Read the files and cut them to the window."""
    from spavision.model.fitting.curve_files import MODE_NAMES, CurveFormat, read_curve, with_distinct_names
    from spavision.model.fitting.measured_curve import in_window

    modes = given["mode"]
    for mode in modes:
        if mode not in MODE_NAMES:
            raise InputError(f"--mode {mode!r}: is unknown, expected one of {', '.join(MODE_NAMES)}")
    if len(modes) not in (0, 1, len(data)):
        raise InputError(
            f"--mode: is given {len(modes)} times for {len(data)} files; give it once, or for each"
        )
    curves = []
    for number, path in enumerate(data):
        form = CurveFormat(
            mode=modes[number % len(modes)] if modes else None,
            columns=tuple(part.strip() for part in (given["columns"] or "").split(",") if part.strip()),
            strain_measure=given["strain_measure"],
            strain_unit=given["strain_unit"],
            stress_measure=given["stress_measure"],
            stress_unit=given["stress_unit"],
            may_stiffen=given["transition"] or given["law"] == "slack-fibre",
        )
        curves.append(read_curve(path, form))
    named = with_distinct_names(curves, data)
    return in_window(named, _window(given["window"])) if given["window"] else named


def _window(text: str) -> tuple[float, float]:
    try:
        low, high = (float(part) for part in text.split(":"))
    except ValueError as error:
        raise InputError(f"--window {text!r}: expected two engineering strains such as -0.3:2") from error
    return low, high


def _settings(given: dict[str, Any], points: list[int]) -> Any:
    from spavision.model.fitting.fit import FitSettings

    return FitSettings(
        weights=_weights(given["weights"], points),
        allow_unstable=given["allow_unstable"],
        any_modulus=given["stress_unit"] is not None,
        errors_by_curve=given["errors"] == "replicates",
    )


def _weights(text: str | None, points: list[int]) -> tuple[float, ...]:
    """Weights of the points of each file."""
    if text is None:
        return ()
    if text == "balanced":
        return tuple(sum(points) / (len(points) * count) for count in points)
    try:
        weights = tuple(float(part) for part in text.split(","))
    except ValueError:
        weights = ()
    if len(weights) != len(points) or not all(0.0 < weight < float("inf") for weight in weights):
        raise InputError(
            f"--weights {text!r}: expected a positive number for each of the {len(points)} files, or balanced"
        )
    return weights


def _report(run: FitRun, folder: Path, *, as_json: bool, quiet: bool) -> None:
    from . import output
    from .fit_results import comparison_rows, fit_run_record

    if as_json:
        output.print_json({**fit_run_record(run), "output": str(folder)})
        return
    if not quiet:
        from spavision.model.fitting.report import data_notes, fit_report

        if len(run.fits) == 1:
            output.print_lines([fit_report(run.fits[0])])
        else:
            output.print_lines(data_notes(run.curves))
        output.print_table("Fitted laws", *comparison_rows(run))
        output.print_lines([*run.left_out, *run.transition_lines()])
    output.print_lines([f"Results: {folder}"])
