"""A fit told in text."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from spavision.model.materials.conventions import CONVENTIONS, MU_OVER_ALPHA, moduli_in
from spavision.model.materials.ogden import Ogden

from .fit import LawFit, Parameter
from .measured_curve import MeasuredCurve

_WORTH_TELLING = 0.5
"""Correlations smaller than this are left out of the report."""


def fit_report(fit: LawFit) -> str:
    """Return parameters, standard errors, correlations, goodness, stability and notes as lines of text."""
    sections = [
        [f"[[{fit.label}]]"],
        _goodness(fit),
        [_errors_line(fit), *(f"  {_parameter(each)}" for each in fit.parameters)],
        _correlations(fit),
        [f"initial shear modulus G0 = {1e3 * fit.law.shear_modulus_MPa:.4g} kPa"],
        _conventions(fit),
        ["stable (Drucker, incompressible)", *(f"  {each}" for each in fit.stable.values())],
        ["notes", *(f"  {note}" for note in fit.notes)] if fit.notes else [],
        data_notes(fit.curves),
    ]
    return "\n".join(line for section in sections for line in section)


def _errors_line(fit: LawFit) -> str:
    if fit.errors_by_curve:
        return f"parameters ± standard error (from the scatter between the {len(fit.curves)} curves)"
    hint = "; --errors replicates takes it from the replicates" if fit.has_replicates else ""
    return (
        "parameters ± standard error (points taken as independent; along one curve they are not, so it is "
        f"too small{hint})"
    )


def _parameter(parameter: Parameter) -> str:
    unit = f" {parameter.unit}" if parameter.unit else ""
    if np.isnan(parameter.standard_error):
        return f"{parameter.name:9s} {parameter.value: .6g}{unit}  (held by a bound)"
    share = abs(parameter.standard_error / parameter.value) if parameter.value else np.inf
    return f"{parameter.name:9s} {parameter.value: .6g} ± {parameter.standard_error:.2g}{unit}  ({share:.1%})"


def _goodness(fit: LawFit) -> list[str]:
    points = sum(len(curve) for curve in fit.curves)
    good = fit.goodness
    lines = [
        f"{points} points of {len(fit.curves)} curves, nominal stress",
        f"R² {good.r_squared:.5f}   RMS {1e3 * good.rms_MPa:.3g} kPa   AIC {good.aic:.1f}",
    ]
    return lines + [
        f"  R² {value:.5f}  {curve.name} ({curve.mode.name}, {len(curve)} points)"
        for curve, value in zip(fit.curves, good.r_squared_of_curves, strict=True)
    ]


def _correlations(fit: LawFit) -> list[str]:
    names = [parameter.name for parameter in fit.parameters]
    pairs = [
        (abs(fit.correlation[i, j]), f"  {names[i]}, {names[j]}: {fit.correlation[i, j]:+.3f}")
        for i in range(len(names))
        for j in range(i)
        if abs(fit.correlation[i, j]) >= _WORTH_TELLING
    ]
    pairs.sort(key=lambda pair: -pair[0])
    return [f"correlations of {_WORTH_TELLING:g} and more", *(text for _, text in pairs)] if pairs else []


def _conventions(fit: LawFit) -> list[str]:
    if not isinstance(fit.law, Ogden):
        return []
    lines = [f"Ogden moduli in MPa by convention (above: {MU_OVER_ALPHA.name}); alpha is the same in all"]
    for convention in CONVENTIONS.values():
        moduli = ", ".join(f"{modulus:.6g}" for modulus in moduli_in(fit.law, convention))
        lines.append(
            f"  {convention.name:11s} {moduli}  (G0 = {convention.shear_modulus}; {convention.used_by})"
        )
    return lines


def data_notes(curves: Sequence[MeasuredCurve]) -> list[str]:
    """Return what was recognised in, and done to, the curves, as lines of text."""
    lines = [f"  {curve.name}: {note}" for curve in curves for note in curve.notes]
    return ["data", *lines] if lines else []
