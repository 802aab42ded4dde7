"""Integrals over the elements of a solid, whatever its mesh: forces, dilatation and volumetric energy."""

from __future__ import annotations

import numpy as np

from .constitutive import Deformation
from .element_geometry import ElementGeometry
from .element_kernels import element_forces
from .elements import FloatArray


def force_integrals(
    tables: ElementGeometry, kinematics: Deformation, stress: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Integrate isochoric forces, dilatation and the operator from pressure to force.

    Parameters
    ----------
    tables : ElementGeometry
    kinematics : Deformation
    stress : array, shape (n_elements, n_points, 6)
        Kirchhoff stress without the volumetric part.

    Returns
    -------
    forces : array, shape (n_elements, 3, n_nodes)
    dilatation : array, shape (n_elements, n_modes)
    pressure_operator : array, shape (n_elements, n_modes, 3, n_nodes)
    """
    n_elements, _, _, n_nodes = tables.gradients.shape
    n_modes = tables.pressure_modes.shape[2]
    forces = np.empty((n_elements, 3, n_nodes))
    dilatation = np.empty((n_elements, n_modes))
    operator = np.empty((n_elements, n_modes, 3, n_nodes))
    element_forces(
        tables.gradients,
        tables.volumes,
        tables.pressure_modes,
        kinematics.F,
        kinematics.J,
        stress,
        forces,
        dilatation,
        operator,
    )
    return forces, dilatation, operator


def volumetric_energy(tables: ElementGeometry, J: FloatArray, bulk_modulus_MPa: FloatArray) -> float:
    """Return the energy of the change of volume, κ/2 times the squared mean dilatations, in N mm.

    Parameters
    ----------
    tables : ElementGeometry
    J : array, shape (n_elements, n_points)
    bulk_modulus_MPa : array, shape (n_elements,)
    """
    excess = np.einsum("eq,eqm->em", tables.volumes * (J - 1.0), tables.pressure_modes)
    return 0.5 * float(bulk_modulus_MPa @ (excess**2).sum(axis=1))
