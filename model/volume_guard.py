"""A barrier against the loss of volume at single Gauss points, to which the solid's own pressure is blind.

The element's few pressure modes hold its volume on average. In strongly bent elements at free corners the
volume ratio J can then fall at one point and rise at another until the corner folds inside out, though the
material, nearly incompressible, would long have resisted. Below J₀ the guard adds to the energy density

    U(J) = k G |ln(J/J₀)|³ / 3,    J < J₀,

with G the shear modulus: nothing for any deformation near the exact solution's, whose J is 1 (so the
discretisation stays consistent), a barrier without bound on the way to J = 0, twice continuously
differentiable at J₀.
"""

from __future__ import annotations

import numpy as np

from .elements import FloatArray, IntArray

GUARDED_BELOW = 0.6
"""J₀. The least J of the default actuator's ramps to 65 kPa is 0.64, so that they do not meet the guard."""

_STRENGTH = 20.0
"""k. A strength of 5 to 20 and J₀ of 0.6 to 0.8 move the tip of a ballooning actuator by 0.1 % of its way."""

_ALL_PAIRS = np.zeros((6, 6))
_ALL_PAIRS[:3, :3] = 1.0
_IDENTITY = np.diag([1.0, 1.0, 1.0, 0.5, 0.5, 0.5])


def guard_energy(J: FloatArray, shear_modulus_MPa: float) -> FloatArray:
    """Return the guard's energy density in MPa at volume ratios of any shape."""
    return shear_modulus_MPa * _STRENGTH / 3.0 * np.abs(_excess(J)) ** 3


def add_guard(
    elements: IntArray, J: FloatArray, shear_modulus_MPa: float, stress: FloatArray, moduli: FloatArray
) -> None:
    """Add the guard's share, with e = ln J a stress U'(e) I and moduli U''(e) I⊗I − 2 U'(e) 𝕀.

    Parameters
    ----------
    elements : array, shape (n,)
        Those to add it for.
    J : array, shape (n_elements, n_points)
        Volume ratios.
    shear_modulus_MPa : float
    stress : array, shape (n_elements, n_points, 6)
        Kirchhoff stress, added to.
    moduli : array, shape (n_elements, n_points, 6, 6)
        Spatial moduli, added to.
    """
    rows, points = np.nonzero(J[elements] < GUARDED_BELOW)
    if len(rows) == 0:
        return
    owners = elements[rows]
    excess = _excess(J[owners, points])
    slope = -shear_modulus_MPa * _STRENGTH * excess**2
    curvature = -2.0 * shear_modulus_MPa * _STRENGTH * excess
    stress[owners, points, :3] += slope[:, None]
    moduli[owners, points] += curvature[:, None, None] * _ALL_PAIRS - 2.0 * slope[:, None, None] * _IDENTITY


def _excess(J: FloatArray) -> FloatArray:
    """ln(J/J₀) where that is negative, else 0."""
    return np.minimum(np.log(J / GUARDED_BELOW), 0.0)
