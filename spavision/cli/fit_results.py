"""A run of ``spavision fit``: the fits, the transition points, and what is written of them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd

from spavision.errors import InputError
from spavision.model.fitting.fit import FitSettings, LawFit, fit_all, fit_law
from spavision.model.fitting.measured_curve import MeasuredCurve
from spavision.model.fitting.report import fit_report
from spavision.model.fitting.transition import StrainTransition, strain_transition, transition_or_none
from spavision.model.materials.curves import PLANAR, UNIAXIAL
from spavision.model.materials.law_tables import law_to_table
from spavision.model.materials.material_files import Material, material_text
from spavision.results import ResultsFolder
from spavision.table_text import csv_text, number
from spavision.workflow.pictures import figure_bytes

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class FitRun:
    """Laws fitted to curves, with their transition points where asked for.

    Parameters
    ----------
    curves : tuple of MeasuredCurve
    fits : tuple of LawFit
        The best first.
    left_out : tuple of str
        A sentence for each law that could not be fitted.
    measured_transition : StrainTransition or None
        Of the first uniaxial tension curve.
    law_transitions : dict
        By law, None where the fitted curve has none.
    """

    curves: tuple[MeasuredCurve, ...]
    fits: tuple[LawFit, ...]
    left_out: tuple[str, ...]
    measured_transition: StrainTransition | None
    law_transitions: dict[str, StrainTransition | None]

    def transition_error(self, key: str) -> float:
        """Return the law's relative error of the transition strain, NaN where there is none."""
        found = self.law_transitions.get(key)
        if self.measured_transition is None or found is None:
            return math.nan
        return self.measured_transition.relative_error_of(found)

    def transition_lines(self) -> list[str]:
        """Return what to print of the measured transition."""
        measured = self.measured_transition
        if measured is None:
            return []
        return [
            f"Strain transition point, measured: {measured.strain:.1%} "
            f"(primary modulus {1e3 * measured.primary.modulus_MPa:.4g} kPa from the first 10 % strain, "
            f"secondary {1e3 * measured.secondary.modulus_MPa:.4g} kPa from the last ten points)"
        ]


def fit_run(
    law: str, curves: tuple[MeasuredCurve, ...], *, settings: FitSettings, transition: bool
) -> FitRun:
    """Fit one law or all.

    Raises
    ------
    InputError
        As `fit_law`; or if a transition is asked for and no curve has one.
    """
    if law == "all":
        compared = fit_all(curves, settings)
        fits, left_out = compared.fits, compared.left_out
    else:
        fits, left_out = (fit_law(law, curves, settings),), ()
    if not transition:
        return FitRun(curves, fits, left_out, None, {})
    curve = tension_curve(curves)
    measured = strain_transition(curve.strain, curve.stress_MPa, name=curve.name)
    of_laws = {fit.key: transition_or_none(curve.strain, fit.stress_of(curve)) for fit in fits}
    return FitRun(curves, fits, left_out, measured, of_laws)


def write_fit_run(
    results: ResultsFolder,
    run: FitRun,
    *,
    inputs: Sequence[Path],
    options: Mapping[str, Any],
    name: str,
    density_g_per_cm3: float,
) -> None:
    """Write a material file for each law, the figure, the curves, the report and ``run.json``."""
    from spavision.model.fitting.figures import fit_figure

    for fit in run.fits:
        material = _material(fit, name if len(run.fits) == 1 else f"{name}, {fit.label}", density_g_per_cm3)
        results.write_text(f"material-{fit.key}.toml", material_text(material))
    results.write_text("curves.csv", csv_text(_curve_table(run)))
    results.write_text("report.txt", "\n\n".join(fit_report(fit) for fit in run.fits) + "\n")
    _write_figure(results, fit_figure(run.fits, transitions=_transitions_to_draw(run)))
    results.record_inputs(inputs)
    results.write_record(
        {
            "command": "fit",
            "options": {
                key: str(value) if isinstance(value, Path) else value for key, value in options.items()
            },
            "fit": fit_run_record(run),
        }
    )


def fit_run_record(run: FitRun) -> dict[str, Any]:
    """Return the run as JSON takes it."""
    return {
        "curves": [
            {"name": curve.name, "mode": curve.mode.name, "points": len(curve), "notes": list(curve.notes)}
            for curve in run.curves
        ],
        "transition": transition_record(run.measured_transition),
        "fits": [_fit_record(fit, run) for fit in run.fits],
        "left_out": list(run.left_out),
    }


