"""An attribution: cases, emulator, sensitivities and explanations of one discrepancy, put together."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from spavision.errors import InputError
from spavision.experiment import Experiment
from spavision.tip_path import FloatArray, TipPath

from .case import CaseResult
from .emulator import Emulator, EmulatorCheck, check_emulator, fit_emulator
from .explanation import Explanation, explain_alone, explain_together, measured_target
from .parameters import Value
from .sampling import draw_shares, one_at_a_time, values_at
from .sensitivity import LocalSensitivity, SobolIndices, local_sensitivities, sobol_indices
from .suspects import Suspect, nominal_point

if TYPE_CHECKING:
    import pandas as pd

HELD_OUT = 0.125
"""Share of the random cases that the emulator is checked with, not fitted to."""

RunCases = Callable[[Sequence[dict[str, Value]], str], list[CaseResult]]
"""Runs cases of the given values, with the model of the given name (empty for the study's)."""


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
    def of_the_model(self) -> tuple[Suspect, ...]:
        """Suspects that move the model."""
        return tuple(one for one in self.suspects if not one.moves_the_measurement)


@dataclass(frozen=True)
class Attribution:
    """What an attribution found.

    Parameters
    ----------
    plan : Plan
    alone : tuple of Explanation
        One for each suspect of the plan.
    together : Explanation
        All suspects of the model at once.
    computed_rmse_mm : float
        What the model itself, not the emulator, leaves there; NaN if that case failed.
    local : tuple of LocalSensitivity
    sobol : SobolIndices
    check : EmulatorCheck
    full_check_mm : array, shape (n_full, 2, n_pressures)
        Emulated minus full model, both as changes from their own nominal path.
    n_not_whole : int
        Random cases that failed or stopped, which the emulator could not learn from.
    """

    plan: Plan
    alone: tuple[Explanation, ...]
    together: Explanation
    computed_rmse_mm: float
    local: tuple[LocalSensitivity, ...]
    sobol: SobolIndices
    check: EmulatorCheck
    full_check_mm: FloatArray
    n_not_whole: int

    def table(self) -> pd.DataFrame:
        """Return one row a suspect, the one that explains most first."""
        import pandas as pd

        changes = {one.suspect.name: one.change_mm for one in self.local}
        totals = dict(zip(self.sobol.names, self.sobol.total, strict=True))
        rows = []
        for one, found in zip(self.plan.suspects, self.alone, strict=True):
            low, high = one.interval
            change, total = changes.get(one.name), totals.get(one.name)
            rows.append(
                {
                    "suspect": one.name,
                    "nominal": one.nominal,
                    "low": low,
                    "high": high,
                    "best": next(iter(found.values.values())),
                    "rmse_nominal_mm": found.nominal_rmse_mm,
                    "rmse_best_mm": found.rmse_mm,
                    "explained": found.explained,
                    "largest_change_ux_mm": float("nan") if change is None else _largest(change[0]),
                    "largest_total_index": float("nan") if total is None else _largest(total),
                }
            )
        frame = pd.DataFrame(rows)
        return frame.sort_values("explained", ascending=False, kind="stable").reset_index(drop=True)

    def sentences(self) -> list[str]:
        """Say the main findings, one sentence each."""
        best = max(self.alone, key=lambda one: one.explained)
        name, value = next(iter(best.values.items()))
        text = value if isinstance(value, str) else f"{value:.3g}"
        rmse = self.check.rmse_mm
        found = [
            f"Model and measurement are {best.nominal_rmse_mm:.1f} mm apart (root mean square distance).",
            f"Alone, {name} explains most: {100 * best.explained:.0f} % of it, at {text}.",
            f"All suspects of the model together leave {self.together.rmse_mm:.1f} mm "
            f"({100 * self.together.explained:.0f} % explained; the model itself, run there, leaves "
            f"{self.computed_rmse_mm:.1f} mm).",
            f"The emulator predicts {100 * self.check.predictivity:.1f} % of the variance of "
            f"{len(self.check.error_mm)} held-out cases; its error is at most {rmse.max():.1f} mm "
            "(root mean square, at the worst pressure).",
        ]
        if self.full_check_mm.size:
            error = np.sqrt(np.nanmean(self.full_check_mm**2))
            found.append(
                f"Against {len(self.full_check_mm)} runs of the full model the predicted change of the path "
                f"is off by {error:.1f} mm (root mean square over all pressures)."
            )
        if self.n_not_whole:
            found.append(
                f"{self.n_not_whole} of {self.plan.n_cases} random cases failed or stopped early; the "
                "emulator and its indices speak for the others."
            )
        return found


def attribute(plan: Plan, measured: TipPath, run: RunCases) -> Attribution:
    """Run the cases and work out the attribution.

    Parameters
    ----------
    plan : Plan
    measured : TipPath
        In the model's axes.
    run : callable

    Raises
    ------
    InputError
        If the nominal case fails, no measured pressure is among the study's, or too few cases succeed.
    """
    suspects, seed = plan.of_the_model, plan.seed
    points = draw_shares(len(suspects), plan.n_cases, sampling=plan.sampling, seed=seed)
    single, random = one_at_a_time(suspects), values_at(suspects, points)
    nominal, *results = run([{}, *single, *random], "")
    _refuse_failed(nominal)
    drawn = results[len(single) :]
    n_fitted = plan.n_cases - max(1, round(HELD_OUT * plan.n_cases))
    emulator = fit_emulator(suspects, points[:n_fitted], drawn[:n_fitted], seed=seed)
    check = check_emulator(emulator, points[n_fitted:], drawn[n_fitted:])
    middle = nominal_point(suspects)
    best_nominal, full_check = _full_runs(plan, emulator, points[n_fitted:], nominal, run)
    target = measured_target(measured, best_nominal.path(plan.pressures_kPa), plan.experiment)
    if not np.isfinite(target.measured_mm).any():
        raise InputError("the measured path and the study share no pressure; set pressures_kPa in [study]")
    together, _ = explain_together(emulator, target, nominal=middle, seed=seed)
    (computed,) = run([together.values], "")
    change = np.array([computed.ux_mm, computed.uy_mm]) - np.array([nominal.ux_mm, nominal.uy_mm])
    return Attribution(
        plan=plan,
        alone=tuple(explain_alone(emulator, target, one, nominal=middle) for one in plan.suspects),
        together=together,
        computed_rmse_mm=float(target.rmse_mm(change[None], np.ones(1))[0]),
        local=local_sensitivities(suspects, results[: len(single)]),
        sobol=sobol_indices(emulator, np.array(plan.pressures_kPa), seed=seed),
        check=check,
        full_check_mm=full_check,
        n_not_whole=sum(result.status != "ok" for result in drawn),
    )


def _full_runs(
    plan: Plan, emulator: Emulator, held_out: FloatArray, nominal: CaseResult, run: RunCases
) -> tuple[CaseResult, FloatArray]:
    """Run the full model at the nominal values and at held-out points.

    Returns the best nominal path at hand, and the emulator's error in the change from it.
    """
    none = np.empty((0, 2, len(plan.pressures_kPa)))
    if plan.n_full == 0:
        return nominal, none
    points = held_out[: plan.n_full]
    full, *others = run([{}, *values_at(plan.of_the_model, points)], "full")
    if full.status == "failed":
        return nominal, none
    middle = nominal_point(plan.of_the_model)
    emulated = emulator.predict(points) - emulator.predict(middle[None])
    base = np.array([full.ux_mm, full.uy_mm])
    changes = np.array([[one.ux_mm, one.uy_mm] for one in others]) - base
    return full, emulated - changes


def _refuse_failed(nominal: CaseResult) -> None:
    if nominal.status == "failed":
        raise InputError(f"the nominal case failed: {nominal.reason}; correct the experiment file")


def _largest(values: FloatArray) -> float:
    finite = values[np.isfinite(values)]
    return float(finite[np.abs(finite).argmax()]) if finite.size else float("nan")
