"""MKL's Pardiso on a matrix of fixed pattern, called without the copies that its wrapper makes."""

from __future__ import annotations

import ctypes
import os
import sys

import numpy as np
from scipy.sparse import csr_array

from .elements import FloatArray, IndexArray

SYMMETRIC_DEFINITE, SYMMETRIC_INDEFINITE = 2, -2

_ANALYSE, _FACTORISE, _SOLVE, _FREE = 11, 22, 33, -1

_SETTINGS = {
    1: 1,  # take the values below, not the defaults
    2: 2,  # METIS ordering
    8: 0,  # no refinement steps
    10: 8,  # pivots below 1e-8 are perturbed
    11: 0,  # no scaling: the tangent is well scaled
    13: 0,  # no matching
    21: 1,  # Bunch-Kaufman pivots
    35: 1,  # indices count from 0
}


class PardisoError(ArithmeticError):
    """Pardiso could not do what it was asked for."""


class Pardiso:
    """One kind of factorisation for matrices of one pattern; its memory is given back at the end.

    Parameters
    ----------
    kind : int
        `SYMMETRIC_DEFINITE` or `SYMMETRIC_INDEFINITE`.
    upper : csr_array
        Upper triangle of a first matrix.
    ordering : array, shape (n,), optional
        Of another with the same pattern; by default one is found.
    """

    def __init__(self, kind: int, upper: csr_array, *, ordering: IndexArray | None = None) -> None:
        from pypardiso import PyPardisoSolver

        mkl = PyPardisoSolver(mtype=kind).libmkl
        # Unless told, the wrapper looks for MKL through the whole environment, each time anew.
        os.environ.setdefault("PYPARDISO_MKL_RT", mkl._name)
        self._pardiso = mkl.pardiso
        self._kind = kind
        self._handle = np.zeros(64, dtype=np.int64)
        self._options = np.zeros(64, dtype=np.int32)
        for index, value in _SETTINGS.items():
            self._options[index - 1] = value
        self._options[4] = 2 if ordering is None else 1
        self.ordering = np.zeros(upper.shape[0], dtype=np.int32) if ordering is None else ordering
        self._matrix = upper
        self._call(_ANALYSE)

    def factorise(self, upper: csr_array) -> None:
        """Factorise a matrix."""
        self._matrix = upper
        self._call(_FACTORISE)

    def solve(self, right_hand_side: FloatArray) -> FloatArray:
        """Solve with the last factors."""
        solution = np.empty(len(right_hand_side))
        self._call(_SOLVE, np.ascontiguousarray(right_hand_side), solution)
        return solution

    @property
    def negative_pivots(self) -> int:
        """Number of negative eigenvalues of the last matrix, if it was taken for indefinite."""
        return int(self._options[22])

    def _call(
        self, phase: int, right_hand_side: FloatArray | None = None, solution: FloatArray | None = None
    ) -> None:
        matrix, error = self._matrix, ctypes.c_int32(0)
        integer, real = ctypes.POINTER(ctypes.c_int32), ctypes.c_void_p
        self._pardiso(
            self._handle.ctypes.data_as(ctypes.POINTER(ctypes.c_int64)),
            *(ctypes.byref(ctypes.c_int32(value)) for value in (1, 1, self._kind, phase, matrix.shape[0])),
            matrix.data.ctypes.data_as(real),
            matrix.indptr.ctypes.data_as(integer),
            matrix.indices.ctypes.data_as(integer),
            self.ordering.ctypes.data_as(integer),
            ctypes.byref(ctypes.c_int32(1)),
            self._options.ctypes.data_as(integer),
            ctypes.byref(ctypes.c_int32(0)),
            None if right_hand_side is None else right_hand_side.ctypes.data_as(real),
            None if solution is None else solution.ctypes.data_as(real),
            ctypes.byref(error),
        )
        if error.value != 0:
            raise PardisoError(f"Pardiso's error {error.value}")

    def __del__(self) -> None:
        # At the interpreter's end the memory goes anyway.
        if hasattr(self, "_matrix") and not sys.is_finalizing():
            self._call(_FREE)
