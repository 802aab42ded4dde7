"""Tables and numbers as text: CSV, rows for JSON, numbers for print."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pandas as pd


def csv_text(frame: pd.DataFrame) -> str:
    """Return a table as CSV text: seven significant digits, an empty cell for a gap."""
    text: str = frame.to_csv(index=False, float_format="%.7g", lineterminator="\n")
    return text


def records(frame: pd.DataFrame) -> list[dict[str, Any]]:
    """Return a table as a list of rows fit for JSON: None for a gap."""
    rows = frame.to_dict(orient="records")
    return [{key: _finite_or_none(value) for key, value in row.items()} for row in rows]


def number(value: float, decimals: int = 2) -> str:
    """Format a number for a printed table; a gap is a dash."""
    return f"{value:.{decimals}f}" if math.isfinite(value) else "–"


def finite_list(values: Sequence[float]) -> list[float | None]:
    """Return numbers fit for JSON: None for a gap."""
    return [_finite_or_none(float(value)) for value in values]


def _finite_or_none(value: Any) -> Any:
    return None if isinstance(value, float) and not math.isfinite(value) else value
