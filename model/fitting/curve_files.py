"""Reading test data: files of machines, databases and papers as they are."""

from __future__ import annotations

import codecs
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from spavision.errors import InputError
from spavision.model.materials.curves import EQUIBIAXIAL, PLANAR, UNIAXIAL

from .column_names import STRAIN_UNITS, Column, STRESS_UNITS_MPa, strain_columns, stress_columns
from .first_loading import Points, first_loading, stretch_from, with_compression_negative
from .measured_curve import FloatArray, MeasuredCurve
from .plausibility import compression_doubts
from .text_table import TextTable, parse_table

COMPRESSION = "compression"
"""Mode name of a uniaxial test whose strains may be written with a positive sign."""

TENSION, UNTOLD = "tension", "uniaxial"
"""Mode names of uniaxial tests whose strains have the sign that is written."""

MODE_NAMES = {
    UNTOLD: UNIAXIAL,
    TENSION: UNIAXIAL,
    COMPRESSION: UNIAXIAL,
    "equibiaxial": EQUIBIAXIAL,
    "planar": PLANAR,
}

_MODE_WORDS = (
    ("equibiaxial", re.compile(r"(?<![a-z])(equi ?)?biax(ial)?(?![a-z])")),
    ("planar", re.compile(r"(?<![a-z])(planar|pure shear)(?![a-z])")),
    (COMPRESSION, re.compile(r"(?<![a-z])(compression|compressive|iso 7743)(?![a-z])")),
    (TENSION, re.compile(r"(?<![a-z])(tension|tensile|iso 37|astm d412)(?![a-z])")),
    (UNTOLD, re.compile(r"(?<![a-z])uniax(ial)?(?![a-z])")),
)
"""Words in a file's name, its folder's name or its preamble that tell the mode, the first match taken."""

_MODE_CODES = {"ut": TENSION, "uc": COMPRESSION, "et": "equibiaxial", "bt": "equibiaxial", "ps": "planar"}
"""Whole names of files or folders that do."""

_PREAMBLE_LENGTH = 2000

_LARGE_STRAIN = 3.0
"""A strain without a unit that goes further may be in percent."""


@dataclass(frozen=True)
class CurveFormat:
    """What the user says about a file; None where it shall be recognised.

    Parameters
    ----------
    mode : str or None
        A key of `MODE_NAMES`.
    columns : tuple of str
        Column names in place of those in the file, such as ``("stress_MPa", "stretch")``.
    strain_measure : str or None
        ``strain``, ``stretch`` or ``true strain``.
    strain_unit : str or None
        ``fraction`` or ``percent``.
    stress_measure : str or None
        ``nominal`` or ``true``.
    stress_unit : str or None
        A key of `STRESS_UNITS_MPa`.
    may_stiffen : bool
        Whether a curve that rises ever more steeply is believed to be tension, as one of the composite.
    """

    mode: str | None = None
    columns: tuple[str, ...] = ()
    strain_measure: str | None = None
    strain_unit: str | None = None
    stress_measure: str | None = None
    stress_unit: str | None = None
    may_stiffen: bool = False


def read_curve(path: Path, form: CurveFormat | None = None) -> MeasuredCurve:
    """Read the first loading curve of a test.

    Parameters
    ----------
    path : Path
        Text file: semicolons, commas, tabs or blanks between the cells; preamble and header or neither.
    form : CurveFormat, optional
        What goes before that which the file tells of itself.

    Raises
    ------
    InputError
        If the file cannot be read, or it is not clear which columns hold strain and stress.
    """
    form = form or CurveFormat()
    source = str(path)
    text = _text_of(path)
    table = parse_table(text, source=source)
    names = _column_names(table, form, source)
    mode_name, mode_notes = _mode(path, text, form)

    def read_as(mode_name: str) -> MeasuredCurve:
        points = _points(table, names, form, mode_name, source)
        notes = (*mode_notes, *points.notes)
        return MeasuredCurve(
            _short_name(path), MODE_NAMES[mode_name], points.stretch, points.stress_MPa, notes
        )

    curve = read_as(mode_name)
    if "crosshead" in text[:_PREAMBLE_LENGTH].lower():
        curve = curve.noted("strain from the crosshead: too large where the grips let slip")
    if mode_name == UNTOLD and form.mode is None and not form.may_stiffen:
        curve = curve.noted(*compression_doubts(curve, lambda: read_as(COMPRESSION), source=source))
    return curve


def with_distinct_names(curves: Sequence[MeasuredCurve], paths: Sequence[Path]) -> tuple[MeasuredCurve, ...]:
    """Put the folder before the names that more than one file bears, and the file's number if need be.

    Raises
    ------
    InputError
        If a file is given twice.
    """
    for path in paths:
        if sum(path.resolve() == other.resolve() for other in paths) > 1:
            raise InputError(f"{path}: is given twice; leave one out (--weights gives a file more weight)")
    names = [curve.name for curve in curves]
    longer = [
        f"{path.resolve().parent.name}/{path.stem}" if names.count(name) > 1 else name
        for name, path in zip(names, paths, strict=True)
    ]
    return tuple(
        replace(curve, name=f"{name} ({number})" if longer.count(name) > 1 else name)
        for number, (curve, name) in enumerate(zip(curves, longer, strict=True), start=1)
    )


