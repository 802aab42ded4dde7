"""An attribution: cases, emulator, sensitivities and explanations of one discrepancy, put together."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from spavision.tip_path import FloatArray, TipPath

from .case import CaseResult, displacements
from .emulator import EmulatorCheck, check_emulator, fit_emulator
from .explanation import Explanation, explain_alone, explain_forms, explain_together, measured_target
from .plan import (
    Plan,
    RunCases,
    full_model_error,
    full_runs,
    n_fitted,
    refuse_before_running,
    refuse_failed,
)
from .sampling import draw_shares, one_at_a_time, values_at
from .sensitivity import LocalSensitivity, SobolIndices, likenesses, local_sensitivities, sobol_indices
from .suspects import nominal_point

if TYPE_CHECKING:
    import pandas as pd

_TRUSTWORTHY = 0.9
"""Predicted share of the held-out variance below which an emulator is not to be relied on."""


@dataclass(frozen=True)
class Attribution:
    """What an attribution found.

    Parameters
    ----------
    plan : Plan
    alone : tuple of Explanation
        One for each suspect of the plan.
    together : Explanation
        All inputs of the model at once.
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
        lowest, highest = min(self.plan.pressures_kPa), max(self.plan.pressures_kPa)
        found = [
            f"At the study's pressures, {lowest:g} to {highest:g} kPa, model and measurement are "
            f"{best.nominal_rmse_mm:.1f} mm apart (root mean square distance).",
            f"Alone, {name} explains most: {100 * best.explained:.0f} % of it, at {text}.",
            f"All inputs of the model together leave {self.together.rmse_mm:.1f} mm "
            f"({100 * self.together.explained:.0f} % explained; the model itself, run there, leaves "
            f"{self.computed_rmse_mm:.1f} mm).",
            f"The emulator predicts {100 * self.check.predictivity:.1f} % of the variance of "
            f"{len(self.check.error_mm)} held-out cases; its error is at most {rmse.max():.1f} mm "
            "(root mean square, at the worst pressure).",
        ]
        if self.check.predictivity < _TRUSTWORTHY:
            found.append(
                "That is too little to trust its indices and shares: raise cases in [study], narrow the "
                "suspects, or lower the highest pressure."
            )
        if self.full_check_mm.size:
            error = np.sqrt(np.nanmean(self.full_check_mm**2))
            found.append(
                f"Against {len(self.full_check_mm)} runs of the full model the predicted change of the path "
                f"is off by {error:.1f} mm (root mean square over all pressures)."
            )
        found += [one.sentence() for one in likenesses(self.local)]
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
    refuse_before_running(plan, measured)
    suspects, seed = plan.inputs, plan.seed
    points = draw_shares(len(suspects), plan.n_cases, sampling=plan.sampling, seed=seed)
    ends, forms = one_at_a_time(suspects), one_at_a_time(plan.forms)
    nominal, *results = run([{}, *ends, *forms, *values_at(suspects, points)])
    refuse_failed(nominal)
    alone, drawn = results[: len(ends) + len(forms)], results[len(ends) + len(forms) :]
    fitted = n_fitted(plan.n_cases)
    emulator = fit_emulator(suspects, points[:fitted], drawn[:fitted], seed=seed)
    middle = nominal_point(suspects)
    full = full_runs(plan, points[fitted:], run)
    best_nominal = full[0] if full and full[0].status != "failed" else nominal
    target = measured_target(measured, best_nominal.path(plan.pressures_kPa), plan.experiment)
    together, _ = explain_together(emulator, target, nominal=middle, seed=seed)
    by_form = explain_forms(target, plan.forms, _changes(alone[len(ends) :], nominal))
    return Attribution(
        plan=plan,
        alone=tuple(
            by_form[one.name] if one.is_form else explain_alone(emulator, target, one, nominal=middle)
            for one in plan.suspects
        ),
        together=together,
        computed_rmse_mm=float(target.rmse_mm(_changes(run([together.values]), nominal), np.ones(1))[0]),
        local=local_sensitivities((*suspects, *plan.forms), alone),
        sobol=sobol_indices(emulator, np.array(plan.pressures_kPa), seed=seed),
        check=check_emulator(emulator, points[fitted:], drawn[fitted:]),
        full_check_mm=full_model_error(emulator, points[fitted:], middle, full),
        n_not_whole=sum(result.status != "ok" for result in drawn),
    )


def _changes(results: list[CaseResult], nominal: CaseResult) -> FloatArray:
    """Return the changes of the tip from the nominal case, shape (n_cases, 2, n_pressures)."""
    values = displacements(results).reshape(len(results), 2, len(nominal.ux_mm))
    return np.asarray(values - displacements([nominal]))


def _largest(values: FloatArray) -> float:
    finite = values[np.isfinite(values)]
    return float(finite[np.abs(finite).argmax()]) if finite.size else float("nan")
