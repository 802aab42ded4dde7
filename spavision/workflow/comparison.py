"""One comparison from measured path to files: model run, discrepancy, figures, report."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from spavision.correlate.gauge import read_pressure_kPa, true_pressure_kPa
from spavision.errors import InputError
from spavision.experiment import GaugeSection
from spavision.results import ResultsFolder
from spavision.table_text import csv_text

from .measure import write_measurement
from .measured_side import MeasuredSide
from .model_run import run_model, simulation_record, write_simulation
from .pictures import figure_bytes
from .report_page import photo_pictures, report_content
from .shape_comparison import compare_shapes

if TYPE_CHECKING:
    from spavision.correlate.centre_lines import ShapeDiscrepancy
    from spavision.correlate.summary import Summary
    from spavision.model.simulate import Simulation

    from .study_results import StudyResults


@dataclass(frozen=True)
class Comparison:
    """Everything that one comparison found."""

    side: MeasuredSide
    simulation: Simulation
    summary: Summary
    shape: ShapeDiscrepancy | None
    study: StudyResults | None = None

    @property
    def title(self) -> str:
        """Name of the comparison, for headings."""
        crimp_ratio = self.side.source.experiment.actuator.crimp_ratio
        return f"Crimp ratio {crimp_ratio:g} against {self.side.source.name}"

    @property
    def notes(self) -> tuple[str, ...]:
        """What the reader must know about either side."""
        notes = [*self.side.notes, *(self.study.notes if self.study is not None else ())]
        gauge, stopped = self.side.source.experiment.gauge, self.simulation.stopped_at_kPa
        if gauge != GaugeSection():
            notes.append(
                f"Pressures are the gauge's readings; the model ran at {gauge.pressure_scale:g} times these "
                f"{gauge.pressure_offset_kPa:+g} kPa, and its steps are listed at true pressures."
            )
        if stopped is not None:
            notes.append(f"The model stopped at {stopped:g} kPa: {self.simulation.stop_reason}")
        return tuple(notes)

    def record(self) -> dict[str, Any]:
        """Return the settings and outcomes that ``run.json`` keeps."""
        return {
            "command": "correlate",
            "experiment": self.side.source.experiment.model_dump(),
            **self.side.record,
            "simulation": simulation_record(self.simulation),
            "study": None if self.study is None else str(self.study.folder),
            "summary": self.sentences(),
        }

    def sentences(self) -> list[str]:
        """Say the main findings on tip and shape, one sentence each."""
        shape = [] if self.shape is None else [self.shape.sentence()]
        studied = () if self.study is None else self.study.findings
        return [*self.summary.sentences(), *shape, *studied]


def compare_with_model(side: MeasuredSide, *, quiet: bool, study: StudyResults | None = None) -> Comparison:
    """Run the model at the measured pressures and compare.

    Parameters
    ----------
    side : MeasuredSide
    quiet : bool
    study : StudyResults, optional
        Gives u_input, and what each suspect can explain.

    Raises
    ------
    InputError
        If there is nothing but the reference, the measured pressures lie outside the model's range, or
        the model cannot be set up.
    """
    from spavision.model.simulate import LARGEST_PRESSURE_KPA

    if len(side.path.readings()) == 1 and side.reference_is_read:
        raise InputError(
            f"{side.source.place}: holds one reading, the reference that the others are relative to; "
            "a comparison needs one more at least"
        )
    highest = float(side.path.pressure_kPa.max())
    if highest > LARGEST_PRESSURE_KPA:
        raise InputError(
            f"{side.source.place}: the pressure {highest:g} kPa lies outside the model's range of 0 to "
            f"{LARGEST_PRESSURE_KPA:g} kPa; correct it, or name its unit with --pressure-unit"
        )
    experiment = side.source.experiment
    pressure_kPa = true_pressure_kPa(side.model_pressure_kPa, experiment.gauge)
    simulation = run_model(experiment, pressure_kPa, quiet=quiet)
    return compare_sides(side, simulation, study=study)


def compare_sides(
    side: MeasuredSide, simulation: Simulation, *, study: StudyResults | None = None
) -> Comparison:
    """Compare a measured path with a simulation at the pressures that both have.

    Where the experiment knows its gauge, the simulation ran at true pressures and is set beside the readings.

    Raises
    ------
    InputError
        If there is no such pressure.
    """
    from spavision.correlate.discrepancy import compare, in_bending_axes
    from spavision.correlate.summary import summarise
    from spavision.correlate.validation import ModelUncertainty
    from spavision.model.mesh_error import numerical_uncertainty_mm

    first_bend = side.source.experiment.actuator.first_bend
    simulation = _at_readings(simulation, side.source.experiment.gauge)
    discrepancy = compare(in_bending_axes(side.path, first_bend=first_bend), simulation.tip_path)
    study = None if study is None else study.for_path(discrepancy.measured)
    modelled = discrepancy.modelled
    mesh_mm = numerical_uncertainty_mm(simulation.settings.mesh_level, modelled.ux_mm, modelled.uy_mm)
    inputs_mm = (None, None) if study is None else study.inputs_mm(discrepancy.pressure_kPa)
    known = ModelUncertainty(
        mesh_x_mm=mesh_mm, mesh_y_mm=mesh_mm, inputs_x_mm=inputs_mm[0], inputs_y_mm=inputs_mm[1]
    )
    return Comparison(
        side,
        simulation,
        summarise(discrepancy, known),
        compare_shapes(side.measurement, simulation, first_bend=first_bend),
        study,
    )


def _at_readings(simulation: Simulation, gauge: GaugeSection) -> Simulation:
    """Name the simulation's states by what the gauge shows at their pressures."""
    if gauge == GaugeSection():
        return simulation
    path = simulation.tip_path
    return replace(
        simulation, tip_path=replace(path, pressure_kPa=read_pressure_kPa(path.pressure_kPa, gauge))
    )


def write_comparison(
    results: ResultsFolder, comparison: Comparison, *, formats: Sequence[str] = ("html",)
) -> list[str]:
    """Write the tables, figures, fields, the report in each format and, last, the record.

    Returns
    -------
    list of str
        File names of the reports.
    """
    from spavision.correlate.figures import path_figure, pressure_figure
    from spavision.correlate.report import report_html
    from spavision.correlate.report_text import report_json, report_markdown

    discrepancy = comparison.summary.discrepancy
    measurement = comparison.side.measurement
    photos = photo_pictures(comparison)
    montage = None
    if measurement is not None:
        montage = write_measurement(results, measurement, show=photos.show if photos is not None else None)
    write_simulation(results, comparison.simulation)
    if comparison.shape is not None:
        results.write_text("shape_discrepancy.csv", csv_text(comparison.shape.table()))
    results.write_text("discrepancy.csv", csv_text(discrepancy.table()))
    figures = {
        "path": path_figure(discrepancy, title=comparison.title),
        "pressure": pressure_figure(discrepancy, title=comparison.title),
    }
    for name, figure in figures.items():
        for ending in ("png", "svg"):
            results.write_bytes(f"figures/{name}.{ending}", figure_bytes(figure, ending))
    writers = {"html": report_html, "md": report_markdown, "json": report_json}
    content = report_content(comparison, photos, montage)
    for ending in formats:
        results.write_text(f"report.{ending}", writers[ending](content))
    results.write_record(comparison.record())
    return [f"report.{ending}" for ending in formats]
