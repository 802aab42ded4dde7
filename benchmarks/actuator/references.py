"""Converged tip paths that other benchmarks measure errors against, and how to make them again.

Each is the path of a graded mesh finer than any level. They cost minutes to an hour, so their digits are
kept; `fe_convergence.py` checks them against Richardson's extrapolation of uniform refinements, and with
four voids they were checked once against a mesh of 2.5 times as many unknowns (246 915), which moved the tip
by 0.16 % of its displacement at the first extremum. The full actuator's took 12 minutes of CPU (346 725
unknowns).

Run: python benchmarks/fe_references.py --voids 4 --crimp 0.3
"""

from __future__ import annotations

import argparse
import time
from dataclasses import dataclass

import numpy as np

from spavision.model import actuator_mesh
from spavision.model.actuator_mesh import MeshLevel
from spavision.model.geometry import ActuatorGeometry
from spavision.model.simulate import SimulationSettings, simulate

REFERENCE_MESH = MeshLevel(
    order=2,
    composite=(0.35, 0.7, 0.9),
    strip_a=2,
    channel=2,
    void=(0.12, 0.4, 0.7, 0.9),
    roof=(0.35,),
    void_width=(0.45, 0.75, 0.92),
    side_wall=(0.25, 0.6),
    void_length=(0.06, 0.2, 0.5, 0.8, 0.94),
    wall_length=2,
)

ACTUATORS = {4: ActuatorGeometry(void_count=4), 15: ActuatorGeometry()}
"""By number of voids: the short one of the studies and the article's."""

FIRST_EXTREMUM_KPA = {0.2: 40.0, 0.3: 55.0}
"""Of the tip's x, at each crimp ratio; the last pressure of the references."""

DIGITS = {
    (4, 0.2): (
        (0.16492, 0.36773, 0.60467, 0.88138, 1.20136, 1.53637, 1.83094, 2.00054),
        (0.28366, 0.58892, 0.91991, 1.28375, 1.68869, 2.13905, 2.64089, 3.20683),
    ),
    (4, 0.3): (
        (0.16492, 0.36773, 0.60467, 0.88143, 1.20722, 1.59494, 2.06415, 2.64688, 3.39981, 4.43742, 5.58932),
        (0.28366, 0.58892, 0.91991, 1.28378, 1.69018, 2.15248, 2.69069, 3.33740, 4.15164, 5.25888, 6.90575),
    ),
    (15, 0.3): (
        (
            2.08102,
            4.75660,
            7.91095,
            11.60909,
            15.97583,
            21.18419,
            27.50648,
            35.39529,
            45.68914,
            60.09561,
            73.09612,
        ),
        (0.87741, 1.79825, 2.74472, 3.70552, 4.66068, 5.57432, 6.38099, 6.95219, 7.00484, 5.84160, 7.46480),
    ),
}
"""Tip displacement (ux, uy) in mm at 5, 10, … kPa for (number of voids, crimp ratio)."""


@dataclass(frozen=True)
class Path:
    """Tip displacement, shape (n_pressures, 2), number of unknowns, CPU and wall seconds."""

    tip_mm: np.ndarray
    unknowns: int
    cpu_s: float
    wall_s: float


def reference(voids: int, crimp_ratio: float) -> np.ndarray:
    """Return the stored path at 5, 10, … kPa, shape (n_pressures, 2)."""
    return np.array(DIGITS[voids, crimp_ratio]).T


def ramp(level: MeshLevel, *, voids: int, crimp_ratio: float, last_kPa: float | None = None) -> Path:
    """Inflate in steps of 5 kPa, up to the first extremum if not told otherwise, on any mesh."""
    actuator_mesh.MESH_LEVELS["benchmark"] = level
    wall, cpu = time.perf_counter(), time.process_time()
    result = simulate(
        ActuatorGeometry(void_count=voids),
        crimp_ratio=crimp_ratio,
        pressures_kPa=np.arange(0.0, (last_kPa or FIRST_EXTREMUM_KPA[crimp_ratio]) + 1.0, 5.0),
        settings=SimulationSettings(mesh_level="benchmark"),
    )
    tip = np.column_stack([result.tip_path.ux_mm, result.tip_path.uy_mm])
    return Path(tip[1:], result.mesh.n_dofs, time.process_time() - cpu, time.perf_counter() - wall)


def errors_percent(tip_mm: np.ndarray, converged_mm: np.ndarray) -> np.ndarray:
    """Return the distance from the converged tip over its largest displacement on the way, in per cent."""
    distance = np.linalg.norm(tip_mm - converged_mm, axis=1)
    return np.asarray(100.0 * distance / np.linalg.norm(converged_mm, axis=1).max())


def main() -> None:
    """Make one reference again and print its digits."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--voids", type=int, default=4)
    parser.add_argument("--crimp", type=float, choices=tuple(FIRST_EXTREMUM_KPA), default=0.3)
    asked = parser.parse_args()
    path = ramp(REFERENCE_MESH, voids=asked.voids, crimp_ratio=asked.crimp)
    print(f"{path.unknowns} unknowns, {path.cpu_s:.0f} s of CPU, {path.wall_s:.0f} s")
    for name, values in zip(("ux_mm", "uy_mm"), path.tip_mm.T, strict=True):
        print(name, ", ".join(f"{value:.5f}" for value in values))


if __name__ == "__main__":
    main()
