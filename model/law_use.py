"""Laws in use: whether each is stable, in Drucker's sense, at the stretches that the body meets."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .constitutive import Deformation, MaterialGroup, isochoric_log_stretch
from .elements import FloatArray, reference_element
from .hex_mesh import HexMesh
from .materials.curves import MODES
from .materials.material_files import Material
from .materials.stability import stability_margin, stable_range


@dataclass(frozen=True)
class UnstableUse:
    """A point at which a law is deformed to where it is not stable.

    Parameters
    ----------
    material, region : str
    stretch : tuple of float
        Principal stretches there, volume change taken off, the largest first.
    position_mm : tuple of float
        In the undeformed body.
    stable_up_to : float
        Largest uniaxial stretch to which the law is stable.
    """

    material: str
    region: str
    stretch: tuple[float, float, float]
    position_mm: tuple[float, float, float]
    stable_up_to: float

    def __str__(self) -> str:
        met = " × ".join(f"{one:.2f}" for one in self.stretch)
        place = ", ".join(f"{one:.1f}" for one in self.position_mm)
        return (
            f"the law of {self.material} ({self.region}) is unstable, in Drucker's sense, at the stretches "
            f"met, {met} at ({place}) mm; in uniaxial tension it is stable up to {self.stable_up_to:.2f}"
        )


def unstable_use(materials: dict[str, Material], mesh: HexMesh, state: Deformation) -> UnstableUse | None:
    """Find the point where a law is farthest beyond its stability; None where all are stable everywhere.

    Parameters
    ----------
    materials : dict of str to Material
        One for each region of the mesh.
    mesh : HexMesh
    state : Deformation
    """
    worst: tuple[float, str, int, int] | None = None
    for code, region in enumerate(mesh.region_names):
        elements = np.flatnonzero(mesh.region == code)
        if len(elements) == 0:
            continue
        margin = stability_margin(materials[region].law, _isochoric(state, elements))
        # NaN: beyond locking
        margin = np.where(np.isnan(margin), -np.inf, margin)
        at = int(margin.argmin())
        if margin[at] <= 0.0 and (worst is None or margin[at] < worst[0]):
            element, point = divmod(at, state.J.shape[1])
            worst = float(margin[at]), region, int(elements[element]), point
    return None if worst is None else _use(materials, mesh, state, *worst[1:])


def laws_are_stable(groups: tuple[MaterialGroup, ...], state: Deformation) -> bool:
    """Whether every law is stable at every point; fibres, which only stiffen, are left out."""
    return all(
        bool(np.all(stability_margin(group.material.law, _isochoric(state, group.elements)) > 0.0))
        for group in groups
    )


def _use(
    materials: dict[str, Material], mesh: HexMesh, state: Deformation, region: str, element: int, point: int
) -> UnstableUse:
    stretch = np.sort(np.exp(_isochoric(state, np.array([element]))[point]))[::-1]
    position = reference_element(mesh.order).values[point] @ mesh.nodes_mm[mesh.elements[element]]
    material = materials[region]
    return UnstableUse(
        material=material.name,
        region=region,
        stretch=(float(stretch[0]), float(stretch[1]), float(stretch[2])),
        position_mm=(float(position[0]), float(position[1]), float(position[2])),
        stable_up_to=stable_range(material.law, MODES["uniaxial"]).highest,
    )


def _isochoric(state: Deformation, elements: np.ndarray) -> FloatArray:
    """Isochoric log stretches at the points of some elements, (n, 3)."""
    return isochoric_log_stretch(state.log_stretch[elements].reshape(-1, 3))
