"""The half actuator as an equilibrium problem: mesh, materials, clamp and symmetry."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .actuator_mesh import actuator_mesh
from .composite import crimped_composite
from .equilibrium import Equilibrium
from .geometry import ActuatorGeometry
from .materials.library import find_material
from .materials.material_files import Material
from .materials.solid import SolidMaterial
from .materials.stiffness import stiffened
from .memory import refuse_too_large
from .simulation import SimulationSettings


def region_materials(settings: SimulationSettings) -> dict[str, Material]:
    """Return the library's material of each region; in the composite, if it is not one law, the matrix.

    Raises
    ------
    InputError
        If a material is not in the library.
    """
    return {
        "composite": settings.composite or find_material(settings.matrix_material),
        "strip A": find_material(settings.strip_a_material),
        "body": find_material(settings.body_material),
        "strip B": find_material(settings.strip_b_material),
    }


def actuator_materials(*, crimp_ratio: float, settings: SimulationSettings) -> dict[str, SolidMaterial]:
    """Return the material of each region of the actuator, as the elements take it.

    Raises
    ------
    InputError
        If the crimp ratio or a material name is unusable.
    """
    stiffness = {
        "composite": settings.matrix_stiffness if settings.composite is None else 1.0,
        "strip A": settings.body_stiffness,
        "body": settings.body_stiffness,
        "strip B": settings.strip_b_stiffness,
    }
    solids = {
        region: replace(material, law=stiffened(material.law, stiffness[region])).solid(
            bulk_to_shear=settings.bulk_to_shear
        )
        for region, material in region_materials(settings).items()
    }
    if settings.composite is None:
        solids["composite"] = crimped_composite(
            solids["composite"], crimp_ratio=crimp_ratio, paper=settings.paper
        )
    return solids


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
