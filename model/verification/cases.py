"""The verification cases: what is measured, the number to hit, its source and how closely."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from spavision.model.materials.ogden import Ogden

from . import measurements as measure
from .bodies import BODY, NEO_HOOKE, bulk_modulus, solid

_ELASTICA = {
    1.0: (0.301721, 0.056433),
    2.0: (0.493457, 0.160642),
    5.0: (0.713792, 0.387628),
    10.0: (0.810609, 0.554996),
}
"""Deflection and shortening over length of the inextensible elastica, by load factor P L²/(E I)."""


@dataclass(frozen=True)
class Case:
    """One number that the model has to reproduce.

    Parameters
    ----------
    row : str
        Of the project's table of closed forms, or the name of a published problem.
    problem, quantity : str
    expected : float
    source : str
        Where the expected number comes from.
    tolerance : float
        Largest relative error that counts as agreement, with the coarse meshes used here.
    measure : callable
    """

    row: str
    problem: str
    quantity: str
    expected: float
    source: str
    tolerance: float
    measure: Callable[[], float]


def all_cases() -> tuple[Case, ...]:
    """Return every case, in the order of the rows."""
    return (*_shear(), *_tubes(), *_spheres(), *_linear(), *_bending(), *_torsion(), *_elastica(), *_cook())


def _shear() -> list[Case]:
    problem, source = "simple shear of 1, neo-Hooke", "closed form"
    return [
        Case("5", problem, "σ₁₂ in MPa", 1.0, source, 1e-6, lambda: measure.shear_stresses(1.0)[0]),
        Case("5", problem, "σ₁₁ − σ₂₂ in MPa", 1.0, source, 1e-6, lambda: measure.shear_stresses(1.0)[1]),
    ]


def _tubes() -> list[Case]:
    three_term = Ogden((1.0, 3.0 / 140.0, -2.0 / 140.0), (2.0, 6.0, -3.0))
    table: list[tuple[str, str, Ogden, dict[float, float]]] = [
        ("7", "neo-Hooke", NEO_HOOKE, {1.2: 0.233369777, 1.5: 0.428228409, 2.0: 0.574053572}),
        ("8", "two-term Ogden", BODY, {1.2: 0.032842849, 1.5: 0.061758212, 2.0: 0.090284809}),
        ("9", "three-term Ogden", three_term, {1.4: 0.417095545, 2.0: 0.696585978}),
    ]
    return [
        Case(
            row,
            f"thick tube, plane strain, {name}",
            f"pressure in MPa at bore stretch {stretch:g}",
            expected,
            "closed form, incompressible",
            1e-4,
            partial(measure.tube_pressure, law, stretch),
        )
        for row, name, law, values in table
        for stretch, expected in values.items()
    ]


def _spheres() -> list[Case]:
    table: list[tuple[str, str, Ogden, dict[float, float]]] = [
        ("10", "neo-Hooke", NEO_HOOKE, {1.2: 0.480159779, 1.5: 0.755433119, 2.0: 0.806926603}),
        ("11", "two-term Ogden", BODY, {1.2: 0.066956692, 1.5: 0.106948425, 2.0: 0.122084703}),
    ]
    return [
        Case(
            row,
            f"thick sphere, {name}",
            f"pressure in MPa at bore stretch {stretch:g}",
            expected,
            "closed form, incompressible",
            3e-4,
            partial(measure.sphere_pressure, law, stretch),
        )
        for row, name, law, values in table
        for stretch, expected in values.items()
    ]


def _linear() -> list[Case]:
    tube = {0.3: 1.906666667, 0.49: 1.996600000, 0.4999: 1.999966660}
    sphere = {0.3: 0.8, 0.4999: 0.857114286}
    return [
        Case(
            row,
            f"Lamé {shape}, small pressure",
            f"u E/(p A) at the bore, Poisson's ratio {poisson:g}",
            expected,
            "closed form, small strain",
            3e-4,
            partial(function, poisson),
        )
        for row, shape, function, values in (
            ("13", "tube", measure.lame_tube, tube),
            ("14", "sphere", measure.lame_sphere, sphere),
        )
        for poisson, expected in values.items()
    ]


def _bending() -> list[Case]:
    moments = {0.1: 0.033233866, 0.5: 0.155610339, 1.0: 0.266419988}
    bent = [
        Case(
            "15",
            "Rivlin's bending of a block, quarter turn",
            f"moment in N mm/mm at {curvature:g} rad per mm of thickness",
            expected,
            "closed form, incompressible",
            3e-4,
            partial(measure.bending_moment, curvature),
        )
        for curvature, expected in moments.items()
    ]
    radii = {0.5: (1.572303, 2.544039), 1.0: (0.643594, 1.553774)}
    turned = [
        Case(
            "15",
            "Rivlin's bending of a block, quarter turn",
            f"{('inner', 'outer')[which]} radius in mm at {curvature:g} rad per mm of thickness",
            expected,
            "closed form, incompressible",
            3e-4,
            lambda curvature=curvature, which=which: measure.bent_radii(curvature)[which],  # type: ignore[misc]
        )
        for curvature, pair in radii.items()
        for which, expected in enumerate(pair)
    ]
    slender = 0.05
    closing = Case(
        "18",
        "slender strip bent to half a circle (its mirror image closes it)",
        "moment over E I times curvature",
        1.0,
        "slender limit, M L/(E I) = 2π",
        3e-3,
        lambda: measure.bending_moment(slender, turn=np.pi) / (4.0 / 12.0 * slender),
    )
    return [*bent, *turned, closing]


def _torsion() -> list[Case]:
    problem, source = "torsion of a cylinder, ends held, twist 0.5", "closed form, incompressible"
    return [
        Case("16", problem, "torque in N mm", 0.785398163, source, 1e-3, lambda: measure.torsion(0.5)[0]),
        Case(
            "16",
            problem,
            "axial force in N (Poynting)",
            -0.196349541,
            source,
            1e-3,
            lambda: measure.torsion(0.5)[1],
        ),
    ]


def _elastica() -> list[Case]:
    names = ("deflection over length", "shortening over length")
    return [
        Case(
            "17",
            "cantilever 100 times as long as thick, dead tip load",
            f"{names[which]}, P L²/(E I) = {factor:g}",
            expected,
            "elastica, inextensible and without shear",
            6e-3,
            lambda factor=factor, which=which: measure.cantilever_tip(factor)[which],  # type: ignore[misc]
        )
        for factor, pair in _ELASTICA.items()
        for which, expected in enumerate(pair)
    ]


def _cook() -> list[Case]:
    soft = solid(Ogden((0.4225,), (2.0,)), bulk_modulus_MPa=bulk_modulus(0.4225, 0.3))
    stiff = solid(Ogden((80.194,), (2.0,)), bulk_modulus_MPa=40094.0)
    return [
        Case(
            "Cook, ν = 0.3",
            "Cook's membrane, plane strain",
            "rise of the corner in mm",
            13.77,
            "published, finite strain",
            2e-3,
            lambda: measure.cook_tip(soft, force_N=1.0),
        ),
        Case(
            "Cook, ν = 0.3, z free",
            "Cook's membrane one thick, z free",
            "rise of the corner in mm",
            14.33,
            "published, finite strain",
            2e-3,
            lambda: measure.cook_tip(soft, force_N=1.0, plane_strain=False),
        ),
        Case(
            "Cook, incompressible",
            "Cook's membrane, plane strain, κ/μ = 500",
            "rise of the corner in mm",
            6.94,
            "published, finite strain",
            5e-3,
            lambda: measure.cook_tip(stiff, force_N=100.0),
        ),
    ]
