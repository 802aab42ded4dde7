"""Finding the numbers in a text file: separator, decimal sign, preamble, header."""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass

from spavision.errors import InputError

SEPARATORS = {";": "semicolon", "\t": "tab", ",": "comma", " ": "blank"}
"""What may stand between cells, with names, in order of preference."""

_UNITS_IN_BRACKETS = ("(", "[")


@dataclass(frozen=True)
class TextTable:
    """The rows of numbers of a file and the names above them.

    Parameters
    ----------
    header : tuple of str
        Column names, empty where the file has none.
    rows : tuple of tuple of str
        Cells with decimal points, every row as long as the first.
    line_numbers : tuple of int
        Line of the file that each row stands on, from 1.
    """

    header: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    line_numbers: tuple[int, ...]

    @property
    def width(self) -> int:
        """Number of columns."""
        return len(self.rows[0])

    def column(self, index: int, *, source: str) -> list[float]:
        """Return a column as numbers, NaN for an empty cell.

        Raises
        ------
        InputError
            If a cell is neither empty nor a finite number, naming its line.
        """
        values = []
        for cells, line in zip(self.rows, self.line_numbers, strict=True):
            value = _number(cells[index]) if cells[index] else math.nan
            if value is None or math.isinf(value):
                raise InputError(
                    f"{source}: line {line} holds {cells[index]!r} in column {index + 1}, expected a number; "
                    "mend the cell or remove the line"
                )
            values.append(value)
        return values


def parse_table(text: str, *, source: str) -> TextTable:
    """Find the table of numbers in the text of a file.

    Lines above the first row of numbers are a preamble whose last line is taken as the header if it has as
    many cells; a line of units in brackets below the names is joined to them. Lines that start with ``#``
    are comments. Decimal commas are read where commas do not separate the cells.

    Parameters
    ----------
    text : str
    source : str
        The file's name for messages.

    Raises
    ------
    InputError
        If there is no row with two numbers, or the rows differ in length.
    """
    lines = [
        (number, line)
        for number, line in enumerate(text.splitlines(), start=1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    separator = max(SEPARATORS, key=lambda each: sum(_is_data(_cells(line, each)) for _, line in lines))
    split = [(number, _cells(line, separator)) for number, line in lines]
    first = next((index for index, (_, cells) in enumerate(split) if _is_data(cells)), None)
    if first is None:
        raise InputError(
            f"{source}: no line holds two numbers, expected columns of strain and stress separated by "
            "semicolons, commas, tabs or blanks, neither of them empty"
        )
    width = len(split[first][1])
    header = _header([cells for _, cells in split[:first]], width)
    below = split[first:]
    for number, cells in below:
        if len(cells) != width:
            raise InputError(
                f"{source}: line {number} has {len(cells)} cells, the first row of numbers has {width}; "
                "mend or remove that line"
            )
    return TextTable(header, tuple(cells for _, cells in below), tuple(number for number, _ in below))


def _cells(line: str, separator: str) -> tuple[str, ...]:
    cells = line.split() if separator == " " else next(csv.reader([line], delimiter=separator))
    stripped = tuple(cell.strip() for cell in cells)
    return stripped if separator == "," else tuple(_with_point(cell) for cell in stripped)


def _with_point(cell: str) -> str:
    """Replace a decimal comma."""
    pointed = cell.replace(",", ".", 1)
    return pointed if _number(pointed) is not None else cell


def _number(cell: str) -> float | None:
    try:
        return float(cell)
    except ValueError:
        return None


def _is_data(cells: tuple[str, ...]) -> bool:
    """Whether a line holds two numbers or more, and they are at least half of what it holds."""
    filled = [cell for cell in cells if cell]
    numbers = sum(_number(cell) is not None for cell in filled)
    return numbers >= 2 and 2 * numbers >= len(filled)


def _header(preamble: list[tuple[str, ...]], width: int) -> tuple[str, ...]:
    if not preamble or len(preamble[-1]) != width:
        return ()
    last = preamble[-1]
    is_units = all(cell.startswith(_UNITS_IN_BRACKETS) for cell in last if cell)
    if is_units and len(preamble) > 1 and len(preamble[-2]) == width:
        return tuple(f"{name} {unit}".strip() for name, unit in zip(preamble[-2], last, strict=True))
    return last
