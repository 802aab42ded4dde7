"""``spavision fit --law slack-fibre``: matrix and paper fitted to tension tests of the composite."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from spavision.model.fitting.measured_curve import MeasuredCurve
from spavision.model.fitting.slack_fibre_fit import NAMES, SlackFibreFit, fit_slack_fibre
from spavision.model.fitting.transition import StrainTransition, strain_transition, transition_or_none
from spavision.model.materials.library import find_material
from spavision.results import ResultsFolder
from spavision.table_text import csv_text
from spavision.workflow.pictures import figure_bytes

from .fit_results import tension_curve, transition_record

LAW = "slack-fibre"


@dataclass(frozen=True)
class CompositeRun:
    """The composite fitted to curves.

    Parameters
    ----------
    fit : SlackFibreFit
    matrix : str
        The matrix's name.
    measured, fitted : StrainTransition or None
        Transition points, where asked for and where there are any.
    """

    fit: SlackFibreFit
    matrix: str
    measured: StrainTransition | None
    fitted: StrainTransition | None

    @property
    def transition_error(self) -> float:
        """Relative error of the transition strain, NaN where there is none."""
        if self.measured is None or self.fitted is None:
            return math.nan
        return self.measured.relative_error_of(self.fitted)


def composite_run(curves: Sequence[MeasuredCurve], *, matrix: str, transition: bool) -> CompositeRun:
    """Fit the slack-fibre composite.

    Raises
    ------
    InputError
        If the matrix is unknown, or the curves have no transition or too few points.
    """
    fit = fit_slack_fibre(curves, find_material(matrix).law)
    if not transition:
        return CompositeRun(fit, matrix, None, None)
    curve = tension_curve(curves)
    return CompositeRun(
        fit,
        matrix,
        strain_transition(curve.strain, curve.stress_MPa, name=curve.name),
        transition_or_none(curve.strain, fit.stress_of(curve)),
    )


def write_composite_run(
    results: ResultsFolder, run: CompositeRun, *, inputs: Sequence[Path], options: Mapping[str, Any]
) -> None:
    """Write report, curves, figure and ``run.json``."""
    from spavision.model.fitting.figures import fit_figure

    results.write_text("report.txt", "\n".join(composite_lines(run)) + "\n")
    parts = [
        pd.DataFrame(
            {
                "curve": curve.name,
                "strain": curve.strain,
                "nominal_stress_MPa": curve.stress_MPa,
                "slack_fibre_MPa": run.fit.stress_of(curve),
            }
        )
        for curve in run.fit.curves
    ]
    results.write_text("curves.csv", csv_text(pd.concat(parts, ignore_index=True)))
    drawn = [] if run.measured is None else [("measured", run.measured)]
    figure = fit_figure([run.fit], transitions=drawn)
    for ending in ("png", "svg"):
        results.write_bytes(f"figures/fit.{ending}", figure_bytes(figure, ending))
    results.record_inputs(inputs)
    stated = {key: str(value) if isinstance(value, Path) else value for key, value in options.items()}
    results.write_record({"command": "fit", "options": stated, "fit": composite_record(run)})


def composite_record(run: CompositeRun) -> dict[str, Any]:
    """Return the run as JSON takes it."""
    fit = run.fit
    return {
        "law": LAW,
        "matrix": run.matrix,
        "parameters": [
            {"name": name, "value": value, "standard_error": error if math.isfinite(error) else None}
            for name, value, error in zip(NAMES, fit.values, fit.standard_errors, strict=True)
        ],
        "r_squared": fit.goodness.r_squared,
        "rms_MPa": fit.goodness.rms_MPa,
        "aic": fit.goodness.aic,
        "transition": transition_record(run.measured),
        "fitted_transition": transition_record(run.fitted),
        "transition_error": run.transition_error if math.isfinite(run.transition_error) else None,
    }


def composite_lines(run: CompositeRun) -> list[str]:
    """Return parameters with standard errors, goodness and transition as lines of text."""
    fit = run.fit
    lines = [
        f"[[{fit.label}, {run.matrix}]]",
        f"{sum(len(curve) for curve in fit.curves)} points of {len(fit.curves)} curves, nominal stress",
        f"R² {fit.goodness.r_squared:.5f}   RMS {1e3 * fit.goodness.rms_MPa:.3g} kPa   AIC "
        f"{fit.goodness.aic:.1f}",
        "parameters ± standard error (independent points assumed)",
        *(
            f"  {name:22s} {value: .6g} "
            + (f"± {error:.2g}" if math.isfinite(error) else "(held by a bound)")
            for name, value, error in zip(NAMES, fit.values, fit.standard_errors, strict=True)
        ),
    ]
    if fit.is_at_end:
        lines.append("the slack strain lies at the end of the data: the stiff range was hardly reached")
    if run.measured is not None:
        lines.append(f"strain transition point, measured: {run.measured.strain:.1%}")
    if run.fitted is not None:
        lines.append(
            f"strain transition point, fitted: {run.fitted.strain:.1%} (error {run.transition_error:.2%})"
        )
    return [*lines, *(f"  {curve.name}: {note}" for curve in fit.curves for note in curve.notes)]
