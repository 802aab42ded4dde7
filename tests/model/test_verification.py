"""The model against closed forms and published numbers; each case names its row and source."""

from __future__ import annotations

import pytest

from spavision.model.verification.cases import Case, all_cases

LONG_ROWS = ("10", "11", "17")


@pytest.mark.parametrize(
    "case",
    [
        pytest.param(
            case,
            id=f"row {case.row}: {case.quantity}",
            marks=[pytest.mark.slow] if case.row in LONG_ROWS else [],
        )
        for case in all_cases()
    ],
)
def test_case(case: Case) -> None:
    assert case.measure() == pytest.approx(case.expected, rel=case.tolerance)
