"""Fields over the elements of a deformed actuator: stretch, pressure and stress."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .actuator_problem import actuator_materials
from .constitutive import deform, evaluate_materials, material_groups, per_element
from .element_geometry import element_geometry
from .elements import FloatArray
from .simulation import Simulation

_NORMAL = np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
_SQUARES = np.array([1.0, 1.0, 1.0, 2.0, 2.0, 2.0])


@dataclass(frozen=True)
class ElementFields:
    """Volume averages over each element.

    Parameters
    ----------
    largest_stretch : array, shape (n_elements,)
        Largest principal stretch.
    pressure_MPa : array, shape (n_elements,)
        The solid's own pressure, minus the volumetric part of the Cauchy stress.
    cauchy_MPa : array, shape (n_elements, 6)
        Cauchy stress: xx, yy, zz, xy, yz, xz.
    """

    largest_stretch: FloatArray
    pressure_MPa: FloatArray
    cauchy_MPa: FloatArray

    @property
    def von_mises_MPa(self) -> FloatArray:
        """Von Mises' measure of the Cauchy stress, shape (n_elements,)."""
        deviator = self.cauchy_MPa - _NORMAL * self.cauchy_MPa[:, :3].mean(axis=1, keepdims=True)
        return np.asarray(np.sqrt(1.5 * (deviator**2) @ _SQUARES))


def element_fields(simulation: Simulation, row: int) -> ElementFields:
    """Compute the fields at one of the asked pressures.

    Parameters
    ----------
    simulation : Simulation
    row : int
        Index of the pressure in the tip path.

    Raises
    ------
    ValueError
        If the ramp did not reach that pressure.
    """
    displacement = simulation.displacement_mm[row]
    if not np.all(np.isfinite(displacement)):
        raise ValueError(f"the ramp did not reach {simulation.tip_path.pressure_kPa[row]:g} kPa")
    mesh = simulation.mesh
    geometry = element_geometry(mesh)
    materials = actuator_materials(crimp_ratio=simulation.crimp_ratio, settings=simulation.settings)
    groups = material_groups(mesh, materials)
    state = deform(displacement, mesh.elements, geometry)
    share = geometry.volumes / geometry.volumes.sum(axis=1, keepdims=True)
    kirchhoff = evaluate_materials(groups, state).stress
    cauchy = np.einsum("eq,eqs->es", share, kirchhoff / state.J[..., None])
    bulk = per_element(groups, len(mesh.elements), "bulk_modulus_MPa")
    pressure = -bulk * (np.einsum("eq,eq->e", share, state.J) - 1.0)
    return ElementFields(
        largest_stretch=np.einsum("eq,eq->e", share, np.exp(state.log_stretch.max(axis=2))),
        pressure_MPa=pressure,
        cauchy_MPa=cauchy - pressure[:, None] * _NORMAL,
    )
