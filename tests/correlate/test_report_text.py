"""The report in Markdown and JSON: the same numbers, and text from files that stays text."""

import json

import numpy as np
import pytest

from spavision.correlate.discrepancy import compare
from spavision.correlate.report import ReportContent
from spavision.correlate.report_text import report_json, report_markdown
from spavision.correlate.summary import summarise

from .paths import make_path

EVIL = "a | b <script>x</script> [link](http://x) `code` ```"


@pytest.fixture(scope="module")
def content():
    pressure = np.array([0.0, 5.0, 10.0, 15.0])
    measured = make_path(pressure, [0.0, 1.0, np.nan, 4.0], [0.0, 0.5, np.nan, 1.0])
    summary = summarise(compare(measured, make_path(pressure, [0.0, 2.0, 3.0, 4.5], [0.0, 0.5, 0.7, 2.0])))
    return ReportContent(
        title=EVIL,
        summary=summary,
        sentences=[*summary.sentences(), EVIL],
        notes=[EVIL],
        tables={"Steps": [["one", "two"], ["1", EVIL]]},
        record={"photo": EVIL},
    )


def test_json_holds_every_row_and_null_for_a_gap(content):
    report = json.loads(report_json(content))
    assert [row["error_ux_mm"] for row in report["discrepancy"]] == [0.0, 1.0, None, 0.5]
    assert report["validation"]["x"]["is_significant"] == [False, True, False, True]
    assert report["title"] == EVIL
    assert report["modes"]["measured"]["first_extremum_mm"] == pytest.approx(4.0, abs=0.2)


def test_markdown_rows_have_as_many_cells_as_their_header(content):
    tables = [line for line in report_markdown(content).splitlines() if line.startswith("|")]
    cells = [len(line.replace(r"\|", "").split("|")) for line in tables]
    # The comparison has a header, a rule and four rows of eleven cells; the other table three of two.
    assert cells == [13] * 6 + [4] * 3


def test_text_from_files_is_no_markup(content):
    text = report_markdown(content)
    before_record, record = text.split("## Settings and versions")
    assert "<script>" not in before_record.replace(r"\<script\>", "")
    assert "[link](" not in before_record
    fence = record.strip().splitlines()[0].removesuffix("json")
    assert fence == "````"
    assert record.count(fence) == 2
