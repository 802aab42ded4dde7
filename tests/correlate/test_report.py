"""The report's page, without a browser."""

import re

import numpy as np
import pytest

from spavision.correlate.discrepancy import compare
from spavision.correlate.report import ReportContent, report_html
from spavision.correlate.summary import summarise

from .paths import make_path


@pytest.mark.parametrize(
    ("last_cells", "is_worded"),
    [(("1.5", "48.1"), False), (("–", "0.3"), False), (("yes", "no"), True), (("", ""), True)],
)
def test_words_stand_to_the_left_and_numbers_to_the_right(last_cells, is_worded):
    pressure = np.array([0.0, 5.0, 10.0])
    measured, modelled = (make_path(pressure, factor * pressure, pressure) for factor in (1.5, 1.7))
    rows = [["pressure kPa", "largest mm"], *(["0", cell] for cell in last_cells)]
    summary = summarise(compare(measured, modelled))
    page = report_html(ReportContent(title="A title", summary=summary, tables={"Bend angle": rows}))
    (opening,) = re.findall(r"<h2>Bend angle</h2>\s*<div class=\"wide\">\s*(<table[^>]*>)", page)
    assert ("worded" in opening) == is_worded
