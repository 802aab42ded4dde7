"""The paper as a sheet bent in one plane: membrane, shear and bending stiffness per unit width."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from spavision.errors import InputError
from spavision.model.elements import FloatArray
from spavision.model.materials.sheet import published_sheets

_SHEAR_CORRECTION = 5.0 / 6.0


@dataclass(frozen=True)
class Paper:
    r"""Paper along its wave (1) and across, along the folds (2); linear in tension, yielding in bending.

    Bent to the radii of a fold, paper is far beyond its strength: an elastic fold of 0.25 mm radius would
    take 900 MPa to flatten. Its moment is therefore limited to the plastic one, σ_y t²/4, by

    .. math:: M = D\kappa\,/\sqrt{1 + (D\kappa/M_p)^2},

    the deformation theory of plasticity: right as long as nothing is unbent again. All of it is assumed
    unless the sheet's file gives a source.

    Parameters
    ----------
    thickness_mm : float
    modulus_MPa : float
        Along the wave; 0 leaves the paper out.
    cross_ratio : float
        Modulus along the folds over that along the wave; 0 lets the paper follow any change of width.
    poissons_ratio : float
        Contraction along the folds under tension along the wave.
    strength_MPa : float
        Mean tension over the thickness at which the paper tears.
    bending_yield_MPa : float
        σ_y of the plastic moment; infinite for elastic bending.

    Raises
    ------
    InputError
        If a number is out of range.
    """

    thickness_mm: float = 0.10
    modulus_MPa: float = 4500.0
    cross_ratio: float = 0.75
    poissons_ratio: float = 0.30
    strength_MPa: float = 35.0
    bending_yield_MPa: float = 35.0

    def __post_init__(self) -> None:
        if not 0.0 <= self.modulus_MPa < 1e6:
            raise InputError(f"paper modulus_MPa is {self.modulus_MPa:g}, expected 0 to 1e6")
        for name in ("thickness_mm", "strength_MPa", "bending_yield_MPa"):
            if not getattr(self, name) > 0.0:
                raise InputError(f"paper {name} is {getattr(self, name):g}, expected a number above 0")
        if not 0.0 <= self.poissons_ratio < 0.5:
            raise InputError(f"paper poissons_ratio is {self.poissons_ratio:g}, expected 0 to below 0.5")
        if not 0.0 <= self.cross_ratio <= 3.0:
            raise InputError(f"paper cross_ratio is {self.cross_ratio:g}, expected 0 to 3")

    @property
    def membrane(self) -> FloatArray:
        """Stiffness of a sheet in plane stress, from strains (1, 2) to forces per width in N/mm, (2, 2)."""
        coupled = self.poissons_ratio * self.cross_ratio
        matrix = np.array([[1.0, coupled], [coupled, self.cross_ratio]])
        return self.thickness_mm * self.modulus_MPa * matrix / (1.0 - self.poissons_ratio * coupled)

    @property
    def shear_stiffness(self) -> float:
        """Of the section, in N/mm."""
        return _SHEAR_CORRECTION * self.thickness_mm * self.modulus_MPa / (2.0 * (1.0 + self.poissons_ratio))

    @property
    def bending_stiffness(self) -> float:
        """D, in N mm, the width held."""
        return float(self.membrane[0, 0]) * self.thickness_mm**2 / 12.0

    @property
    def plastic_moment(self) -> float:
        """σ_y t²/4, in N (per unit width)."""
        return self.bending_yield_MPa * self.thickness_mm**2 / 4.0

    def moment(self, curvature: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return bending moment in N and its slope in N mm at changes of curvature in 1/mm."""
        elastic = self.bending_stiffness * curvature
        growth = 1.0 + (elastic / self.plastic_moment) ** 2
        return elastic / np.sqrt(growth), self.bending_stiffness / growth**1.5

    def bending_energy(self, curvature: FloatArray) -> FloatArray:
        """Return ∫ M dκ, in N."""
        ratio = self.bending_stiffness * curvature / self.plastic_moment
        # (√(1 + r²) − 1) written so that it keeps its digits for small r
        gained = curvature**2 * self.bending_stiffness / (1.0 + np.sqrt(1.0 + ratio**2))
        return np.asarray(gained)


def paper_of_sheet(name: str, **changes: float) -> Paper:
    """Return a sheet of the library as paper, with what is given in place of the sheet's own.

    Parameters
    ----------
    name : str
    **changes : float
        Fields of `Paper`. Without one of its own, the yield stress in bending is the strength.

    Raises
    ------
    InputError
        If there is no such sheet, or a number is out of range.
    """
    sheets = published_sheets()
    if name not in sheets:
        raise InputError(f"paper {name!r} is unknown, expected one of {', '.join(sheets)}")
    sheet = sheets[name]
    fields = {
        "thickness_mm": sheet.thickness_mm,
        "modulus_MPa": sheet.youngs_modulus_MPa,
        "cross_ratio": sheet.cross_direction_modulus_MPa / sheet.youngs_modulus_MPa,
        "poissons_ratio": sheet.poissons_ratio,
        "strength_MPa": sheet.strength_MPa,
        "bending_yield_MPa": changes.get("strength_MPa", sheet.strength_MPa),
    }
    return Paper(**(fields | changes))
