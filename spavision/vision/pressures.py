"""Pressures of the photographs: from their names, from a table, or from a step the user states."""

from __future__ import annotations

import re
import warnings
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from spavision.errors import InputError, InputWarning

from .arrays import FloatArray
from .photos import natural_key

if TYPE_CHECKING:
    import pandas as pd


KPA_PER_UNIT = {"pa": 1e-3, "hpa": 0.1, "kpa": 1.0, "mpa": 1e3, "mbar": 0.1, "bar": 100.0, "psi": 6.894757}
# MPa alone is told apart from a milli-pascal by nobody's file names, so case does not matter.

WITH_UNIT = re.compile(
    r"(\d+[a-z](?=\d))?(?<![\d.,])(\d+(?:[.,]\d+)?)\s?[_-]?(hpa|kpa|mpa|pa|mbar|bar|psi)(?![a-z])", re.I
)
WITH_P = re.compile(r"(?<![a-z\d])p[_-]?(\d+(?:[.,]\d+)?)(?![a-z\d.,]*\d)", re.I)
P_AND_DIGIT = re.compile(r"(?<![a-z\d])p[_-]?\d+[_-]\d(?!\d)", re.I)
SUFFIX = re.compile(r"\.(jpe?g|png|tiff?|bmp|webp)$", re.I)


def pressures_from_names(names: Sequence[str]) -> FloatArray:
    """Read each photograph's pressure from its name, kPa.

    Understood are a number with a unit (``IMG_0003_010kPa.jpg``, ``5kPa.png``, ``0.05bar.tif``) or, where no
    name has a unit, one number after the letter p (``p005.jpg``). Bare numbers are counters as often as
    pressures, so they are refused.

    Returns
    -------
    array, shape (n,)
        Pressures in the order of ``names``.

    Raises
    ------
    InputError
        Listing the names whose pressure cannot be told, or is told twice.
    """
    stems = [SUFFIX.sub("", name) for name in names]
    told = [_with_unit(stem) for stem in stems]
    if not any(told):
        told = [_with_p(stem) for stem in stems]
    unclear = [name for name, values in zip(names, told, strict=True) if len(set(values)) != 1]
    if unclear:
        raise InputError(
            f"the pressure cannot be told from the name of {_listed(unclear)}; name photos like "
            "IMG_0003_010kPa.jpg or p005.jpg, or give --pressures CSV (photo, pressure_kPa)"
        )
    pressures = np.array([values[0] for values in told])
    _refuse_duplicates(names, pressures)
    return pressures


def pressures_from_table(frame: pd.DataFrame, names: Sequence[str]) -> FloatArray:
    """Look up each photograph's pressure in a table with the columns ``photo`` and ``pressure_kPa``.

    Rows of photographs that are not there are left alone, with an `InputWarning`.

    Raises
    ------
    InputError
        If a column is missing, a pressure is no number, or a photograph is absent or listed twice.
    """
    missing = [column for column in ("photo", "pressure_kPa") if column not in frame.columns]
    if missing:
        raise InputError(
            f"the pressure table lacks the column {' and '.join(missing)}; "
            f"it has {', '.join(map(str, frame.columns))}"
        )
    listed: dict[str, float] = {}
    for photo, value in zip(frame["photo"].astype(str).str.strip(), frame["pressure_kPa"], strict=True):
        if photo in listed:
            raise InputError(f"the pressure table lists {photo} twice; keep one row a photo")
        try:
            listed[photo] = float(value)
        except (TypeError, ValueError) as error:
            raise InputError(
                f"the pressure of {photo} in the pressure table is {value!r}; expected a number"
            ) from error
        if not np.isfinite(listed[photo]):
            raise InputError(f"the pressure of {photo} in the pressure table is empty; expected a number")
    absent = [name for name in names if name not in listed]
    if absent:
        raise InputError(
            f"the pressure table has no row for {_listed(absent)}; add one, or move the photos away"
        )
    idle = sorted(set(listed) - set(names), key=natural_key)
    if idle:
        message = f"the pressure table lists {_listed(idle)}, which the folder does not hold"
        warnings.warn(message, InputWarning, stacklevel=2)
    pressures = np.array([listed[name] for name in names])
    _refuse_duplicates(names, pressures)
    return pressures


