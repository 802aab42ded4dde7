"""The centre lines of photos and model, brought into one system of axes and compared."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from spavision.tip_path import FloatArray

if TYPE_CHECKING:
    from spavision.correlate.centre_lines import CentreLine, ShapeDiscrepancy
    from spavision.model.simulate import Simulation

    from .measure import Measurement


def compare_shapes(
    measurement: Measurement | None, simulation: Simulation, *, first_bend: str
) -> ShapeDiscrepancy | None:
    """Compare the centre lines where the photos show any; None otherwise."""
    from spavision.correlate.centre_lines import compare_centre_lines

    if measurement is None or not simulation.tip_path.has_reading.any():
        return None
    sense = np.array([-1.0 if first_bend == "left" else 1.0, 1.0])
    return compare_centre_lines(_measured_lines(measurement, sense), _modelled_lines(simulation))


def _measured_lines(measurement: Measurement, sense: FloatArray) -> list[CentreLine]:
    from spavision.correlate.centre_lines import CentreLine

    readings = measurement.track.readings
    origin = next((reading.marker_mm for reading in readings if reading.marker_mm is not None), np.zeros(2))
    return [
        CentreLine(reading.pressure_kPa, (reading.shape.points_mm - origin) * sense)
        for reading in measurement.shapes
        if reading.shape is not None
    ]


def _modelled_lines(simulation: Simulation) -> list[CentreLine]:
    from spavision.correlate.centre_lines import CentreLine

    path, origin = simulation.tip_path, simulation.marker_at_rest_mm[:2]
    return [
        CentreLine(float(path.pressure_kPa[row]), simulation.centre_line_mm[row] - origin)
        for row in np.flatnonzero(path.has_reading)
    ]
