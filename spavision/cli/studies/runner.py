"""Runs the cases that a study asks for one batch after another, and remembers them for its tables."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from .setup import Setup

if TYPE_CHECKING:
    from spavision.correlate.study.case import Case, CaseResult
    from spavision.correlate.study.parameters import Value


class Runner:
    """Runs cases through the folder of a study.

    Parameters
    ----------
    setup : Setup
    crimp_ratio : float or None
        Of the cases unless another is named; None for the study's.
    """

    def __init__(self, setup: Setup, *, crimp_ratio: float | None = None) -> None:
        self._setup, self._crimp_ratio = setup, crimp_ratio
        self._seen: dict[str, tuple[Case, CaseResult]] = {}

    def __call__(
        self, values: Sequence[dict[str, Value]], model: str = "", crimp_ratio: float | None = None
    ) -> list[CaseResult]:
        """Return the results of cases with these values, in their order."""
        ratio = self._crimp_ratio if crimp_ratio is None else crimp_ratio
        cases = [self._setup.case(each, model=model, crimp_ratio=ratio) for each in values]
        results = self._setup.run(cases, title=f"{model or self._setup.study.study.model} model")
        self._seen |= {case.name: (case, result) for case, result in zip(cases, results, strict=True)}
        return results

    def write_cases(self) -> None:
        """Write the tables of all cases so far."""
        cases, results = zip(*self._seen.values(), strict=True)
        self._setup.write_cases(cases, results)
