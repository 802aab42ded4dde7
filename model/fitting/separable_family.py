"""Laws that are sums of moduli times functions of one exponent or limit each: Ogden, Gent, Arruda-Boyce."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from spavision.model.materials.solid import IsotropicLaw

from .fit_data import FitData
from .measured_curve import FloatArray
from .solution import NoSuchLawError, Solution
from .variable_projection import Minimum, best_of_many_starts

STARTS_PER_TERM = 8
"""Twice as many where moduli of any sign are let in: there are more local minima then."""

_AT_BOUND = 1e-3
"""Share of the range of a shape variable within which it counts as at the end: the solver stays inside."""

Shape = Callable[[float, FloatArray], tuple[FloatArray, FloatArray]]
"""From a shape variable and log stretches (n, 3) to a unit term's first derivatives and how they change with
the variable, each (n, 3)."""


@dataclass(frozen=True)
class Reported:
    """The parameters that a user knows.

    Parameters
    ----------
    law : IsotropicLaw
    names, units : tuple of str
    values : array, shape (k,)
    change : array, shape (k, k)
        Derivatives of the values with respect to (moduli, shape variables).
    """

    law: IsotropicLaw
    names: tuple[str, ...]
    units: tuple[str, ...]
    values: FloatArray
    change: FloatArray


@dataclass(frozen=True)
class SeparableFamily:
    """A law W = Σ aⱼ φ(θⱼ), with moduli a and shape variables θ.

    Parameters
    ----------
    key, label : str
    terms : int
    shape : callable
        See `Shape`.
    shape_bounds : callable
        From the data to the lowest and highest shape variable.
    draw : callable
        From a random generator and those bounds to the shape variables of one start, shape (terms,).
    report : callable
        From moduli and shape variables to `Reported`.
    """

    key: str
    label: str
    terms: int
    shape: Shape
    shape_bounds: Callable[[FitData], tuple[float, float]]
    draw: Callable[[np.random.Generator, tuple[float, float]], FloatArray]
    report: Callable[[FloatArray, FloatArray], Reported]

    @property
    def parameter_count(self) -> int:
        """Number of parameters."""
        return 2 * self.terms

    def solve(
        self,
        data: FitData,
        reach: Mapping[str, tuple[float, float]],  # noqa: ARG002
        *,
        allow_unstable: bool,
        starts: int | None = None,
        seed: int = 0,
    ) -> Solution:
        """Fit the law from many starts; moduli of 0 and more make it stable everywhere.

        Parameters
        ----------
        data : FitData
        reach : mapping
            Not used, for the condition of stability does not depend on the range.
        allow_unstable : bool
            Let the moduli have any sign.
        starts : int, optional
            How many random starts; after `STARTS_PER_TERM` unless given.
        seed : int
            Which.

        Raises
        ------
        NoSuchLawError
            If no start leads to a law with a positive shear modulus.
        """
        bounds = self.shape_bounds(data)
        rng = np.random.default_rng(seed)
        if starts is None:
            starts = STARTS_PER_TERM * self.terms * (2 if allow_unstable else 1)
        candidates = [self.draw(rng, bounds) for _ in range(starts)]
        minima = best_of_many_starts(self.shape, data, candidates, bounds=bounds, any_sign=allow_unstable)
        for minimum in minima:
            if (minimum.moduli.sum() > 0.0) and np.isfinite(minimum.cost):
                return self._solution(minimum, data, bounds)
        raise NoSuchLawError(
            f"{self.label}: no law of this kind fits the data with a positive shear modulus; check the sign "
            "of the stresses and the strain window"
        )

    def _solution(self, minimum: Minimum, data: FitData, bounds: tuple[float, float]) -> Solution:
        order = np.argsort(minimum.shape_variables, kind="stable")
        used = order[minimum.moduli[order] != 0.0]
        moduli, variables = minimum.moduli[used], minimum.shape_variables[used]
        reported = self.report(moduli, variables)
        terms = [self.shape(variable, data.log_stretch) for variable in variables]
        columns = [data.stress_from(term[0]) for term in terms]
        slopes = [modulus * data.stress_from(term[1]) for modulus, term in zip(moduli, terms, strict=True)]
        room = _AT_BOUND * (bounds[1] - bounds[0])
        at_bound = (variables < bounds[0] + room) | (variables > bounds[1] - room)
        free = np.concatenate([np.ones(len(moduli), dtype=bool), ~at_bound])
        return Solution(
            law=reported.law,
            names=reported.names,
            units=reported.units,
            values=reported.values,
            jacobian=np.stack(columns + slopes, axis=1)[:, free],
            directions=reported.change[:, free],
            notes=self._notes(len(used), at_bound.any()),
        )

    def _notes(self, used: int, at_bound: bool) -> tuple[str, ...]:
        notes = []
        if used < self.terms:
            notes.append(f"{used} of {self.terms} terms are enough: the others vanish in the best stable fit")
        if at_bound:
            notes.append("a parameter is at the end of the range in which it is looked for")
        return tuple(notes)
