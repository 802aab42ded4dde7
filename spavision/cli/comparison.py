"""One comparison from measured path to files: model run, discrepancy, figures, report."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from spavision.errors import InputError
from spavision.results import ResultsFolder, versions

from .measure import DrawnPhotos, write_measurement
from .measured_side import MeasuredSide
from .model_run import run_model, simulation_record, state_pictures, write_simulation
from .output import csv_text, number
from .pictures import figure_bytes

if TYPE_CHECKING:
    from spavision.correlate.report import Frame, ReportContent
    from spavision.correlate.summary import Summary
    from spavision.model.simulate import Simulation


@dataclass(frozen=True)
class Comparison:
    """Everything that one comparison found."""

    side: MeasuredSide
    simulation: Simulation
    summary: Summary

    @property
    def title(self) -> str:
        """Name of the comparison, for headings."""
        crimp_ratio = self.side.source.experiment.actuator.crimp_ratio
        return f"Crimp ratio {crimp_ratio:g} against {self.side.source.name}"

    @property
    def notes(self) -> tuple[str, ...]:
        """What the reader must know about either side."""
        stopped = self.simulation.stopped_at_kPa
        if stopped is None:
            return self.side.notes
        return (*self.side.notes, f"The model stopped at {stopped:g} kPa: {self.simulation.stop_reason}")

    def record(self) -> dict[str, Any]:
        """Return the settings and outcomes that ``run.json`` keeps."""
        return {
            "command": "correlate",
            "experiment": self.side.source.experiment.model_dump(),
            **self.side.record,
            "simulation": simulation_record(self.simulation),
            "summary": self.summary.sentences(),
        }


def compare_with_model(side: MeasuredSide, *, quiet: bool) -> Comparison:
    """Run the model at the measured pressures and compare.

    Raises
    ------
    InputError
        If the measured pressures lie outside the model's range, or the model cannot be set up.
    """
    from spavision.correlate.discrepancy import compare, in_bending_axes
    from spavision.correlate.summary import summarise
    from spavision.correlate.validation import ModelUncertainty
    from spavision.model.mesh_error import numerical_uncertainty_mm
    from spavision.model.simulate import LARGEST_PRESSURE_KPA

    highest = float(side.path.pressure_kPa.max())
    if highest > LARGEST_PRESSURE_KPA:
        raise InputError(
            f"{side.source.place}: the pressure {highest:g} kPa lies outside the model's range of 0 to "
            f"{LARGEST_PRESSURE_KPA:g} kPa; correct it, or name its unit with --pressure-unit"
        )
    experiment = side.source.experiment
    simulation = run_model(experiment, side.model_pressure_kPa, quiet=quiet)
    measured = in_bending_axes(side.path, first_bend=experiment.actuator.first_bend)
    discrepancy = compare(measured, simulation.tip_path)
    modelled = discrepancy.modelled
    mesh_mm = numerical_uncertainty_mm(experiment.model.mesh, modelled.ux_mm, modelled.uy_mm)
    known = ModelUncertainty(mesh_x_mm=mesh_mm, mesh_y_mm=mesh_mm)
    return Comparison(side, simulation, summarise(discrepancy, known))


def write_comparison(results: ResultsFolder, comparison: Comparison) -> None:
    """Write the tables, figures, fields, the report and, last, the record."""
    from spavision.correlate.figures import path_figure, pressure_figure
    from spavision.correlate.report import report_html

    discrepancy = comparison.summary.discrepancy
    measurement = comparison.side.measurement
    drawn = None if measurement is None else write_measurement(results, measurement)
    write_simulation(results, comparison.simulation)
    results.write_text("discrepancy.csv", csv_text(discrepancy.table()))
    figures = {
        "path": path_figure(discrepancy, title=comparison.title),
        "pressure": pressure_figure(discrepancy, title=comparison.title),
    }
    for name, figure in figures.items():
        for ending in ("png", "svg"):
            results.write_bytes(f"figures/{name}.{ending}", figure_bytes(figure, ending))
    results.write_text("report.html", report_html(_report_content(comparison, drawn)))
    results.write_record(comparison.record())


def _report_content(comparison: Comparison, drawn: DrawnPhotos | None) -> ReportContent:
    from spavision.correlate.report import ReportContent

    measurement = comparison.side.measurement
    tables = {
        "Error against validation uncertainty (V&V 20)": _validation_rows(comparison.summary),
        "Steps of the model": _step_rows(comparison.simulation),
    }
    if measurement is not None:
        tables = {"Uncertainty budget of the readings": measurement.budget_rows(), **tables}
    return ReportContent(
        title=comparison.title,
        summary=comparison.summary,
        frames=_frames(comparison, drawn),
        pictures=[drawn.montage] if drawn is not None else [],
        notes=comparison.notes,
        tables=tables,
        record={**comparison.record(), "versions": versions()},
    )


def _frames(comparison: Comparison, drawn: DrawnPhotos | None) -> list[Frame]:
    """Pair the photo and the model's state at each pressure."""
    from spavision.correlate.report import Frame

    photos = drawn.by_pressure_kPa if drawn is not None else {}
    states = state_pictures(comparison.simulation)
    pressures = comparison.summary.discrepancy.pressure_kPa.tolist()
    return [Frame(pressure, photos.get(pressure), states.get(pressure)) for pressure in pressures]


def _validation_rows(summary: Summary) -> list[list[str]]:
    header = ["pressure kPa", "component", "error mm", "u_val mm", "u_num mm", "u_D mm", "verdict"]
    rows = [header]
    for row in np.flatnonzero(summary.discrepancy.is_common):
        for name, validation in (("x", summary.validation_x), ("y", summary.validation_y)):
            numbers = (
                validation.error_mm[row],
                validation.u_val_mm[row],
                validation.u_num_mm[row],
                validation.u_data_mm[row],
            )
            verdict = "differ significantly" if validation.is_significant[row] else "within 2 u_val"
            pressure = f"{summary.discrepancy.pressure_kPa[row]:g}"
            rows.append([pressure, name, *(number(value, 3) for value in numbers), verdict])
    return rows


def _step_rows(simulation: Simulation) -> list[list[str]]:
    header = ["pressure kPa", "Newton iterations", "relative residual", "enclosed volume cm³", "stable"]
    rows = [
        [
            f"{step.pressure_kPa:.2f}",
            str(step.newton_iterations),
            f"{step.residual:.1e}",
            f"{step.enclosed_volume_mm3 / 1000:.2f}",
            "unknown" if step.negative_pivots is None else "no" if step.negative_pivots else "yes",
        ]
        for step in simulation.steps
    ]
    return [header, *rows]
