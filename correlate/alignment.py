"""Pressure error told apart from shape error: the shift or scale of pressure that best aligns two paths."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.optimize import minimize_scalar

from spavision.tip_path import FloatArray, TipPath

SMALLEST_SHARE = 0.6
"""Share of the measured readings that must stay inside the model's pressures for an alignment to count."""

FEWEST_READINGS = 4
"""With fewer readings a shift could fit anything."""


@dataclass(frozen=True)
class Alignment:
    """The best pressure correction of one kind.

    Parameters
    ----------
    kind : str
        ``shift`` (model taken at p + value, in kPa) or ``scale`` (model taken at p · value).
    value : float
        The correction.
    rmse_before_mm, rmse_after_mm : float
        Root mean square tip distance without and with it, over the same readings.
    readings : int
        How many readings that is.
    """

    kind: str
    value: float
    rmse_before_mm: float
    rmse_after_mm: float
    readings: int

    @property
    def explained(self) -> float:
        """Share of the mean square distance that the correction removes, 0 to 1."""
        if self.rmse_before_mm == 0:
            return 0.0
        return 1.0 - (self.rmse_after_mm / self.rmse_before_mm) ** 2


def best_shift(measured: TipPath, modelled: TipPath) -> Alignment | None:
    """Return the best pressure shift within half the modelled range, or None with too few readings."""
    half_range = np.ptp(modelled.readings().pressure_kPa) / 2 if np.any(modelled.has_reading) else 0.0
    candidates = np.linspace(-half_range, half_range, 121)
    return _best("shift", measured, modelled, lambda p, value: p + value, candidates)


def best_scale(measured: TipPath, modelled: TipPath) -> Alignment | None:
    """Return the best pressure scale between 0.4 and 2.5, or None with too few readings."""
    return _best("scale", measured, modelled, lambda p, value: p * value, np.geomspace(0.4, 2.5, 121))


def _best(
    kind: str,
    measured: TipPath,
    modelled: TipPath,
    correct: Callable[[FloatArray, float], FloatArray],
    candidates: FloatArray,
) -> Alignment | None:
    data, model = measured.readings(), modelled.readings()
    if len(data) < FEWEST_READINGS or len(model) < FEWEST_READINGS:
        return None
    curve = PchipInterpolator(
        model.pressure_kPa, np.column_stack([model.ux_mm, model.uy_mm]), extrapolate=False
    )
    target = np.column_stack([data.ux_mm, data.uy_mm])

    before = np.sum((curve(data.pressure_kPa) - target) ** 2, axis=1)

    def over_the_same_readings(value: float) -> tuple[float, float, int]:
        after = np.sum((curve(correct(data.pressure_kPa, value)) - target) ** 2, axis=1)
        both = np.isfinite(after) & np.isfinite(before)
        if both.sum() < max(FEWEST_READINGS, SMALLEST_SHARE * len(data)):
            return 0.0, 0.0, 0
        return float(np.mean(before[both])), float(np.mean(after[both])), int(both.sum())

    def remaining_share(value: float) -> float:
        # Not the error itself: that would reward a correction for moving the worst readings off the path.
        mean_before, mean_after, readings = over_the_same_readings(value)
        return mean_after / mean_before if readings and mean_before > 0 else 1.0

    scores = np.array([remaining_share(value) for value in candidates])
    best = int(np.argmin(scores))
    bracket = candidates[max(best - 1, 0)], candidates[min(best + 1, len(candidates) - 1)]
    refined = minimize_scalar(remaining_share, bounds=bracket, method="bounded")
    value = float(refined.x if refined.fun < scores[best] else candidates[best])
    mean_before, mean_after, readings = over_the_same_readings(value)
    if not readings:
        return None
    return Alignment(kind, value, float(np.sqrt(mean_before)), float(np.sqrt(mean_after)), readings)
