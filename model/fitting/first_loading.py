"""Cleaning a raw curve: measures, sign, loops, offset; every change is told in a note."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from spavision.errors import InputError

FloatArray = NDArray[np.float64]

REVERSAL = 0.01
"""Share of the range by which strain must fall back to count as unloading, not as noise."""

OFFSET = 0.002
"""Share of the range from which a stress at zero strain, or a strain at zero stress, is an offset."""

_AT_REST = 1e-3
"""Share of the range within which a strain counts as zero."""

_LARGEST_OFFSET = 0.5
"""Strain at zero stress that is no slack of a specimen any more."""

_LARGEST_STRETCH = 30.0
"""No silicone or rubber goes there: the strain must be in percent."""


@dataclass(frozen=True)
class Points:
    """Stretch and nominal stress, each (n,), with the notes so far.

    Parameters
    ----------
    stretch, stress_MPa : array, shape (n,)
    notes : tuple of str
    """

    stretch: FloatArray
    stress_MPa: FloatArray
    notes: tuple[str, ...] = ()

    def take(self, chosen: NDArray[np.bool_] | slice, note: str) -> Points:
        """Return the chosen points with one note more."""
        return Points(self.stretch[chosen], self.stress_MPa[chosen], (*self.notes, note))


def stretch_from(values: FloatArray, measure: str, *, source: str) -> FloatArray:
    """Turn strain (fractions) or stretch into stretch.

    Parameters
    ----------
    values : array, shape (n,)
        NaN stays NaN.
    measure : str
        ``strain``, ``stretch`` or ``true strain``.
    source : str
        File name for messages.

    Raises
    ------
    InputError
        If a stretch is not positive, or larger than any rubber's.
    """
    with np.errstate(over="ignore"):
        stretch = {"strain": 1.0 + values, "stretch": values, "true strain": np.exp(values)}[measure]
    if np.nanmin(stretch) <= 0.0:
        raise InputError(
            f"{source}: {measure} goes down to {np.nanmin(values):g}, which no body survives; give "
            f"{'--strain-measure strain' if measure == 'stretch' else '--strain-unit percent'} if that is "
            "what it is"
        )
    if np.nanmax(stretch) > _LARGEST_STRETCH:
        raise InputError(
            f"{source}: {measure} goes up to {np.nanmax(values):g}; give --strain-unit percent if it is in "
            "percent"
        )
    return stretch


def with_compression_negative(values: FloatArray, measure: str) -> tuple[FloatArray, tuple[str, ...]]:
    """Turn round the strains of a compression test that are written with a positive sign.

    Parameters
    ----------
    values : array, shape (n,)
        Strain; a stretch is below 1 in compression in any case and stays.
    measure : str
        As in `stretch_from`.
    """
    if measure == "stretch" or np.nanmax(values) <= -np.nanmin(values):
        return values, ()
    return -values, ("strain positive in compression: its sign is reversed",)


def first_loading(points: Points, *, source: str) -> Points:
    """Clean a curve: empty rows out, compression negative, first loading alone, through the origin.

    Parameters
    ----------
    points : Points
        As read.
    source : str
        File name for messages.

    Raises
    ------
    InputError
        If nothing is left, or the signs of strain and stress contradict each other.
    """
    filled = np.isfinite(points.stretch) & np.isfinite(points.stress_MPa)
    if not filled.all():
        points = points.take(filled, f"{(~filled).sum()} rows with empty cells left out")
    if len(points.stretch) < 2:
        raise InputError(
            f"{source}: {len(points.stretch)} rows have both strain and stress, expected two or more; a "
            "column may be empty"
        )
    return _through_origin(_up_to_reversal(_with_stress_sign(points, source)), source)


def _with_stress_sign(points: Points, source: str) -> Points:
    far = np.argmax(np.abs(np.log(points.stretch)))
    strain_sign, stress_sign = np.sign(points.stretch[far] - 1.0), np.sign(points.stress_MPa[far])
    if strain_sign < 0.0 < stress_sign:
        note = "stress positive in compression: its sign is reversed"
        return Points(points.stretch, -points.stress_MPa, (*points.notes, note))
    if stress_sign < 0.0 < strain_sign:
        raise InputError(
            f"{source}: stress is negative where strain is positive; give --mode compression if that is the "
            "test, else reverse the sign in the file"
        )
    return points


def _up_to_reversal(points: Points) -> Points:
    """Keep the points up to where strain first runs backwards; a table in falling order is turned round."""
    log_stretch = np.log(points.stretch)
    span = np.ptp(log_stretch)
    way = np.sign(_first_large_move(log_stretch, REVERSAL * span))
    travelled = way * log_stretch
    peak = np.maximum.accumulate(travelled)
    back = np.flatnonzero(travelled < peak - REVERSAL * span)
    if len(back) > 0:
        end = int(np.argmax(travelled[: back[0]])) + 1
        note = f"strain runs backwards after point {end} of {len(log_stretch)}: the first loading is taken"
        points = points.take(slice(0, end), note)
    if abs(np.log(points.stretch[-1])) < abs(np.log(points.stretch[0])) and not _crosses_rest(points):
        order = np.argsort(np.abs(np.log(points.stretch)), kind="stable")
        points = Points(points.stretch[order], points.stress_MPa[order], points.notes)
    return points


def _first_large_move(values: FloatArray, threshold: float) -> float:
    moved = np.flatnonzero(np.abs(values - values[0]) > threshold)
    return float(values[moved[0]] - values[0]) if len(moved) else 1.0


def _crosses_rest(points: Points) -> bool:
    """Whether the curve holds tension and compression, more than noise about rest."""
    strain = points.stretch - 1.0
    noise = _AT_REST * np.abs(strain).max()
    return bool(strain.max() > noise and strain.min() < -noise)


def _through_origin(points: Points, source: str) -> Points:
    """Take off a stress at zero strain, or a strain at which the stress starts from zero."""
    strain, stress = points.stretch - 1.0, points.stress_MPa
    reach, load = np.abs(strain).max(), np.abs(stress).max()
    if _crosses_rest(points) or load == 0.0:
        return points
    if abs(strain[0]) <= _AT_REST * reach and abs(stress[0]) > OFFSET * load:
        note = f"stress of {1e3 * stress[0]:.3g} kPa at zero strain: the curve is shifted by it"
        return Points(points.stretch, stress - stress[0], (*points.notes, note))
    if abs(stress[0]) <= 1e-6 * load and abs(strain[0]) > OFFSET * reach:
        if strain[0] > _LARGEST_OFFSET:
            raise InputError(
                f"{source}: strain is {strain[0]:.3g} at zero stress; give --strain-measure stretch if it is "
                "that, else take the slack out of the file"
            )
        note = f"strain of {100 * strain[0]:.3g} % at zero stress: the curve is shifted by it"
        return Points(points.stretch / points.stretch[0], stress, (*points.notes, note))
    return points
