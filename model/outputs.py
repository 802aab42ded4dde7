"""What a designer asks of a simulation: mode change, extremum, volume, stretch against calibrated range."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .constitutive import deform
from .element_geometry import element_geometry
from .elements import FloatArray
from .materials.library import find_material
from .materials.material_files import Material
from .materials.stability import stability_margin
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
    composite_unstable_from_kPa : float or None
        Lowest pressure at which a homogeneous composite is deformed, at any Gauss point, to where its law is
        unstable in Drucker's sense; None where it is not, or the composite is matrix and paper.
    """

    mode_change_kPa: float | None
    first_extremum_mm: float
    secondary_displacement_mm: float | None
    enclosed_volume_mm3: float
    volume_ratio: float
    stretch: tuple[StretchUse, ...]
    composite_unstable_from_kPa: float | None = None


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
    return DesignOutputs(
        mode_change_kPa=change_kPa,
        first_extremum_mm=extremum_mm,
        secondary_displacement_mm=secondary_mm,
        enclosed_volume_mm3=volume,
        volume_ratio=volume / simulation.geometry.gas_volume_mm3(),
        stretch=_stretch_uses(simulation, reached),
        composite_unstable_from_kPa=_unstable_from(simulation, reached),
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
    mesh, settings = simulation.mesh, simulation.settings
    materials = {
        "composite": settings.composite or find_material(settings.matrix_material),
        "strip A": find_material(settings.strip_a_material),
        "body": find_material(settings.body_material),
        "strip B": find_material(settings.strip_b_material),
    }
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


def _unstable_from(simulation: Simulation, reached: np.ndarray) -> float | None:
    composite, mesh = simulation.settings.composite, simulation.mesh
    if composite is None:
        return None
    geometry = element_geometry(mesh)
    filled = mesh.region == mesh.region_names.index("composite")
    for row in reached:
        state = deform(simulation.displacement_mm[row], mesh.elements, geometry)
        log_stretch = state.log_stretch[filled].reshape(-1, 3)
        isochoric = log_stretch - log_stretch.mean(axis=1, keepdims=True)
        if not np.all(stability_margin(composite.law, isochoric) > 0.0):
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
