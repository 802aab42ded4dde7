"""How well a law fits and how well its parameters are known."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .fit_data import FitData
from .measured_curve import FloatArray
from .solution import Solution

_ILL_CONDITIONED = 1e7
"""Condition number of the scaled Jacobian from which the data do not tell the parameters apart."""


@dataclass(frozen=True)
class Goodness:
    """Goodness of fit; all of it of nominal stress, without the weights.

    Parameters
    ----------
    r_squared : float
        1 − Σ residual²/Σ (stress − mean stress)², over the points of all curves.
    r_squared_of_curves : tuple of float
        The same for each curve.
    rms_MPa : float
        Root mean square residual.
    aic : float
        Akaike's criterion n ln(Σ residual²/n) + 2k. Points of one curve are not independent, so small
        differences mean nothing.
    """

    r_squared: float
    r_squared_of_curves: tuple[float, ...]
    rms_MPa: float
    aic: float


def goodness(data: FitData, residual_MPa: FloatArray, parameter_count: int) -> Goodness:
    """Compute the goodness of fit from the residuals, shape (n,)."""
    curves = [data.curve == number for number in np.unique(data.curve)]
    mean_square = float(np.mean(residual_MPa**2))
    return Goodness(
        r_squared=r_squared(data.stress_MPa, residual_MPa),
        r_squared_of_curves=tuple(r_squared(data.stress_MPa[part], residual_MPa[part]) for part in curves),
        rms_MPa=mean_square**0.5,
        aic=len(data) * float(np.log(max(mean_square, 1e-300))) + 2.0 * parameter_count,
    )


def r_squared(stress: FloatArray, residual: FloatArray) -> float:
    """Return 1 − Σ residual²/Σ (stress − mean)², or NaN for a curve whose stress does not vary."""
    total = float(np.sum((stress - stress.mean()) ** 2))
    return 1.0 - float(np.sum(residual**2)) / total if total > 0.0 else float("nan")


def covariance(
    solution: Solution, data: FitData, residual_MPa: FloatArray, *, by_curve: bool = False
) -> tuple[FloatArray, bool]:
    """Return the covariance of the parameters, (k, k), and whether the data tell them apart.

    Linearised at the solution. By default for independent errors of the points: the scatter of each curve is
    taken from its own residuals, so the weights need not be inverse variances (White's estimator with one
    variance a curve). What a law misses in shape is no such error, so standard errors from a poor fit mean
    little.

    By curve, the errors along a curve may depend on each other in any way, as those of one specimen do; only
    the curves are independent (Liang and Zeger's estimator, times m/(m − 1) for m curves). It needs
    replicates, and with few of them is itself uncertain: by 50 % for three.

    References
    ----------
    H. White, Econometrica 48 (1980) 817-838. K.-Y. Liang, S. L. Zeger, Biometrika 73 (1986) 13-22.
    """
    width = solution.jacobian.shape[1]
    freedom = max(1.0 - width / len(data), 1.0 / len(data))
    variance = np.empty(len(data))
    for number in np.unique(data.curve):
        part = data.curve == number
        variance[part] = np.mean(residual_MPa[part] ** 2) / freedom
    scale = np.linalg.norm(solution.jacobian, axis=0)
    scale[scale == 0.0] = 1.0
    weighted = solution.jacobian / scale * data.root_weight[:, None]
    _, singular, _ = np.linalg.svd(weighted, full_matrices=False)
    apart = bool(singular[-1] * _ILL_CONDITIONED > singular[0])
    pseudo_inverse = np.linalg.pinv(weighted, rcond=1e-13) / scale[:, None]
    spread = solution.directions @ pseudo_inverse
    if by_curve:
        # spread already holds one root of the weight: the estimate moves by it times the weighted residual
        moves = spread * (data.root_weight * residual_MPa)
        curves = np.unique(data.curve)
        sums = np.stack([moves[:, data.curve == number].sum(axis=1) for number in curves], axis=1)
        return len(curves) / (len(curves) - 1.0) * sums @ sums.T, apart
    return (spread * (variance * data.weight)) @ spread.T, apart


def correlation(covariance_matrix: FloatArray) -> FloatArray:
    """Return the correlation matrix, (k, k); NaN for parameters without scatter."""
    deviation = np.sqrt(np.diag(covariance_matrix))
    safe = np.where(deviation > 0.0, deviation, np.nan)
    return covariance_matrix / np.outer(safe, safe)
