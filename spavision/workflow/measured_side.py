"""The measured side of a comparison: the user's photos, the user's table, or the sample photos."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from spavision.errors import InputError
from spavision.experiment import Experiment
from spavision.results import ResultsFolder
from spavision.tip_path import FloatArray, TipPath

if TYPE_CHECKING:
    from .measure import Measurement


@dataclass(frozen=True)
class Source:
    """Where the measured path comes from: one of ``photos`` and ``table`` is given."""

    name: str
    experiment: Experiment
    photos: Path | None = None
    table: Path | None = None
    pressure_unit: str = "kPa"
    notes: tuple[str, ...] = ()
    experiment_file: Path | None = None

    @property
    def place(self) -> str:
        """The folder or file, for messages."""
        return str(self.table if self.photos is None else self.photos)


@dataclass(frozen=True)
class MeasuredSide:
    """The measured path in the photos' axes, with how it was come by."""

    path: TipPath
    source: Source
    measurement: Measurement | None
    record: dict[str, Any] = field(default_factory=dict)

    @property
    def notes(self) -> tuple[str, ...]:
        """What the reader must know about the measurement."""
        tracked = self.measurement.notes if self.measurement is not None else ()
        return self.source.notes + tracked

    @property
    def reference_is_read(self) -> bool:
        """Whether the lowest reading is the one that the displacements are relative to."""
        first = self.path.readings().take(np.array([0]))
        return bool(first.ux_mm[0] == 0.0 and first.uy_mm[0] == 0.0)

    @property
    def reference_kPa(self) -> float:
        """Pressure that the displacements are relative to.

        The lowest reading's, where it holds no displacement; else the displacements began at rest, at 0 kPa.
        """
        return float(self.path.readings().pressure_kPa[0]) if self.reference_is_read else 0.0

    @property
    def model_pressure_kPa(self) -> FloatArray:
        """Pressures at which the model must run to meet every measured row, the reference first."""
        above = self.path.pressure_kPa[self.path.pressure_kPa >= self.reference_kPa]
        return np.unique(np.append(above, self.reference_kPa))


def take_measurement(source: Source, *, results: ResultsFolder, quiet: bool) -> MeasuredSide:
    """Track the photos, or read the table.

    Raises
    ------
    InputError
        If that fails, or if no reading is left to compare.
    """
    from spavision.tables import PRESSURE_UNITS_kPa, read_tip_path

    from .measure import measure

    results.record_inputs([] if source.experiment_file is None else [source.experiment_file])
    if source.photos is not None:
        measurement = measure(source.photos, source.experiment, results=results, quiet=quiet)
        return MeasuredSide(measurement.track.tip_path, source, measurement, {"track": measurement.record()})
    assert source.table is not None
    if source.pressure_unit not in PRESSURE_UNITS_kPa:
        raise InputError(
            f"--pressure-unit {source.pressure_unit!r}: expected one of {', '.join(PRESSURE_UNITS_kPa)}"
        )
    path = read_tip_path(source.table, pressure_unit=source.pressure_unit)
    results.record_inputs([source.table])
    if not np.any(path.has_reading):
        raise InputError(f"{source.table}: no row holds a displacement; fill ux_mm and uy_mm")
    return MeasuredSide(path, source, None)
