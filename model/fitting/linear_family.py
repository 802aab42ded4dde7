"""Laws that are linear in their parameters: fitted by convex problems, no start values."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from scipy.linalg import null_space

from spavision.model.materials.curves import MODES
from spavision.model.materials.solid import IsotropicLaw
from spavision.model.materials.stability import incremental_moduli

from .constrained import constrained_least_squares
from .fit_data import FitData
from .measured_curve import FloatArray
from .solution import NoSuchLawError, Solution

_STRETCHES_CHECKED = 480
"""On the way through each test: so many that the law does not lose stability between two of them."""

_FIRST_STATES = 8
"""Each of so many of them makes the first conditions."""

_FIRST_INCREMENTS = np.array([[1.0, 0.0, 1.0, 1.0], [0.0, 1.0, -1.0, 1.0]])
"""Volume-preserving increments for which stability is asked to begin with."""

_ROUNDS = 30
"""Of adding the increments for which it is violated; about five are needed."""

STABILITY_MARGIN = 1e-3
"""Least incremental modulus asked for, over the shear modulus of the neo-Hookean fit."""


@dataclass(frozen=True)
class LinearFamily:
    """A law whose energy is a sum of parameters times known functions.

    Parameters
    ----------
    key : str
        As on the command line.
    label : str
        As printed.
    names : tuple of str
        Names of the parameters, all in MPa. The first alone must make a law.
    make : callable
        From parameters to the law.
    """

    key: str
    label: str
    names: tuple[str, ...]
    make: Callable[..., IsotropicLaw]

    @property
    def parameter_count(self) -> int:
        """Number of parameters."""
        return len(self.names)

    def solve(
        self, data: FitData, reach: Mapping[str, tuple[float, float]], *, allow_unstable: bool
    ) -> Solution:
        """Fit the law under the condition of stability, which is convex in the parameters.

        Parameters
        ----------
        data : FitData
        reach : mapping
            Range of stretch for each test in which the law must be stable.
        allow_unstable : bool
            Ask for no more than a positive shear modulus.

        Raises
        ------
        NoSuchLawError
            If no parameters make a stable law.
        """
        columns = data.stress_from(self._basis(data.log_stretch)[0])
        moduli = self._incremental_moduli({} if allow_unstable else reach)
        try:
            values, active = _solve_stably(columns, data, moduli)
            law = self.make(*values.tolist())
        except ValueError as error:
            raise NoSuchLawError(
                f"{self.label}: no stable law of this kind fits the data; check the sign of the stresses, "
                "fit a smaller --window, or add --allow-unstable"
            ) from error
        directions = null_space(active) if len(active) else np.eye(len(values))
        notes = ("held back by the condition of stability",) if len(active) else ()
        return Solution(
            law, self.names, ("MPa",) * len(values), values, columns @ directions, directions, notes
        )

    def _basis(self, log_stretch: FloatArray) -> tuple[FloatArray, FloatArray]:
        """First and second derivatives for each parameter alone, (n, 3, k) and (n, 3, 3, k).

        Taken as differences of laws, which is exact for linear ones and needs no second set of formulas;
        a law of the second parameter alone would have no shear modulus.
        """
        unit = np.eye(self.parameter_count)
        start = self.make(*unit[0].tolist()).derivatives(log_stretch)
        first, second = [start[0]], [start[1]]
        for row in unit[1:]:
            both = self.make(*(unit[0] + row).tolist()).derivatives(log_stretch)
            first.append(both[0] - start[0])
            second.append(both[1] - start[1])
        return np.stack(first, axis=-1), np.stack(second, axis=-1)

    def _incremental_moduli(self, reach: Mapping[str, tuple[float, float]]) -> FloatArray:
        """Incremental moduli at rest and along the tests for each parameter alone, (n, 2, 2, k)."""
        states = [np.zeros((1, 3))]
        for name, (low, high) in reach.items():
            states.append(MODES[name].log_stretch(np.geomspace(low, high, _STRETCHES_CHECKED)))
        _, second = self._basis(np.concatenate(states))
        return np.stack([incremental_moduli(part) for part in np.moveaxis(second, -1, 0)], axis=-1)


def _solve_stably(columns: FloatArray, data: FitData, moduli: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Fit with every incremental modulus above the margin; return the parameters and the active rows.

    Stability in every increment is infinitely many linear conditions: the violated ones are added until none
    is left (Kelley's cutting planes).
    """
    root = data.root_weight
    matrix, target = columns * root[:, None], data.stress_MPa * root
    modulus = float(matrix[:, 0] @ target) / float(matrix[:, 0] @ matrix[:, 0])
    if not modulus > 0.0:
        raise ValueError("the stresses oppose the strains")
    margin = STABILITY_MARGIN * modulus
    first = moduli[::_FIRST_STATES]
    rows = _rows(first, np.broadcast_to(_FIRST_INCREMENTS, (len(first), 2, 4)))
    for _ in range(_ROUNDS):
        values, active = constrained_least_squares(matrix, target, rows, np.full(len(rows), margin))
        lowest, increments = np.linalg.eigh(moduli @ values)
        violated = lowest[:, 0] < 0.5 * margin
        if not violated.any():
            break
        rows = np.concatenate([rows, _rows(moduli[violated], increments[violated][:, :, :1])])
    return values, rows[active]


def _rows(moduli: FloatArray, increments: FloatArray) -> FloatArray:
    """Modulus met by each increment, as a row in the parameters: (n, 2, 2, k), (n, 2, d) to (nd, k)."""
    rows = np.einsum("nad,nabk,nbd->ndk", increments, moduli, increments)
    return rows.reshape(-1, moduli.shape[-1])
