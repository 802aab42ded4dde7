"""Cheap stand-ins for the model, importable in worker processes, and cases for them."""

from __future__ import annotations

import importlib
from pathlib import Path
from types import ModuleType

import pytest

from spavision.correlate.study.case import Case
from spavision.experiment import Experiment

PRESSURES = (0.0, 10.0, 20.0)

STAND_IN = '''
import os
import signal
from pathlib import Path

from spavision.correlate.study.case import CaseResult, failed
from spavision.correlate.study.evaluate import evaluate

LOG = Path({log!r})


def linear(case):
    """ux = wall * p, uy = p; walls above 4.9 mm have no result."""
    wall = case.experiment.actuator.side_wall_mm
    with (LOG / "evaluated").open("a") as file:
        file.write(f"{{wall:.6f}}\\n")
    if wall > 4.9:
        return failed(case, "wall too thick")
    ux = tuple(wall * p for p in case.pressures_kPa)
    return CaseResult("ok", "", ux, tuple(case.pressures_kPa), 0.0)


def kill_once(case):
    """Kill the worker of the case with a wall of 3 mm, the first time."""
    mark = LOG / "killed"
    if case.experiment.actuator.side_wall_mm == 3.0 and not mark.exists():
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)


def killed_once(case):
    kill_once(case)
    return linear(case)


def reduced_killed_once(case):
    kill_once(case)
    return evaluate(case)


def killed_always(case):
    if case.experiment.actuator.side_wall_mm == 3.0:
        os.kill(os.getpid(), signal.SIGKILL)
    return linear(case)
'''


@pytest.fixture
def stand_in(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """A module that stands in for the model; worker processes can import it."""
    folder = tmp_path / "importable"
    folder.mkdir()
    (folder / "stand_in_for_the_model.py").write_text(STAND_IN.format(log=str(tmp_path)))
    monkeypatch.syspath_prepend(folder)
    monkeypatch.delitem(__import__("sys").modules, "stand_in_for_the_model", raising=False)
    return importlib.import_module("stand_in_for_the_model")


def wall_cases(walls: list[float], *, pressures_kPa: tuple[float, ...] = PRESSURES) -> list[Case]:
    """Cases that differ in the side wall."""
    nominal = Experiment().with_options({"model": {"mesh": "draft"}})
    return [
        Case(
            "reduced",
            nominal.with_options({"actuator": {"crimp_ratio": 0.2, "side_wall_mm": wall}}),
            pressures_kPa,
            {"side_wall_mm": wall},
        )
        for wall in walls
    ]


def silent(text: str, done: float) -> None:
    """Show no progress."""
