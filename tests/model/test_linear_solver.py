"""Direct solvers on definite and indefinite matrices, against NumPy's dense solution and eigenvalues."""

from importlib.util import find_spec

import numpy as np
import pytest
from scipy.sparse import csr_array, triu

from spavision.model.linear_solver import PardisoSolver, SuperLUSolver

SOLVERS = [
    pytest.param(
        PardisoSolver, marks=pytest.mark.skipif(find_spec("pypardiso") is None, reason="needs pypardiso")
    ),
    SuperLUSolver,
]
SIZE = 60


def _matrix(negative):
    """A banded symmetric matrix, full pattern within the band, with so many negative eigenvalues."""
    random = np.random.default_rng(4)
    dense = np.triu(np.tril(random.standard_normal((SIZE, SIZE)), 4))
    dense = dense + dense.T
    values = np.linalg.eigvalsh(dense)
    between = 0.0 if negative == 0 else 0.5 * (values[negative - 1] + values[negative])
    return dense + (1.0 - values[0] if negative == 0 else -between) * np.eye(SIZE)


@pytest.mark.parametrize("make", SOLVERS)
def test_definite_and_indefinite_matrices_by_turns(make):
    solver, right = make(), np.linspace(1.0, 2.0, SIZE)
    for negative in (0, 3, 0, 1):
        dense = _matrix(negative)
        assert np.count_nonzero(np.linalg.eigvalsh(dense) < 0) == negative
        solver.factorise(csr_array(triu(csr_array(dense))))
        assert solver.solve(right) == pytest.approx(np.linalg.solve(dense, right), rel=1e-8)
        if solver.negative_pivots is not None:
            assert solver.negative_pivots == negative
