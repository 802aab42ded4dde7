"""The points of all curves in one stack, as the least-squares problems take them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from spavision.model.materials.curves import EQUIBIAXIAL, MODES

from .measured_curve import FloatArray, MeasuredCurve

_FEWEST_OF_A_CURVE = 12
"""Points that thinning leaves of every curve."""


@dataclass(frozen=True)
class FitData:
    """Points of all curves.

    Parameters
    ----------
    log_stretch : array, shape (n, 3)
        Principal log stretches.
    projection : array, shape (n, 3)
        Nominal stress is the dot product of a row with the energy's first derivatives in the log stretches.
    stress_MPa : array, shape (n,)
    weight : array, shape (n,)
        On the squared residual.
    curve : array of int, shape (n,)
        Number of the curve that each point is from.
    """

    log_stretch: FloatArray
    projection: FloatArray
    stress_MPa: FloatArray
    weight: FloatArray
    curve: np.ndarray

    def __len__(self) -> int:
        return len(self.stress_MPa)

    @property
    def root_weight(self) -> FloatArray:
        """What the residuals are multiplied by, shape (n,)."""
        return np.sqrt(self.weight)

    @property
    def largest_invariant(self) -> float:
        """The data's largest Ī₁ − 3."""
        return float(np.expm1(2.0 * self.log_stretch).sum(axis=1).max())

    def stress_from(self, first: FloatArray) -> FloatArray:
        """Turn derivatives in the log stretches, (n, 3, ...), into nominal stress, (n, ...)."""
        stress: FloatArray = np.einsum("ni,ni...->n...", self.projection, first)
        return stress

    def thinned(self, count: int) -> FitData:
        """Return about so many points, evenly taken from each curve, that weigh as much as all."""
        if len(self) <= count:
            return self
        chosen, weight = [], []
        for number in np.unique(self.curve):
            whole = np.flatnonzero(self.curve == number)
            keep = min(len(whole), max(_FEWEST_OF_A_CURVE, round(count * len(whole) / len(self))))
            part = whole[np.linspace(0, len(whole) - 1, keep).round().astype(int)]
            chosen.append(part)
            weight.append(self.weight[part] * len(whole) / keep)
        index = np.concatenate(chosen)
        return FitData(
            self.log_stretch[index],
            self.projection[index],
            self.stress_MPa[index],
            np.concatenate(weight),
            self.curve[index],
        )


def stack(curves: Sequence[MeasuredCurve], weights: Sequence[float]) -> FitData:
    """Stack curves; each point weighs as its curve does."""
    projection = [
        np.array(curve.mode.direction) / (curve.mode.loaded_directions * curve.stretch[:, None])
        for curve in curves
    ]
    return FitData(
        log_stretch=np.concatenate([curve.mode.log_stretch(curve.stretch) for curve in curves]),
        projection=np.concatenate(projection),
        stress_MPa=np.concatenate([curve.stress_MPa for curve in curves]),
        weight=np.repeat(np.asarray(weights, dtype=float), [len(curve) for curve in curves]),
        curve=np.repeat(np.arange(len(curves)), [len(curve) for curve in curves]),
    )


def stretch_reach(curves: Sequence[MeasuredCurve]) -> dict[str, tuple[float, float]]:
    """Return, for each of the three tests, the stretches that a law fitted to the curves should bear.

    For a test that was made, from 1 over the range of its data. For one that was not, as far as the larger of
    the principal log strains goes in those that were: the stretch x in uniaxial tension is √x in equibiaxial.
    """
    tested: dict[str, tuple[float, float]] = {}
    for curve in curves:
        low, high = tested.get(curve.mode.name, (1.0, 1.0))
        tested[curve.mode.name] = (min(low, curve.stretch.min()), max(high, curve.stretch.max()))
    lowest = min(low ** _reach_exponent(name) for name, (low, _) in tested.items())
    highest = max(high ** _reach_exponent(name) for name, (_, high) in tested.items())
    return {
        name: tested.get(
            name, (lowest ** (1 / _reach_exponent(name)), highest ** (1 / _reach_exponent(name)))
        )
        for name in MODES
    }


def _reach_exponent(mode_name: str) -> int:
    """2 where the largest principal log strain is twice that in the loaded direction."""
    return 2 if mode_name == EQUIBIAXIAL.name else 1
