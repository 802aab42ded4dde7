"""Convergence of the tip displacement with the mesh, up to the first extremum, at two crimp ratios.

An actuator of four voids stands for the whole in the study of levels and refinements: its cells deform like
the others'. Errors are distances from the converged path (`actuator/references.py`) over the displacement at
the first extremum, at each pressure. Uniform refinements of the default mesh, each element cut into equal
parts, give Richardson's estimate of the limit, the check on the reference that owes nothing to its mesh.
The full actuator's levels follow. `spavision.model.mesh_error` quotes the levels' errors.

Run: python benchmarks/fe_convergence.py [--refinements 3]   (3 takes a quarter of an hour and some 3 GB)
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from itertools import pairwise

import numpy as np
from actuator.references import DIGITS, FIRST_EXTREMUM_KPA, Path, errors_percent, ramp, reference

from spavision.model.actuator_mesh import MESH_LEVELS, MeshLevel

PARTS = (
    "composite",
    "strip_a",
    "channel",
    "void",
    "roof",
    "strip_b",
    "channel_width",
    "void_width",
    "side_wall",
    "void_length",
    "wall_length",
)
ASSUMED_ORDER = 1.5
"""With two refinements: between the 1.1 (twice 0.54, edges at which the solid turns by 270°) that bounds late
convergence and the 4 of smooth fields."""


def uniformly_refined(level: MeshLevel, times: int) -> MeshLevel:
    """Cut each element into equal parts."""
    return replace(level, **{part: times * getattr(level, part) for part in PARTS})


def richardson(tips_mm: list[np.ndarray]) -> tuple[np.ndarray, float]:
    """Extrapolate refinements 1, 2 (and 3) to none; with three of them the order is the last value's own."""
    order = ASSUMED_ORDER
    if len(tips_mm) == 3:
        orders = np.linspace(0.3, 4.0, 371)
        changes = [np.linalg.norm(after[-1] - before[-1]) for before, after in pairwise(tips_mm)]
        predicted = (1.0 - 2.0**-orders) / (2.0**-orders - 3.0**-orders)
        order = float(orders[np.abs(predicted - changes[0] / changes[1]).argmin()])
    finest, coarser = len(tips_mm), len(tips_mm) - 1
    gain = (finest / coarser) ** order - 1.0
    return tips_mm[-1] + (tips_mm[-1] - tips_mm[-2]) / gain, order


def row(name: str, path: Path | None, errors: np.ndarray) -> str:
    """One line of a table."""
    cost = f"{path.unknowns:8d} {path.cpu_s:7.1f}" if path else f"{'':8s} {'':7s}"
    return f"{name:20s} {cost}  {errors.max():5.2f}   " + " ".join(f"{error:5.2f}" for error in errors)


def heading(title: str, last_kPa: float) -> str:
    """Title and column names of a table."""
    pressures = " ".join(f"{pressure:5.0f}" for pressure in np.arange(5.0, last_kPa + 1.0, 5.0))
    return f"\n{title}\n{'mesh':20s} {'unknowns':>8s} {'CPU s':>7s}  worst   {pressures} kPa"


def levels_table(voids: int, crimp_ratio: float) -> None:
    """Print the errors of the three levels."""
    title = f"{voids} voids, crimp ratio {crimp_ratio}: error in % of the displacement at the first extremum"
    print(heading(title, FIRST_EXTREMUM_KPA[crimp_ratio]))
    for name in ("draft", "default", "fine"):
        path = ramp(MESH_LEVELS[name], voids=voids, crimp_ratio=crimp_ratio)
        print(row(name, path, errors_percent(path.tip_mm, reference(voids, crimp_ratio))), flush=True)


def refinements_table(crimp_ratio: float, refinements: int) -> None:
    """Print the errors of uniform refinements of the default mesh and of their limit."""
    title = f"4 voids, crimp ratio {crimp_ratio}: uniform refinement of the default mesh"
    print(heading(title, FIRST_EXTREMUM_KPA[crimp_ratio]))
    converged = reference(4, crimp_ratio)
    tips = []
    for times in range(1, refinements + 1):
        path = ramp(uniformly_refined(MESH_LEVELS["default"], times), voids=4, crimp_ratio=crimp_ratio)
        tips.append(path.tip_mm)
        print(row(f"default/{times}", path, errors_percent(path.tip_mm, converged)), flush=True)
    limit, order = richardson(tips)
    print(row(f"limit, order {order:.2f}", None, errors_percent(limit, converged)), flush=True)


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--refinements", type=int, choices=(2, 3), default=2)
    refinements = parser.parse_args().refinements
    for crimp_ratio in FIRST_EXTREMUM_KPA:
        levels_table(4, crimp_ratio)
        refinements_table(crimp_ratio, refinements)
    for voids, crimp_ratio in DIGITS:
        if voids == 15:
            levels_table(voids, crimp_ratio)


if __name__ == "__main__":
    main()
