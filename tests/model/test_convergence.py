"""Orders of convergence: of the mesh, of Newton's method with and without the follower stiffness."""

from __future__ import annotations

import numpy as np
import pytest

from spavision.model.cavity import Cavity
from spavision.model.equilibrium import Load
from spavision.model.linear_solver import linear_solver
from spavision.model.newton import NewtonSettings, NotConvergedError, find_equilibrium
from spavision.model.verification.bodies import NEO_HOOKE, solid, tube
from spavision.model.verification.measurements import lame_tube

LAME_TUBE = 1.906666667
"""Row 13, Poisson's ratio 0.3: u E/(p A) at the bore."""


@pytest.mark.parametrize(("order", "cells", "rate"), [(1, 8, 2.0), (2, 4, 4.0)])
def test_bore_displacement_converges_with_the_mesh(order: int, cells: int, rate: float) -> None:
    """Row 13: the error falls as h² for Q1 and, at the nodes of a regular mesh, as h⁴ for Q2."""
    coarse, fine = (abs(lame_tube(0.3, order=order, cells=n) - LAME_TUBE) for n in (cells // 2, cells))
    assert np.log2(coarse / fine) == pytest.approx(rate, abs=0.2)


def newton_residuals(pressure_MPa: float) -> tuple[float, ...]:
    body = tube(solid(NEO_HOOKE, bulk_modulus_MPa=1e3), order=2, cells=3)
    settings = NewtonSettings(residual_tolerance=1e-11, correction_tolerance_mm=1e-6, max_iterations=12)
    solver = linear_solver()
    start = find_equilibrium(body, body.unloaded(), Load(0.25, 0.0), solver=solver, settings=settings).state
    return find_equilibrium(body, start, Load(pressure_MPa, 0.0), solver=solver, settings=settings).residuals


def test_newton_is_quadratic() -> None:
    """Row 25: once small, the residual is about squared from one iteration to the next."""
    residuals = np.array(newton_residuals(0.45))
    before, after = residuals[-3:-1], residuals[-2:]
    assert before[0] < 1e-2
    assert np.all(after < np.maximum(before**1.8, 1e-13))  # the latter is rounding


def test_newton_without_follower_stiffness_is_not(monkeypatch: pytest.MonkeyPatch) -> None:
    """Row 25: with the cavity's Hessian left out the iteration is linear at best, and may diverge."""
    exact = len(newton_residuals(0.45))

    def nothing(cavity: Cavity, _: np.ndarray) -> np.ndarray:
        n_nodes = cavity.faces.shape[1]
        return np.zeros((len(cavity.faces), 3, n_nodes, n_nodes))

    monkeypatch.setattr(Cavity, "hessians", nothing)
    with pytest.raises(NotConvergedError):
        newton_residuals(0.45)
    assert exact < 8
