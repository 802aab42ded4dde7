"""The numerical uncertainty of the tip displacement at each mesh level, for the validation uncertainty."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from spavision.errors import InputError

from .elements import FloatArray


@dataclass(frozen=True)
class ErrorBound:
    """Bound of the tip's distance from its converged place.

    Parameters
    ----------
    of_displacement : float
        Share of the displacement at the same pressure.
    of_largest : float
        Share of the largest displacement of the path: small displacements are differences of large strains,
        and their errors do not shrink with them.
    """

    of_displacement: float
    of_largest: float


ERROR_BOUNDS = {
    "draft": ErrorBound(0.095, 0.0),
    "default": ErrorBound(0.019, 0.004),
    "fine": ErrorBound(0.008, 0.0),
}
"""Up to the first extremum, at crimp ratios 0.2 and 0.3.

Source: `benchmarks/fe_convergence.py`, an actuator of 4 voids against a converged path. At the first
extremum itself the errors are 6.8, 0.5 and 0.2 % at crimp ratio 0.2 and 9.4, 1.7 and 0.8 % at 0.3 (of the
full actuator, default: 1.8 % at 0.3). Beyond it the walls balloon, the sensitivity to the mesh grows and
the numbers do not hold.
"""

_COVERAGE = 2.0
"""The bound is taken for one of 95 %, two standard uncertainties (ASME V&V 20-2009)."""


def numerical_uncertainty_mm(mesh_level: str, ux_mm: FloatArray, uy_mm: FloatArray) -> FloatArray:
    """Return the standard uncertainty u_num of each displacement component, from discretisation.

    Parameters
    ----------
    mesh_level : str
        ``draft``, ``default`` or ``fine``.
    ux_mm, uy_mm : array, shape (n,)
        Tip displacement along the path; NaN where it is not known.

    Returns
    -------
    array, shape (n,)

    Raises
    ------
    InputError
        If the level is unknown.
    """
    if mesh_level not in ERROR_BOUNDS:
        known = ", ".join(ERROR_BOUNDS)
        raise InputError(f"mesh level is {mesh_level!r}, expected one of {known}")
    bound = ERROR_BOUNDS[mesh_level]
    size = np.hypot(ux_mm, uy_mm)
    largest = np.fmax.reduce(size, initial=0.0)
    return (bound.of_displacement * size + bound.of_largest * largest) / _COVERAGE
