"""Direct solution of the symmetric indefinite tangent: MKL Pardiso where installed, else SuperLU."""

from __future__ import annotations

import os
import sys
from importlib.util import find_spec
from typing import Protocol

import numpy as np
from scipy.sparse import csc_array, csr_array, triu
from scipy.sparse.linalg import splu

from .elements import FloatArray

_SYMMETRIC_INDEFINITE = -2
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
    """Intel MKL's Pardiso, L·D·Lᵀ with Bunch-Kaufman pivoting; the ordering is kept between matrices."""

    name = "pardiso"

    def __init__(self) -> None:
        from pypardiso import PyPardisoSolver

        self._pardiso = PyPardisoSolver(mtype=_SYMMETRIC_INDEFINITE)
        # Unless told, the wrapper looks for MKL through the whole environment, each time anew.
        os.environ.setdefault("PYPARDISO_MKL_RT", self._pardiso.libmkl._name)
        # iparm 1: take the values below, not the defaults; 2: METIS ordering; 8: no refinement steps;
        # 10: pivots below 1e-8 are perturbed; 11, 13: neither scaling nor matching, the tangent being well
        # scaled; 21: Bunch-Kaufman pivots.
        for index, value in ((1, 1), (2, 2), (8, 0), (10, 8), (11, 0), (13, 0), (21, 1), (24, 0)):
            self._pardiso.set_iparm(index, value)
        self._matrix: csr_array | None = None

    def factorise(self, upper: csr_array) -> None:
        """Factorise the symmetric matrix whose upper triangle is given."""
        self._call(upper, _ANALYSE_AND_FACTORISE if self._matrix is None else _FACTORISE)
        self._matrix = upper

    def solve(self, right_hand_side: FloatArray) -> FloatArray:
        """Solve with the last factorisation."""
        return self._call(self._matrix, _SOLVE, right_hand_side)

    @property
    def negative_pivots(self) -> int | None:
        """Number of negative eigenvalues of the last matrix."""
        return int(self._pardiso.get_iparm(23))

    def _call(
        self, matrix: csr_array | None, phase: int, right_hand_side: FloatArray | None = None
    ) -> FloatArray:
        from pypardiso.pardiso_wrapper import PyPardisoError

        if matrix is None:
            raise ValueError("solve() before factorise()")
        vector = np.zeros(matrix.shape[0]) if right_hand_side is None else right_hand_side
        self._pardiso.set_phase(phase)
        try:
            return self._pardiso._call_pardiso(matrix, np.ascontiguousarray(vector))
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
