"""An interrupted ramp as a file, from which a later run goes on."""

from __future__ import annotations

import zipfile
from dataclasses import astuple, fields
from pathlib import Path

import numpy as np

from .elements import FloatArray
from .journal import Checkpoint
from .ramp_path import RampPlace, Waypoint
from .simulation import StepRecord
from .state import State

_PARTS = tuple(part.name for part in fields(State))


def write_checkpoint(path: Path, checkpoint: Checkpoint, *, run: str) -> None:
    """Write a checkpoint.

    Parameters
    ----------
    path : Path
        Ending in ``.npz``.
    checkpoint : Checkpoint
    run : str
        Everything that the ramp depends on, in words; a run with others is not continued.
    """
    plain = (part.name for part in fields(Checkpoint) if part.name not in ("place", "steps"))
    content = {name: np.asarray(getattr(checkpoint, name)) for name in plain}
    content["run"] = np.array(run)
    content["step_kPa"] = np.array(checkpoint.place.step_kPa)
    content["steps"] = np.array([astuple(step) for step in checkpoint.steps], dtype=float)
    content["waypoints_kPa"] = np.array([point.pressure_kPa for point in checkpoint.place.history])
    for number, point in enumerate(checkpoint.place.history):
        for name, state in (("state", point.state), ("rate", point.rate)):
            content |= _arrays_of(state, f"{number}.{name}")
    path.parent.mkdir(parents=True, exist_ok=True)
    np.savez(path, **content)  # type: ignore[arg-type]


def read_checkpoint(path: Path, *, run: str) -> Checkpoint | None:
    """Read a checkpoint; None where there is none, or one of another run."""
    try:
        with np.load(path) as file:
            content = dict(file)
    except (OSError, ValueError, zipfile.BadZipFile):
        return None
    if str(content["run"]) != run:
        return None
    history = []
    for number, pressure_kPa in enumerate(content["waypoints_kPa"]):
        state, rate = (_state_of(content, f"{number}.{name}") for name in ("state", "rate"))
        if state is None:
            return None
        history.append(Waypoint(float(pressure_kPa), state, rate))
    return Checkpoint(
        place=RampPlace(tuple(history), float(content["step_kPa"])),
        steps=tuple(_record_of(row) for row in content["steps"]),
        displacement_mm=content["displacement_mm"],
        enclosed_volume_mm3=content["enclosed_volume_mm3"],
        energy_at_rest_mJ=float(content["energy_at_rest_mJ"]),
        gravity_work_at_rest_mJ=float(content["gravity_work_at_rest_mJ"]),
    )


def _arrays_of(state: State | None, prefix: str) -> dict[str, FloatArray]:
    if state is None:
        return {}
    parts = {f"{prefix}.{part}": getattr(state, part) for part in _PARTS}
    return {name: array for name, array in parts.items() if array is not None}


def _state_of(content: dict[str, FloatArray], prefix: str) -> State | None:
    parts = {part: content.get(f"{prefix}.{part}") for part in _PARTS}
    return None if parts["displacement"] is None else State(**parts)  # type: ignore[arg-type]


def _record_of(row: FloatArray) -> StepRecord:
    """Return a record from a row of numbers, of which some are whole and one may be missing."""
    values = dict(zip((one.name for one in fields(StepRecord)), row.tolist(), strict=True))
    pivots = values["negative_pivots"]
    values["newton_iterations"] = int(values["newton_iterations"])
    values["negative_pivots"] = None if np.isnan(pivots) else int(pivots)
    return StepRecord(**values)
