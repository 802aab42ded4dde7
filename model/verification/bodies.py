"""Bodies of the verification problems; lengths in mm, moduli in MPa, as simple numbers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from spavision.model.elements import FloatArray
from spavision.model.equilibrium import GRAVITY_MM_PER_S2, Equilibrium
from spavision.model.hex_mesh import HexMesh, TensorGrid, structured_mesh
from spavision.model.materials.ogden import Ogden
from spavision.model.materials.solid import IsotropicLaw, SolidMaterial

from .merging import merged

NEO_HOOKE = Ogden((1.0,), (2.0,))
"""Shear modulus 1 MPa."""

BODY = Ogden((0.131, 0.003), (2.0, 6.0))
"""Shear modulus 0.140 MPa."""

INNER_RADIUS = 1.0
_CUT_WEIGHTS = (0.5, 0.5, 0.0)
_HEAVY_LAYER = 1e-4
"""Length, over the body's, of the layer whose weight stands for a dead load."""


def solid(law: IsotropicLaw, *, bulk_modulus_MPa: float, density: float = 0.0) -> SolidMaterial:
    """Return a material without fibres."""
    return SolidMaterial(law=law, bulk_modulus_MPa=bulk_modulus_MPa, density_tonne_per_mm3=density)


def bulk_modulus(shear_modulus_MPa: float, poisson: float) -> float:
    """Return κ = 2 G (1 + ν) / (3 (1 − 2ν))."""
    return 2.0 * shear_modulus_MPa * (1.0 + poisson) / (3.0 * (1.0 - 2.0 * poisson))


def cube(material: SolidMaterial) -> Equilibrium:
    """Return a unit cube whose skin is held."""
    lines = np.linspace(0.0, 1.0, 3)
    mesh = structured_mesh(TensorGrid(lines, lines, lines), order=2)
    on_skin = np.any(np.isclose(mesh.nodes_mm, 0.0) | np.isclose(mesh.nodes_mm, 1.0), axis=1)
    return Equilibrium(mesh, {"solid": material}, is_fixed=np.repeat(on_skin[:, None], 3, axis=1))


def tube(material: SolidMaterial, *, order: int, cells: int, outer_radius: float = 2.0) -> Equilibrium:
    """Return a quarter of a thick tube of inner radius 1 in plane strain."""

    def to_tube(grid: FloatArray) -> FloatArray:
        radius, angle, height = grid.T
        return np.column_stack([radius * np.cos(angle), radius * np.sin(angle), height])

    mesh = structured_mesh(
        TensorGrid(
            np.linspace(INNER_RADIUS, outer_radius, cells + 1),
            np.linspace(0.0, np.pi / 2, cells + 1),
            np.array([0.0, 0.5]),
        ),
        order=order,
        is_cavity_face=lambda centres: np.isclose(centres[:, 0], INNER_RADIUS),
        mapping=to_tube,
    )
    is_fixed = np.isclose(mesh.nodes_mm, 0.0, atol=1e-9)
    is_fixed[:, 2] |= np.isclose(mesh.nodes_mm[:, 2], 0.5)
    return Equilibrium(mesh, {"solid": material}, is_fixed=is_fixed, cavity_axis_weights=_CUT_WEIGHTS)


def sphere(
    material: SolidMaterial, *, order: int, across: int, around: int, outer_radius: float = 2.0
) -> Equilibrium:
    """Return an octant of a hollow sphere of inner radius 1: three patches of ``around``² columns."""

    def to_patch(grid: FloatArray) -> FloatArray:
        radius, first, second = grid.T
        ray = np.column_stack([np.ones(len(grid)), np.tan(first), np.tan(second)])
        return radius[:, None] * ray / np.linalg.norm(ray, axis=1, keepdims=True)

    angles = np.linspace(0.0, np.pi / 4, around + 1)
    grid = TensorGrid(np.linspace(INNER_RADIUS, outer_radius, across + 1), angles, angles)

    def patch(turns: int) -> HexMesh:
        return structured_mesh(
            grid,
            order=order,
            is_cavity_face=lambda centres: np.isclose(centres[:, 0], INNER_RADIUS),
            mapping=lambda nodes: np.roll(to_patch(nodes), turns, axis=1),
        )

    mesh = merged([patch(turns) for turns in range(3)])
    return Equilibrium(mesh, {"solid": material}, is_fixed=np.isclose(mesh.nodes_mm, 0.0, atol=1e-9))


