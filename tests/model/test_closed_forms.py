"""The assembled model against closed forms (the rows are those of the project's table of closed forms)."""

from __future__ import annotations

import numpy as np
import pytest

from spavision.model.equilibrium import Equilibrium, Load, State
from spavision.model.hex_mesh import TensorGrid, structured_mesh
from spavision.model.linear_solver import linear_solver
from spavision.model.materials.ogden import Ogden
from spavision.model.materials.solid import SolidMaterial
from spavision.model.newton import NewtonSettings, find_equilibrium

from .conftest import cube_mesh


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize(
    ("stretch", "nominal_MPa", "J"),
    [
        (1.5, 0.160353990, 1.000572365),
        (2.0, 0.324480727, 1.001542766),
        (0.7, -0.187586302, 0.999687258),
    ],
)
def test_uniaxial_tension(
    body_solid: SolidMaterial,
    tight: NewtonSettings,
    order: int,
    stretch: float,
    nominal_MPa: float,
    J: float,
) -> None:
    """Row 2: BODY with κ = 140 MPa."""
    body, state = stretched_cube(body_solid, order=order, stretch=stretch, settings=tight)
    reactions = body.balance(state, Load(0.0, 0.0)).condensed
    top = np.isclose(body.mesh.nodes_mm[:, 1], 1.0)
    assert reactions[top, 1].sum() == pytest.approx(nominal_MPa, rel=1e-8)
    side = np.isclose(body.mesh.nodes_mm[:, 0], 1.0)
    lateral = 1.0 + state.displacement[side, 0]
    np.testing.assert_allclose(stretch * lateral**2, J, rtol=1e-8)
    if stretch == 1.5:
        np.testing.assert_allclose(lateral, 0.816730215, rtol=1e-8)


@pytest.mark.parametrize("order", [1, 2])
def test_incompressible_cube(tight: NewtonSettings, order: int) -> None:
    """anchors.md: pulled to twice its length the side moves in by 1 − 1/√2; κ = 10⁸ G leaves some 10⁻⁸."""
    incompressible = SolidMaterial(Ogden((1.0,), (2.0,)), bulk_modulus_MPa=1e8, density_tonne_per_mm3=0.0)
    body, state = stretched_cube(incompressible, order=order, stretch=2.0, settings=tight)
    side = np.isclose(body.mesh.nodes_mm[:, 0], 1.0)
    np.testing.assert_allclose(state.displacement[side, 0], -0.292893, atol=1e-6)


def stretched_cube(
    solid: SolidMaterial, *, order: int, stretch: float, settings: NewtonSettings
) -> tuple[Equilibrium, State]:
    """A unit cube between rollers that are drawn apart along y, its sides free."""
    mesh = cube_mesh(order=order)
    is_fixed = np.isclose(mesh.nodes_mm, 0.0)
    is_fixed[:, 1] |= np.isclose(mesh.nodes_mm[:, 1], 1.0)
    body = Equilibrium(mesh, {"solid": solid}, is_fixed=is_fixed)
    guess = stretch**-0.5 * 1.02
    start = State(mesh.nodes_mm * np.array([guess, stretch, guess]) - mesh.nodes_mm, body.unloaded().pressure)
    result = find_equilibrium(body, start, Load(0.0, 0.0), solver=linear_solver(), settings=settings)
    return body, result.state


@pytest.mark.parametrize("order", [1, 2])
def test_cube_under_pressure_all_round(body_solid: SolidMaterial, tight: NewtonSettings, order: int) -> None:
    """Row 6: J = 1 − p/κ under the Cauchy pressure p."""
    mesh = cube_mesh(order=order, enclosed=True)
    is_fixed = np.isclose(mesh.nodes_mm, 0.0)
    body = Equilibrium(mesh, {"solid": body_solid}, is_fixed=is_fixed)
    result = find_equilibrium(body, body.unloaded(), Load(1.4, 0.0), solver=linear_solver(), settings=tight)
    far = np.isclose(mesh.nodes_mm, 1.0)
    np.testing.assert_allclose(1.0 + result.state.displacement[far], 0.996655493, rtol=1e-9)


def tube_problem(law: Ogden, *, bulk_modulus_MPa: float, cells: int) -> Equilibrium:
    """A quarter of a thick tube, inner radius 1, outer 2, in plane strain."""

    def to_tube(grid: np.ndarray) -> np.ndarray:
        radius, angle, height = grid.T
        return np.column_stack([radius * np.cos(angle), radius * np.sin(angle), height])

    mesh = structured_mesh(
        TensorGrid(
            np.linspace(1.0, 2.0, cells + 1), np.linspace(0.0, np.pi / 2, cells + 1), np.array([0.0, 0.5])
        ),
        order=2,
        is_cavity_face=lambda centres: np.isclose(centres[:, 0], 1.0),
        mapping=to_tube,
    )
    is_fixed = np.isclose(mesh.nodes_mm, 0.0)
    is_fixed[:, 2] = np.isclose(mesh.nodes_mm[:, 2], 0.0) | np.isclose(mesh.nodes_mm[:, 2], 0.5)
    solid = SolidMaterial(law=law, bulk_modulus_MPa=bulk_modulus_MPa, density_tonne_per_mm3=0.0)
    return Equilibrium(mesh, {"solid": solid}, is_fixed=is_fixed, cavity_axis_weights=(0.5, 0.5, 0.0))


@pytest.mark.parametrize(
    ("law", "pressures_MPa", "bore_stretch"),
    [
        (Ogden((1.0,), (2.0,)), (0.1, 0.2, 0.3, 0.428228409), 1.5),
        (Ogden((1.0, 3.0 / 140.0, -2.0 / 140.0), (2.0, 6.0, -3.0)), (0.1, 0.2, 0.3, 0.417095545), 1.4),
    ],
    ids=["neo-Hooke (row 7)", "three-term Ogden (row 9)"],
)
def test_thick_tube(
    law: Ogden, pressures_MPa: tuple[float, ...], bore_stretch: float, tight: NewtonSettings
) -> None:
    body = tube_problem(law, bulk_modulus_MPa=1e5, cells=6)
    state, solver = body.unloaded(), linear_solver()
    for pressure in pressures_MPa:
        state = find_equilibrium(body, state, Load(pressure, 0.0), solver=solver, settings=tight).state
    bore = np.isclose(np.linalg.norm(body.mesh.nodes_mm[:, :2], axis=1), 1.0)
    radius = np.linalg.norm((body.mesh.nodes_mm + state.displacement)[bore, :2], axis=1)
    # The floor set by κ = 1e5 μ instead of infinity is 2e-5.
    np.testing.assert_allclose(radius - 1.0, bore_stretch - 1.0, rtol=2e-4)
