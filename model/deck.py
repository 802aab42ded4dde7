"""The actuator as an input deck for CalculiX and Abaqus."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .actuator_problem import actuator_problem
from .deck_fibres import fibre_springs
from .deck_materials import material_cards
from .elements import FloatArray, IntArray
from .equilibrium import GRAVITY_MM_PER_S2, Equilibrium
from .export import vtk_elements
from .geometry import ActuatorGeometry
from .hex_mesh import HexMesh
from .simulation import SimulationSettings

_NODES_KEPT = 20
_ABAQUS_FACES = ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))
"""Corners of the faces P1 to P6 (Abaqus Elements Guide, three-dimensional solid elements)."""

_LABELS_A_LINE = 12

_HEADING = """\
** Bimodal soft pneumatic actuator, half model z >= 0, written by spavision.
** Units: mm, N, MPa, tonne, s. Axes: x towards region B, y from clamp down to tip, z across the width.
** Mesh: 20-node hexahedra on the nodes of the 27-node ones (face and body centres are left out).
** Materials: hyperelastic laws with D1 = 2/kappa; Ogden's mu is converted, mu alpha/2. Where no further
** D is given, CalculiX warns and adds terms of higher order that do not matter here.
** Abaqus: put C3D20RH for C3D20R if it warns of volumetric locking.
** CalculiX leaves the stiffness of the follower pressure out of its static Newton iteration: expect it
** to stop between 30 and 40 kPa.
"""

_FIBRES = """\
** The programs have no material for the composite's paper. Each family of slack fibres is given as
** nonlinear springs (SPRINGA) between neighbouring nodes, along the length and across the width: slack
** up to the elongation at which the paper is straight, nothing in compression. Over each section they
** carry the same force as the fibres, lumped on lines of nodes (Simpson's rule over the thickness).
"""


def write_deck(
    path: Path,
    geometry: ActuatorGeometry,
    *,
    crimp_ratio: float,
    pressures_kPa: FloatArray,
    settings: SimulationSettings | None = None,
) -> None:
    """Write the half actuator with its clamp, symmetry, weight and pressures.

    Parameters
    ----------
    path : Path
    geometry : ActuatorGeometry
    crimp_ratio : float
    pressures_kPa : array, shape (n,)
        One step for each, after the step of the weight; 0 is left out.
    settings : SimulationSettings, optional

    Raises
    ------
    InputError
        If crimp ratio, materials or mesh level are unusable, or a law is not one of the programs'.
    """
    settings = settings or SimulationSettings()
    problem = actuator_problem(geometry, crimp_ratio=crimp_ratio, settings=settings)
    elements = vtk_elements(problem.mesh)[:, :_NODES_KEPT]
    lines = [
        _HEADING.rstrip(),
        *_node_cards(problem.mesh.nodes_mm, elements),
        *_element_cards(problem.mesh, elements),
        *_set_cards(problem.mesh, elements, geometry),
        *_material_section(problem),
        *_fibre_section(problem, elements),
        *_boundary_cards(),
        *_step_cards(problem.mesh, elements, pressures_kPa, gravity=settings.gravity),
    ]
    path.write_text("\n".join(lines) + "\n", encoding="ascii")


def _node_cards(nodes_mm: FloatArray, elements: IntArray) -> list[str]:
    rows = (f"{node + 1}, " + ", ".join(f"{x:.9g}" for x in nodes_mm[node]) for node in np.unique(elements))
    return ["*NODE, NSET=NALL", *rows]


def _element_cards(mesh: HexMesh, elements: IntArray) -> list[str]:
    lines = []
    for code, name in enumerate(mesh.region_names):
        members = np.flatnonzero(mesh.region == code)
        if not len(members):
            continue
        lines.append(f"*ELEMENT, TYPE=C3D20R, ELSET={_label(name)}")
        for element in members:
            labels = [element + 1, *(elements[element] + 1)]
            lines += [", ".join(map(str, labels[:16])) + ",", ", ".join(map(str, labels[16:]))]
    filled = [_label(name) for code, name in enumerate(mesh.region_names) if np.any(mesh.region == code)]
    return [*lines, "*ELSET, ELSET=SOLID", *filled]


def _set_cards(mesh: HexMesh, elements: IntArray, geometry: ActuatorGeometry) -> list[str]:
    used = np.unique(elements)
    lines = []
    for name, nodes in mesh.node_sets.items():
        lines += [f"*NSET, NSET={_label(name)}", *_label_lines(np.intersect1d(nodes, used))]
    distance = np.linalg.norm(mesh.nodes_mm[used] - np.array(geometry.marker_position_mm), axis=1)
    lines += ["** The used node nearest to the tracked point", "*NSET, NSET=MARKER"]
    lines += _label_lines(used[[int(distance.argmin())]])
    for face, members in _cavity_faces(mesh, elements).items():
        lines += [f"*ELSET, ELSET=GAS_{face}", *_label_lines(members)]
    return lines


def _material_section(problem: Equilibrium) -> list[str]:
    lines = []
    for group in problem.groups:
        names = [problem.mesh.region_names[code] for code in np.unique(problem.mesh.region[group.elements])]
        lines += material_cards(_label(names[0]), group.material)
        lines += [f"*SOLID SECTION, ELSET={_label(name)}, MATERIAL={_label(names[0])}" for name in names]
    return lines


def _fibre_section(problem: Equilibrium, elements: IntArray) -> list[str]:
    lines: list[str] = []
    label = len(elements)
    for group in problem.groups:
        stiff = [fibre for fibre in group.material.fibres if fibre.modulus_MPa > 0.0]
        for number, fibre in enumerate(stiff, start=1):
            for part, springs in enumerate(
                fibre_springs(problem.mesh, elements[group.elements], fibre), start=1
            ):
                name = f"FIBRE{number}_{part}"
                lines.append(f"*ELEMENT, TYPE=SPRINGA, ELSET={name}")
                for first, second in springs.pairs:
                    label += 1
                    lines.append(f"{label}, {first + 1}, {second + 1}")
                lines += [f"*SPRING, NONLINEAR, ELSET={name}", ""]
                # CalculiX takes an integer in the first row for a degree of freedom, hence the exponents.
                lines += [
                    f"{force:.9e}, {elongation:.9e}"
                    for force, elongation in zip(springs.force_N, springs.elongation_mm, strict=True)
                ]
    return [_FIBRES.rstrip(), *lines] if lines else []


def _boundary_cards() -> list[str]:
    return ["*BOUNDARY", "CLAMP, 1, 3", "SYMMETRY, 3, 3"]


def _step_cards(mesh: HexMesh, elements: IntArray, pressures_kPa: FloatArray, *, gravity: bool) -> list[str]:
    lines = []
    if gravity:
        load = ["*DLOAD", f"SOLID, GRAV, {GRAVITY_MM_PER_S2:g}, 0., 1., 0."]
        # Under the weight alone CalculiX's Ogden law is too noisy, near equal stretches, for its tolerance.
        relaxed = ["*CONTROLS, PARAMETERS=FIELD", "1., 0.05"]
        lines += ["** The weight", *_step(load, controls=relaxed, first_increment=0.25)]
    faces = _cavity_faces(mesh, elements)
    previous = 0.0
    for pressure in pressures_kPa[pressures_kPa > 0.0]:
        load = ["*DLOAD", *(f"GAS_{face}, {face}, {1e-3 * pressure:.9g}" for face in faces)]
        # Increments of about 1 kPa, for the first one is a guess without history.
        first = min(1.0, 1.0 / (pressure - previous))
        lines += [
            f"** Gas at {pressure:g} kPa",
            *_step(load, controls=["*CONTROLS, RESET"], first_increment=first),
        ]
        previous = float(pressure)
    return lines


def _step(load: list[str], *, controls: list[str], first_increment: float) -> list[str]:
    return [
        "*STEP, NLGEOM, INC=1000",
        *controls,
        "*STATIC",
        f"{first_increment:.6g}, 1., 1e-4, 1.",
        *load,
        "*NODE PRINT, NSET=MARKER, FREQUENCY=1000",
        "U",
        "*NODE FILE, FREQUENCY=1000",
        "U",
        "*EL FILE, FREQUENCY=1000",
        "S, E",
        "*END STEP",
    ]


def _cavity_faces(mesh: HexMesh, elements: IntArray) -> dict[str, IntArray]:
    """Elements at the gas by the label of the face that it presses on."""
    wanted = {frozenset(face.tolist()) for face in mesh.cavity_faces}
    found: dict[str, IntArray] = {}
    for number, corners in enumerate(_ABAQUS_FACES, start=1):
        is_wet = [any(set(face) <= whole for whole in wanted) for face in elements[:, corners].tolist()]
        if any(is_wet):
            found[f"P{number}"] = np.flatnonzero(is_wet)
    return found


def _label(name: str) -> str:
    return name.upper().replace(" ", "_")


def _label_lines(indices: IntArray) -> list[str]:
    labels = [str(index + 1) for index in indices]
    return [
        ", ".join(labels[start : start + _LABELS_A_LINE]) for start in range(0, len(labels), _LABELS_A_LINE)
    ]
