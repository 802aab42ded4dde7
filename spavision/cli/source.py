"""What a comparison's options name as the measured side: photos, a table, or the sample photos."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from spavision.errors import InputError
from spavision.experiment import Experiment
from spavision.samples import nearest_sample_set
from spavision.workflow.measured_side import Source

from .options import MODEL_OPTIONS, PHOTO_OPTIONS, experiment_file, experiment_for


def choose_source(
    photos: Path | None, table: Path | None, given: dict[str, Any], *, pressure_unit: str
) -> Source:
    """Decide from the options what is measured, and read the experiment that goes with it.

    Raises
    ------
    InputError
        If the options contradict each other or name nothing to measure.
    """
    options = PHOTO_OPTIONS | MODEL_OPTIONS
    if photos is not None and table is not None:
        raise InputError("--photos and --measured name two measured sides; give one of them")
    if table is not None:
        experiment = experiment_for(None, given["experiment"], given, options)
        file = experiment_file(None, given["experiment"])
        return Source(table.stem, experiment, table=table, pressure_unit=pressure_unit, experiment_file=file)
    if photos is not None:
        return Source(
            photos.resolve().name,
            experiment_for(photos, given["experiment"], given, options),
            photos=photos,
            experiment_file=experiment_file(photos, given["experiment"]),
        )
    if given["crimp"] is None:
        raise InputError(
            "nothing to compare: give --crimp 0.2 for the sample photos, --photos DIR or --measured CSV"
        )
    return _sample_source(given, options)


def _sample_source(given: dict[str, Any], options: dict[str, tuple[str, str]]) -> Source:
    crimp_ratio = given["crimp"]
    Experiment().with_options({"actuator": {"crimp_ratio": crimp_ratio}})
    folder, own_ratio = nearest_sample_set(crimp_ratio)
    notes: tuple[str, ...] = ("The photos are the sample set: renders by spavision, not a laboratory's.",)
    if abs(own_ratio - crimp_ratio) > 1e-9:
        notes += (
            f"There are no sample photos of crimp ratio {crimp_ratio:g}: the model of {crimp_ratio:g} is "
            f"compared with the photos of {own_ratio:g}, the nearest; "
            "name your own with --photos or --measured.",
        )
    return Source(
        f"crimp-{crimp_ratio:.2f}",
        experiment_for(folder, given["experiment"], given, options),
        photos=folder,
        notes=notes,
        experiment_file=experiment_file(folder, given["experiment"]),
    )
