"""What a study's folder tells a comparison: u_input, and what each suspect can explain."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from spavision.correlate.study.agreement import first_difference, same_path
from spavision.correlate.study.case import model_description
from spavision.correlate.study.case_files import CaseFolder
from spavision.errors import InputError
from spavision.experiment import Experiment
from spavision.tables import numbers, read_columns
from spavision.tip_path import FloatArray, TipPath

if TYPE_CHECKING:
    from spavision.correlate.report import Picture

BAND = Path("tolerance/tolerance.csv")
_ATTRIBUTION = Path("attribute/attribution.csv")
_CHART = Path("attribute/figures/attribution.png")
_SHOWN = {
    "suspect": "suspect",
    "nominal": "nominal",
    "low": "2.5 %",
    "high": "97.5 %",
    "best": "nearest at",
    "explained": "explains",
}


@dataclass(frozen=True)
class StudyResults:
    """Input uncertainty of the modelled path, and the attribution where there is one.

    Parameters
    ----------
    folder : Path
    pressure_kPa : array, shape (n,)
    u_input_mm : array, shape (2, n)
        Standard uncertainty of x and y from the model's inputs.
    notes : tuple of str
        What makes it a lower bound.
    attribution : tuple of dict
        One a suspect; empty where the folder holds no attribution.
    findings : tuple of str
        The attribution in words.
    chart : bytes or None
        PNG of what each suspect can explain.
    measured : mapping
        The path that the attribution explains: its file's name and its readings.
    """

    folder: Path
    pressure_kPa: FloatArray
    u_input_mm: FloatArray
    notes: tuple[str, ...]
    attribution: tuple[dict[str, str], ...] = ()
    findings: tuple[str, ...] = ()
    chart: bytes | None = None
    measured: Mapping[str, Any] = field(default_factory=dict)

    def for_path(self, measured: TipPath) -> StudyResults:
        """Return what the study says of a path in the model's axes: an attribution of that path alone."""
        if not self.attribution or same_path(self.measured, measured):
            return self
        note = (
            f"The attribution of the study is left out: it explains another measured path "
            f"({self.measured.get('file', 'unknown')}); run spavision study attribute with this one."
        )
        return replace(self, notes=(*self.notes, note), attribution=(), findings=(), chart=None)

    def inputs_mm(self, pressure_kPa: FloatArray) -> FloatArray:
        """Return u_input of x and y at other pressures, shape (2, n).

        Interpolated between the study's pressures; NaN beyond them, where nobody has estimated it.
        """
        return np.array(
            [
                np.interp(pressure_kPa, self.pressure_kPa, one, left=np.nan, right=np.nan)
                for one in self.u_input_mm
            ]
        )

    def rows(self) -> list[list[str]]:
        """Return the attribution as rows of text, the header first."""
        rows = []
        for one in self.attribution:
            cells = {name: _short(one[name]) for name in _SHOWN}
            cells["explained"] = f"{100 * float(one['explained']):.0f} %"
            if not _is_number(one["low"]):
                cells |= {"low": "choice", "high": ""}
            rows.append(list(cells.values()))
        return [list(_SHOWN.values()), *rows]

    def picture(self) -> Picture | None:
        """Return the chart of the attribution, where there is one."""
        from spavision.correlate.report import Picture

        caption = "How much of the distance between model and measurement each suspect can explain, alone."
        return None if self.chart is None else Picture(self.chart, "image/png", caption)


def read_study_results(folder: Path, experiment: Experiment) -> StudyResults:
    """Read what ``spavision study`` has left in a folder.

    An attribution of another actuator or model than the tolerance study's is left out, and told.

    Parameters
    ----------
    folder : Path
    experiment : Experiment
        Of the comparison.

    Raises
    ------
    InputError
        If the folder holds no tolerance study, is of another version, or of another actuator or model.
    """
    if not (folder / BAND).is_file():
        raise InputError(
            f"--study {folder}: holds no {BAND}; run spavision study tolerance STUDY.toml -o {folder} first"
        )
    CaseFolder(folder)
    description = model_description(experiment)
    record = _record((folder / BAND).parent)
    difference = first_difference(record.get("description", {}), description)
    if difference is not None:
        raise InputError(f"--study {folder}: {difference}; name a study of the same actuator and model")
    columns = read_columns(folder / BAND)
    table = {
        name: numbers(columns, name, folder / BAND, allow_empty=True)
        for name in ("pressure_kPa", "u_input_ux_mm", "u_input_uy_mm", "n_reached", "n_cases")
    }
    found = StudyResults(
        folder=folder,
        pressure_kPa=table["pressure_kPa"],
        u_input_mm=np.array([table["u_input_ux_mm"], table["u_input_uy_mm"]]),
        notes=_notes(table, record),
    )
    return _with_attribution(found, description)


def _with_attribution(found: StudyResults, description: dict[str, Any]) -> StudyResults:
    """Return the results with the attribution of the same folder, where there is one that belongs to them."""
    file = found.folder / _ATTRIBUTION
    if not file.is_file():
        return found
    record = _record(file.parent)
    difference = first_difference(record.get("description", {}), description)
    if difference is not None:
        return replace(
            found, notes=(*found.notes, f"The attribution of the study is left out: {difference}.")
        )
    columns, chart = read_columns(file), found.folder / _CHART
    return replace(
        found,
        attribution=tuple(
            dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)
        ),
        findings=tuple(record.get("findings", ())),
        chart=chart.read_bytes() if chart.is_file() else None,
        measured=record.get("measured", {}),
    )


def _notes(table: dict[str, FloatArray], record: dict[str, Any]) -> tuple[str, ...]:
    highest = table["pressure_kPa"].max()
    model = record.get("study", {}).get("study", {}).get("model", "reduced")
    notes = [
        f"u_input is the scatter of {table['n_cases'][0]:.0f} cases of the {model} model, known up to "
        f"{highest:g} kPa, the highest pressure of the study."
    ]
    if record.get("remark"):
        notes.append(f"The study of u_input is {record['remark']}.")
    lacking = table["n_reached"] < table["n_cases"]
    if lacking.any():
        first = int(np.flatnonzero(lacking)[0])
        notes.append(
            f"From {table['pressure_kPa'][first]:g} kPa on not every case of the study came to a result: "
            "u_input is a lower bound there."
        )
    return tuple(notes)


def _record(folder: Path) -> dict[str, Any]:
    try:
        content = json.loads((folder / "run.json").read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return content if isinstance(content, dict) else {}


def _short(text: str) -> str:
    return f"{float(text):.4g}" if _is_number(text) else text


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
