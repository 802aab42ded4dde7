"""The paper's beam elements against the elastica and the circle, and against finite differences."""

import numpy as np
import pytest
from scipy.integrate import solve_bvp

from spavision.errors import InputError
from spavision.model.coupon.beam import Beam
from spavision.model.coupon.geometry import CouponGeometry
from spavision.model.coupon.paper import Paper, paper_of_sheet

SLENDER = Paper(thickness_mm=0.01, modulus_MPa=1e4, poissons_ratio=0.0, bending_yield_MPa=np.inf)
"""Length over thickness 1000 below: the shear and stretching of the elastica's limit vanish."""

LENGTH = 10.0


def solve(beam, n_nodes, *, fixed, load, guess=None, steps=20):
    """Newton's method on the beam alone; unknowns x, y, θ of each node, dead loads applied in steps."""
    places = np.hstack([3 * beam.nodes[:, :1] + np.arange(9), np.full((len(beam.nodes), 1), 3 * n_nodes)])
    free = np.setdiff1d(np.arange(3 * n_nodes), fixed)
    u = np.zeros(3 * n_nodes) if guess is None else guess.copy()
    for share in np.linspace(1.0 / steps, 1.0, steps):
        for _ in range(60):
            field = u.reshape(-1, 3)
            response = beam.respond(field[:, :2], field[:, 2], 0.0)
            forces = np.zeros(3 * n_nodes + 1)
            np.add.at(forces, places, response.forces)
            matrix = np.zeros((3 * n_nodes + 1, 3 * n_nodes + 1))
            np.add.at(matrix, (places[:, :, None], places[:, None, :]), response.tangents)
            residual = (forces[:-1] - share * load)[free]
            change = -np.linalg.solve(matrix[np.ix_(free, free)], residual)
            u[free] += change
            if np.abs(change).max() < 1e-10:
                break
        else:
            pytest.fail("no convergence")
    return u.reshape(-1, 3)


def cantilever(n_elements):
    x = np.linspace(0.0, LENGTH, 2 * n_elements + 1)
    return Beam(np.column_stack([x, np.zeros_like(x)]), SLENDER), len(x)


@pytest.mark.parametrize(
    ("load", "down", "back"),
    [(1.0, 0.301721, 0.056433), (5.0, 0.713792, 0.387628), (10.0, 0.810609, 0.554996)],
)
def test_elastica_under_a_dead_tip_load(load, down, back):
    """Row 17 of the closed forms: P L²/EI and the tip's displacements over L."""
    beam, n = cantilever(16)
    force = np.zeros(3 * n)
    force[3 * (n - 1) + 1] = load * SLENDER.bending_stiffness / LENGTH**2
    tip = solve(beam, n, fixed=[0, 1, 2], load=force)[-1]
    assert tip[1] / LENGTH == pytest.approx(down, abs=2e-4)
    assert -tip[0] / LENGTH == pytest.approx(back, abs=2e-4)


def test_end_moment_closes_the_circle():
    """Row 18: M L/EI = 2π brings the tip back to the root."""
    beam, n = cantilever(16)
    moment = np.zeros(3 * n)
    moment[3 * (n - 1) + 2] = 2.0 * np.pi * SLENDER.bending_stiffness / LENGTH
    tip = solve(beam, n, fixed=[0, 1, 2], load=moment)[-1]
    np.testing.assert_allclose([LENGTH + tip[0], tip[1]], 0.0, atol=2e-3 * LENGTH)
    assert tip[2] == pytest.approx(2.0 * np.pi, rel=1e-6)


def test_tangent_and_forces_are_derivatives_of_the_energy():
    paper = Paper()
    geometry = CouponGeometry(0.3)
    points = geometry.points(geometry.stations(2, 3))
    beam = Beam(points, paper)
    rng = np.random.default_rng(2)
    u = 0.05 * rng.standard_normal((len(points), 3))
    move = rng.standard_normal((len(points), 3))
    cross, cross_move, step = 0.02, 0.3, 1e-6

    def respond(sign):
        field = u + sign * step * move
        return beam.respond(field[:, :2], field[:, 2], cross + sign * step * cross_move)

    def energy(sign):
        field = u + sign * step * move
        return beam.energy(field[:, :2], field[:, 2], cross + sign * step * cross_move)

    local = np.hstack(
        [move[beam.nodes].reshape(len(beam.nodes), 9), np.full((len(beam.nodes), 1), cross_move)]
    )
    here = respond(0.0)
    work = float(np.sum(here.forces * local))
    assert work == pytest.approx((energy(1.0) - energy(-1.0)) / (2 * step), rel=1e-7)
    expected = (respond(1.0).forces - respond(-1.0).forces) / (2 * step)
    actual = np.einsum("edf,ef->ed", here.tangents, local)
    np.testing.assert_allclose(actual, expected, atol=1e-6 * np.abs(expected).max())


