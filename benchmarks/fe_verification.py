"""Run every verification case and write docs/verification.md with its figures.

python benchmarks/fe_verification.py
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure

from spavision.model.verification.cases import Case, all_cases
from spavision.model.verification.measurements import balloon_pressures, lame_sphere, lame_tube

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "verification.md"
IMAGES = ROOT / "docs" / "images"

PROPERTIES = (
    (
        "1, 3, 4",
        "uniaxial, equibiaxial and planar stress of the law",
        "test_materials.py::test_ogden_nominal_stress",
    ),
    ("2", "uniaxial tension with a finite bulk modulus", "test_closed_forms.py::test_uniaxial_tension"),
    (
        "cube",
        "incompressible cube pulled to twice its length",
        "test_closed_forms.py::test_incompressible_cube",
    ),
    ("6", "cube under pressure all round", "test_closed_forms.py::test_cube_under_pressure_all_round"),
    (
        "12",
        "limit point of a thin balloon",
        "test_volume_control.py::test_volume_control_passes_the_limit_point",
    ),
    ("19", "patch test on distorted elements", "test_elements.py::test_patch"),
    ("20", "rigid rotation free of stress", "test_elements.py::test_rigid_rotation_is_free_of_force"),
    (
        "21",
        "tangents against finite differences",
        "test_elements.py::test_tangent_against_finite_differences",
    ),
    ("22", "closed cavity in balance", "test_cavity.py::test_closed_cavity_is_in_balance"),
    ("23", "forces in a cut cavity", "test_cavity.py::test_cut_cavity_has_the_forces_of_the_pressure"),
    ("24", "energy balance, second order in the step", "test_simulate.py::test_energy_balance"),
    ("25", "Newton's method is quadratic", "test_convergence.py::test_newton_is_quadratic"),
    ("–", "half model against full actuator", "test_symmetry.py::test_half_model_is_half_of_the_full_one"),
)
"""Row, what is checked, the test that does it."""

HEAD = """# Verification of the finite-element model

Written by `python benchmarks/fe_verification.py`; do not edit. Each number is computed with the mesh, kernels
and Newton's method of the actuator and compared with one that we did not compute. The meshes are coarse (some
10 to 200 elements): what is left is their error, for closed forms of incompressible bodies that of the bulk
modulus of 10⁵ shear moduli (some 10⁻⁵), and for the cantilever the clamp, which holds the section's width.
`tests/model/test_verification.py` runs the same cases.

"""


def main() -> None:
    """Write the page and its figures."""
    IMAGES.mkdir(parents=True, exist_ok=True)
    rows = [_measured(case) for case in all_cases()]
    save(mesh_convergence(), IMAGES / "verification_convergence.svg")
    save(balloon(), IMAGES / "verification_balloon.svg")
    PAGE.write_text(HEAD + case_table(rows) + FIGURES + property_table(), encoding="utf-8")
    failed = [case.row for case, value in rows if not abs(value / case.expected - 1.0) <= case.tolerance]
    print(f"{PAGE.relative_to(ROOT)}: {len(rows)} case(s), beyond tolerance: {', '.join(failed) or 'none'}")


def _measured(case: Case) -> tuple[Case, float]:
    value = case.measure()
    print(f"row {case.row}, {case.problem}, {case.quantity}: {100.0 * (value / case.expected - 1.0):+.4f} %")
    return case, value


def case_table(rows: list[tuple[Case, float]]) -> str:
    """Return the table of cases."""
    lines = [
        "| row | problem | quantity | reference | ours | error |",
        "|---|---|---|---:|---:|---:|",
    ]
    lines += [
        f"| {case.row} | {case.problem} | {case.quantity} | {case.expected:.9g} | {value:.7g} "
        f"| {100.0 * (value / case.expected - 1.0):+.3f} % |"
        for case, value in rows
    ]
    sources: dict[str, list[str]] = {}
    for case, _ in rows:
        if case.row not in sources.setdefault(case.source, []):
            sources[case.source].append(case.row)
    named = "; ".join(f"{source}: {', '.join(found)}" for source, found in sources.items())
    return "\n".join(lines) + f"\n\nWhere the references come from, by row: {named}.\n\n"


FIGURES = """## Convergence with the mesh