def _points(
    table: TextTable, names: tuple[str, ...], form: CurveFormat, mode_name: str, source: str
) -> Points:
    """First loading as stretch and nominal stress."""
    stretch, strain_notes = _stretch(table, names, form, mode_name, source)
    stress, is_true, stress_notes = _stress(table, names, form, source)
    if is_true:
        # an incompressible body's section shrinks by λ in the loaded direction, in each of the three tests
        stress = stress / stretch
    return first_loading(Points(stretch, stress, (*strain_notes, *stress_notes)), source=source)


def _text_of(path: Path) -> str:
    try:
        content = path.read_bytes()
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror}); name an existing text file") from error
    if content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return content.decode("utf-16", errors="replace")
    if b"\0" in content:
        raise InputError(f"{path}: is not a text file; save the table as CSV")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        return content.decode("latin-1")


def _short_name(path: Path) -> str:
    """File name, with its folder's where the name alone says little."""
    generic = {"stress_stretch", "data", "curve"}
    return f"{path.parent.name}/{path.stem}" if path.stem in generic else path.stem


def _column_names(table: TextTable, form: CurveFormat, source: str) -> tuple[str, ...]:
    names = form.columns or table.header
    if not names:
        raise InputError(
            f"{source}: has no header line to tell its {table.width} columns apart; name them, for example "
            "--columns strain,stress_MPa"
        )
    if len(names) != table.width:
        raise InputError(
            f"{source}: --columns names {len(names)} columns, the file has {table.width}; name each of them, "
            "'-' for one to leave out"
        )
    return names


def _stretch(
    table: TextTable, names: tuple[str, ...], form: CurveFormat, mode_name: str, source: str
) -> tuple[FloatArray, tuple[str, ...]]:
    column, notes = _choose(strain_columns(names), form.strain_measure, "strain", names, source)
    measure = form.strain_measure or column.measure or "strain"
    unit = form.strain_unit or column.unit or "fraction"
    if column.measure is None and form.strain_measure is None:
        notes = (*notes, "strain taken as engineering strain")
    values = np.array(table.column(column.index, source=source)) * STRAIN_UNITS[unit]
    _refuse_empty(values, names[column.index], source)
    if measure != "stretch" and (form.strain_unit or column.unit) is None:
        notes = (*notes, *_fraction_notes(float(np.nanmax(np.abs(values)))))
    if mode_name == COMPRESSION:
        values, sign_notes = with_compression_negative(values, measure)
        notes = (*notes, *sign_notes)
    return stretch_from(values, measure, source=source), notes


def _fraction_notes(largest: float) -> tuple[str, ...]:
    if largest <= _LARGE_STRAIN:
        return ()
    return (
        f"strain taken as a fraction, up to {100.0 * largest:.4g} %: --strain-unit percent if it is percent",
    )


def _stress(
    table: TextTable, names: tuple[str, ...], form: CurveFormat, source: str
) -> tuple[FloatArray, bool, tuple[str, ...]]:
    """Stress in MPa, whether it is true stress, and notes."""
    column, notes = _choose(stress_columns(names), form.stress_measure, "stress", names, source)
    measure = form.stress_measure or column.measure
    unit = form.stress_unit or column.unit
    if measure is None:
        notes = (*notes, "stress taken as nominal stress")
    if unit is None:
        notes = (*notes, "stress taken to be in MPa")
    if column.unit not in (None, unit):
        notes = (*notes, f"stress taken to be in {unit} as told, though its column says {column.unit}")
    values = np.array(table.column(column.index, source=source)) * STRESS_UNITS_MPa[unit or "MPa"]
    _refuse_empty(values, names[column.index], source)
    return values, measure == "true", notes


def _choose(
    found: list[Column], wanted: str | None, quantity: str, names: tuple[str, ...], source: str
) -> tuple[Column, tuple[str, ...]]:
    """Take the column of the wanted measure, else the first that is not a true one."""
    if not found:
        raise InputError(
            f"{source}: no column is named {quantity} (it has {', '.join(names)}); name the columns with "
            "--columns, force and extension first divided by section and gauge length"
        )
    if wanted is not None:
        exact = [column for column in found if column.measure == wanted]
        return (exact or found)[0], ()
    conventional = [column for column in found if not (column.measure or "").startswith("true")]
    chosen = (conventional or found)[0]
    if len(found) > 1:
        return chosen, (f"column {names[chosen.index]!r} taken for {quantity}",)
    return chosen, ()


def _refuse_empty(values: FloatArray, name: str, source: str) -> None:
    if not np.isfinite(values).any():
        raise InputError(f"{source}: column {name!r} is empty; fill it or name another with --columns")


def _mode(path: Path, text: str, form: CurveFormat) -> tuple[str, tuple[str, ...]]:
    if form.mode is not None:
        return form.mode, ()
    for place, words in (("name", path.stem), ("folder", path.parent.name)):
        if words.lower() in _MODE_CODES:
            return _MODE_CODES[words.lower()], (f"{_MODE_CODES[words.lower()]} test, by the file's {place}",)
    for place, words in (
        ("name", path.stem),
        ("folder", path.parent.name),
        ("preamble", text[:_PREAMBLE_LENGTH]),
    ):
        plain = re.sub(r"[_\-\s]+", " ", words).lower()
        told = [name for name, pattern in _MODE_WORDS if pattern.search(plain)]
        # a machine for tension and compression does not tell which of them was made
        told = told if not {COMPRESSION, TENSION} <= set(told) else []
        if told:
            return told[0], (f"{told[0]} test, by the file's {place}",)
    return UNTOLD, ("uniaxial test assumed; --mode names another",)
