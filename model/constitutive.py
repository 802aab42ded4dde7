"""Stress, moduli and energy at the Gauss points of a mesh made of several materials."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .element_geometry import ElementGeometry
from .elements import FloatArray, IntArray
from .hex_mesh import HexMesh
from .materials.slack_fibre import SlackFibre
from .materials.solid import SolidMaterial
from .stress_kernels import add_fibre, deformation, principal_moduli, principal_stress


@dataclass(frozen=True)
class MaterialGroup:
    """The elements that one material fills.

    Parameters
    ----------
    material : SolidMaterial
    elements : array, shape (n,)
    """

    material: SolidMaterial
    elements: IntArray


@dataclass(frozen=True)
class Deformation:
    """Kinematics at the Gauss points.

    Parameters
    ----------
    F : array, shape (n_elements, n_points, 3, 3)
    J : array, shape (n_elements, n_points)
    log_stretch : array, shape (n_elements, n_points, 3)
        Principal log stretches in no particular order.
    directions : array, shape (n_elements, n_points, 3, 3)
        Their spatial directions, in columns.
    """

    F: FloatArray
    J: FloatArray
    log_stretch: FloatArray
    directions: FloatArray

    @property
    def is_admissible(self) -> bool:
        """Whether every volume ratio is finite and positive."""
        return bool(np.all(self.J > 0.0))


def material_groups(mesh: HexMesh, materials: dict[str, SolidMaterial]) -> tuple[MaterialGroup, ...]:
    """Return one group for each distinct material, in the order of the regions."""
    regions: dict[SolidMaterial, list[int]] = {}
    for code, name in enumerate(mesh.region_names):
        regions.setdefault(materials[name], []).append(code)
    groups = (
        MaterialGroup(material, np.flatnonzero(np.isin(mesh.region, codes)))
        for material, codes in regions.items()
    )
    return tuple(group for group in groups if len(group.elements))


def per_element(groups: tuple[MaterialGroup, ...], n_elements: int, attribute: str) -> FloatArray:
    """Return a property of the material of each element, shape (n_elements,)."""
    values = np.empty(n_elements)
    for group in groups:
        values[group.elements] = getattr(group.material, attribute)
    return values


def deform(displacement: FloatArray, elements: IntArray, geometry: ElementGeometry) -> Deformation:
    """Compute the kinematics of a displacement field.

    Parameters
    ----------
    displacement : array, shape (n_nodes, 3)
        In mm.
    elements : array, shape (n_elements, n_element_nodes)
    geometry : ElementGeometry
    """
    shape = geometry.volumes.shape
    out = Deformation(
        np.empty((*shape, 3, 3)), np.empty(shape), np.empty((*shape, 3)), np.empty((*shape, 3, 3))
    )
    deformation(displacement, elements, geometry.gradients, out.F, out.J, out.log_stretch, out.directions)
    return out


def stress_and_moduli(
    groups: tuple[MaterialGroup, ...], state: Deformation, *, with_moduli: bool
) -> tuple[FloatArray, FloatArray]:
    """Evaluate every material, volumetric part left out.

    Returns
    -------
    stress : array, shape (n_elements, n_points, 6)
        Kirchhoff stress in MPa, components 11, 22, 33, 12, 23, 13.
    moduli : array, shape (n_elements, n_points, 6, 6), or (0, 0, 6, 6) without moduli
    """
    n_elements, n_points = state.J.shape
    stress = np.empty((n_elements, n_points, 6))
    moduli = np.empty((n_elements, n_points, 6, 6) if with_moduli else (0, 0, 6, 6))
    for group in groups:
        part = _take(state, group.elements)
        part_stress, part_moduli = _evaluate(group.material, part, with_moduli=with_moduli)
        stress[group.elements] = part_stress.reshape(-1, n_points, 6)
        if with_moduli:
            moduli[group.elements] = part_moduli.reshape(-1, n_points, 6, 6)
    return stress, moduli


def isochoric_energy(groups: tuple[MaterialGroup, ...], state: Deformation, volumes: FloatArray) -> float:
    """Integrate the strain energy without its volumetric part, in N mm."""
    total = 0.0
    for group in groups:
        part = _take(state, group.elements)
        density = group.material.law.energy(_isochoric(part.log_stretch))
        for fibre in group.material.fibres:
            density = density + fibre.energy(_fibre_stretch(fibre, part.F)[1])
        total += float(density @ volumes[group.elements].ravel())
    return total


def _take(state: Deformation, elements: IntArray) -> Deformation:
    """Points of some elements, flattened to one axis."""
    return Deformation(
        F=state.F[elements].reshape(-1, 3, 3),
        J=state.J[elements].reshape(-1),
        log_stretch=state.log_stretch[elements].reshape(-1, 3),
        directions=state.directions[elements].reshape(-1, 3, 3),
    )


def _isochoric(log_stretch: FloatArray) -> FloatArray:
    return log_stretch - log_stretch.mean(axis=1, keepdims=True)


def _evaluate(
    material: SolidMaterial, state: Deformation, *, with_moduli: bool
) -> tuple[FloatArray, FloatArray]:
    first, second = material.law.derivatives(_isochoric(state.log_stretch))
    stress = np.empty((len(first), 6))
    moduli = np.empty((len(first) if with_moduli else 0, 6, 6))
    principal_stress(state.directions, first, stress)
    if with_moduli:
        principal_moduli(state.directions, state.log_stretch, first, second, moduli)
    for fibre in material.fibres:
        direction, stretch = _fibre_stretch(fibre, state.F)
        tension = fibre.tension(stretch) / stretch
        add_fibre(direction, tension, (fibre.stiffness(stretch) - tension) / stretch**2, stress, moduli)
    return stress, moduli


def _fibre_stretch(fibre: SlackFibre, F: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Deformed fibre vectors, (n, 3), and their lengths, (n,)."""
    direction = F @ np.asarray(fibre.direction)
    return direction, np.sqrt(np.einsum("ni,ni->n", direction, direction))
