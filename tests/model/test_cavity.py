"""The enclosed volume, the forces of the gas and their derivative."""

from __future__ import annotations

import numpy as np
import pytest

from spavision.model.cavity import Cavity
from spavision.model.hex_mesh import TensorGrid, structured_mesh

from .conftest import cube_mesh


def deformed_box(order: int) -> tuple[Cavity, np.ndarray]:
    """A closed skin round a unit cube (normals into it), bent at random."""
    mesh = cube_mesh(order=order, enclosed=True)
    noise = np.random.default_rng(2).standard_normal(mesh.nodes_mm.shape)
    return Cavity(mesh.cavity_faces, order), mesh.nodes_mm + 0.05 * noise


def nodal(cavity: Cavity, position: np.ndarray) -> np.ndarray:
    total = np.zeros_like(position)
    for axis in range(3):
        np.add.at(total[:, axis], cavity.faces, cavity.forces(position)[:, axis])
    return total


@pytest.mark.parametrize("order", [1, 2])
def test_closed_cavity_is_in_balance(order: int) -> None:
    """Row 22: the gas exerts neither force nor moment, and its volume does not depend on the origin."""
    cavity, position = deformed_box(order)
    forces = nodal(cavity, position)
    assert np.abs(forces.sum(axis=0)).max() < 1e-12
    assert np.abs(np.cross(position, forces).sum(axis=0)).max() < 1e-12
    shifted = cavity.volume(position + np.array([10.0, -20.0, 5.0]))
    assert shifted == pytest.approx(cavity.volume(position), rel=1e-10)


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("weights", [(1 / 3, 1 / 3, 1 / 3), (0.5, 0.5, 0.0), (0.2, 0.1, 0.7)])
def test_forces_and_hessian_against_differences(order: int, weights: tuple[float, float, float]) -> None:
    """Row 21; one face alone, so that nothing cancels."""
    closed, position = deformed_box(order)
    cavity = Cavity(closed.faces[:1], order, weights)
    face = cavity.faces[0]
    forces, blocks = cavity.forces(position)[0], cavity.hessians(position)[0]
    pairs = {(0, 1): blocks[0], (1, 2): blocks[1], (0, 2): blocks[2]}
    step = 1e-4  # the volume is a cubic: the error of the central difference is its rounding and step²
    for a, node in enumerate(face):
        for i in range(3):
            move = np.zeros_like(position)
            move[node, i] = step
            slope = (cavity.volume(position + move) - cavity.volume(position - move)) / (2 * step)
            assert slope == pytest.approx(forces[i, a], abs=1e-9)
            change = (cavity.forces(position + move)[0] - cavity.forces(position - move)[0]) / (2 * step)
            for j in range(3):
                row = (
                    pairs[i, j][a]
                    if (i, j) in pairs
                    else pairs[j, i][:, a]
                    if i != j
                    else np.zeros(len(face))
                )
                np.testing.assert_allclose(change[j], row, atol=1e-10)


def test_cut_cavity_has_the_forces_of_the_pressure() -> None:
    """Row 23: a tube cut at z = 0 and z = h; direct integration of the normals gives the same forces."""
    mesh = structured_mesh(
        TensorGrid(np.array([1.0, 1.5]), np.linspace(0.0, np.pi / 2, 4), np.array([0.0, 0.7])),
        order=2,
        is_cavity_face=lambda centres: np.isclose(centres[:, 0], 1.0),
        mapping=lambda g: np.column_stack([g[:, 0] * np.cos(g[:, 1]), g[:, 0] * np.sin(g[:, 1]), g[:, 2]]),
    )
    # Move the nodes without leaving the planes of symmetry.
    noise = 0.03 * np.random.default_rng(3).standard_normal(mesh.nodes_mm.shape)
    noise[np.isclose(mesh.nodes_mm, 0.0)] = 0.0
    noise[np.isclose(mesh.nodes_mm[:, 2], 0.7), 2] = 0.0
    position = mesh.nodes_mm + noise
    held = np.isclose(mesh.nodes_mm, 0.0)
    held[:, 2] |= np.isclose(mesh.nodes_mm[:, 2], 0.7)
    forces = nodal(Cavity(mesh.cavity_faces, 2, (0.5, 0.5, 0.0)), position)
    direct = _integrated_normals(mesh.cavity_faces, position)
    np.testing.assert_allclose(forces[~held], direct[~held], atol=1e-12)
    wrong = nodal(Cavity(mesh.cavity_faces, 2), position)
    assert np.abs(wrong - direct)[~held].max() > 1e-2


def _integrated_normals(faces: np.ndarray, position: np.ndarray) -> np.ndarray:
    """∫ N n da at each node."""
    from spavision.model.elements import reference_face

    table = reference_face(2)
    tangents = np.einsum("qda,fai->dfqi", table.tangents, position[faces])
    normal = np.cross(tangents[0], tangents[1])
    local = np.einsum("q,qa,fqi->fai", table.weights, table.values, normal)
    total = np.zeros_like(position)
    np.add.at(total, faces, local)
    return total
