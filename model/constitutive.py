"""Stress, moduli and energy at the Gauss points of a mesh made of several materials."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .element_geometry import ElementGeometry
from .elements import FloatArray, IntArray
from .fibre_points import FibreFamily, add_fibres, fibre_response
from .hex_mesh import HexMesh
from .materials.solid import SolidMaterial
from .stress_kernels import deformation, principal_moduli, principal_stress
from .volume_guard import add_guard, guard_energy


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


@dataclass(frozen=True)
class MaterialResponse:
    """Stress and moduli at the Gauss points, volumetric part left out.

    Parameters
    ----------
    stress : array, shape (n_elements, n_points, 6)
        Kirchhoff stress in MPa, components 11, 22, 33, 12, 23, 13.
    moduli : array, shape (n_elements, n_points, 6, 6)
        Spatial moduli in MPa.
    fibres : tuple of FibreFamily
        In the order of their rows in an array of tensions.
    """

    stress: FloatArray
    moduli: FloatArray
    fibres: tuple[FibreFamily, ...]


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


def evaluate_materials(
    groups: tuple[MaterialGroup, ...], state: Deformation, *, tension: FloatArray | None = None
) -> MaterialResponse:
    """Evaluate every material, volumetric part left out.

    Parameters
    ----------
    groups : tuple of MaterialGroup
    state : Deformation
    tension : array, shape (n_fibre_rows, n_points), optional
        Fibre tensions predicted by the last Newton iteration, see `fibre_response`.
    """
    n_elements, n_points = state.J.shape
    stress = np.empty((n_elements, n_points, 6))
    moduli = np.empty((n_elements, n_points, 6, 6))
    fibres = []
    row = 0
    for group in groups:
        elements = group.elements
        _evaluate(group, state, stress, moduli)
        for fibre in group.material.fibres:
            predicted = None if tension is None else tension[row : row + len(elements)]
            family = FibreFamily(fibre, elements, fibre_response(fibre, state.F[elements], predicted))
            add_fibres(family, stress, moduli)
            fibres.append(family)
            row += len(elements)
    return MaterialResponse(stress, moduli, tuple(fibres))


def isochoric_energy(groups: tuple[MaterialGroup, ...], state: Deformation, volumes: FloatArray) -> float:
    """Integrate the strain energy without its volumetric part, in N mm."""
    total = 0.0
    for group in groups:
        part = _take(state, group.elements)
        law = group.material.law
        density = law.energy(isochoric_log_stretch(part.log_stretch)) + guard_energy(
            part.J, law.shear_modulus_MPa
        )
        for fibre in group.material.fibres:
            density = density + fibre.energy(np.linalg.norm(part.F @ np.asarray(fibre.direction), axis=1))
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


def isochoric_log_stretch(log_stretch: FloatArray) -> FloatArray:
    """Return log stretches, shape (n, 3), with the change of volume taken off."""
    return log_stretch - log_stretch.mean(axis=1, keepdims=True)


def _evaluate(group: MaterialGroup, state: Deformation, stress: FloatArray, moduli: FloatArray) -> None:
    """Write a group's stress and moduli, fibres left out."""
    law, elements = group.material.law, group.elements
    points = (len(elements), state.J.shape[1])
    first, second = law.derivatives(isochoric_log_stretch(state.log_stretch[elements].reshape(-1, 3)))
    first, second = first.reshape(*points, 3), second.reshape(*points, 3, 3)
    principal_stress(elements, state.directions, first, stress)
    principal_moduli(elements, state.directions, state.log_stretch, first, second, moduli)
    add_guard(elements, state.J, law.shear_modulus_MPa, stress, moduli)
