"""``spavision track``: photographs -> tip path with uncertainty."""

from __future__ import annotations

from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import click

from spavision.table_text import number, records

from .options import PHOTO_OPTIONS, experiment_option, photo_options, results_options

if TYPE_CHECKING:
    from spavision.workflow.measure import Measurement

NOT_ALL_OK = 3
"""Exit code of ``--strict`` where a reading is not ``ok``; the results are written all the same."""


@click.command()
@click.argument("photos", type=click.Path(path_type=Path))
@click.option(
    "--strict", is_flag=True, help=f"Exit with code {NOT_ALL_OK} after the work unless every photo is ok."
)
@photo_options
@experiment_option
@results_options
def track(photos: Path, **given: Any) -> None:
    """Measure the displacement of the tip in PHOTOS, a folder of photographs or a video.

    Reads experiment.toml beside the photos where there is one; options go before it. Writes track.csv, one
    overlay picture a photo and a montage of all photos with the tip marked.

    What corrections.csv beside the photos says goes before what is found in them: its columns are photo, and
    x_px and y_px of the marker or yes under reject, and a note.
    """
    from spavision.results import ResultsFolder
    from spavision.workflow.measure import measure, save_measurement

    from . import output
    from .options import experiment_file, experiment_for

    experiment = experiment_for(photos, given["experiment"], given, PHOTO_OPTIONS)
    name = photos.resolve().name
    results = ResultsFolder(given["output"] or output.default_output("track", name), force=given["force"])
    experiment_path = experiment_file(photos, given["experiment"])
    results.record_inputs([] if experiment_path is None else [experiment_path])
    measurement = measure(photos, experiment, results=results, quiet=given["quiet"])
    save_measurement(results, measurement, experiment)
    _report(measurement, results.path, as_json=given["as_json"], quiet=given["quiet"])
    if given["strict"]:
        _refuse_unless_all_ok(measurement)


def _refuse_unless_all_ok(measurement: Measurement) -> None:
    path = measurement.track.tip_path
    rest = [
        f"{name} ({status})" for name, status in zip(path.photo, path.status, strict=True) if status != "ok"
    ]
    if rest:
        raise _NotAllOk(
            f"--strict: {len(rest)} of {len(path)} photos are not ok: {', '.join(rest)}; "
            "mend or remove them, or give their marker in corrections.csv"
        )


class _NotAllOk(click.ClickException):
    """The work is done, and not every reading is ``ok``."""

    exit_code = NOT_ALL_OK

    def show(self, file: IO[Any] | None = None) -> None:  # noqa: ARG002
        click.echo(f"spavision: {self.message}", err=True)


def _report(measurement: Measurement, folder: Path, *, as_json: bool, quiet: bool) -> None:
    from . import output

    path = measurement.track.tip_path
    if as_json:
        output.print_json(
            {
                "tip_path": records(path.table()),
                "track": measurement.record(),
                "output": str(folder),
            }
        )
        return
    if not quiet:
        columns = zip(
            path.photo,
            path.pressure_kPa,
            path.ux_mm,
            path.sigma_ux_mm,
            path.uy_mm,
            path.sigma_uy_mm,
            path.status,
            path.reason,
            strict=True,
        )
        rows = [
            [
                photo,
                f"{p:g}",
                *(number(value, 3) for value in (x, sx, y, sy)),
                f"{status}: {why}" if why else status,
            ]
            for photo, p, x, sx, y, sy, status, why in columns
        ]
        header = ["photo", "pressure kPa", "x mm", "σ x mm", "y mm", "σ y mm", "remark"]
        output.print_table("Measured tip path", header, rows)
        budget_header, *budget = measurement.budget_rows()
        output.print_table("Uncertainty budget", budget_header, budget)
        output.print_lines(measurement.notes)
    output.print_lines([f"Results: {folder}"])
