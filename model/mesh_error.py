"""The numerical uncertainty of the tip displacement at each mesh level, for the validation uncertainty."""

from __future__ import annotations

import numpy as np

from spavision.errors import InputError

from .elements import FloatArray

LARGEST_RELATIVE_ERROR = {"draft": 0.116, "default": 0.048, "fine": 0.022}
"""Largest error of the tip displacement over its size, up to the first extremum, at crimp ratios 0.2 and 0.3.

Source: `benchmarks/fe_convergence.py`, an actuator of 4 voids against a converged mesh. At crimp ratio 0.2
alone it is 0.085, 0.048 (0.019 from 15 kPa on) and 0.011. Beyond the first extremum the walls balloon, the
sensitivity to the mesh grows and the numbers do not hold.
"""

_COVERAGE = 2.0
"""The largest error is taken for a bound of 95 %, two standard uncertainties (ASME V&V 20-2009)."""


def numerical_uncertainty_mm(mesh_level: str, ux_mm: FloatArray, uy_mm: FloatArray) -> FloatArray:
    """Return the standard uncertainty u_num of each displacement component, from discretisation.

    Parameters
    ----------
    mesh_level : str
        ``draft``, ``default`` or ``fine``.
    ux_mm, uy_mm : array, shape (n,)
        Tip displacement.

    Returns
    -------
    array, shape (n,)

    Raises
    ------
    InputError
        If the level is unknown.
    """
    if mesh_level not in LARGEST_RELATIVE_ERROR:
        known = ", ".join(LARGEST_RELATIVE_ERROR)
        raise InputError(f"mesh level is {mesh_level!r}, expected one of {known}")
    size = np.hypot(ux_mm, uy_mm)
    return LARGEST_RELATIVE_ERROR[mesh_level] / _COVERAGE * size
