"""What a study's folder tells a comparison: u_input, and what each suspect can explain."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from spavision.correlate.study.case_files import CaseFolder
from spavision.errors import InputError
from spavision.tables import numbers, read_columns
from spavision.tip_path import FloatArray

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
    """

    folder: Path
    pressure_kPa: FloatArray
    u_input_mm: FloatArray
    notes: tuple[str, ...]
    attribution: tuple[dict[str, str], ...] = ()
    findings: tuple[str, ...] = ()
    chart: bytes | None = None

    def inputs_mm(self, pressure_kPa: FloatArray) -> FloatArray:
        """Return u_input of x and y at other pressures, shape (2, n).

        Interpolated between the study's pressures, zero beyond them, where nobody has estimated it; NaN
        everywhere if all pressures lie beyond.
        """
        found = np.array(
            [
                np.interp(pressure_kPa, self.pressure_kPa, one, left=np.nan, right=np.nan)
                for one in self.u_input_mm
            ]
        )
        return np.nan_to_num(found) if np.isfinite(found).any() else found

    def rows(self) -> list[list[str]]:
        """Return the attribution as rows of text, the header first."""
        rows = []
        for one in self.attribution:
            cells = [_short(one[name]) for name in _SHOWN]
            rows.append([*cells[:-1], f"{100 * float(one['explained']):.0f} %"])
        return [list(_SHOWN.values()), *rows]

    def picture(self) -> Picture | None:
        """Return the chart of the attribution, where there is one."""
        from spavision.correlate.report import Picture

        caption = "How much of the distance between model and measurement each suspect can explain, alone."
        return None if self.chart is None else Picture(self.chart, "image/png", caption)


def read_study_results(folder: Path, *, crimp_ratio: float | None) -> StudyResults:
    """Read what ``spavision study`` has left in a folder.

    Parameters
    ----------
    folder : Path
    crimp_ratio : float or None
        Of the comparison.

    Raises
    ------
    InputError
        If the folder holds no tolerance study, belongs to another version, or to another crimp ratio.
    """
    if not (folder / BAND).is_file():
        raise InputError(
            f"--study {folder}: holds no {BAND}; run spavision study tolerance STUDY.toml -o {folder} first"
        )
    CaseFolder(folder)
    _refuse_other_crimp(folder, crimp_ratio)
    columns = read_columns(folder / BAND)
    table = {
        name: numbers(columns, name, folder / BAND, allow_empty=True)
        for name in ("pressure_kPa", "u_input_ux_mm", "u_input_uy_mm", "n_reached", "n_cases")
    }
    attribution: tuple[dict[str, str], ...] = ()
    if (folder / _ATTRIBUTION).is_file():
        found = read_columns(folder / _ATTRIBUTION)
        attribution = tuple(dict(zip(found, row, strict=True)) for row in zip(*found.values(), strict=True))
    return StudyResults(
        folder=folder,
        pressure_kPa=table["pressure_kPa"],
        u_input_mm=np.array([table["u_input_ux_mm"], table["u_input_uy_mm"]]),
        notes=_notes(table),
        attribution=attribution,
        findings=tuple(_record(folder / "attribute").get("findings", ())),
        chart=(folder / _CHART).read_bytes() if (folder / _CHART).is_file() else None,
    )


def _notes(table: dict[str, FloatArray]) -> tuple[str, ...]:
    highest = table["pressure_kPa"].max()
    notes = [f"u_input is known up to {highest:g} kPa, the highest pressure of the study; beyond, it is 0."]
    lacking = table["n_reached"] < table["n_cases"]
    if lacking.any():
        first = int(np.flatnonzero(lacking)[0])
        notes.append(
            f"From {table['pressure_kPa'][first]:g} kPa on not every case of the study came to a result: "
            "u_input is a lower bound there."
        )
    return tuple(notes)


def _refuse_other_crimp(folder: Path, crimp_ratio: float | None) -> None:
    theirs = _record((folder / BAND).parent).get("experiment", {}).get("actuator", {}).get("crimp_ratio")
    if theirs is not None and crimp_ratio is not None and abs(theirs - crimp_ratio) > 1e-9:
        raise InputError(
            f"--study {folder}: is of crimp ratio {theirs:g}, the comparison of {crimp_ratio:g}; "
            "name a study of the same actuator"
        )


def _record(folder: Path) -> dict[str, Any]:
    try:
        content = json.loads((folder / "run.json").read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return content if isinstance(content, dict) else {}


def _short(text: str) -> str:
    try:
        return f"{float(text):.4g}"
    except ValueError:
        return text
