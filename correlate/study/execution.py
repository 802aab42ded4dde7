"""How a study's cases are run: one after the other, in processes, or on a Dask cluster."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

Evaluate = Callable[[Any], Any]

ATTEMPTS = 3
"""Times that a case is tried whose worker dies under it."""


@dataclass(frozen=True)
class Finished:
    """A case that is done.

    Parameters
    ----------
    index : int
        Its place among the cases.
    result : object or None
        What the evaluation returned; None where the case was lost.
    reason : str
        Why it was lost.
    """

    index: int
    result: Any = None
    reason: str = ""


@dataclass(frozen=True)
class Machine:
    """Where cases are run.

    Parameters
    ----------
    workers : int
        Processes on this machine; 1 runs them in this one.
    scheduler : str
        Address of a Dask scheduler, such as ``tcp://host:8786``; empty for this machine.
    """

    workers: int = 1
    scheduler: str = ""


def run_cases(evaluate: Evaluate, cases: Sequence[object], machine: Machine) -> Iterator[Finished]:
    """Run cases, in no particular order.

    Parameters
    ----------
    evaluate : callable
        Takes a case; must be importable by name where other processes run it.
    cases : sequence
    machine : Machine

    Yields
    ------
    Finished
        Each case once, as they finish.

    Raises
    ------
    InputError
        If the scheduler does not answer or Dask is not installed.
    """
    if machine.scheduler:
        from .dask_workers import run_on_dask

        yield from run_on_dask(evaluate, cases, address=machine.scheduler)
    elif machine.workers > 1:
        from .processes import run_in_processes

        yield from run_in_processes(evaluate, cases, workers=machine.workers)
    else:
        yield from (Finished(index, evaluate(case)) for index, case in enumerate(cases))


def lost(index: int) -> Finished:
    """Return what becomes of a case under which every worker died."""
    return Finished(
        index,
        reason=f"its worker died at each of {ATTEMPTS} attempts (killed, or out of memory); run the study "
        "again",
    )
