"""What the pressure gauge shows, and the pressure in the actuator."""

from __future__ import annotations

import numpy as np

from spavision.errors import InputError
from spavision.experiment import GaugeSection
from spavision.tip_path import FloatArray


def true_pressure_kPa(read_kPa: FloatArray, gauge: GaugeSection) -> FloatArray:
    """Return the pressures in the actuator when the gauge shows others: scale · reading + offset.

    A reading of 0 is the vented actuator, whatever the gauge's offset.

    Parameters
    ----------
    read_kPa : array, shape (n,)
    gauge : GaugeSection

    Raises
    ------
    InputError
        If a reading above 0 would be a pressure of 0 or less.
    """
    found = np.where(read_kPa > 0.0, gauge.pressure_scale * read_kPa + gauge.pressure_offset_kPa, 0.0)
    below = (read_kPa > 0.0) & (found <= 0.0)
    if np.any(below):
        raise InputError(
            f"[gauge] pressure_offset_kPa is {gauge.pressure_offset_kPa:g}: the reading of "
            f"{read_kPa[below][0]:g} kPa would be {found[below][0]:g} kPa in truth; correct the offset"
        )
    return np.asarray(found)


def read_pressure_kPa(true_kPa: FloatArray, gauge: GaugeSection) -> FloatArray:
    """Return what the gauge shows at the given pressures in the actuator, shape (n,)."""
    shown = (true_kPa - gauge.pressure_offset_kPa) / gauge.pressure_scale
    return np.asarray(np.where(true_kPa > 0.0, shown, 0.0))