def wave_under_tension(pull, geometry, paper):
    """Strain of a bare zigzag of inextensible elastic legs with stiff folds, from the elastica's equation.

    A quarter wave from a fold, where the angle keeps its value φ, to the moment-free middle of the leg:
    D ψ'' = P sin ψ with ψ(0) = φ, ψ'(ℓ) = 0.
    """
    quarter = 0.25 * geometry.wavelength_mm / np.cos(geometry.slope)
    s = np.linspace(0.0, quarter, 400)
    load = pull / paper.bending_stiffness
    decay = np.exp(-np.sqrt(load) * s)
    found = solve_bvp(
        lambda _, y: np.vstack([y[1], load * np.sin(y[0])]),
        lambda a, b: np.array([a[0] - geometry.slope, b[1]]),
        s,
        np.vstack([geometry.slope * decay, -np.sqrt(load) * geometry.slope * decay]),
        tol=1e-8,
        max_nodes=20000,
    )
    assert found.success
    return np.trapezoid(np.cos(found.sol(s)[0]), s) / (0.25 * geometry.wavelength_mm) - 1.0


@pytest.mark.parametrize("pull", [0.02, 0.2, 2.0, 20.0])
def test_bare_wave_follows_the_elastica_towards_full_decrimp(pull):
    """Paper alone with sharp, stiff folds against a boundary-value solver; limit √(1 + 16 CR²) − 1."""
    geometry = CouponGeometry(0.3, fold_radius_mm=0.0)
    paper = Paper(modulus_MPa=1e6 - 1.0, thickness_mm=0.02, poissons_ratio=0.0, bending_yield_MPa=np.inf)
    points = geometry.points(geometry.stations(0, 24))
    n = len(points)
    load = np.zeros(3 * n)
    load[3 * (n - 1)] = pull
    field = solve(Beam(points, paper), n, fixed=[0, 1, 2, 3 * n - 1], load=load, steps=30)
    strain = field[-1, 0] / (0.5 * geometry.wavelength_mm)
    stretched = pull / (paper.modulus_MPa * paper.thickness_mm) * (1.0 + geometry.straight_strain)
    expected = wave_under_tension(pull, geometry, paper)
    assert strain == pytest.approx(expected, abs=1e-3 + stretched)
    full = np.sqrt(1.0 + 16.0 * 0.3**2) - 1.0
    assert geometry.straight_strain == pytest.approx(full)
    assert strain < full + stretched
    if pull == 20.0:
        assert strain > 0.95 * full


def test_bending_moment_is_elastic_at_first_and_plastic_at_last():
    paper = Paper()
    moment, slope = paper.moment(np.array([1e-6, 1e3]))
    assert slope[0] == pytest.approx(paper.bending_stiffness)
    # the textbook's plastic moment of a rectangle, σ_y t²/4
    assert moment[1] == pytest.approx(35.0 * 0.1**2 / 4.0, rel=1e-5)


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"modulus_MPa": -1.0}, "modulus_MPa"),
        ({"thickness_mm": 0.0}, "thickness_mm"),
        ({"poissons_ratio": 0.6}, "poissons_ratio"),
        ({"cross_ratio": 9.0}, "cross_ratio"),
        ({"strength_MPa": float("nan")}, "strength_MPa"),
    ],
)
def test_impossible_paper_is_refused(changes, word):
    with pytest.raises(InputError, match=word):
        paper_of_sheet("Bond paper 80 gsm", **changes)


def test_unknown_sheet_is_told():
    with pytest.raises(InputError, match="Bond paper 80 gsm"):
        paper_of_sheet("Cardboard")
