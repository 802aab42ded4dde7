"""What a designer asks of a simulation: mode change, extremum, volume, stretch against calibrated range."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from .actuator_problem import region_materials
from .constitutive import deform
from .element_geometry import element_geometry
from .elements import FloatArray
from .law_use import UnstableUse, unstable_use
from .materials.material_files import Material
from .self_contact import self_contact
from .simulation import Simulation

_SMALLEST_TURN_MM = 0.5
"""A fall of ux by less is not taken for a change of mode."""


@dataclass(frozen=True)
class StretchUse:
    """How far a material is stretched, against the range in which its law was calibrated.

    Parameters
    ----------
    material : str
    largest_stretch, smallest_stretch : float
        Principal stretches at any Gauss point and any pressure reached.
    pressure_kPa : float
        Where the largest is met.
    calibrated : tuple of float or None
        Smallest and largest stretch of the calibration, where known.
    """

    material: str
    largest_stretch: float
    smallest_stretch: float
    pressure_kPa: float
    calibrated: tuple[float, float] | None

    @property
    def is_beyond(self) -> bool:
        """Whether the largest stretch lies beyond the calibration."""
        return self.calibrated is not None and self.largest_stretch > self.calibrated[1]


@dataclass(frozen=True)
class DesignOutputs:
    """Figures of merit of a ramp. Displacements are the tracked point's, from the lowest pressure.

    Parameters
    ----------
    mode_change_kPa : float or None
        Pressure at which ux first turns round, by a parabola through the highest reading and its neighbours;
        None where it does not within the pressures reached.
    first_extremum_mm : float
        ux there; the largest ux where the mode does not change.
    secondary_displacement_mm : float or None
        Way of ux from there to its smallest value afterwards.
    enclosed_volume_mm3, volume_ratio : float
        At the highest pressure reached; the ratio is to the undeformed volume.
    stretch : tuple of StretchUse
        One for each material.
    unstable : UnstableUse or None
        A point at which a law is deformed to where it is unstable; None where all are stable everywhere.
    unstable_from_kPa : float or None
        Lowest of the pressures at which there is one.
    touches_itself_from_kPa : float or None
        Lowest of the pressures at which the outline in the plane of symmetry crosses itself, see
        `self_contact`: from there on contact, which is not modelled, would change the path.
    loses_stability_at_kPa : float or None
        Pressure from which the tangent has a negative eigenvalue: the branch followed is unstable.
    snaps_from_kPa : float or None
        Pressure of the first step at which the actuator snapped over a fold of the path.
    released_mJ : float
        Energy given off in all such snaps.
    """

    mode_change_kPa: float | None
    first_extremum_mm: float
    secondary_displacement_mm: float | None
    enclosed_volume_mm3: float
    volume_ratio: float
    stretch: tuple[StretchUse, ...]
    unstable: UnstableUse | None
    unstable_from_kPa: float | None
    touches_itself_from_kPa: float | None
    loses_stability_at_kPa: float | None
    snaps_from_kPa: float | None
    released_mJ: float


def design_outputs(simulation: Simulation) -> DesignOutputs:
    """Work out the figures of merit of a simulation.

    Raises
    ------
    ValueError
        If no pressure was reached.
    """
    reached = np.flatnonzero(simulation.tip_path.has_reading)
    if len(reached) == 0:
        raise ValueError("no pressure was reached, so there is nothing to report")
    ux = simulation.tip_path.ux_mm[reached]
    pressures = simulation.tip_path.pressure_kPa[reached]
    change_kPa, extremum_mm, secondary_mm = mode_change(pressures, ux)
    volume = float(simulation.enclosed_volume_mm3[reached[-1]])
    unstable, unstable_kPa = _first_unstable(simulation, reached)
    return DesignOutputs(
        mode_change_kPa=change_kPa,
        first_extremum_mm=extremum_mm,
        secondary_displacement_mm=secondary_mm,
        enclosed_volume_mm3=volume,
        volume_ratio=volume / simulation.geometry.gas_volume_mm3(),
        stretch=_stretch_uses(simulation, reached),
        unstable=unstable,
        unstable_from_kPa=unstable_kPa,
        touches_itself_from_kPa=_touches_itself_from(simulation, reached),
        loses_stability_at_kPa=_loses_stability_at(simulation),
        snaps_from_kPa=next(
            (step.pressure_kPa for step in simulation.steps if step.released_mJ != 0.0), None
        ),
        released_mJ=simulation.steps[-1].released_mJ,
    )


def mode_change(pressure_kPa: FloatArray, ux_mm: FloatArray) -> tuple[float | None, float, float | None]:
    """Find where ux first turns round.

    Parameters
    ----------
    pressure_kPa, ux_mm : array, shape (n,)

    Returns
    -------
    tuple
        Pressure, ux there, and the way of ux from there to its smallest value afterwards; without a turn
        None, the largest ux and None.
    """
    highest_so_far = np.maximum.accumulate(ux_mm)
    fallen = np.flatnonzero(highest_so_far - ux_mm > _SMALLEST_TURN_MM)
    if len(fallen) == 0:
        return None, float(ux_mm.max()), None
    top = int(ux_mm[: fallen[0]].argmax())
    pressure, extremum = float(pressure_kPa[top]), float(ux_mm[top])
    if top > 0:
        around = slice(top - 1, top + 2)
        a, b, c = np.polyfit(pressure_kPa[around] - pressure, ux_mm[around], 2)
        pressure, extremum = pressure - b / (2.0 * a), c - b**2 / (4.0 * a)
    return float(pressure), float(extremum), float(extremum - ux_mm[top:].min())


def _stretch_uses(simulation: Simulation, reached: np.ndarray) -> tuple[StretchUse, ...]:
    mesh = simulation.mesh
    materials = region_materials(simulation.settings)
    by_name = {each.name: each for each in materials.values()}
    material = np.array([materials[mesh.region_names[code]].name for code in mesh.region])
    geometry = element_geometry(mesh)
    extremes = np.empty((len(reached), 2, len(mesh.elements)))
    for place, row in enumerate(reached):
        state = deform(simulation.displacement_mm[row], mesh.elements, geometry)
        stretch = np.exp(state.log_stretch)
        extremes[place] = stretch.max(axis=(1, 2)), stretch.min(axis=(1, 2))
    pressures = simulation.tip_path.pressure_kPa[reached]
    return tuple(
        _use(by_name[name], extremes[:, :, material == name], pressures) for name in dict.fromkeys(material)
    )


def _first_unstable(
    simulation: Simulation, reached: np.ndarray
) -> tuple[UnstableUse, float] | tuple[None, None]:
    mesh, materials = simulation.mesh, region_materials(simulation.settings)
    geometry = element_geometry(mesh)
    for row in reached:
        state = deform(simulation.displacement_mm[row], mesh.elements, geometry)
        unstable = unstable_use(materials, mesh, state)
        if unstable is not None:
            return unstable, float(simulation.tip_path.pressure_kPa[row])
    return None, None


def _loses_stability_at(simulation: Simulation) -> float | None:
    """Pressure of the first of two steps running with a negative pivot: one alone may lie off equilibrium."""
    for step, following in pairwise(simulation.steps):
        if step.negative_pivots and following.negative_pivots:
            return step.pressure_kPa
    return None


def _touches_itself_from(simulation: Simulation, reached: np.ndarray) -> float | None:
    for row in reached:
        if self_contact(simulation.mesh, simulation.displacement_mm[row]) is not None:
            return float(simulation.tip_path.pressure_kPa[row])
    return None


def _use(material: Material, extremes: FloatArray, pressure_kPa: FloatArray) -> StretchUse:
    largest = extremes[:, 0].max(axis=1)
    strains = material.strain_range
    return StretchUse(
        material=material.name,
        largest_stretch=float(largest.max()),
        smallest_stretch=float(extremes[:, 1].min()),
        pressure_kPa=float(pressure_kPa[largest.argmax()]),
        calibrated=None if strains is None else (1.0 + strains[0], 1.0 + strains[1]),
    )
