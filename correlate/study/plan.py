"""What a study of suspects is asked, and the steps that such studies share."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from spavision.correlate.discrepancy import SAME_PRESSURE_kPa
from spavision.errors import InputError
from spavision.experiment import Experiment
from spavision.tip_path import FloatArray, TipPath

from .case import CaseResult, displacements
from .emulator import FEWEST_CASES, Emulator
from .parameters import Value
from .sampling import values_at
from .suspects import Suspect

_HELD_OUT = 0.125


class RunCases(Protocol):
    """Runs cases of given values; the study's model and crimp ratio unless others are named."""

    def __call__(
        self, values: Sequence[dict[str, Value]], model: str = "", crimp_ratio: float | None = None
    ) -> list[CaseResult]:
        """Return the results in the order of the values."""
        ...


@dataclass(frozen=True)
class Plan:
    """What an attribution is asked.

    Parameters
    ----------
    suspects : tuple of Suspect
    experiment : Experiment
    pressures_kPa : tuple of float
    n_cases, n_full : int
        Random cases; held-out ones among them that the full model runs too.
    sampling : str
    seed : int
    """

    suspects: tuple[Suspect, ...]
    experiment: Experiment
    pressures_kPa: tuple[float, ...]
    n_cases: int
    n_full: int
    sampling: str
    seed: int

    @property
    def inputs(self) -> tuple[Suspect, ...]:
        """Suspects that are inputs of the model: what an emulator learns, and what scatters."""
        return tuple(one for one in self.suspects if one.is_input)

    @property
    def forms(self) -> tuple[Suspect, ...]:
        """Suspects that choose the form of the model, which is run for each option as it is."""
        return tuple(one for one in self.suspects if one.is_form)


def n_fitted(n_cases: int) -> int:
    """Return how many random cases an emulator is fitted to; the rest, an eighth, check it."""
    return n_cases - max(1, round(_HELD_OUT * n_cases))


def refuse_before_running(plan: Plan, measured: TipPath) -> None:
    """Refuse a study that could only fail, before its cases are run.

    Raises
    ------
    InputError
        If the measured path and the study share no pressure, or the cases are too few for an emulator.
    """
    refuse_no_common_pressure(plan, measured, what="measured")
    if n_fitted(plan.n_cases) < FEWEST_CASES:
        raise InputError(
            f"{plan.n_cases} cases are too few: an eighth is kept to check the emulator, and it is fitted to "
            f"{FEWEST_CASES} at least; raise cases in [study]"
        )


def refuse_no_common_pressure(plan: Plan, path: TipPath, *, what: str) -> None:
    """Refuse a path that has no reading at a pressure of the study, above the lowest.

    Raises
    ------
    InputError
        If it has none.
    """
    readings = path.readings().pressure_kPa
    pressures = np.array(plan.pressures_kPa)
    if not np.any(np.abs(pressures[:, None] - readings[None, :]) < SAME_PRESSURE_kPa):
        raise InputError(f"the {what} path and the study share no pressure; set pressures_kPa in [study]")


def refuse_failed(nominal: CaseResult) -> None:
    """Refuse to go on from a nominal case without result.

    Raises
    ------
    InputError
        If it failed.
    """
    if nominal.status == "failed":
        raise InputError(f"the nominal case failed: {nominal.reason}; correct the experiment file")


def full_runs(plan: Plan, held_out: FloatArray, run: RunCases) -> list[CaseResult]:
    """Run the full model at the nominal values and at the first held-out points, where any is asked."""
    if plan.n_full == 0:
        return []
    return run([{}, *values_at(plan.inputs, held_out[: plan.n_full])], model="full")


def full_model_error(
    emulator: Emulator, held_out: FloatArray, middle: FloatArray, full: list[CaseResult]
) -> FloatArray:
    """Return emulated minus full model, both as changes from their nominal path, (n, 2, n_pressures)."""
    if not full or full[0].status == "failed":
        return np.empty((0, 2, emulator.n_pressures))
    values = displacements(full)
    emulated = emulator.predict(held_out[: len(full) - 1]) - emulator.predict(middle[None])
    return np.asarray(emulated - (values[1:] - values[0]))
