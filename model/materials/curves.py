"""Nominal stress of an incompressible law in the three standard tests, from its derivatives alone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from .slack_fibre import SlackFibre
from .solid import IsotropicLaw

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Mode:
    """A homogeneous test of an incompressible specimen.

    Parameters
    ----------
    name : str
    direction : tuple of float
        Principal log stretches over ln λ, λ being the stretch in the first loaded direction.
    loaded_directions : int
        How many directions the machine pulls, all alike.
    """

    name: str
    direction: tuple[float, float, float]
    loaded_directions: int

    def log_stretch(self, stretch: FloatArray) -> FloatArray:
        """Return the principal log stretches, (n,) to (n, 3)."""
        return np.log(np.asarray(stretch, dtype=float))[:, None] * np.array(self.direction)


UNIAXIAL = Mode("uniaxial", (1.0, -0.5, -0.5), 1)
"""Tension (ISO 37) for λ > 1, compression (ISO 7743) without friction for λ < 1."""

EQUIBIAXIAL = Mode("equibiaxial", (1.0, 1.0, -2.0), 2)

PLANAR = Mode("planar", (1.0, 0.0, -1.0), 1)
"""Wide strip held at its width, also called pure shear."""

MODES = {mode.name: mode for mode in (UNIAXIAL, EQUIBIAXIAL, PLANAR)}


@runtime_checkable
class LockingLaw(Protocol):
    """A law that is defined up to a finite stretch only."""

    @property
    def largest_invariant(self) -> float:
        """Ī₁ − 3 at which the law locks."""
        ...


def nominal_stress(law: IsotropicLaw, stretch: FloatArray, mode: Mode) -> FloatArray:
    r"""Return the nominal stress in the loaded direction, (n,) to (n,), in MPa.

    With the log strains ln λ·d of the mode and m loaded directions, power balance gives

    .. math:: P = \frac{1}{m\lambda}\sum_i d_i\,\frac{\partial W}{\partial\ln\lambda_i}.

    Parameters
    ----------
    law : IsotropicLaw
    stretch : array, shape (n,)
        λ > 0.
    mode : Mode

    References
    ----------
    R. W. Ogden, Non-linear Elastic Deformations, Dover 1997, section 7.2.
    """
    first, _ = law.derivatives(mode.log_stretch(stretch))
    return project_stress(first, stretch, mode)


def project_stress(first: FloatArray, stretch: FloatArray, mode: Mode) -> FloatArray:
    """Turn derivatives in the log stretches, (n, 3, ...), into nominal stress, (n, ...); linear in them."""
    work = np.tensordot(first, np.array(mode.direction), axes=(1, 0))
    return work / (mode.loaded_directions * _like(stretch, work))


def nominal_stiffness(law: IsotropicLaw, stretch: FloatArray, mode: Mode) -> FloatArray:
    """Return dP/dλ of the nominal stress, (n,) to (n,), in MPa."""
    first, second = law.derivatives(mode.log_stretch(stretch))
    direction = np.array(mode.direction)
    stretch = np.asarray(stretch, dtype=float)
    curvature = np.einsum("i,nij,j->n", direction, second, direction)
    return (curvature - first @ direction) / (mode.loaded_directions * stretch**2)


def fibre_composite_stress(
    law: IsotropicLaw, fibre: SlackFibre, stretch: FloatArray, mode: Mode
) -> FloatArray:
    """Return the nominal stress along the fibres of a matrix with slack fibres, (n,) to (n,), in MPa.

    The fibres lie in the first loaded direction, so that their stretch is λ in each mode. Matrix and fibres
    share it, as in the finite-element model; fibres across it are left out, for they are slack in tension
    and in the planar test do no work.
    """
    return nominal_stress(law, stretch, mode) + fibre.tension(stretch)


def locking_stretches(law: LockingLaw, mode: Mode) -> tuple[float, float]:
    """Return the stretches below and above 1 at which the law locks in a mode."""
    direction = np.array(mode.direction)

    def excess(log_stretch: float) -> float:
        return float(np.expm1(2.0 * log_stretch * direction).sum()) - law.largest_invariant

    def root(end: float) -> float:
        while excess(end) < 0.0:
            end *= 2.0
        return float(np.exp(brentq(excess, 0.0, end, xtol=1e-13)))

    return root(-0.5), root(0.5)


def _like(stretch: FloatArray, values: FloatArray) -> FloatArray:
    return np.asarray(stretch, dtype=float).reshape((-1,) + (1,) * (values.ndim - 1))
