"""The Python interface: track, simulate, compare; each result has a table, a plot, and saves its folder.

Sections of the experiment file are keyword arguments, so that everything a file can say can be said here:

>>> from spavision import simulate
>>> simulated = simulate(actuator={"crimp_ratio": 0.2}, model={"mesh": "draft"})  # doctest: +SKIP
>>> simulated.table()  # doctest: +SKIP
"""

from __future__ import annotations

import shutil
import tempfile
import weakref
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from spavision.errors import InputError
from spavision.experiment import FILE_NAME, Experiment, read_experiment
from spavision.results import ResultsFolder
from spavision.tip_path import FloatArray, TipPath
from spavision.workflow.comparison import Comparison, compare_sides, compare_with_model, write_comparison
from spavision.workflow.measure import Measurement, measure, save_measurement
from spavision.workflow.measured_side import MeasuredSide, Source, take_measurement
from spavision.workflow.model_run import run_model, save_simulation

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

    from spavision.model.simulation import Simulation

DEFAULT_PRESSURES_kPa = tuple(range(0, 70, 5))


@dataclass(frozen=True)
class _PathResult(ABC):
    """A tip path with its table, and its folder as the command of the same kind writes it."""

    tip_path: TipPath
    experiment: Experiment
    scratch: ResultsFolder = field(repr=False)

    def table(self) -> pd.DataFrame:
        """Return the tip path, one row a photograph or pressure, as in the command's CSV file."""
        return self.tip_path.table()

    def save(self, folder: str | Path, *, force: bool = False) -> Path:
        """Write everything that the command of the same kind writes; return the folder.

        Raises
        ------
        InputError
            If the folder holds files already and ``force`` is off, or cannot be written to.
        """
        results = _begun(folder, self.scratch, force=force)
        self._write(results)
        return results.path

    @abstractmethod
    def _write(self, results: ResultsFolder) -> None:
        """Write the command's files and its record."""


@dataclass(frozen=True)
class Tracked(_PathResult):
    """What `track` measured.

    Parameters
    ----------
    tip_path : TipPath
        One row a photograph.
    measurement : Measurement
        The track with its photographs, shapes, budget and notes.
    experiment : Experiment
        What was said of the set-up.
    scratch : ResultsFolder
        What was read on the way, for the record.
    """

    measurement: Measurement

    def plot(self) -> Figure:
        """Draw the tip path in the x-y plane."""
        from spavision.correlate.figures import single_path_figure

        return single_path_figure(self.tip_path, label="measured")

    def _write(self, results: ResultsFolder) -> None:
        save_measurement(results, self.measurement, self.experiment)


@dataclass(frozen=True)
class Simulated(_PathResult):
    """What `simulate` computed.

    Parameters
    ----------
    tip_path : TipPath
        One row for each asked pressure.
    simulation : Simulation
        Mesh, displacements, steps, and why it stopped if it had to.
    experiment : Experiment
        The actuator and the model's settings.
    scratch : ResultsFolder
        What was read on the way, for the record.
    """

    simulation: Simulation

    def plot(self) -> Figure:
        """Draw the deformed shapes at several pressures."""
        from spavision.model.figures import deformed_shapes

        return deformed_shapes(self.simulation)

    def _write(self, results: ResultsFolder) -> None:
        save_simulation(results, self.simulation, self.experiment)


@dataclass(frozen=True)
class Compared:
    """What `compare` found.

    Parameters
    ----------
    comparison : Comparison
        Both sides, with discrepancy, modes, alignment, validation and shapes.
    scratch : ResultsFolder
        What was read on the way, for the record.
    """

    comparison: Comparison
    scratch: ResultsFolder = field(repr=False)

    def table(self) -> pd.DataFrame:
        """Return both sides and their difference, one row a pressure, as in ``discrepancy.csv``."""
        return self.comparison.summary.discrepancy.table()

    def sentences(self) -> list[str]:
        """Say the main findings, one sentence each."""
        return self.comparison.sentences()

    def plot(self) -> Figure:
        """Draw both tip paths in the x-y plane."""
        from spavision.correlate.figures import path_figure

        return path_figure(self.comparison.summary.discrepancy, title=self.comparison.title)

    def save(self, folder: str | Path, *, force: bool = False, formats: Sequence[str] = ("html",)) -> Path:
        """Write everything that ``spavision correlate`` writes, the report in each format; return the folder.

        Raises
        ------
        InputError
            If the folder holds files already and ``force`` is off, or cannot be written to.
        """
        results = _begun(folder, self.scratch, force=force)
        write_comparison(results, self.comparison, formats=formats)
        return results.path


