"""Element routine: tangents against finite differences and NumPy, patch test, rigid rotation."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numba
import numpy as np
import pytest
from scipy.sparse import triu

from spavision.model.constitutive import deform, evaluate_materials
from spavision.model.element_kernels import BLOCKS, element_forces, element_tangents
from spavision.model.equilibrium import Equilibrium, Load, State
from spavision.model.fibre_points import fibre_response
from spavision.model.hex_mesh import TensorGrid, structured_mesh
from spavision.model.linear_solver import linear_solver
from spavision.model.materials.slack_fibre import SlackFibre
from spavision.model.materials.solid import SolidMaterial
from spavision.model.newton import NewtonSettings, find_equilibrium
from spavision.model.reference_kernels import reference_element_tangent
from spavision.model.sparsity import slabs

from .conftest import cube_mesh

LOAD = Load(gas_pressure_MPa=0.02, gravity=1.0)


def with_fibre(solid: SolidMaterial) -> SolidMaterial:
    return replace(solid, fibres=(SlackFibre((0.0, 0.6, 0.8), 2.0, 0.05, 0.05),))


def problem(solid: SolidMaterial, *, order: int) -> Equilibrium:
    mesh = cube_mesh(order=order, enclosed=True, distortion=0.06)
    is_fixed = np.repeat(np.isclose(mesh.nodes_mm[:, 1:2], 0.0), 3, axis=1)
    return Equilibrium(mesh, {"solid": solid}, is_fixed=is_fixed)


def displaced(body: Equilibrium, amplitude: float) -> State:
    """A smooth displacement, with the pressure that belongs to it."""
    x, y, z = body.mesh.nodes_mm.T
    field = amplitude * np.column_stack([np.sin(2 * y + z), np.cos(x + 2 * z) + y, np.sin(x * y + 1)])
    state = State(field * body.is_free, body.unloaded().pressure)
    return State(state.displacement, body.balance(state, LOAD).projected_pressure)


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("amplitude", [0.0, 1e-7, 0.12])
def test_tangent_against_finite_differences(body_solid: SolidMaterial, order: int, amplitude: float) -> None:
    """Row 21, cavity included; amplitudes 0 and 1e-7 meet equal and nearly equal stretches."""
    body = problem(with_fibre(body_solid), order=order)
    state = displaced(body, amplitude)
    upper = body.tangent(state, LOAD, body.balance(state, LOAD))
    full = (upper + triu(upper, k=1).T).toarray()
    rng = np.random.default_rng(1)
    step = 1e-6
    for _ in range(3):
        move = np.zeros_like(state.displacement)
        move[body.is_free] = rng.standard_normal(full.shape[0])
        ends = [State(state.displacement + s * step * move, state.pressure) for s in (1.0, -1.0)]
        forces = [body.balance(end, LOAD).condensed[body.is_free] for end in ends]
        expected = (forces[0] - forces[1]) / (2.0 * step)
        actual = full @ move[body.is_free]
        assert np.linalg.norm(actual - expected) < 1e-6 * np.linalg.norm(expected)


@pytest.mark.parametrize("order", [1, 2])
def test_linear_change_against_finite_differences(body_solid: SolidMaterial, order: int) -> None:
    """What a correction predicts of pressure, stress S = F⁻¹·τ·F⁻ᵀ and tension is their derivative."""
    body = problem(with_fibre(body_solid), order=order)
    state = displaced(body, 0.12)
    move = np.random.default_rng(4).standard_normal(state.displacement.shape) * body.is_free
    step = 1e-6

    def moved(sign: float) -> State:
        end = State(state.displacement + sign * step * move, state.pressure)
        balance = body.balance(end, LOAD)
        inverse = np.linalg.inv(balance.kinematics.F)
        kirchhoff = balance.response.stress[..., [[0, 3, 5], [3, 1, 4], [5, 4, 2]]]
        reference = inverse @ kirchhoff @ np.swapaxes(inverse, -1, -2)
        (family,) = balance.response.fibres
        six = reference[..., [0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]]
        return State(end.displacement, balance.projected_pressure, six, family.response.tension)

    forward, back = moved(1.0), moved(-1.0)
    change = body.linear_change(body.balance(state, LOAD), move)
    assert np.abs(change.tension).max() > 0.0
    for name in ("pressure", "stress", "tension"):
        expected = (getattr(forward, name) - getattr(back, name)) / (2.0 * step)
        np.testing.assert_allclose(getattr(change, name), expected, atol=1e-6 * np.abs(expected).max())


@pytest.mark.parametrize("tension", [1e-6, 1e-3, 0.1, 1.0])
def test_fibre_linearised_at_its_tension(tension: float) -> None:
    """At convergence prediction and law agree; before, the linearised law still touches the law's curve."""
    fibre = SlackFibre((0.0, 1.0, 0.0), 10.0, 0.2, 0.1)
    stretches = np.linspace(0.9, 1.6, 29)
    F = np.tile(np.eye(3), (1, len(stretches), 1, 1))
    F[0, :, 1, 1] = stretches
    response = fibre_response(fibre, F, np.full((1, len(stretches)), tension))
    # the law is convex: its tangents lie below it
    assert np.all(response.tension <= fibre.tension(stretches) + 1e-9)
    agreed = fibre_response(fibre, F, fibre.tension(stretches)[None])
    np.testing.assert_allclose(agreed.tension[0], fibre.tension(stretches), atol=1e-9)
    np.testing.assert_allclose(agreed.stiffness[0], fibre.stiffness(stretches), atol=1e-6)


