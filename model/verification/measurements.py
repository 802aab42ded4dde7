"""What the verification problems measure: a number for each problem, from its parameters."""

from __future__ import annotations

from functools import cache

import numpy as np

from spavision.model.elements import FloatArray
from spavision.model.equilibrium import Equilibrium
from spavision.model.materials.solid import IsotropicLaw, SolidMaterial

from .bodies import (
    INNER_RADIUS,
    NEO_HOOKE,
    bent_block,
    bulk_modulus,
    cantilever,
    cook_membrane,
    cube,
    cylinder,
    solid,
    sphere,
    tube,
)
from .solving import LIGHTLY_LOADED, at, inflated, loaded, moved_to, reactions

NEARLY_INCOMPRESSIBLE = 1e5
"""Bulk over shear modulus: its error in the closed forms for incompressible bodies is some 1e-5."""

_SMALL_PRESSURE = 1e-6
"""Over the shear modulus, for the linear problems."""


def tube_pressure(law: IsotropicLaw, bore_stretch: float, *, cells: int = 6) -> float:
    """Return the pressure (MPa) at which the bore of a thick tube (B/A = 2) has a stretch."""
    material = solid(law, bulk_modulus_MPa=NEARLY_INCOMPRESSIBLE * law.shear_modulus_MPa)
    body = tube(material, order=2, cells=cells)
    return _pressure_at(body, np.linspace(1.0, bore_stretch, 4)[1:] ** 2)


def sphere_pressure(law: IsotropicLaw, bore_stretch: float, *, across: int = 4, around: int = 2) -> float:
    """Return the pressure (MPa) at which the bore of a thick sphere (B/A = 2) has a stretch."""
    material = solid(law, bulk_modulus_MPa=NEARLY_INCOMPRESSIBLE * law.shear_modulus_MPa)
    body = sphere(material, order=2, across=across, around=around)
    return _pressure_at(body, np.linspace(1.0, bore_stretch, 6)[1:] ** 3)


def balloon_pressures(volume_ratios: FloatArray, *, thickness: float) -> FloatArray:
    """Return p R/(μ t) of a thin neo-Hookean sphere at volume ratios, R being the mean radius."""
    outer = INNER_RADIUS + thickness
    material = solid(NEO_HOOKE, bulk_modulus_MPa=NEARLY_INCOMPRESSIBLE)
    body = sphere(material, order=2, across=1, around=2, outer_radius=outer)
    mean = 0.5 * (INNER_RADIUS + outer)
    pressures = [
        point.gas_pressure_MPa for point in inflated(body, [float(ratio) for ratio in volume_ratios])
    ]
    return np.array(pressures) * mean / thickness


def shear_stresses(amount: float) -> tuple[float, float]:
    """Return σ₁₂ and σ₁₁ − σ₂₂ (MPa) of a neo-Hookean cube in simple shear, from the forces on its faces."""
    body = cube(solid(NEO_HOOKE, bulk_modulus_MPa=NEARLY_INCOMPRESSIBLE))
    x, y, z = body.mesh.nodes_mm.T
    inside = ~body.is_free.all(axis=1)
    guess = 0.02 * np.sin(np.pi * x) * np.sin(np.pi * y) * np.sin(np.pi * z) * ~inside
    state = loaded(body, start=moved_to(body, np.column_stack([x + amount * y + guess, y, z])))
    forces = reactions(body, state)
    # The mean nominal stress of a body held at its skin alone is the sum of force times position.
    nominal = np.einsum("ni,nj->ij", forces, body.mesh.nodes_mm)
    return float(nominal[0, 1]), float(nominal[0, 0] + amount * nominal[0, 1] - nominal[1, 1])


def lame_tube(poisson: float, *, order: int = 2, cells: int = 4) -> float:
    """Return u E/(p A) at the bore of a thick tube (B/A = 2) under a small pressure."""
    material = solid(NEO_HOOKE, bulk_modulus_MPa=bulk_modulus(1.0, poisson))
    return _small_bore_displacement(tube(material, order=order, cells=cells), poisson, axes=2)


def lame_sphere(poisson: float, *, order: int = 2, across: int = 4, around: int = 3) -> float:
    """Return u E/(p A) at the bore of a thick sphere (B/A = 2) under a small pressure."""
    material = solid(NEO_HOOKE, bulk_modulus_MPa=bulk_modulus(1.0, poisson))
    body = sphere(material, order=order, across=across, around=around)
    return _small_bore_displacement(body, poisson, axes=3)


def bending_moment(curvature: float, *, turn: float = 0.5 * np.pi) -> float:
    """Return the moment (N mm per mm) that bends a neo-Hookean block of thickness 1.

    Parameters
    ----------
    curvature : float
        Angle per undeformed length, 1/mm.
    turn : float
        π/2 or π.
    """
    body, position = _bent(curvature, turn)
    state = loaded(body, start=moved_to(body, position))
    forces, final = reactions(body, state), body.mesh.nodes_mm + state.displacement
    far = at(body.mesh.nodes_mm[:, 1], turn / curvature)
    return abs(_moment(final[far], forces[far])) / 0.5


