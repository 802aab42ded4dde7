"""The two bending modes of a tip path: first extremum, reversal, second direction."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from spavision.tip_path import FloatArray, TipPath


@dataclass(frozen=True)
class Modes:
    """Where a tip path turns, x positive in the direction of the first bending mode.

    Parameters
    ----------
    first_extremum_mm : float
        Largest x displacement in the first direction.
    first_extremum_kPa : float
        Pressure of it, from the parabola through the largest reading and its two neighbours.
    sigma_extremum_mm, sigma_extremum_kPa : float
        Standard uncertainties: of the reading, and of the pressure, which the spacing of the readings limits
        (uniform over one spacing, hence spacing/√12).
    reverses : bool
        Whether the tip turns back before the last reading.
    second_extreme_mm : float
        Smallest x displacement after the first extremum: negative when the tip crosses to the other side.
    second_extreme_kPa : float
        Pressure of that reading.
    crosses_zero_kPa : float
        Pressure at which the tip, after the first extremum, passes its x of rest; NaN if it does not.
    """

    first_extremum_mm: float
    first_extremum_kPa: float
    sigma_extremum_mm: float
    sigma_extremum_kPa: float
    reverses: bool
    second_extreme_mm: float
    second_extreme_kPa: float
    crosses_zero_kPa: float


def find_modes(path: TipPath) -> Modes:
    """Find the modes of a path; the same function serves the measured and the modelled side.

    Parameters
    ----------
    path : TipPath
        At least one reading; gaps are passed over.

    Raises
    ------
    ValueError
        If the path holds no reading.
    """
    readings = path.readings()
    if not len(readings):
        raise ValueError("a path without a reading has no modes")
    pressure, ux = readings.pressure_kPa, readings.ux_mm
    top = int(np.argmax(ux))
    extremum_kPa, extremum_mm = _refined(pressure, ux, top)
    after = slice(top, None)
    low = top + int(np.argmin(ux[after]))
    return Modes(
        first_extremum_mm=extremum_mm,
        first_extremum_kPa=extremum_kPa,
        sigma_extremum_mm=float(readings.sigma_ux_mm[top]),
        sigma_extremum_kPa=_spacing(pressure, top) / np.sqrt(12.0),
        reverses=top < len(ux) - 1,
        second_extreme_mm=float(ux[low]),
        second_extreme_kPa=float(pressure[low]),
        crosses_zero_kPa=_zero_crossing(pressure[after], ux[after]),
    )


def _refined(pressure: FloatArray, ux: FloatArray, top: int) -> tuple[float, float]:
    """Return pressure and value of the vertex of the parabola through three readings."""
    if not 0 < top < len(ux) - 1:
        return float(pressure[top]), float(ux[top])
    local = slice(top - 1, top + 2)
    a, b, c = np.polyfit(pressure[local] - pressure[top], ux[local], 2)
    if a >= 0:
        return float(pressure[top]), float(ux[top])
    offset = -b / (2 * a)
    return float(pressure[top] + offset), float(c - b * b / (4 * a))


def _spacing(pressure: FloatArray, top: int) -> float:
    if len(pressure) == 1:
        return float("nan")
    neighbours = pressure[max(top - 1, 0) : top + 2]
    return float(np.mean(np.diff(neighbours)))


def _zero_crossing(pressure: FloatArray, ux: FloatArray) -> float:
    below = np.flatnonzero((ux[:-1] > 0) & (ux[1:] <= 0))
    if not len(below):
        return float("nan")
    i = int(below[0])
    return float(pressure[i] + ux[i] / (ux[i] - ux[i + 1]) * (pressure[i + 1] - pressure[i]))
