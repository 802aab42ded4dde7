"""The report: one HTML file that opens without a network."""

from __future__ import annotations

import base64
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from .interactive import path_plot, plotly_script, pressure_plot
from .summary import Summary

COMPARISON_HEADER = [
    "pressure kPa",
    "measured x mm",
    "measured y mm",
    "σ x mm",
    "σ y mm",
    "modelled x mm",
    "modelled y mm",
    "error x mm",
    "error y mm",
    "distance mm",
    "remark",
]


@dataclass(frozen=True)
class Picture:
    """An encoded picture with what it shows.

    Parameters
    ----------
    content : bytes
        The encoded file.
    media_type : str
        ``image/png`` or ``image/jpeg``.
    caption : str
        One sentence; also the text for readers who do not see the picture.
    """

    content: bytes
    media_type: str
    caption: str

    @property
    def address(self) -> str:
        """The picture as a data address, so that the page needs no other file."""
        return f"data:{self.media_type};base64,{base64.b64encode(self.content).decode('ascii')}"


@dataclass(frozen=True)
class Frame:
    """What the slider shows at one pressure: the photo with its overlay, and the deformed model."""

    pressure_kPa: float
    photo: Picture | None
    model: Picture | None


@dataclass(frozen=True)
class ReportContent:
    """Everything that the page shows.

    Parameters
    ----------
    title : str
        Heading of the page.
    summary : Summary
        The comparison.
    sentences : sequence of str
        The main findings.
    frames : sequence of Frame
        One a pressure, in order.
    pictures : sequence of Picture
        Further pictures, shown one below the other.
    notes : sequence of str
        What the reader must know about the input or the run.
    tables : mapping
        Heading to rows of cells; the first row is the header.
    record : mapping
        Settings and versions, as in ``run.json``.
    """

    title: str
    summary: Summary
    sentences: Sequence[str] = ()
    frames: Sequence[Frame] = ()
    pictures: Sequence[Picture] = ()
    notes: Sequence[str] = ()
    tables: Mapping[str, Sequence[Sequence[str]]] = field(default_factory=dict)
    record: Mapping[str, Any] = field(default_factory=dict)


def report_html(content: ReportContent) -> str:
    """Return the report as one HTML page; every text is escaped."""
    environment = Environment(
        loader=PackageLoader("spavision.correlate", "templates"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    discrepancy = content.summary.discrepancy
    return environment.get_template("report.html").render(
        content=content,
        tables={"Comparison at each pressure": comparison_rows(content.summary), **content.tables},
        path_plot=Markup(path_plot(discrepancy)),
        pressure_plot=Markup(pressure_plot(discrepancy)),
        plotly_script=Markup(plotly_script()),
        record=json.dumps(content.record, indent=2, ensure_ascii=False),
    )


def comparison_rows(summary: Summary) -> list[list[str]]:
    """Return the comparison as rows of text, the header first; a gap is a dash."""
    frame = summary.discrepancy.table()
    numeric = [name for name in frame.columns if name != "remark"]
    rows = [
        [*(_number(row[name], 0 if name == "pressure_kPa" else 2) for name in numeric), row["remark"]]
        for _, row in frame.iterrows()
    ]
    return [COMPARISON_HEADER, *rows]


def _number(value: float, decimals: int) -> str:
    if not np.isfinite(value):
        return "–"
    return f"{value:g}" if decimals == 0 else f"{value:.{decimals}f}"
