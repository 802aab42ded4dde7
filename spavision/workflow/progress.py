"""Progress on a terminal's standard error; silent elsewhere."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

Advance = Callable[[str, float], None]
"""Called with what was just done and how much of the total is done by now."""


@contextmanager
def progress_bar(title: str, *, total: float, quiet: bool) -> Iterator[Advance]:
    """Show a progress bar while the block runs.

    Parameters
    ----------
    title : str
        What is being done.
    total : float
        Value of ``done`` at which the bar is full.
    quiet : bool
        Show nothing, even on a terminal.
    """
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    console = Console(stderr=True)
    columns = (
        TextColumn(title),
        BarColumn(),
        TextColumn("{task.description}"),
        TimeElapsedColumn(),
    )
    with Progress(
        *columns, console=console, transient=True, disable=quiet or not console.is_terminal
    ) as progress:
        task = progress.add_task("", total=total)
        yield lambda description, done: progress.update(task, description=description, completed=done)
