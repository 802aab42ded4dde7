"""``spavision track``: photographs -> tip path with uncertainty."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from .options import PHOTO_OPTIONS, experiment_option, photo_options, results_options

if TYPE_CHECKING:
    from .measure import Measurement


@click.command()
@click.argument("photos", type=click.Path(path_type=Path))
@photo_options
@experiment_option
@results_options
def track(photos: Path, **given: Any) -> None:
    """Measure the displacement of the tip in PHOTOS, a folder of photographs.

    Reads experiment.toml beside the photos where there is one; options go before it. Writes track.csv, one
    overlay picture a photo and a montage of all photos with the tip marked.
    """
    from spavision.results import ResultsFolder

    from . import output
    from .measure import measure, write_measurement
    from .options import experiment_for

    experiment = experiment_for(photos, given["experiment"], given, PHOTO_OPTIONS)
    name = photos.resolve().name
    results = ResultsFolder(given["output"] or output.default_output("track", name), force=given["force"])
    measurement = measure(photos, experiment, quiet=given["quiet"])
    write_measurement(results, measurement)
    results.write_record(
        {"command": "track", "experiment": experiment.model_dump(), "track": measurement.record()}
    )
    _report(measurement, results.path, as_json=given["as_json"], quiet=given["quiet"])


def _report(measurement: Measurement, folder: Path, *, as_json: bool, quiet: bool) -> None:
    from . import output

    path = measurement.track.tip_path
    if as_json:
        output.print_json(
            {
                "tip_path": output.records(path.table()),
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
                *(output.number(value, 3) for value in (x, sx, y, sy)),
                f"{status}: {why}" if why else status,
            ]
            for photo, p, x, sx, y, sy, status, why in columns
        ]
        header = ["photo", "pressure kPa", "x mm", "σ x mm", "y mm", "σ y mm", "remark"]
        output.print_table("Measured tip path", header, rows)
        output.print_lines(measurement.track.notes)
    output.print_lines([f"Results: {folder}"])