def bent_radii(curvature: float) -> tuple[float, float]:
    """Return inner and outer radius of the block bent to a quarter turn."""
    body, position = _bent(curvature, 0.5 * np.pi)
    state = loaded(body, start=moved_to(body, position))
    near = at(body.mesh.nodes_mm[:, 1], 0.0)
    x = (body.mesh.nodes_mm + state.displacement)[near, 0]
    return float(x.min()), float(x.max())


@cache
def torsion(twist: float, *, cells: int = 4) -> tuple[float, float]:
    """Return torque (N mm) and axial force (N) of a neo-Hookean cylinder twisted with its ends held."""
    body = cylinder(solid(NEO_HOOKE, bulk_modulus_MPa=NEARLY_INCOMPRESSIBLE), cells=cells)
    x, y, z = body.mesh.nodes_mm.T
    cosine, sine = np.cos(twist * z), np.sin(twist * z)
    bulge = 1.0 + 0.02 * np.sin(np.pi * z)
    twisted = np.column_stack([bulge * (x * cosine - y * sine), bulge * (x * sine + y * cosine), z])
    state = loaded(body, start=moved_to(body, twisted))
    forces = reactions(body, state)
    top = at(z, 1.0)
    return _moment(twisted[top], forces[top]), float(forces[top, 2].sum())


@cache
def cantilever_tip(load_factor: float, *, length: float = 100.0, cells: int = 40) -> tuple[float, float]:
    """Return deflection and shortening over length of a strip under a dead tip load P L²/(E I)."""
    law = NEO_HOOKE
    bulk = 1e3 * law.shear_modulus_MPa
    lame = bulk - 2.0 / 3.0
    plane_strain_modulus = 4.0 * (lame + 1.0) / (lame + 2.0)
    force = load_factor * plane_strain_modulus / 12.0 / length**2
    body = cantilever(law, length=length, cells=cells, tip_force_N=force)
    state = loaded(body, weights=_steps(4 + round(2.0 * load_factor)), settings=LIGHTLY_LOADED)
    tip = at(body.mesh.nodes_mm[:, 1], length) & at(body.mesh.nodes_mm[:, 0], 0.5)
    moved = state.displacement[tip].mean(axis=0) / length
    return float(moved[0]), float(-moved[1])


def cook_tip(material: SolidMaterial, *, force_N: float, plane_strain: bool = True, cells: int = 8) -> float:
    """Return the rise (mm) of the upper right corner of Cook's membrane."""
    body = cook_membrane(material, force_N=force_N, cells=cells, plane_strain=plane_strain)
    state = loaded(body, weights=_steps(5))
    corner = at(body.mesh.nodes_mm[:, 0], 48.0) & at(body.mesh.nodes_mm[:, 1], 60.0)
    return float(state.displacement[corner, 1].mean())


def _steps(count: int) -> list[float]:
    return [float(step) for step in np.linspace(0.0, 1.0, count + 1)[1:]]


def _moment(position: FloatArray, force: FloatArray) -> float:
    """Moment about the z axis."""
    return float(np.cross(position, force)[:, 2].sum())


def _pressure_at(body: Equilibrium, volume_ratios: FloatArray) -> float:
    return inflated(body, [float(ratio) for ratio in volume_ratios])[-1].gas_pressure_MPa


def _small_bore_displacement(body: Equilibrium, poisson: float, *, axes: int) -> float:
    state = loaded(body, gas_pressures_MPa=(_SMALL_PRESSURE,), settings=LIGHTLY_LOADED)
    nodes: FloatArray = body.mesh.nodes_mm[:, :axes]
    bore = at(np.linalg.norm(nodes, axis=1), INNER_RADIUS)
    outward = np.einsum("ni,ni->n", nodes[bore], state.displacement[bore, :axes])
    youngs_modulus = 2.0 * (1.0 + poisson)
    return float(outward.mean()) * youngs_modulus / _SMALL_PRESSURE


def _bent(curvature: float, turn: float) -> tuple[Equilibrium, FloatArray]:
    """Set up the block and a first guess: circular fibres as long as they were at the middle."""
    body = bent_block(
        solid(NEO_HOOKE, bulk_modulus_MPa=NEARLY_INCOMPRESSIBLE),
        length=turn / curvature,
        cells=round(10.0 * turn),
        end_plane=0 if turn < 2.0 else 1,
    )
    x, y, z = body.mesh.nodes_mm.T
    radius = 1.0 / curvature + x - 0.5
    position = np.column_stack([radius * np.cos(curvature * y), radius * np.sin(curvature * y), z])
    held_axis = 0 if turn < 2.0 else 1
    position[at(y, turn / curvature), held_axis] = 0.0
    return body, position
