"""What commands print and the text form of tables."""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    pass

TEXT_COLUMNS = ("remark", "basis")
"""Columns of whole sentences, which may be folded."""

PLAIN_WIDTH = 160
"""Columns of a table that is not printed to a terminal."""


def print_json(content: Mapping[str, Any]) -> None:
    """Print a result on standard output as JSON."""
    click.echo(json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False))


def print_table(title: str, header: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    """Print a table on standard output; numbers right-aligned, texts (`TEXT_COLUMNS`) left-aligned."""
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    table = Table(title=title, title_justify="left", title_style="bold")
    for name in header:
        text = name in TEXT_COLUMNS
        table.add_column(name, justify="left" if text else "right", no_wrap=not text)
    for row in rows:
        table.add_row(*(Text(cell) for cell in row))
    # A pipe or a log has no width of its own: the table must not be folded to 80 columns there.
    Console(width=None if sys.stdout.isatty() else PLAIN_WIDTH).print(table)


def print_lines(lines: Sequence[str]) -> None:
    """Print sentences on standard output, one a line."""
    for line in lines:
        click.echo(line)


def warn(sentence: str) -> None:
    """Print one sentence of warning on standard error."""
    click.echo(f"spavision: note: {sentence}", err=True)


def default_output(command: str, name: str) -> Path:
    """Return the results folder that a command writes to unless told otherwise."""
    return Path("results") / f"{command}-{name}"
