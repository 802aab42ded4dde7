"""Reading the files that users write: comma-separated tables with a header line, and TOML."""

from __future__ import annotations

import csv
import io
import tomllib
from pathlib import Path
from typing import Any

import numpy as np

from spavision.errors import InputError
from spavision.tip_path import STATUSES, FloatArray, TipPath

PRESSURE_UNITS_kPa = {"kPa": 1.0, "Pa": 1e-3, "bar": 100.0, "mbar": 0.1, "psi": 6.894757, "MPa": 1000.0}
"""Kilopascals in one unit (psi: NIST SP 811, appendix B)."""


def read_tip_path(path: Path, *, pressure_unit: str = "kPa") -> TipPath:
    """Read a tip path from a CSV file with the columns ``pressure_kPa, ux_mm, uy_mm``.

    The optional columns ``sigma_ux_mm, sigma_uy_mm, photo, status, reason`` are taken where present. An empty
    displacement is a missing reading and keeps its row.

    Parameters
    ----------
    path : Path
        The file.
    pressure_unit : str
        Unit of the pressure column, a key of `PRESSURE_UNITS_kPa`; the column may then be called
        ``pressure_<unit>`` or ``pressure``.

    Raises
    ------
    InputError
        If the file cannot be read, a column is missing, a number is not one, or a pressure stands twice.
    """
    columns = read_columns(path)
    pressure_name = _pressure_column(columns, path, pressure_unit)
    _require(columns, ("ux_mm", "uy_mm"), path)
    pressure = numbers(columns, pressure_name, path) * PRESSURE_UNITS_kPa[pressure_unit]
    _refuse_repeated(pressure, path)
    if np.any(pressure < 0):
        raise InputError(
            f"{path}: {pressure_name} holds {pressure.min():g}, expected gauge pressures of 0 or more"
        )
    empty = np.full(len(pressure), np.nan)

    def optional(name: str) -> FloatArray:
        return numbers(columns, name, path, allow_empty=True) if name in columns else empty

    status = tuple(columns.get("status", ()))
    unknown = sorted(set(status) - set(STATUSES))
    if unknown:
        raise InputError(f"{path}: status {unknown[0]!r} is unknown, expected one of {', '.join(STATUSES)}")
    path_read = TipPath(
        pressure_kPa=pressure,
        ux_mm=numbers(columns, "ux_mm", path, allow_empty=True),
        uy_mm=numbers(columns, "uy_mm", path, allow_empty=True),
        sigma_ux_mm=optional("sigma_ux_mm"),
        sigma_uy_mm=optional("sigma_uy_mm"),
        photo=tuple(columns.get("photo", ())),
        status=status,
        reason=tuple(columns.get("reason", ())),
    )
    return path_read.take(np.argsort(pressure, kind="stable"))


def read_columns(path: Path) -> dict[str, list[str]]:
    """Read a comma-separated file with a header line into lists of text, one a column.

    Raises
    ------
    InputError
        If the file cannot be read, is not UTF-8 text, is empty, uses semicolons, or has ragged lines.
    """
    try:
        text = path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror}); name an existing CSV file") from error
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: is not UTF-8 text; save the table as CSV in UTF-8") from error
    header_line = next((line for line in text.splitlines() if line.strip()), "")
    if not header_line:
        raise InputError(f"{path}: is empty, expected a header line and one line a pressure")
    if ";" in header_line:
        raise InputError(
            f"{path}: is separated by semicolons, expected commas with decimal points; save it as such"
        )
    rows = [row for row in csv.reader(io.StringIO(text)) if any(cell.strip() for cell in row)]
    header = [name.strip() for name in rows[0]]
    if len(set(header)) < len(header):
        twice = next(name for name in header if header.count(name) > 1)
        raise InputError(f"{path}: column {twice!r} stands twice; keep one of them")
    if len(rows) == 1:
        raise InputError(f"{path}: holds a header line only, expected one line a pressure below it")
    for number, row in enumerate(rows[1:], start=2):
        if len(row) != len(header):
            raise InputError(
                f"{path}: row {number} has {len(row)} cells, the header has {len(header)}; mend that row"
            )
    return {name: [row[index].strip() for row in rows[1:]] for index, name in enumerate(header)}


def read_toml(path: Path) -> dict[str, Any]:
    """Read a TOML file.

    Raises
    ------
    InputError
        If the file cannot be read or is not TOML.
    """
    try:
        return tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror}); name an existing TOML file") from error
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: is not UTF-8 text; save the file as UTF-8") from error
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{path}: is not valid TOML ({error}); correct that line") from error


def numbers(columns: dict[str, list[str]], name: str, path: Path, *, allow_empty: bool = False) -> FloatArray:
    """Convert one column to numbers, shape (n,); an empty cell becomes NaN where that is allowed.

    Raises
    ------
    InputError
        If a cell is not a finite number.
    """
    values = np.empty(len(columns[name]))
    for index, cell in enumerate(columns[name]):
        if not cell and allow_empty:
            values[index] = np.nan
            continue
        try:
            values[index] = float(cell)
        except ValueError:
            values[index] = np.inf
        if np.isnan(values[index]) and allow_empty:
            continue
        if not np.isfinite(values[index]):
            raise InputError(
                f"{path}: {name} in row {index + 2} is {cell!r}, "
                "expected a number such as 12.5; mend that cell"
            )
    return values


def _pressure_column(columns: dict[str, list[str]], path: Path, unit: str) -> str:
    candidates = (f"pressure_{unit}", "pressure")
    for name in candidates:
        if name in columns:
            return name
    raise InputError(
        f"{path}: column {candidates[0]} is missing (it has {', '.join(columns)}); "
        "add it, or name the unit with --pressure-unit"
    )


def _require(columns: dict[str, list[str]], names: tuple[str, ...], path: Path) -> None:
    for name in names:
        if name not in columns:
            raise InputError(
                f"{path}: column {name} is missing (it has {', '.join(columns)}); add or rename it"
            )


def _refuse_repeated(pressure_kPa: FloatArray, path: Path) -> None:
    values, counts = np.unique(pressure_kPa, return_counts=True)
    if np.any(counts > 1):
        raise InputError(
            f"{path}: pressure {values[counts > 1][0]:g} kPa stands {counts.max()} times; "
            "keep one row a pressure"
        )