def bent_block(material: SolidMaterial, *, length: float, cells: int, end_plane: int) -> Equilibrium:
    """Return a block of thickness 1 (x) in plane strain, its ends (y) to be held on radial planes.

    Parameters
    ----------
    material : SolidMaterial
    length : float
    cells : int
        Along the length; three across.
    end_plane : int
        Component of displacement held at the far end: 0 for a quarter turn, 1 for half a turn, for which
        one corner is held in x too.
    """
    mesh = structured_mesh(
        TensorGrid(np.linspace(0.0, 1.0, 4), np.linspace(0.0, length, cells + 1), np.array([0.0, 0.5])),
        order=2,
    )
    x, y, z = mesh.nodes_mm.T
    is_fixed = np.zeros((len(x), 3), dtype=bool)
    is_fixed[:, 2] = np.isclose(z, 0.0) | np.isclose(z, 0.5)
    is_fixed[np.isclose(y, 0.0), 1] = True
    is_fixed[np.isclose(y, length), end_plane] = True
    if end_plane == 1:
        is_fixed[np.isclose(y, 0.0) & np.isclose(x, 0.5), 0] = True
    return Equilibrium(mesh, {"solid": material}, is_fixed=is_fixed)


def cylinder(material: SolidMaterial, *, cells: int) -> Equilibrium:
    """Return a solid cylinder of radius 1 and length 1 along z, both end faces held."""

    def to_disc(grid: FloatArray) -> FloatArray:
        x, y, z = grid.T
        return np.column_stack([x * np.sqrt(1.0 - 0.5 * y**2), y * np.sqrt(1.0 - 0.5 * x**2), z])

    lines = np.linspace(-1.0, 1.0, cells + 1)
    mesh = structured_mesh(TensorGrid(lines, lines, np.array([0.0, 0.5, 1.0])), order=2, mapping=to_disc)
    at_end = np.isclose(mesh.nodes_mm[:, 2], 0.0) | np.isclose(mesh.nodes_mm[:, 2], 1.0)
    return Equilibrium(mesh, {"solid": material}, is_fixed=np.repeat(at_end[:, None], 3, axis=1))


def cantilever(law: IsotropicLaw, *, length: float, cells: int, tip_force_N: float) -> Equilibrium:
    """Return a strip of thickness 1 (x) and unit width in plane strain, clamped at y = 0.

    Under its full weight (gravity 1) the tip bears a dead force along +x.
    """
    layer = _HEAVY_LAYER * length
    y_lines = np.append(np.linspace(0.0, length, cells + 1), length + layer)
    grid = TensorGrid(np.array([0.0, 1.0]), y_lines, np.array([0.0, 1.0]))
    density = tip_force_N / (layer * GRAVITY_MM_PER_S2)
    mesh = structured_mesh(
        grid,
        order=2,
        region=(grid.cell_centres()[:, 1] > length).astype(np.int64),
        region_names=("strip", "weight"),
    )
    bulk = 1e3 * law.shear_modulus_MPa
    is_fixed = np.zeros((len(mesh.nodes_mm), 3), dtype=bool)
    is_fixed[:, 2] = np.isclose(mesh.nodes_mm[:, 2] % 1.0, 0.0)
    is_fixed[np.isclose(mesh.nodes_mm[:, 1], 0.0)] = True
    materials = {
        "strip": solid(law, bulk_modulus_MPa=bulk),
        "weight": solid(law, bulk_modulus_MPa=bulk, density=density),
    }
    return Equilibrium(mesh, materials, is_fixed=is_fixed, gravity_direction=(1.0, 0.0, 0.0))


def cook_membrane(
    material: SolidMaterial, *, force_N: float, cells: int, plane_strain: bool = True
) -> Equilibrium:
    """Return Cook's membrane, 48 wide, 44 to 16 high, thickness 1, clamped at x = 0.

    Under its full weight (gravity 1) the right edge bears a dead force, spread evenly, along +y.
    """

    def to_membrane(grid: FloatArray) -> FloatArray:
        across, up, z = grid.T
        share = np.minimum(across, 1.0)
        low, high = 44.0 * share, 44.0 + 16.0 * share
        return np.column_stack([48.0 * across, low + up * (high - low), z])

    lines = np.linspace(0.0, 1.0, cells + 1)
    grid = TensorGrid(np.append(lines, 1.0 + _HEAVY_LAYER), lines, np.array([0.0, 1.0]))
    mesh = structured_mesh(
        grid,
        order=2,
        region=(grid.cell_centres()[:, 0] > 1.0).astype(np.int64),
        region_names=("membrane", "weight"),
        mapping=to_membrane,
    )
    density = force_N / (48.0 * _HEAVY_LAYER * 16.0 * GRAVITY_MM_PER_S2)
    is_fixed = np.zeros((len(mesh.nodes_mm), 3), dtype=bool)
    is_fixed[:, 2] = (
        np.isclose(mesh.nodes_mm[:, 2] % 1.0, 0.0) if plane_strain else np.isclose(mesh.nodes_mm[:, 2], 0.0)
    )
    is_fixed[np.isclose(mesh.nodes_mm[:, 0], 0.0)] = True
    materials = {
        "membrane": material,
        "weight": replace(material, density_tonne_per_mm3=density),
    }
    return Equilibrium(mesh, materials, is_fixed=is_fixed)
