"""The report as Markdown for a notebook or a repository, and as JSON for another program."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from .report import ReportContent, comparison_rows
from .validation import Validation

FIGURES = {
    "figures/path.png": "Both tip paths, the pressure beside each point",
    "figures/pressure.png": "Displacement against pressure",
}
"""Figures that lie beside the report, by their place from there."""


def report_markdown(content: ReportContent) -> str:
    """Return the report as Markdown; text from files cannot become markup."""
    parts = [f"# {_plain(content.title)}", *(f"> {_plain(note)}" for note in content.notes)]
    parts += ["## Summary", "\n".join(f"- {_plain(sentence)}" for sentence in content.sentences)]
    parts += [f"![{caption}]({place})" for place, caption in FIGURES.items()]
    parts += ["## Comparison at each pressure", _table(comparison_rows(content.summary))]
    for heading, rows in content.tables.items():
        parts += [f"## {_plain(heading)}", _table(rows)]
    record = json.dumps(content.record, indent=2, ensure_ascii=False)
    parts += ["## Settings and versions", _fenced(record)]
    return "\n\n".join(parts) + "\n"


def report_json(content: ReportContent) -> str:
    """Return the report's numbers as JSON; a gap is null."""
    summary = content.summary
    numbers = {
        "title": content.title,
        "notes": list(content.notes),
        "sentences": list(content.sentences),
        "discrepancy": summary.discrepancy.table().to_dict(orient="records"),
        "modes": {"measured": asdict(summary.measured_modes), "modelled": asdict(summary.modelled_modes)},
        "frechet_mm": summary.frechet_mm,
        "pressure_shift": None if summary.shift is None else asdict(summary.shift),
        "pressure_scale": None if summary.scale is None else asdict(summary.scale),
        "validation": {"x": _validation(summary.validation_x), "y": _validation(summary.validation_y)},
        "settings": content.record,
    }
    return json.dumps(_finite(numbers), indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def _validation(validation: Validation) -> dict[str, Any]:
    return {
        **asdict(validation),
        "u_val_mm": validation.u_val_mm,
        "is_significant": validation.is_significant,
        "left_out": validation.left_out,
        "left_out_in_part": validation.left_out_in_part,
    }


def _finite(value: Any) -> Any:
    """Turn arrays into lists and what is no number into None."""
    if isinstance(value, Mapping):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return _finite(value.tolist())
    if isinstance(value, list | tuple):
        return [_finite(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _table(rows: Sequence[Sequence[str]]) -> str:
    head, *body = ([_plain(cell).replace("|", r"\|") for cell in row] for row in rows)
    lines = [head, ["---"] * len(head), *body]
    return "\n".join("| " + " | ".join(cells) + " |" for cells in lines)


def _plain(text: str) -> str:
    """Return text on one line in which no character means markup."""
    escaped = "".join(f"\\{letter}" if letter in "\\`*_[]<>#" else letter for letter in text)
    return " ".join(escaped.split())


def _fenced(text: str) -> str:
    """Set a text in a fence that is longer than any run of backticks in it."""
    fence = "```"
    while fence in text:
        fence += "`"
    return f"{fence}json\n{text}\n{fence}"
