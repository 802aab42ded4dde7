"""What the solvers of all families hand back."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from spavision.errors import InputError
from spavision.model.materials.solid import IsotropicLaw

FloatArray = NDArray[np.float64]


class NoSuchLawError(InputError):
    """No law of the kind asked for fits the data; another kind may."""


@dataclass(frozen=True)
class Solution:
    """A fitted law and how its stress moves with its parameters.

    Parameters
    ----------
    law : IsotropicLaw
    names, units : tuple of str
        One of each a parameter.
    values : array, shape (k,)
    jacobian : array, shape (n, f)
        Derivatives of the nominal stress at every point in the f directions in which the parameters are free.
    directions : array, shape (k, f)
        Those directions; a parameter held by a bound has a row of zeros.
    notes : tuple of str
    """

    law: IsotropicLaw
    names: tuple[str, ...]
    units: tuple[str, ...]
    values: FloatArray
    jacobian: FloatArray
    directions: FloatArray
    notes: tuple[str, ...] = ()
