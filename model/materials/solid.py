"""A solid material: isotropic law, bulk modulus, density and fibres together."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from .slack_fibre import SlackFibre

FloatArray = NDArray[np.float64]


class IsotropicLaw(Protocol):
    """What a hyperelastic law tells the solver, as functions of the isochoric principal log stretches."""

    @property
    def shear_modulus_MPa(self) -> float:
        """Initial shear modulus."""
        ...

    def energy(self, log_stretch: FloatArray) -> FloatArray:
        """Return the energy density, (n, 3) to (n,)."""
        ...

    def derivatives(self, log_stretch: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return its first and second derivatives, (n, 3) to (n, 3) and (n, 3, 3)."""
        ...


BULK_TO_SHEAR = 1000.0
"""Default ratio of bulk to initial shear modulus: nearly incompressible."""


@dataclass(frozen=True)
class SolidMaterial:
    """A nearly incompressible solid, W = law(isochoric stretches) + κ/2 (J − 1)² + fibres.

    Parameters
    ----------
    law : IsotropicLaw
    bulk_modulus_MPa : float
    density_tonne_per_mm3 : float
    fibres : tuple of SlackFibre
    """

    law: IsotropicLaw
    bulk_modulus_MPa: float
    density_tonne_per_mm3: float
    fibres: tuple[SlackFibre, ...] = ()
