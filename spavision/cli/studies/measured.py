"""The measured paths that a study is held against."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from spavision.correlate.discrepancy import in_bending_axes
from spavision.errors import InputError
from spavision.tables import read_tip_path
from spavision.tip_path import TipPath

from .setup import Setup


@dataclass(frozen=True)
class MeasuredPath:
    """A measured path in the model's axes.

    Parameters
    ----------
    path : TipPath
    crimp_ratio : float or None
        The study's where None.
    file : Path
    """

    path: TipPath
    crimp_ratio: float | None
    file: Path

    def record(self) -> dict[str, Any]:
        """Return what ``run.json`` keeps of it: the file's name and the readings."""
        readings = self.path.readings()
        columns = ("pressure_kPa", "ux_mm", "uy_mm")
        return {"file": self.file.name, **{name: getattr(readings, name).tolist() for name in columns}}


def measured_paths(setup: Setup, given: Path | None) -> list[MeasuredPath]:
    """Read the measured paths: the one given as an option before those of the study file.

    Raises
    ------
    InputError
        If there is none, or a file is not valid.
    """
    side = setup.nominal.actuator.first_bend
    found = []
    if given is not None:
        found.append(MeasuredPath(in_bending_axes(read_tip_path(given), first_bend=side), None, given))
    for one in setup.study.measured:
        file = setup.beside(one.path)
        read = read_tip_path(file, pressure_unit=one.pressure_unit)
        path = in_bending_axes(read, first_bend=one.first_bend or side)
        found.append(MeasuredPath(path, one.crimp_ratio, file))
    if not found:
        raise InputError(
            f"{setup.source}: names no measured path; give --measured CSV, or add [[measured]] with path"
        )
    setup.results.record_inputs([one.file for one in found])
    return found
