"""Direct solution of the symmetric tangent, mostly definite: MKL Pardiso where installed, else SuperLU."""

from __future__ import annotations

import os
import sys
from importlib.util import find_spec
from typing import Protocol

import numpy as np
from scipy.sparse import csc_array, csr_array, triu
from scipy.sparse.linalg import splu

from .elements import FloatArray

_SYMMETRIC_DEFINITE, _SYMMETRIC_INDEFINITE = 2, -2
_ANALYSE_AND_FACTORISE, _FACTORISE, _SOLVE = 12, 22, 33


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
        self._definite = _Factoriser(_SYMMETRIC_DEFINITE)
        self._indefinite = _Factoriser(_SYMMETRIC_INDEFINITE)
        self._last: _Factoriser | None = None

    def factorise(self, upper: csr_array) -> None:
        """Factorise the symmetric matrix whose upper triangle is given."""
        try:
            self._definite.factorise(upper)
            self._last = self._definite
        except SingularTangentError:
            self._indefinite.factorise(upper)
            self._last = self._indefinite

    def solve(self, right_hand_side: FloatArray) -> FloatArray:
        """Solve with the last factorisation."""
        if self._last is None:
            raise ValueError("solve() before factorise()")
        return self._last.solve(right_hand_side)

    @property
    def negative_pivots(self) -> int | None:
        """Number of negative eigenvalues of the last matrix."""
        return 0 if self._last is self._definite else self._indefinite.negative_pivots


class _Factoriser:
    """One kind of factorisation for matrices of one pattern; its memory is given back at the end."""

    def __init__(self, kind: int) -> None:
        from pypardiso import PyPardisoSolver

        self._pardiso = PyPardisoSolver(mtype=kind)
        # Unless told, the wrapper looks for MKL through the whole environment, each time anew.
        os.environ.setdefault("PYPARDISO_MKL_RT", self._pardiso.libmkl._name)
        # iparm 1: take the values below, not the defaults; 2: METIS ordering; 8: no refinement steps;
        # 10: pivots below 1e-8 are perturbed; 11, 13: neither scaling nor matching, the tangent being well
        # scaled; 21: Bunch-Kaufman pivots.
        for index, value in ((1, 1), (2, 2), (8, 0), (10, 8), (11, 0), (13, 0), (21, 1), (24, 0)):
            self._pardiso.set_iparm(index, value)
        self._matrix: csr_array | None = None

    def factorise(self, upper: csr_array) -> None:
        """Factorise; the first time the ordering is found too."""
        phase = _ANALYSE_AND_FACTORISE if self._matrix is None else _FACTORISE
        self._matrix = upper
        self._call(phase, np.zeros(upper.shape[0]))

    def solve(self, right_hand_side: FloatArray) -> FloatArray:
        """Solve with the last factors."""
        return self._call(_SOLVE, right_hand_side)

    @property
    def negative_pivots(self) -> int:
        """Number of negative eigenvalues of the last matrix, if it was taken for indefinite."""
        return int(self._pardiso.get_iparm(23))

    def _call(self, phase: int, right_hand_side: FloatArray) -> FloatArray:
        from pypardiso.pardiso_wrapper import PyPardisoError

        self._pardiso.set_phase(phase)
        try:
            return self._pardiso._call_pardiso(self._matrix, np.ascontiguousarray(right_hand_side))
        except PyPardisoError as error:
            raise SingularTangentError(str(error)) from error

    def __del__(self) -> None:
        # At the interpreter's end the memory goes anyway, and the wrapper's imports are gone.
        if getattr(self, "_matrix", None) is not None and not sys.is_finalizing():
            self._pardiso.free_memory(everything=True)


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
