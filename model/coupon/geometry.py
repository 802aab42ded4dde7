"""The shape of the crimped paper in its layer: a triangular wave with rounded folds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from spavision.errors import InputError
from spavision.model.elements import FloatArray

CRIMP_RATIO_RANGE = (0.0, 0.5)


@dataclass(frozen=True)
class CouponGeometry:
    """A layer of matrix with a sheet folded into a triangular wave in its middle.

    The legs of the wave lie on a sharp triangle of the given crimp ratio; its folds are rounded on the inner
    side. A fold radius so shortens the paper, and with it the strain at which it is straight.

    Parameters
    ----------
    crimp_ratio : float
        Amplitude, from mid-line to peak of the sharp triangle, over wavelength.
    wavelength_mm : float
        Assumed: the article does not tell it.
    thickness_mm : float
        Of the layer (article: 5 mm).
    fold_radius_mm : float
        Of the paper's middle surface, 0 for sharp folds. Assumed.

    Raises
    ------
    InputError
        If a length is out of range, the wave does not fit into the layer, or the folds leave no legs.
    """

    crimp_ratio: float
    wavelength_mm: float = 5.0
    thickness_mm: float = 5.0
    fold_radius_mm: float = 0.25

    def __post_init__(self) -> None:
        low, high = CRIMP_RATIO_RANGE
        if not low <= self.crimp_ratio <= high:
            raise InputError(f"crimp ratio is {self.crimp_ratio:g}, expected {low:g} to {high:g}")
        for name in ("wavelength_mm", "thickness_mm"):
            if not 0.0 < getattr(self, name) <= 1000.0:
                raise InputError(f"{name} is {getattr(self, name):g}, expected a length above 0 in mm")
        if not self.amplitude_mm < 0.5 * self.thickness_mm:
            raise InputError(
                f"wavelength_mm {self.wavelength_mm:g} at crimp ratio {self.crimp_ratio:g}: the wave is "
                f"{2.0 * self.amplitude_mm:g} mm high and does not fit into thickness_mm "
                f"{self.thickness_mm:g}; take a shorter wavelength"
            )
        if not 0.0 <= self.fold_radius_mm * np.sin(self.slope) < 0.2 * self.wavelength_mm:
            raise InputError(
                f"fold_radius_mm is {self.fold_radius_mm:g}, expected 0 or more and so small that straight "
                f"legs are left between the folds of a wave of {self.wavelength_mm:g} mm"
            )

    def refuse_thick_paper(self, paper_mm: float) -> None:
        """Raise `InputError` where wave and paper, of this thickness in mm, are together too high."""
        high = 2.0 * self.amplitude_mm + paper_mm
        if high > self.thickness_mm:
            raise InputError(
                f"wave and paper are {high:.4g} mm high and do not fit into thickness_mm "
                f"{self.thickness_mm:g}; take thinner paper, a shorter wavelength or a thicker layer"
            )

    @property
    def amplitude_mm(self) -> float:
        """From mid-line to peak of the sharp triangle."""
        return self.crimp_ratio * self.wavelength_mm

    @property
    def slope(self) -> float:
        """Angle of the legs against the length, in rad."""
        return float(np.arctan(4.0 * self.crimp_ratio))

    @property
    def straight_strain(self) -> float:
        """Strain at which inextensible paper is straight: path length over wavelength, less 1."""
        return 2.0 * sum(self._parts()) / self.wavelength_mm - 1.0

    def _parts(self) -> tuple[float, float, float]:
        """Lengths of half a fold, a leg and half a fold, in mm: half a wave."""
        fold = self.fold_radius_mm * self.slope
        half_span = 0.5 * self.wavelength_mm - 2.0 * self.fold_radius_mm * np.sin(self.slope)
        return fold, float(half_span / np.cos(self.slope)), fold

    def stations(self, cells_of_fold: int, cells_of_leg: int) -> FloatArray:
        """Return ends and middles of cells along half a wave, by path length in mm, finer towards folds."""
        fold, leg, _ = self._parts()
        even = np.linspace(0.0, 1.0, 2 * cells_of_leg + 1)
        leg_stations = fold + leg * _fine_at_ends(even)
        if fold == 0.0:
            return leg_stations
        arc = np.linspace(0.0, fold, 2 * cells_of_fold + 1)
        return np.concatenate([arc, leg_stations[1:-1], arc + fold + leg])

    def points(self, path_mm: FloatArray) -> FloatArray:
        """Return the paper's middle surface at path lengths from trough to peak, (n,) to (n, 2)."""
        fold, leg, _ = self._parts()
        whole = 2.0 * fold + leg
        second_half = path_mm > 0.5 * whole
        s = np.where(second_half, whole - path_mm, path_mm)
        radius, slope = self.fold_radius_mm, self.slope
        trough = -self.amplitude_mm + radius * (1.0 / np.cos(slope) - 1.0)
        turned = np.minimum(s / radius, slope) if radius > 0.0 else np.full(len(s), slope)
        beyond = np.maximum(s - fold, 0.0)
        x = radius * np.sin(turned) + beyond * np.cos(slope)
        y = trough + radius * (1.0 - np.cos(turned)) + beyond * np.sin(slope)
        return np.column_stack(
            [np.where(second_half, 0.5 * self.wavelength_mm - x, x), np.where(second_half, -y, y)]
        )


_GRADING = 0.75
"""How much finer the cells are at the folds than in mid-leg: 1 − this, relative to the mean."""


def _fine_at_ends(even: FloatArray) -> FloatArray:
    """Map equal parts of 0 to 1 to parts that are smaller at both ends; cells keep their middles."""
    ends = even[::2] - _GRADING * np.sin(2.0 * np.pi * even[::2]) / (2.0 * np.pi)
    stations = np.empty_like(even)
    stations[::2] = ends
    stations[1::2] = 0.5 * (ends[1:] + ends[:-1])
    return stations