def comparison_rows(run: FitRun) -> tuple[list[str], list[list[str]]]:
    """Return header and rows of the table of laws."""
    header = ["law", "parameters", "R²", "RMS kPa", "AIC", "G0 kPa", "stable"]
    with_transition = run.measured_transition is not None
    header += ["transition %", "error %"] if with_transition else []
    rows = []
    for fit in run.fits:
        good = fit.goodness
        row = [
            fit.label,
            str(len(fit.parameters)),
            number(good.r_squared, 5),
            number(1e3 * good.rms_MPa, 3),
            number(good.aic, 1),
            number(1e3 * fit.law.shear_modulus_MPa, 2),
            "yes" if fit.is_stable else "no",
        ]
        if with_transition:
            found = run.law_transitions[fit.key]
            row.append(number(100.0 * found.strain, 1) if found else number(math.nan))
            row.append(number(100.0 * run.transition_error(fit.key), 2))
        rows.append([*row, "; ".join(fit.notes)])
    return [*header, "remark"], rows


def tension_curve(curves: Sequence[MeasuredCurve]) -> MeasuredCurve:
    """Return the tension test of which the transition point is asked: uniaxial, else planar, the first.

    Raises
    ------
    InputError
        If there is none.
    """
    for mode in (UNIAXIAL, PLANAR):
        for curve in curves:
            if curve.mode == mode and curve.strain.max() > -curve.strain.min():
                return curve
    raise InputError(
        "--transition: none of the files is a uniaxial or planar tension test; add one or leave it out"
    )


def _transitions_to_draw(run: FitRun) -> list[tuple[str, StrainTransition]]:
    best = run.law_transitions.get(run.fits[0].key)
    drawn = [] if run.measured_transition is None else [("measured", run.measured_transition)]
    return [*drawn, (run.fits[0].label, best)] if best is not None else drawn


def _material(fit: LawFit, name: str, density_g_per_cm3: float) -> Material:
    strains = [end for curve in fit.curves for end in (curve.strain.min(), curve.strain.max())]
    tests = ", ".join(f"{curve.name} ({curve.mode.name})" for curve in fit.curves)
    untested = sorted(set(fit.reach) - {curve.mode.name for curve in fit.curves})
    doubts = list(fit.notes)
    if untested:
        doubts.append(f"not tested: {', '.join(untested)}")
    return Material(
        name=name,
        law=fit.law,
        density_g_per_cm3=density_g_per_cm3,
        source=f"spavision fit of {tests}; R² {fit.goodness.r_squared:.4f}",
        uncertain="; ".join(doubts),
        strain_range=(min(0.0, float(min(strains))), float(max(strains))),
    )


def _curve_table(run: FitRun) -> pd.DataFrame:
    parts = []
    for curve in run.curves:
        columns = {
            "curve": curve.name,
            "mode": curve.mode.name,
            "strain": curve.strain,
            "stress_MPa": curve.stress_MPa,
        }
        columns |= {f"{fit.key}_MPa": fit.stress_of(curve) for fit in run.fits}
        parts.append(pd.DataFrame(columns))
    return pd.concat(parts, ignore_index=True)


def _write_figure(results: ResultsFolder, figure: Figure) -> None:
    for ending in ("png", "svg"):
        results.write_bytes(f"figures/fit.{ending}", figure_bytes(figure, ending))


def _fit_record(fit: LawFit, run: FitRun) -> dict[str, Any]:
    good = fit.goodness
    return {
        "law": fit.key,
        "label": fit.label,
        "table": law_to_table(fit.law),
        "parameters": [
            {
                "name": each.name,
                "value": each.value,
                "standard_error": _finite(each.standard_error),
                "unit": each.unit,
            }
            for each in fit.parameters
        ],
        "correlation": [[_finite(value) for value in row] for row in fit.correlation.tolist()],
        "shear_modulus_MPa": fit.law.shear_modulus_MPa,
        "r_squared": good.r_squared,
        "r_squared_of_curves": [_finite(value) for value in good.r_squared_of_curves],
        "rms_MPa": good.rms_MPa,
        "aic": good.aic,
        "stable_in_range": fit.is_stable,
        "stable_stretch": {name: [each.lowest, each.highest] for name, each in fit.stable.items()},
        "transition": transition_record(run.law_transitions.get(fit.key)),
        "transition_error": _finite(run.transition_error(fit.key)),
        "standard_errors": "between curves" if fit.errors_by_curve else "independent points",
        "notes": list(fit.notes),
    }


def transition_record(transition: StrainTransition | None) -> dict[str, float] | None:
    """Return a transition point as JSON takes it."""
    if transition is None:
        return None
    return {
        "strain": transition.strain,
        "primary_modulus_MPa": transition.primary.modulus_MPa,
        "secondary_modulus_MPa": transition.secondary.modulus_MPa,
    }


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
