"""Model updating: parameters brought to one measured path and checked on others."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from spavision.tip_path import FloatArray, TipPath

from .case import CaseResult
from .emulator import EmulatorCheck, check_emulator, fit_emulator
from .explanation import Target, measured_target
from .identifiability import Parameter, identified
from .parameters import Value
from .plan import Plan, RunCases, full_runs, n_fitted, refuse_before_running, refuse_failed
from .posterior import Misfit, Posterior, best_point, sample_posterior
from .sampling import draw_shares, values_at
from .suspects import nominal_point

if TYPE_CHECKING:
    import pandas as pd

_UNKNOWN_U_DATA_MM = 0.5
_NEARBY = 0.15
"""Half the width of the neighbourhood, in the unit cube, where a second round of cases is run."""


@dataclass(frozen=True)
class Measured:
    """A measured path with the crimp ratio of its actuator.

    Parameters
    ----------
    name : str
    path : TipPath
        In the model's axes.
    crimp_ratio : float or None
        The study's where None.
    """

    name: str
    path: TipPath
    crimp_ratio: float | None


@dataclass(frozen=True)
class Comparison:
    """One measured path with the model before and after.

    Parameters
    ----------
    measured : Measured
    is_fitted : bool
        Whether the parameters were fitted to it.
    nominal, updated : TipPath
    nominal_rmse_mm, updated_rmse_mm : float
        Root mean square distance to the measured path.
    """

    measured: Measured
    is_fitted: bool
    nominal: TipPath
    updated: TipPath
    nominal_rmse_mm: float
    updated_rmse_mm: float


@dataclass(frozen=True)
class Update:
    """What an update found.

    Parameters
    ----------
    plan : Plan
    best : dict
        Parameters of least squares.
    parameters : tuple of Parameter
        What is known of each, from the posterior.
    posterior : Posterior
    comparisons : tuple of Comparison
        The fitted path first.
    check : EmulatorCheck
    """

    plan: Plan
    best: dict[str, Value]
    parameters: tuple[Parameter, ...]
    posterior: Posterior
    comparisons: tuple[Comparison, ...]
    check: EmulatorCheck

    def table(self) -> pd.DataFrame:
        """Return one row a parameter."""
        import pandas as pd

        rows = [
            {
                "parameter": one.suspect.name,
                "nominal": one.suspect.nominal,
                "least_squares": self.best[one.suspect.name],
                "median": one.median,
                "low": one.low,
                "high": one.high,
                "width_over_prior": one.width_ratio,
                "verdict": one.verdict,
            }
            for one in self.parameters
        ]
        return pd.DataFrame(rows)

    def comparison_table(self) -> pd.DataFrame:
        """Return one row a measured path."""
        import pandas as pd

        rows = [
            {
                "path": one.measured.name,
                "crimp_ratio": one.measured.crimp_ratio,
                "role": "fitted" if one.is_fitted else "check",
                "rmse_nominal_mm": one.nominal_rmse_mm,
                "rmse_updated_mm": one.updated_rmse_mm,
            }
            for one in self.comparisons
        ]
        return pd.DataFrame(rows)

    def sentences(self) -> list[str]:
        """Say the main findings, one sentence each."""
        lowest, highest = min(self.plan.pressures_kPa), max(self.plan.pressures_kPa)
        found = [
            f"{one.measured.name} ({'fitted' if one.is_fitted else 'check'}): at the study's pressures, "
            f"{lowest:g} to {highest:g} kPa, the distance goes from "
            f"{one.nominal_rmse_mm:.1f} to {one.updated_rmse_mm:.1f} mm (root mean square)."
            for one in self.comparisons
        ]
        found += [one.sentence() for one in self.parameters]
        names = [one.suspect.name for one in self.parameters]
        correlation = self.posterior.correlation
        found += [
            f"{names[i]} and {names[j]} go together (correlation {correlation[i, j]:+.2f}): the path tells "
            "only a combination of the two."
            for i in range(len(names))
            for j in range(i)
            if abs(correlation[i, j]) > 0.8
        ]
        low, high = np.quantile(self.posterior.model_error_mm, [0.025, 0.975])
        found.append(
            f"Whatever the parameters, the model is wrong by {low:.1f} to {high:.1f} mm at a reading (95 %)."
        )
        if not self.posterior.is_converged:
            found.append("The posterior's chains are short for their correlation: raise steps in [update].")
        return found


def update(plan: Plan, measured: list[Measured], run: RunCases, *, steps: int) -> Update:
    """Fit the plan's suspects to the first measured path and check on the others.

    Parameters
    ----------
    plan : Plan
        Its suspects are the parameters.
    measured : list of Measured
    run : callable
    steps : int
        Of each walker of the posterior.

    Raises
    ------
    InputError
        If the nominal case fails, too few cases succeed, or the path and the study share no pressure.
    """
    suspects, seed = plan.inputs, plan.seed
    fitted_path = measured[0]
    refuse_before_running(plan, fitted_path.path)
    points = draw_shares(len(suspects), plan.n_cases, sampling=plan.sampling, seed=seed)
    nominal, *results = run([{}, *values_at(suspects, points)])
    refuse_failed(nominal)
    full = full_runs(plan, points[:0], run)
    base = full[0] if full and full[0].status != "failed" else nominal
    target = measured_target(fitted_path.path, base.path(plan.pressures_kPa), plan.experiment)
    n = n_fitted(plan.n_cases)
    middle = nominal_point(suspects)

    def misfit(at: FloatArray, found: list[CaseResult]) -> tuple[Misfit, EmulatorCheck]:
        emulator = fit_emulator(suspects, at, found, seed=seed)
        check = check_emulator(emulator, points[n:], results[n:])
        return Misfit(emulator, target, middle, _sigma(fitted_path.path, target, check, plan)), check

    first, _ = misfit(points[:n], results[:n])
    near = _nearby(best_point(first, seed=seed), plan)
    added = run(values_at(suspects, near))
    second, check = misfit(np.vstack([points[:n], near]), [*results[:n], *added])
    best = best_point(second, seed=seed)
    posterior = sample_posterior(second, best, steps=steps, seed=seed)
    values = values_at(suspects, best[None])[0]
    return Update(
        plan=plan,
        best=values,
        parameters=tuple(identified(posterior, index) for index in range(len(suspects))),
        posterior=posterior,
        comparisons=tuple(
            _compared(plan, one, values, run, is_fitted=one is fitted_path) for one in measured
        ),
        check=check,
    )


def _nearby(best: FloatArray, plan: Plan) -> FloatArray:
    """Return points about the best one, an eighth of the number of cases, the first of them itself."""
    count = plan.n_cases - n_fitted(plan.n_cases)
    around = draw_shares(len(best), count, sampling=plan.sampling, seed=plan.seed + 1)
    around = best + _NEARBY * (2.0 * around - 1.0)
    around[0] = best
    return np.asarray(np.clip(around, 1e-3, 1.0 - 1e-3))


def _sigma(path: TipPath, target: Target, check: EmulatorCheck, plan: Plan) -> FloatArray:
    """Uncertainty of measurement and emulator together, shape (2, n_pressures)."""
    row = np.abs(np.array(plan.pressures_kPa)[:, None] - path.pressure_kPa[None, :]).argmin(axis=1)
    data = np.array([path.sigma_ux_mm[row], path.sigma_uy_mm[row]])
    data = np.where(np.isfinite(data), data, _UNKNOWN_U_DATA_MM)
    return np.asarray(np.hypot(data, check.rmse_mm).reshape(target.nominal_mm.shape))


def _compared(
    plan: Plan, one: Measured, values: dict[str, Value], run: RunCases, *, is_fitted: bool
) -> Comparison:
    nominal, updated = run([{}, values], crimp_ratio=one.crimp_ratio)
    paths = [result.path(plan.pressures_kPa) for result in (nominal, updated)]
    rmse = []
    for path in paths:
        target = measured_target(one.path, path, plan.experiment)
        rmse.append(float(target.rmse_mm(np.zeros((1, *target.nominal_mm.shape)), np.ones(1))[0]))
    return Comparison(one, is_fitted, paths[0], paths[1], rmse[0], rmse[1])
