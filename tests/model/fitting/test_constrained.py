"""Least squares under inequalities against problems with known answers and against a general solver."""

import numpy as np
import pytest
from scipy.optimize import minimize

from spavision.model.fitting.constrained import constrained_least_squares


def test_point_is_projected_on_a_half_plane():
    """The nearest point to (0, 0) with x + y ≥ 2 is (1, 1)."""
    x, active = constrained_least_squares(np.eye(2), np.zeros(2), np.array([[1.0, 1.0]]), np.array([2.0]))
    np.testing.assert_allclose(x, [1.0, 1.0], rtol=1e-12)
    assert active.tolist() == [0]


def test_idle_inequalities_leave_the_minimum_alone():
    matrix = np.array([[1.0, 2.0], [3.0, 4.0], [5.0, 7.0]])
    target = np.array([1.0, 2.0, 2.5])
    x, active = constrained_least_squares(matrix, target, np.eye(2), np.array([-10.0, -10.0]))
    np.testing.assert_allclose(x, np.linalg.lstsq(matrix, target, rcond=None)[0], rtol=1e-10)
    assert len(active) == 0


@pytest.mark.parametrize("seed", range(5))
def test_agrees_with_a_general_solver(seed):
    rng = np.random.default_rng(seed)
    matrix, target = rng.normal(size=(30, 4)) * [1.0, 10.0, 0.1, 1.0], rng.normal(size=30)
    inequalities, margins = rng.normal(size=(12, 4)), rng.uniform(-0.02, -0.01, 12)
    # the origin satisfies them, the free minimum does not
    x, active = constrained_least_squares(matrix, target, inequalities, margins)
    assert len(active) > 0
    general = minimize(
        lambda v: 0.5 * np.sum((matrix @ v - target) ** 2),
        x,
        jac=lambda v: matrix.T @ (matrix @ v - target),
        method="SLSQP",
        constraints={"type": "ineq", "fun": lambda v: inequalities @ v - margins},
        options={"ftol": 1e-14, "maxiter": 500},
    )
    assert np.all(inequalities @ x >= margins - 1e-9)
    assert 0.5 * np.sum((matrix @ x - target) ** 2) <= general.fun * (1.0 + 1e-9)


def test_contradictions_are_refused():
    with pytest.raises(ValueError, match="no solution"):
        constrained_least_squares(np.eye(1), np.zeros(1), np.array([[1.0], [-1.0]]), np.array([1.0, 1.0]))
