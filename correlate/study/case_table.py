"""The cases of a study as one table."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from spavision.correlate.modes import find_modes

from .case import Case, CaseResult

if TYPE_CHECKING:
    import pandas as pd


def case_table(cases: Sequence[Case], results: Sequence[CaseResult]) -> pd.DataFrame:
    """Return one row a case: name, values, status, reason, where the path turns, processor time."""
    import pandas as pd

    return pd.DataFrame([_row(case, result) for case, result in zip(cases, results, strict=True)])


def _row(case: Case, result: CaseResult) -> dict[str, Any]:
    row: dict[str, Any] = {"case": case.name, "model": case.model, **case.values}
    row |= {"first_extremum_mm": float("nan"), "mode_change_kPa": float("nan")}
    row |= {"second_extreme_mm": float("nan")}
    path = result.path(case.pressures_kPa)
    if path.has_reading.any():
        modes = find_modes(path)
        row["first_extremum_mm"] = modes.first_extremum_mm
        if modes.reverses:
            row |= {"mode_change_kPa": modes.first_extremum_kPa, "second_extreme_mm": modes.second_extreme_mm}
    return row | {"seconds": result.seconds, "status": result.status, "reason": result.reason}