def pressures_from_list(names: Sequence[str], pressures_kPa: Sequence[float]) -> FloatArray:
    """Give pressures to the photographs in the natural order of their names, kPa.

    Raises
    ------
    InputError
        If there are not as many pressures as photographs.
    """
    if len(names) != len(pressures_kPa):
        raise InputError(
            f"--pressures-kpa gives {len(pressures_kPa)} pressures, but there are {len(names)} photos; "
            "expected one pressure a photo, so correct the list or use --pressures CSV (photo, pressure_kPa)"
        )
    return _in_natural_order(names, np.asarray(pressures_kPa, dtype=float))


def pressures_from_step(names: Sequence[str], step_kPa: float) -> FloatArray:
    """Count up from 0 in equal steps along the natural order of the names, kPa.

    Raises
    ------
    InputError
        If the step is not positive, or the names' numbers skip one, so that a photograph may be missing.
    """
    if not (np.isfinite(step_kPa) and step_kPa > 0):
        raise InputError(f"--pressure-step-kpa is {step_kPa:g}; expected a number above 0")
    _refuse_gap(sorted(names, key=natural_key))
    return _in_natural_order(names, np.arange(len(names), dtype=float) * step_kPa)


def _in_natural_order(names: Sequence[str], values: FloatArray) -> FloatArray:
    order = sorted(range(len(names)), key=lambda k: natural_key(names[k]))
    pressures = np.empty(len(names))
    pressures[order] = values
    return pressures


def _refuse_gap(names: list[str]) -> None:
    """Refuse names whose counter goes up by one but for a skip: a photograph may be missing there."""
    numbers = [re.findall(r"\d+", SUFFIX.sub("", name)) for name in names]
    if len({len(found) for found in numbers}) != 1:
        return
    for counter in zip(*numbers, strict=True):
        steps = np.diff([int(text) for text in counter])
        # A date or a time of day does not go up by one from most photographs to the next.
        if np.count_nonzero(steps == 1) >= 0.5 * len(steps) and steps.min() >= 1 and steps.max() > 1:
            skip = int(np.argmax(steps > 1))
            raise InputError(
                f"the numbering skips from {names[skip]} to {names[skip + 1]}, so a photo may be missing and "
                "--pressure-step-kpa cannot be trusted; give each photo's pressure with --pressures CSV, or "
                "all of them with --pressures-kpa"
            )


def _with_unit(stem: str) -> list[float]:
    """Every pressure with a unit in a name; a letter for a decimal point (0p5kPa) makes it unclear."""
    found = WITH_UNIT.findall(stem)
    if any(letter_before for letter_before, _, _ in found):
        return [np.nan, np.inf]
    return [
        round(float(number.replace(",", ".")) * KPA_PER_UNIT[unit.lower()], 9) for _, number, unit in found
    ]


def _with_p(stem: str) -> list[float]:
    """Every pressure after the letter p in a name; a single digit after it (p1_5, p1-5) makes it unclear."""
    if P_AND_DIGIT.search(stem):
        return [np.nan, np.inf]
    return [float(text.replace(",", ".")) for text in WITH_P.findall(stem)]


def _refuse_duplicates(names: Sequence[str], pressures: FloatArray) -> None:
    values, counts = np.unique(pressures, return_counts=True)
    if (counts > 1).any():
        value = values[counts > 1][0]
        same = [name for name, pressure in zip(names, pressures, strict=True) if pressure == value]
        raise InputError(f"{_listed(same)} all claim {value:g} kPa; keep one photo a pressure")


def _listed(names: Sequence[str]) -> str:
    shown = ", ".join(names[:8])
    return shown if len(names) <= 8 else f"{shown} and {len(names) - 8} more"
