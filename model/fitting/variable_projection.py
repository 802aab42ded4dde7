"""Multi-start least squares for Σ aⱼ φ(θⱼ): the moduli a are solved for exactly at every step."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.optimize import least_squares, nnls

from .fit_data import FitData
from .measured_curve import FloatArray

_SCREENING_POINTS = 150
_POLISHED = 3
"""Starts are followed on few points; so many of the best are then finished on all."""

_SCREENING_TOLERANCE = 1e-9
_TOLERANCE = 1e-13
_EVALUATIONS = 200


@dataclass(frozen=True)
class Minimum:
    """Where one start has led.

    Parameters
    ----------
    moduli, shape_variables : array, shape (terms,)
    cost : float
        Half the weighted sum of squared residuals, over that of the stresses.
    """

    moduli: FloatArray
    shape_variables: FloatArray
    cost: float


@dataclass
class _Projected:
    """Residuals as a function of the shape variables alone (Golub and Pereyra's variable projection)."""

    shape: Callable[[float, FloatArray], tuple[FloatArray, FloatArray]]
    data: FitData
    any_sign: bool
    _target: FloatArray = field(init=False)
    _root: FloatArray = field(init=False)

    def __post_init__(self) -> None:
        self._target = self.data.stress_MPa * self.data.root_weight
        norm = np.linalg.norm(self._target)
        self._target = self._target / norm
        self._root = self.data.root_weight / norm

    def residuals(self, variables: FloatArray) -> FloatArray:
        """Return the weighted residuals, shape (n,)."""
        columns, _ = self._columns(variables)
        return columns @ self._moduli(columns) - self._target

    def jacobian(self, variables: FloatArray) -> FloatArray:
        """Return their derivatives in Kaufman's form, shape (n, terms)."""
        columns, slopes = self._columns(variables)
        moduli = self._moduli(columns)
        basis, _ = np.linalg.qr(columns[:, moduli != 0.0])
        change = slopes * moduli
        return change - basis @ (basis.T @ change)

    def minimum(self, variables: FloatArray) -> Minimum:
        """Return the point with its moduli and cost."""
        columns, _ = self._columns(variables)
        moduli = self._moduli(columns)
        rest = columns @ moduli - self._target
        return Minimum(moduli, variables, 0.5 * float(rest @ rest))

    def _columns(self, variables: FloatArray) -> tuple[FloatArray, FloatArray]:
        terms = [self.shape(float(variable), self.data.log_stretch) for variable in variables]
        columns, slopes = (
            np.stack([self.data.stress_from(term[part]) * self._root for term in terms], axis=1)
            for part in (0, 1)
        )
        return columns, slopes

    def _moduli(self, columns: FloatArray) -> FloatArray:
        scale = np.linalg.norm(columns, axis=0)
        if self.any_sign:
            return np.linalg.lstsq(columns / scale, self._target, rcond=1e-10)[0] / scale
        q, r = np.linalg.qr(columns / scale)
        return nnls(r, q.T @ self._target)[0] / scale


def best_of_many_starts(
    shape: Callable[[float, FloatArray], tuple[FloatArray, FloatArray]],
    data: FitData,
    starts: Sequence[FloatArray],
    *,
    bounds: tuple[float, float],
    any_sign: bool,
) -> list[Minimum]:
    """Follow every start on thinned data, finish the best on all; return these, the best first.

    Left out are those whose moduli do not add up to a positive one; there may be none left.

    Parameters
    ----------
    shape : callable
        From a shape variable and log stretches (n, 3) to a unit term's first derivatives and their change
        with the variable, each (n, 3).
    data : FitData
    starts : sequence of array, shape (terms,)
    bounds : tuple of float
        Lowest and highest shape variable.
    any_sign : bool
        Whether moduli may be negative.

    References
    ----------
    G. H. Golub, V. Pereyra, SIAM J. Numer. Anal. 10 (1973) 413-432. L. Kaufman, BIT 15 (1975) 49-57.
    """
    few = _Projected(shape, data.thinned(_SCREENING_POINTS), any_sign)
    followed = (_descend(few, start, bounds, _SCREENING_TOLERANCE) for start in starts)
    screened = sorted((each for each in followed if each.moduli.sum() > 0.0), key=lambda each: each.cost)
    whole = _Projected(shape, data, any_sign)
    finished = [_descend(whole, each.shape_variables, bounds, _TOLERANCE) for each in screened[:_POLISHED]]
    return sorted(finished, key=lambda each: each.cost)


def _descend(
    problem: _Projected, start: FloatArray, bounds: tuple[float, float], tolerance: float
) -> Minimum:
    inset = 1e-9 * (bounds[1] - bounds[0])
    found = least_squares(
        problem.residuals,
        np.clip(start, bounds[0] + inset, bounds[1] - inset),
        problem.jacobian,
        bounds=bounds,
        xtol=tolerance,
        ftol=tolerance,
        gtol=tolerance,
        max_nfev=_EVALUATIONS,
    )
    return problem.minimum(found.x)