@pytest.mark.parametrize("order", [1, 2])
def test_kernel_against_numpy(body_solid: SolidMaterial, order: int) -> None:
    body = problem(with_fibre(body_solid), order=order)
    state = displaced(body, 0.1)
    geometry, kinematics = body.geometry, deform(state.displacement, body.mesh.elements, body.geometry)
    response = evaluate_materials(body.groups, kinematics)
    stress, moduli = response.stress, response.moduli
    tables = (
        geometry.gradients,
        geometry.volumes,
        geometry.pressure_modes,
        kinematics.F,
        kinematics.J,
        stress,
    )
    n_elements, n_nodes = body.mesh.elements.shape
    operator = np.empty((n_elements, state.pressure.shape[1], 3, n_nodes))
    element_forces(*tables, np.empty((n_elements, 3, n_nodes)), np.empty_like(state.pressure), operator)
    blocks = np.empty((n_elements, 6, n_nodes, n_nodes))
    element_tangents(*tables, moduli, state.pressure, body.bulk_modulus_MPa, operator, blocks)
    for e in range(n_elements):
        expected = reference_element_tangent(
            gradients=geometry.gradients[e],
            volumes=geometry.volumes[e],
            modes=geometry.pressure_modes[e],
            F=kinematics.F[e],
            stress=stress[e],
            moduli=moduli[e],
            pressure=state.pressure[e],
            bulk_modulus_MPa=140.0,
        )
        for block, (i, j) in zip(blocks[e], BLOCKS, strict=True):
            np.testing.assert_allclose(block, expected[i, :, j, :], atol=1e-11 * np.abs(expected).max())


def test_threads_never_add_to_the_same_entry(body_solid: SolidMaterial) -> None:
    """Slabs of a long body: those two apart share no node, and the tangent is bitwise that of one thread."""
    lines = [np.linspace(0.0, size, size + 1) for size in (2, 24, 1)]
    mesh = structured_mesh(TensorGrid(*lines), order=2)
    order, starts = slabs(mesh.elements, mesh.nodes_mm[mesh.elements].mean(axis=1))
    nodes = [set(mesh.elements[order[a:b]].ravel()) for a, b in itertools.pairwise(starts)]
    assert len(nodes) > 2
    assert sorted(order) == list(range(len(mesh.elements)))
    assert all(not nodes[i] & nodes[j] for i in range(len(nodes)) for j in range(i + 2, len(nodes)))

    is_fixed = np.repeat(np.isclose(mesh.nodes_mm[:, 1:2], 0.0), 3, axis=1)
    body = Equilibrium(mesh, {"solid": body_solid}, is_fixed=is_fixed)
    state = displaced(body, 0.01)
    balance = body.balance(state, LOAD)
    tangent = body.tangent(state, LOAD, balance)
    threads = numba.get_num_threads()
    numba.set_num_threads(1)
    try:
        alone = body.tangent(state, LOAD, balance)
    finally:
        numba.set_num_threads(threads)
    np.testing.assert_array_equal(alone.data, tangent.data)


@pytest.mark.parametrize("order", [1, 2])
def test_patch(body_solid: SolidMaterial, order: int, tight: NewtonSettings) -> None:
    """Row 19: affine displacement of the skin of distorted elements is affine inside."""
    mesh = cube_mesh(order=order, distortion=0.05, cells=3)
    on_skin = np.any(np.isclose(mesh.nodes_mm, 0.0) | np.isclose(mesh.nodes_mm, 1.0), axis=1)
    body = Equilibrium(mesh, {"solid": body_solid}, is_fixed=np.repeat(on_skin[:, None], 3, axis=1))
    gradient = np.array([[0.2, 0.1, 0.0], [-0.05, -0.1, 0.15], [0.1, 0.0, -0.06]])
    affine = mesh.nodes_mm @ gradient.T
    start = State(np.where(on_skin[:, None], affine, 0.97 * affine), body.unloaded().pressure)
    result = find_equilibrium(body, start, Load(0.0, 0.0), solver=linear_solver(), settings=tight)
    np.testing.assert_allclose(result.state.displacement, affine, atol=1e-10)


@pytest.mark.parametrize("order", [1, 2])
def test_rigid_rotation_is_free_of_force(body_solid: SolidMaterial, order: int) -> None:
    """Row 20: 90° about z and a translation."""
    mesh = cube_mesh(order=order, distortion=0.05)
    body = Equilibrium(mesh, {"solid": body_solid}, is_fixed=np.zeros((len(mesh.nodes_mm), 3), dtype=bool))
    rotation = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    moved = mesh.nodes_mm @ rotation.T + np.array([3.0, -2.0, 1.0])
    state = State(moved - mesh.nodes_mm, body.unloaded().pressure)
    forces = body.balance(state, Load(0.0, 0.0)).condensed
    # κ (J − 1) turns the rounding of the moved coordinates, 1e-15, into stresses of κ·1e-15.
    assert np.abs(forces).max() < 1e-12 * 140.0
    assert body.strain_energy(state) < 1e-12 * 0.140
