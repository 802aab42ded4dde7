"""Fitting the slack-fibre composite to tension curves, its matrix being known."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from spavision.errors import InputError
from spavision.model.materials.curves import nominal_stiffness, nominal_stress
from spavision.model.materials.slack_fibre import SlackFibre
from spavision.model.materials.solid import IsotropicLaw

from .fit_data import stack
from .measured_curve import FloatArray, MeasuredCurve
from .statistics import Goodness, goodness
from .transition import strain_transition

NAMES = ("slack_strain", "length_modulus_MPa", "transition_half_width")
"""The parameters, as `PaperLayer` and experiment files call them."""

_ALONG = (0.0, 1.0, 0.0)
_SMALLEST_SLACK = 1e-3
_SMALLEST_SHARE = 0.01
"""Of the half-width in the slack strain."""

_AT_END = 1e-3
"""Share of the largest strain within which the slack strain counts as being there."""

_STARTS = ((0.4, 0.2), (0.6, 0.2), (0.6, 0.8), (0.8, 0.2), (0.8, 0.8), (0.95, 0.5))
"""Slack strain over the largest strain, half-width over slack strain."""


@dataclass(frozen=True)
class SlackFibreFit:
    """A slack-fibre composite fitted to tension curves.

    Parameters
    ----------
    fibre : SlackFibre
    matrix : IsotropicLaw
        Not fitted.
    curves : tuple of MeasuredCurve
    standard_errors : tuple of float
        Of the parameters in the order of `NAMES`; NaN where a bound holds one.
    goodness : Goodness
    """

    fibre: SlackFibre
    matrix: IsotropicLaw
    curves: tuple[MeasuredCurve, ...]
    standard_errors: tuple[float, ...]
    goodness: Goodness

    @property
    def label(self) -> str:
        """What the law is called."""
        return "matrix with slack fibre"

    @property
    def is_at_end(self) -> bool:
        """Whether the slack strain lies at the data's end: the stiff range was hardly reached."""
        return self.fibre.slack_strain > (1.0 - _AT_END) * max(each.strain.max() for each in self.curves)

    @property
    def values(self) -> tuple[float, ...]:
        """Parameters in the order of `NAMES`."""
        return self.fibre.slack_strain, self.fibre.modulus_MPa, self.fibre.transition_half_width

    def stress_of(self, curve: MeasuredCurve) -> FloatArray:
        """Return the composite's nominal stress at a curve's stretches, in MPa."""
        return nominal_stress(self.matrix, curve.stretch, curve.mode) + self.fibre.tension(curve.stretch)


def fit_slack_fibre(curves: Sequence[MeasuredCurve], matrix: IsotropicLaw) -> SlackFibreFit:
    """Fit slack strain, stiffness and width of the transition by least squares of nominal stress.

    The stiffness enters linearly and is solved for at each step; the other two start from several places.

    Parameters
    ----------
    curves : sequence of MeasuredCurve
        Tension along the fibres, uniaxial or planar.
    matrix : IsotropicLaw

    Raises
    ------
    InputError
        If there are too few points, no tension, or the curve never rises above the matrix's own.
    """
    data = stack(curves, (1.0,) * len(curves))
    stretch = np.concatenate([curve.stretch for curve in curves])
    reach = float(stretch.max()) - 1.0
    if len(data) <= len(NAMES) or reach < 10.0 * _SMALLEST_SLACK:
        raise InputError(
            f"slack-fibre: {len(data)} points up to {reach:.1%} strain are too few for {len(NAMES)} "
            "parameters; give a tension test"
        )
    rest = np.concatenate([_beside_matrix(curve, matrix) for curve in curves])
    problem = _Projected(stretch, rest)
    bounds = ([_SMALLEST_SLACK, _SMALLEST_SHARE], [reach, 1.0])
    solutions = [
        least_squares(problem.residual, (share * reach, part), bounds=bounds, xtol=1e-12, ftol=1e-12)
        for share, part in _STARTS
    ]
    best = min(solutions, key=lambda each: float(each.cost))
    fibre = problem.fibre(best.x)
    if not fibre.modulus_MPa > 0.0:
        raise InputError(
            "slack-fibre: the curve never rises above the matrix's own stress, so no fibre can be found; "
            "check the units, or name a softer matrix with --matrix"
        )
    return _described(fibre, matrix, curves)


