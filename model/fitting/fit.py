"""Fitting one law, or all of them, to the curves of a material."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from spavision.errors import InputError
from spavision.model.materials.curves import nominal_stress
from spavision.model.materials.solid import IsotropicLaw
from spavision.model.materials.stability import StableRange, stable_ranges

from .families import FAMILIES, Family, find_family
from .fit_data import FitData, stack, stretch_reach
from .measured_curve import FloatArray, MeasuredCurve
from .plausibility import biaxial_notes, refuse_absurd_modulus
from .solution import NoSuchLawError, Solution
from .statistics import Goodness, correlation, covariance, goodness


@dataclass(frozen=True)
class FitSettings:
    """How to fit.

    Parameters
    ----------
    weights : tuple of float
        One for each curve, on its points' squared residuals; empty for equal weights.
    allow_unstable : bool
        Whether the law may lose stability within the range of the data.
    any_modulus : bool
        Accept a shear modulus that is no rubber's.
    errors_by_curve : bool
        Standard errors from the scatter between replicates, not from that of points taken as independent.
    """

    weights: tuple[float, ...] = ()
    allow_unstable: bool = False
    any_modulus: bool = False
    errors_by_curve: bool = False


@dataclass(frozen=True)
class Parameter:
    """A fitted parameter.

    Parameters
    ----------
    name, unit : str
    value : float
    standard_error : float
        NaN where the parameter is held by a bound or not determined by the data.
    """

    name: str
    unit: str
    value: float
    standard_error: float


@dataclass(frozen=True)
class LawFit:
    """A law fitted to curves.

    Parameters
    ----------
    key, label : str
        Which law, as on the command line and as printed.
    law : IsotropicLaw
    curves : tuple of MeasuredCurve
    parameters : tuple of Parameter
    correlation : array, shape (k, k)
    goodness : Goodness
    stable : dict of str to StableRange
        By mode.
    reach : dict of str to tuple of float
        By mode, the stretches that the data call for.
    notes : tuple of str
    errors_by_curve : bool
        Whether the standard errors are those between replicates.
    """

    key: str
    label: str
    law: IsotropicLaw
    curves: tuple[MeasuredCurve, ...]
    parameters: tuple[Parameter, ...]
    correlation: FloatArray
    goodness: Goodness
    stable: dict[str, StableRange]
    reach: dict[str, tuple[float, float]]
    notes: tuple[str, ...]
    errors_by_curve: bool = False

    @property
    def has_replicates(self) -> bool:
        """Whether a test was made more than once."""
        return has_replicates(self.curves)

    @property
    def is_stable(self) -> bool:
        """Whether the law is stable in all three tests as far as the data call for."""
        return all(self.stable[mode].covers(*ends) for mode, ends in self.reach.items())

    def stress_of(self, curve: MeasuredCurve) -> FloatArray:
        """Return the law's nominal stress at a curve's stretches, in MPa."""
        return nominal_stress(self.law, curve.stretch, curve.mode)


def fit_law(name: str, curves: Sequence[MeasuredCurve], settings: FitSettings | None = None) -> LawFit:
    """Fit a law by least squares of nominal stress.

    Parameters
    ----------
    name : str
        A key of `FAMILIES`, or ``ogden`` for three terms.
    curves : sequence of MeasuredCurve
        Tests of one material: different modes, replicates.
    settings : FitSettings, optional

    Raises
    ------
    InputError
        If there are fewer points than parameters, the stresses are all alike, no stable law fits
        (`NoSuchLawError`), or the data are absurdly soft or stiff.
    """
    settings = settings or FitSettings()
    family = find_family(name)
    data = stack(curves, settings.weights or (1.0,) * len(curves))
    _refuse_too_little(family, data)
    if settings.errors_by_curve:
        _refuse_without_replicates(curves)
    if not settings.any_modulus:
        refuse_absurd_modulus(data)
    reach = stretch_reach(curves)
    solution = family.solve(data, reach, allow_unstable=settings.allow_unstable)
    return _described(family, solution, data, tuple(curves), reach, by_curve=settings.errors_by_curve)


@dataclass(frozen=True)
class Comparison:
    """Every law fitted to the same curves.

    Parameters
    ----------
    fits : tuple of LawFit
        The best R² first.
    left_out : tuple of str
        A sentence for each law that could not be fitted.
    """

    fits: tuple[LawFit, ...]
    left_out: tuple[str, ...]


def fit_all(curves: Sequence[MeasuredCurve], settings: FitSettings | None = None) -> Comparison:
    """Fit every law that has fewer parameters than there are points.

    Raises
    ------
    InputError
        As `fit_law`, or if no law can be fitted at all.
    """
    points = sum(len(curve) for curve in curves)
    fits, left_out = [], []
    for key, family in FAMILIES.items():
        if family.parameter_count >= points:
            left_out.append(
                f"{family.label}: {points} points are too few for {family.parameter_count} parameters"
            )
            continue
        try:
            fits.append(fit_law(key, curves, settings))
        except NoSuchLawError as error:
            left_out.append(str(error))
    if not fits:
        raise InputError(f"no law can be fitted to these {points} points; {left_out[0]}")
    return Comparison(tuple(sorted(fits, key=lambda fit: -fit.goodness.r_squared)), tuple(left_out))


def has_replicates(curves: Sequence[MeasuredCurve]) -> bool:
    """Return whether two curves or more are of one mode and one side of rest."""
    kinds = [(curve.mode.name, bool(curve.strain.max() > -curve.strain.min())) for curve in curves]
    return len(set(kinds)) < len(kinds)


def _refuse_without_replicates(curves: Sequence[MeasuredCurve]) -> None:
    if not has_replicates(curves):
        raise InputError(
            "standard errors between replicates: no test was made twice; give the replicates' files "
            "together, or leave --errors replicates out"
        )


def _refuse_too_little(family: Family, data: FitData) -> None:
    if len(data) <= family.parameter_count:
        raise InputError(
            f"{family.label}: {len(data)} points are too few for {family.parameter_count} parameters; "
            "measure more, or fit a law with fewer parameters"
        )
    if not (np.ptp(data.stress_MPa) > 0.0 and np.ptp(data.log_stretch[:, 0]) > 0.0):
        raise InputError("the stress or the strain does not vary in the data; check the columns")


def _described(
    family: Family,
    solution: Solution,
    data: FitData,
    curves: tuple[MeasuredCurve, ...],
    reach: dict[str, tuple[float, float]],
    *,
    by_curve: bool,
) -> LawFit:
    residual = data.stress_from(solution.law.derivatives(data.log_stretch)[0]) - data.stress_MPa
    matrix, apart = covariance(solution, data, residual, by_curve=by_curve)
    error = np.sqrt(np.diag(matrix))
    parameters = tuple(
        Parameter(name, unit, float(value), float(sigma) if sigma > 0.0 else float("nan"))
        for name, unit, value, sigma in zip(
            solution.names, solution.units, solution.values, error, strict=True
        )
    )
    stable = stable_ranges(solution.law)
    notes = list(solution.notes)
    lost = [each.name for each in parameters if each.standard_error > abs(each.value)]
    if lost:
        notes.append(f"{', '.join(lost)}: smaller than the standard error, a simpler law may do")
    if not apart:
        notes.append("the data do not tell the parameters apart: standard errors mean little")
    beyond = [str(stable[mode]) for mode, ends in reach.items() if not stable[mode].covers(*ends)]
    if beyond:
        notes.append(f"unstable or locked within the range of the data ({'; '.join(beyond)})")
    notes += biaxial_notes(solution.law, curves)
    return LawFit(
        key=family.key,
        label=family.label,
        law=solution.law,
        curves=curves,
        parameters=parameters,
        correlation=correlation(matrix),
        goodness=goodness(data, residual, len(parameters)),
        stable=stable,
        reach=reach,
        notes=tuple(notes),
        errors_by_curve=by_curve,
    )
