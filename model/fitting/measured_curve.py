"""A measured stress-stretch curve as the fit takes it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from spavision.errors import InputError
from spavision.model.materials.curves import Mode

FloatArray = NDArray[np.float64]


_ROUNDING = 1e-9
"""A strain written as 0.3 shall lie in a window that ends there."""


@dataclass(frozen=True)
class MeasuredCurve:
    """One specimen's first loading.

    Parameters
    ----------
    name : str
        What the curve is called in tables and figures, such as the file's name.
    mode : Mode
    stretch : array, shape (n,)
    stress_MPa : array, shape (n,)
        Nominal: force over undeformed section. Negative in compression.
    notes : tuple of str
        What was done to the data on the way here.
    """

    name: str
    mode: Mode
    stretch: FloatArray
    stress_MPa: FloatArray
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if self.stretch.shape != self.stress_MPa.shape or self.stretch.ndim != 1:
            raise ValueError(f"{self.name}: stretch {self.stretch.shape}, stress {self.stress_MPa.shape}")
        if not (np.all(self.stretch > 0.0) and np.all(np.isfinite(self.stress_MPa))):
            raise ValueError(f"{self.name}: expected positive stretches and finite stresses")

    def __len__(self) -> int:
        return len(self.stretch)

    @property
    def strain(self) -> FloatArray:
        """Engineering strain, stretch − 1, shape (n,)."""
        return self.stretch - 1.0

    def noted(self, *notes: str) -> MeasuredCurve:
        """Return the curve with more notes."""
        return replace(self, notes=(*self.notes, *notes))

    def within(self, lowest_strain: float, highest_strain: float) -> MeasuredCurve:
        """Return the points inside a window of engineering strain."""
        inside = (self.strain >= lowest_strain - _ROUNDING) & (self.strain <= highest_strain + _ROUNDING)
        if inside.all():
            return self
        note = (
            f"{inside.sum()} of {len(self)} points lie in the strain window "
            f"{100 * lowest_strain:g} % to {100 * highest_strain:g} %"
        )
        return replace(
            self,
            stretch=self.stretch[inside],
            stress_MPa=self.stress_MPa[inside],
            notes=(*self.notes, note),
        )


def in_window(curves: Sequence[MeasuredCurve], window: tuple[float, float]) -> tuple[MeasuredCurve, ...]:
    """Cut every curve to a window of engineering strain, both ends included.

    Raises
    ------
    InputError
        If the window is empty, or leaves a curve without points.
    """
    low, high = window
    if not low < high:
        raise InputError(f"strain window {low:g} to {high:g}: expected the lower end first")
    cut = tuple(curve.within(low, high) for curve in curves)
    for curve, whole in zip(cut, curves, strict=True):
        if len(curve) == 0:
            raise InputError(
                f"{curve.name}: no point lies in the strain window {low:g} to {high:g} (its strains run "
                f"from {whole.strain.min():.3g} to {whole.strain.max():.3g}); widen it or leave the file out"
            )
    return cut
