"""The half actuator as an equilibrium problem: mesh, materials, clamp and symmetry."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .actuator_mesh import actuator_mesh
from .composite import crimped_composite
from .equilibrium import Equilibrium
from .geometry import ActuatorGeometry
from .materials.library import find_material
from .materials.solid import SolidMaterial
from .materials.stiffness import stiffened
from .memory import refuse_too_large
from .simulation import SimulationSettings


def actuator_materials(*, crimp_ratio: float, settings: SimulationSettings) -> dict[str, SolidMaterial]:
    """Return the material of each region of the actuator.

    Raises
    ------
    InputError
        If the crimp ratio or a material name is unusable.
    """
    solids = {
        region: _solid(name, stiffness, settings.bulk_to_shear)
        for region, name, stiffness in (
            ("composite", settings.matrix_material, settings.matrix_stiffness),
            ("strip A", settings.strip_a_material, settings.body_stiffness),
            ("body", settings.body_material, settings.body_stiffness),
            ("strip B", settings.strip_b_material, settings.strip_b_stiffness),
        )
    }
    if settings.composite is not None:
        solids["composite"] = settings.composite.solid(bulk_to_shear=settings.bulk_to_shear)
    else:
        solids["composite"] = crimped_composite(
            solids["composite"], crimp_ratio=crimp_ratio, paper=settings.paper
        )
    return solids


def _solid(name: str, stiffness: float, bulk_to_shear: float) -> SolidMaterial:
    material = find_material(name)
    return replace(material, law=stiffened(material.law, stiffness)).solid(bulk_to_shear=bulk_to_shear)


def actuator_problem(
    geometry: ActuatorGeometry, *, crimp_ratio: float, settings: SimulationSettings
) -> Equilibrium:
    """Set up the half actuator: mesh, materials, clamp at y = 0 and symmetry at z = 0.

    Raises
    ------
    InputError
        If crimp ratio, material names or mesh level are unusable, or the mesh is too large for the memory.
    """
    solids = actuator_materials(crimp_ratio=crimp_ratio, settings=settings)
    mesh = actuator_mesh(geometry, level=settings.mesh_level)
    refuse_too_large(mesh)
    is_fixed = np.zeros((len(mesh.nodes_mm), 3), dtype=bool)
    is_fixed[mesh.node_sets["clamp"]] = True
    is_fixed[mesh.node_sets["symmetry"], 2] = True
    tilt = np.deg2rad(settings.gravity_tilt_deg)
    down = (float(np.sin(tilt)), float(np.cos(tilt)), 0.0)
    return Equilibrium(mesh, solids, is_fixed=is_fixed, gravity_direction=down)