def track(
    photos: str | Path,
    *,
    experiment: Experiment | str | Path | None = None,
    progress: bool = False,
    **sections: Mapping[str, Any],
) -> Tracked:
    """Measure the displacement of the tip in a folder of photographs, or in a video.

    Parameters
    ----------
    photos : str or Path
        The folder or the video; ``corrections.csv`` beside the photographs is honoured.
    experiment : Experiment, str or Path, optional
        The set-up, or its file; by default ``experiment.toml`` beside the photographs where there is one.
    progress : bool
        Show progress on a terminal.
    **sections : mapping
        Sections of the experiment laid over that, such as ``camera={"standoff_mm": 20}``.

    Raises
    ------
    InputError
        If something said of the set-up is not valid, or the photographs cannot be used.
    """
    place, results = Path(photos), _scratch()
    home = place.parent if place.is_file() else place
    found = _experiment(experiment, home, sections, results)
    measurement = measure(place, found, results=results, quiet=not progress)
    return Tracked(measurement.track.tip_path, found, results, measurement)


def simulate(
    *,
    pressures_kPa: Sequence[float] | FloatArray = DEFAULT_PRESSURES_kPa,
    experiment: Experiment | str | Path | None = None,
    progress: bool = False,
    **sections: Mapping[str, Any],
) -> Simulated:
    """Run the finite-element model of the actuator.

    Parameters
    ----------
    pressures_kPa : sequence of float
        Increasing.
    experiment, progress, **sections
        As in `track`, without a default file.

    Raises
    ------
    InputError
        If the crimp ratio is not said, or geometry, materials or pressures are not valid.
    """
    results = _scratch()
    found = _experiment(experiment, None, sections, results)
    simulation = run_model(found, np.asarray(pressures_kPa, dtype=float), quiet=not progress)
    return Simulated(simulation.tip_path, found, results, simulation)


def compare(
    measured: Tracked | str | Path,
    modelled: Simulated | None = None,
    *,
    study: str | Path | None = None,
    progress: bool = False,
) -> Compared:
    """Compare a measured with a modelled tip path at equal pressures.

    Parameters
    ----------
    measured : Tracked, str or Path
        A track, or the CSV file of a path that was measured otherwise (then ``modelled`` says of what).
    modelled : Simulated, optional
        By default the model of the track's own experiment is run at the measured pressures.
    study : str or Path, optional
        Results folder of ``spavision study``: its u_input, and what each suspect can explain.
    progress : bool
        Show progress on a terminal.

    Raises
    ------
    InputError
        If the sides share no pressure, a table comes without a model, or the study is of another actuator.
    """
    results = _scratch()
    if isinstance(measured, Tracked):
        results.take_over(measured.scratch)
        series = measured.measurement.series
        source = Source(series.photos[0].parent.name, measured.experiment, photos=series.photos[0].parent)
        record = {"track": measured.measurement.record()}
        side = MeasuredSide(measured.tip_path, source, measured.measurement, record)
    elif modelled is None:
        raise InputError(f"{measured}: of which actuator? give the model too: compare(path, simulate(…))")
    else:
        table = Path(measured)
        source = Source(table.stem, modelled.experiment, table=table)
        side = take_measurement(source, results=results, quiet=True)
    studied = None
    if study is not None:
        from spavision.workflow.study_results import read_study_results

        studied = read_study_results(Path(study), source.experiment)
    if modelled is None:
        return Compared(compare_with_model(side, quiet=not progress, study=studied), results)
    results.take_over(modelled.scratch)
    return Compared(compare_sides(side, modelled.simulation, study=studied), results)


def _experiment(
    given: Experiment | str | Path | None,
    home: Path | None,
    sections: Mapping[str, Mapping[str, Any]],
    results: ResultsFolder,
) -> Experiment:
    """Return the experiment, from its file where there is one, with sections laid over it."""
    if isinstance(given, Experiment):
        experiment = given
    else:
        beside = None if home is None else home / FILE_NAME
        file = Path(given) if given is not None else beside if beside and beside.is_file() else None
        experiment = Experiment() if file is None else read_experiment(file)
        results.record_inputs([] if file is None else [file])
    return experiment.with_options({name: dict(keys) for name, keys in sections.items()}, source="arguments")


def _begun(folder: str | Path, scratch: ResultsFolder, *, force: bool) -> ResultsFolder:
    """Return a results folder that holds already what was read on the way."""
    results = ResultsFolder(Path(folder), force=force)
    results.take_over(scratch)
    return results


def _scratch() -> ResultsFolder:
    """Return a folder for what is read on the way, removed with the result that holds it."""
    results = ResultsFolder(Path(tempfile.mkdtemp(prefix="spavision-")))
    weakref.finalize(results, shutil.rmtree, results.path, ignore_errors=True)
    return results
