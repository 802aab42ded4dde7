"""Direct solution of the symmetric tangent, mostly definite: MKL Pardiso where installed, else SuperLU."""

from __future__ import annotations

from importlib.util import find_spec
from typing import Protocol

import numpy as np
from scipy.sparse import csc_array, csr_array, triu
from scipy.sparse.linalg import splu

from .elements import FloatArray, IndexArray
from .mkl_pardiso import SYMMETRIC_DEFINITE, SYMMETRIC_INDEFINITE, Pardiso, PardisoError


class SingularTangentError(ArithmeticError):
    """The tangent could not be factorised."""


class LinearSolver(Protocol):
    """Factorises matrices of one pattern, again and again."""

    name: str

    def factorise(self, upper: csr_array) -> None:
        """Factorise the symmetric matrix whose upper triangle is given."""
        ...

    def solve(self, right_hand_side: FloatArray) -> FloatArray:
        """Solve with the last factorisation."""
        ...

    @property
    def negative_pivots(self) -> int | None:
        """Number of negative eigenvalues of the last matrix, where the solver tells."""
        ...


def linear_solver() -> LinearSolver:
    """Return the fastest solver installed."""
    return PardisoSolver() if find_spec("pypardiso") else SuperLUSolver()


class PardisoSolver:
    """Intel MKL's Pardiso: Cholesky's L·Lᵀ, or L·D·Lᵀ with Bunch-Kaufman pivoting where that fails.

    Nearly all tangents of a ramp are positive definite, and Cholesky's factors cost three quarters of the
    others' time; a few off equilibrium or past a limit point are not. Orderings are kept between matrices.
    """

    name = "pardiso"

    def __init__(self) -> None:
        self._definite: Pardiso | None = None
        self._indefinite: Pardiso | None = None
        self._last: Pardiso | None = None

    def factorise(self, upper: csr_array) -> None:
        """Factorise the symmetric matrix whose upper triangle is given."""
        self._last = None
        if self._definite is None:
            self._definite = Pardiso(SYMMETRIC_DEFINITE, upper)
        try:
            self._definite.factorise(upper)
            self._last = self._definite
        except PardisoError:
            self._last = self._factorise_indefinite(upper, self._definite.ordering)

    def _factorise_indefinite(self, upper: csr_array, ordering: IndexArray) -> Pardiso:
        try:
            if self._indefinite is None:
                self._indefinite = Pardiso(SYMMETRIC_INDEFINITE, upper, ordering=ordering)
            self._indefinite.factorise(upper)
        except PardisoError as error:
            raise SingularTangentError(str(error)) from error
        return self._indefinite

    def solve(self, right_hand_side: FloatArray) -> FloatArray:
        """Solve with the last factorisation."""
        if self._last is None:
            raise ValueError("solve() before factorise()")
        return self._last.solve(right_hand_side)

    @property
    def negative_pivots(self) -> int | None:
        """Number of negative eigenvalues of the last matrix."""
        return 0 if self._last is None or self._last is self._definite else self._last.negative_pivots


class SuperLUSolver:
    """SciPy's SuperLU on the full matrix: slower, but everywhere."""

    name = "superlu"
    negative_pivots = None

    def factorise(self, upper: csr_array) -> None:
        """Factorise the symmetric matrix whose upper triangle is given."""
        full = csc_array(upper + triu(upper, k=1).T)
        try:
            self._factors = splu(
                full, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.01, options={"SymmetricMode": True}
            )
        except RuntimeError as error:
            raise SingularTangentError(str(error)) from error

    def solve(self, right_hand_side: FloatArray) -> FloatArray:
        """Solve with the last factorisation."""
        return np.asarray(self._factors.solve(right_hand_side))