![Error of the bore displacement against element size](images/verification_convergence.svg)

Lamé tube and sphere (rows 13 and 14, Poisson's ratio 0.3): the error of the bore displacement falls with the
square of the element size for Q1/P0 and with its fourth power for Q2/P1.

## Limit point

![Pressure of a thin balloon against its stretch](images/verification_balloon.svg)

Thin neo-Hookean balloon (row 12) under volume control: the circles pass the limit point, at which pressure
control has to stop.

"""


def property_table() -> str:
    """Return the table of the rows that tests check as properties.

    Raises
    ------
    ValueError
        If a test named here does not exist.
    """
    for _, _, test in PROPERTIES:
        module, name = test.split("::")
        if f"def {name}(" not in (ROOT / "tests" / "model" / module).read_text(encoding="utf-8"):
            raise ValueError(f"tests/model/{test} does not exist")
    lines = ["## Rows checked as properties", "", "| row | what | test in tests/model |", "|---|---|---|"]
    lines += [f"| {row} | {what} | `{test}` |" for row, what, test in PROPERTIES]
    return "\n".join(lines) + "\n"


def mesh_convergence() -> Figure:
    """Draw the error of the bore displacement against the element size."""
    figure = Figure(figsize=(5.5, 4.0), layout="constrained")
    axis = figure.add_subplot()
    for order, colour in ((1, "C0"), (2, "C1")):
        cells = np.array([2, 4, 8])
        tube = [abs(lame_tube(0.3, order=order, cells=n) / 1.906666667 - 1.0) for n in cells]
        axis.loglog(1.0 / cells, tube, "o-", color=colour, label=f"tube, Q{order}")
        around = np.array([2, 3, 4])
        ball = [abs(lame_sphere(0.3, order=order, across=n, around=n) / 0.8 - 1.0) for n in around]
        axis.loglog(1.0 / around, ball, "s--", color=colour, label=f"sphere, Q{order}")
    size = np.array([0.125, 0.5])
    axis.loglog(size, 0.25 * size**2, "k:", linewidth=0.8, label="h² and h⁴")
    axis.loglog(size, 0.01 * size**4, "k:", linewidth=0.8)
    axis.set(xlabel="element size over wall", ylabel="relative error of the bore displacement")
    axis.legend(fontsize="small")
    return figure


def balloon() -> Figure:
    """Draw pressure against stretch of a thin balloon beside the closed form."""
    thickness, ratios = 0.01, np.linspace(1.2, 8.0, 25)
    pressures = balloon_pressures(ratios, thickness=thickness)
    figure = Figure(figsize=(5.5, 3.5), layout="constrained")
    axis = figure.add_subplot()
    stretch = np.linspace(1.0, 2.0, 200)
    axis.plot(stretch, 2.0 * (stretch**-1.0 - stretch**-7.0), "k-", linewidth=0.8, label="closed form, thin")
    axis.plot(np.cbrt(ratios), pressures, "o", markersize=4.0, label="Q2/P1, volume control")
    axis.axvline(7.0 ** (1.0 / 6.0), color="k", linewidth=0.5, linestyle=":")
    axis.set(xlabel="stretch", ylabel="p R / (μ t)")
    axis.legend(fontsize="small")
    return figure


def save(figure: Figure, path: Path) -> None:
    """Write a figure as SVG, the same bytes for the same content."""
    with rc_context({"svg.hashsalt": "spavision", "svg.fonttype": "none"}):
        figure.savefig(path, metadata={"Date": None})


if __name__ == "__main__":
    main()
