"""Convergence of the tip displacement with the mesh, level by level and under uniform refinement.

An actuator of four voids stands for the whole: its cells deform like the others', and its converged mesh can
be afforded. Three tables for each crimp ratio: the levels against a graded converged mesh, up to the first
extremum; uniform refinements of the default mesh; and Richardson's extrapolation of these, which is the
check on the converged mesh. `spavision.model.mesh_error` quotes the levels' errors.

Run: python benchmarks/fe_convergence.py [--refinements 2]   (3 takes several minutes and some 4 GB)
"""

from __future__ import annotations

import argparse
import time
from dataclasses import dataclass, replace

import numpy as np

from spavision.model import actuator_mesh
from spavision.model.actuator_mesh import MESH_LEVELS, MeshLevel
from spavision.model.geometry import ActuatorGeometry
from spavision.model.simulate import SimulationSettings, simulate

ACTUATOR = ActuatorGeometry(void_count=4)
LAST_PRESSURE_KPA = {0.2: 40.0, 0.3: 55.0}
"""First extremum of the tip's x at each crimp ratio."""

CONVERGED = MeshLevel(
    order=2,
    composite=4,
    strip_a=2,
    channel=2,
    void=4,
    roof=2,
    void_width=3,
    void_width_grading=0.5,
    side_wall=2,
    void_length=5,
    wall_length=2,
)
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
ASSUMED_ORDER = 2.0
"""With two refinements; against the converged mesh the order comes out as 1.6 (late) to 2.8 (early)."""


@dataclass(frozen=True)
class Path:
    """Tip displacement, shape (n_pressures, 2), number of unknowns and CPU seconds."""

    tip_mm: np.ndarray
    unknowns: int
    seconds: float


def ramp(level: MeshLevel, crimp_ratio: float) -> Path:
    """Inflate the short actuator on a mesh that is none of the named levels."""
    actuator_mesh.MESH_LEVELS["benchmark"] = level
    begin = time.process_time()
    pressures = np.arange(0.0, LAST_PRESSURE_KPA[crimp_ratio] + 1.0, 5.0)
    result = simulate(
        ACTUATOR,
        crimp_ratio=crimp_ratio,
        pressures_kPa=pressures,
        settings=SimulationSettings(mesh_level="benchmark"),
    )
    tip = np.column_stack([result.tip_path.ux_mm, result.tip_path.uy_mm])
    return Path(tip[1:], result.mesh.n_dofs, time.process_time() - begin)


def uniformly_refined(level: MeshLevel, times: int) -> MeshLevel:
    """Cut each element into equal parts."""
    return replace(level, **{part: times * getattr(level, part) for part in PARTS})


def richardson(paths: list[Path]) -> tuple[np.ndarray, float]:
    """Extrapolate refinements 1, 2 (and 3) to none; with three of them the order is the last value's own."""
    values = [path.tip_mm for path in paths]
    order = ASSUMED_ORDER
    if len(values) == 3:
        orders = np.linspace(0.3, 4.0, 371)
        ratio = np.linalg.norm(values[1] - values[0]) / np.linalg.norm(values[2] - values[1])
        predicted = (1.0 - 2.0**-orders) / (2.0**-orders - 3.0**-orders)
        order = float(orders[np.abs(predicted - ratio).argmin()])
    fine, coarse = len(values), len(values) - 1
    gain = (fine / coarse) ** order - 1.0
    return values[-1] + (values[-1] - values[-2]) / gain, order


def row(name: str, path: Path, reference: np.ndarray) -> str:
    """One line of the table: error over the displacement's size, in per cent."""
    error = np.linalg.norm(path.tip_mm - reference, axis=1)
    size = np.linalg.norm(reference, axis=1)
    cells = " ".join(f"{value:6.2f}" for value in 100.0 * error / size)
    of_extremum = 100.0 * error.max() / size.max()
    return f"{name:14s} {path.unknowns:7d} {path.seconds:7.1f}  {of_extremum:6.2f}  {cells}"


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--refinements", type=int, choices=(2, 3), default=2)
    refinements = parser.parse_args().refinements
    for crimp_ratio, last in LAST_PRESSURE_KPA.items():
        converged = ramp(CONVERGED, crimp_ratio)
        pressures = " ".join(f"{pressure:6.0f}" for pressure in np.arange(5.0, last + 1.0, 5.0))
        print(f"\ncrimp ratio {crimp_ratio}: error of the tip displacement against the converged mesh, %")
        print(f"{'mesh':14s} {'unknowns':>7s} {'CPU s':>6s}  {'of max':>6s}  at kPa: {pressures}")
        for name in ("draft", "default", "fine"):
            print(row(name, ramp(MESH_LEVELS[name], crimp_ratio), converged.tip_mm), flush=True)
        paths = [
            ramp(uniformly_refined(MESH_LEVELS["default"], times), crimp_ratio)
            for times in range(1, refinements + 1)
        ]
        for times, path in enumerate(paths, start=1):
            print(row(f"default/{times}", path, converged.tip_mm), flush=True)
        limit, order = richardson(paths)
        print(row(f"limit, order {order:.1f}", Path(limit, 0, 0.0), converged.tip_mm))
        print(row("converged", converged, limit), " (against that limit)", flush=True)


if __name__ == "__main__":
    main()