def slack_fibre_at_transition(curve: MeasuredCurve, matrix: IsotropicLaw) -> SlackFibreFit:
    """Take slack strain and stiffness from the article's transition point, and fit the width alone.

    The fibre is taut on average at the transition strain and adds to the matrix what the secondary modulus
    lacks there. A curve that stiffens ever more up to its end, as a coupon's does, has no straight part for
    a least-squares fit of the stiffness to find; this way the point that matters is met.

    Parameters
    ----------
    curve : MeasuredCurve
        Tension along the fibres.
    matrix : IsotropicLaw

    Raises
    ------
    InputError
        If the curve has no transition, or is no stiffer beyond it than the matrix.
    """
    point = strain_transition(curve.strain, curve.stress_MPa, name=curve.name)
    own = float(nominal_stiffness(matrix, np.array([1.0 + point.strain]), curve.mode)[0])
    modulus = point.secondary.modulus_MPa - own
    if not (modulus > 0.0 and point.strain > _SMALLEST_SLACK):
        raise InputError(
            f"{curve.name}: the secondary modulus {point.secondary.modulus_MPa:.3g} MPa is the matrix's own, "
            "so there is no paper to calibrate; check the matrix"
        )
    rest = _beside_matrix(curve, matrix)

    def residual(share: FloatArray) -> FloatArray:
        width = float(share[0]) * point.strain
        return SlackFibre(_ALONG, modulus, point.strain, width).tension(curve.stretch) - rest

    found = least_squares(residual, [0.3], bounds=([_SMALLEST_SHARE], [1.0]))
    fibre = SlackFibre(_ALONG, modulus, point.strain, float(found.x[0]) * point.strain)
    return _described(fibre, matrix, (curve,))


def _beside_matrix(curve: MeasuredCurve, matrix: IsotropicLaw) -> FloatArray:
    """Stress that the matrix does not carry, (n,)."""
    return curve.stress_MPa - nominal_stress(matrix, curve.stretch, curve.mode)


def _described(fibre: SlackFibre, matrix: IsotropicLaw, curves: Sequence[MeasuredCurve]) -> SlackFibreFit:
    data = stack(curves, (1.0,) * len(curves))
    stretch = np.concatenate([curve.stretch for curve in curves])
    residual = fibre.tension(stretch) - np.concatenate([_beside_matrix(curve, matrix) for curve in curves])
    return SlackFibreFit(
        fibre=fibre,
        matrix=matrix,
        curves=tuple(curves),
        standard_errors=_standard_errors(fibre, stretch, residual),
        goodness=goodness(data, residual, len(NAMES)),
    )


@dataclass(frozen=True)
class _Projected:
    """Residuals as a function of slack strain and the half-width's share of it."""

    stretch: FloatArray
    target: FloatArray

    def fibre(self, variables: FloatArray) -> SlackFibre:
        slack, share = (float(value) for value in variables)
        unit = SlackFibre(_ALONG, 1.0, slack, share * slack)
        tension = unit.tension(self.stretch)
        length = float(tension @ tension)
        modulus = max(float(tension @ self.target) / length, 0.0) if length > 0.0 else 0.0
        return SlackFibre(_ALONG, modulus, slack, share * slack)

    def residual(self, variables: FloatArray) -> FloatArray:
        return self.fibre(variables).tension(self.stretch) - self.target


def _standard_errors(fibre: SlackFibre, stretch: FloatArray, residual: FloatArray) -> tuple[float, ...]:
    """Linearised, for independent errors of one variance; derivatives by central differences."""
    values = np.array([fibre.slack_strain, fibre.modulus_MPa, fibre.transition_half_width])
    held = fibre.transition_half_width > (1.0 - 1e-6) * fibre.slack_strain
    columns = []
    for index in range(2 if held else 3):
        step = 1e-5 * values[index]
        ends = []
        for sign in (1.0, -1.0):
            moved = values.copy()
            moved[index] += sign * step
            if held:
                moved[2] = moved[0]
            ends.append(SlackFibre(_ALONG, moved[1], moved[0], moved[2]).tension(stretch))
        columns.append((ends[0] - ends[1]) / (2.0 * step))
    jacobian = np.stack(columns, axis=1)
    variance = float(residual @ residual) / max(len(stretch) - len(columns), 1)
    errors = np.sqrt(np.maximum(np.diag(variance * np.linalg.pinv(jacobian.T @ jacobian)), 0.0))
    return (*errors.tolist(), *([float("nan")] if held else []))
