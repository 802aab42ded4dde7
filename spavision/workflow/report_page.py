"""What the report of a comparison shows: pictures side by side, tables, notes, settings."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from spavision.results import versions
from spavision.table_text import number

from .frame_pictures import PhotoPictures, model_pictures

if TYPE_CHECKING:
    from spavision.correlate.centre_lines import ShapeDiscrepancy
    from spavision.correlate.frames import Window
    from spavision.correlate.report import Frame, Picture, ReportContent
    from spavision.correlate.summary import Summary
    from spavision.model.simulate import Simulation

    from .comparison import Comparison


def photo_pictures(comparison: Comparison) -> PhotoPictures | None:
    """Return what collects the report's photos; None where there are none or no model to set beside them."""
    measurement, window = comparison.side.measurement, _window(comparison)
    if measurement is None or window is None:
        return None
    return PhotoPictures(measurement.track, window)


def report_content(
    comparison: Comparison, photos: PhotoPictures | None, montage: Picture | None
) -> ReportContent:
    """Gather the page of a comparison.

    Parameters
    ----------
    comparison : Comparison
    photos : PhotoPictures or None
        The photos straightened, where there are any.
    montage : Picture or None
        All photos in small.
    """
    from spavision.correlate.report import ReportContent

    measurement = comparison.side.measurement
    tables = {
        "Error against validation uncertainty (V&V 20)": _validation_rows(comparison.summary),
        "Steps of the model": _step_rows(comparison.simulation),
    }
    if comparison.shape is not None:
        tables = {"Bend angle and centre line": _shape_rows(comparison.shape), **tables}
    if measurement is not None:
        tables = {"Uncertainty budget of the readings": measurement.budget_rows(), **tables}
    pictures = [montage] if montage is not None else []
    if comparison.study is not None and comparison.study.attribution:
        tables = {"What each suspect can explain of the discrepancy": comparison.study.rows(), **tables}
        chart = comparison.study.picture()
        pictures = [chart, *pictures] if chart is not None else pictures
    return ReportContent(
        title=comparison.title,
        summary=comparison.summary,
        sentences=comparison.sentences(),
        frames=_frames(comparison, photos),
        pictures=pictures,
        notes=comparison.notes,
        tables=tables,
        record={**comparison.record(), "versions": versions()},
    )


def _frames(comparison: Comparison, photos: PhotoPictures | None) -> list[Frame]:
    """Pair the photo and the model's state at each pressure."""
    from spavision.correlate.report import Frame

    window = _window(comparison)
    states = model_pictures(comparison.simulation, window) if window is not None else {}
    taken = photos.by_pressure_kPa if photos is not None else {}
    pressures = comparison.summary.discrepancy.pressure_kPa.tolist()
    return [Frame(pressure, taken.get(pressure), states.get(pressure)) for pressure in pressures]


def _window(comparison: Comparison) -> Window | None:
    from spavision.correlate.frames import window_of

    if not comparison.simulation.tip_path.has_reading.any():
        return None
    mirrored = comparison.side.source.experiment.actuator.first_bend == "left"
    return window_of(comparison.side.path, comparison.simulation, mirrored=mirrored)


def _shape_rows(shape: ShapeDiscrepancy) -> list[list[str]]:
    header = [
        "pressure kPa",
        "angle measured °",
        "angle modelled °",
        "error °",
        "mean distance mm",
        "largest mm",
    ]
    columns = (
        shape.measured_angle_deg,
        shape.modelled_angle_deg,
        shape.angle_error_deg,
        shape.mean_distance_mm,
        shape.largest_distance_mm,
    )
    rows = [
        [f"{pressure:g}", *(number(column[row], 1) for column in columns)]
        for row, pressure in enumerate(shape.pressure_kPa)
    ]
    return [header, *rows]


def _validation_rows(summary: Summary) -> list[list[str]]:
    header = [
        "pressure kPa",
        "component",
        "error mm",
        "u_val mm",
        "u_num mm",
        "u_input mm",
        "u_D mm",
        "verdict",
    ]
    rows = [header]
    for row in np.flatnonzero(summary.discrepancy.is_common):
        for name, validation in (("x", summary.validation_x), ("y", summary.validation_y)):
            numbers = (
                validation.error_mm[row],
                validation.u_val_mm[row],
                validation.u_num_mm[row],
                validation.u_input_mm[row],
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
