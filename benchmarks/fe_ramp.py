"""Time to a tip path of a given error: spavision against FElupe and CalculiX, in one and in two threads.

First the whole actuator from 0 to 65 kPa at crimp ratio 0.2 by spavision alone, the shortest of three runs,
with the peak memory.

Then one of four voids, crimp ratio 0.3, from hanging to its first extremum at 55 kPa, so that the peers'
runs stay within minutes. The error is the distance from the converged path (`actuator/references.py`) over
the largest displacement on the way. FElupe takes our default mesh and one with two elements in each wall,
with which its error is about that of spavision: its element, with the pressure of a trilinear one, is
stiffer. CalculiX cannot finish the ramp (its static Newton iteration leaves out the stiffness of the
follower pressure) and is compared with spavision up to the pressure that it reaches. Compilation of kernels
is not timed. CPU time is what counts on a machine that is shared; wall time is given beside it.

Settings. spavision: as it comes, steps of 5 kPa. FElupe: 27-node three-field solid, Job with CutbackPlugin,
MKL Pardiso, compiled materials, the largest of the steps tried (5, 2.5, 1.25 kPa) that finishes, same
tolerance. CalculiX: C3D20R from the deck that spavision writes, its default solver, increments from 1 kPa.
NumPy's OpenBLAS in one thread for all: its waiting threads take cores from the others.

Run: python benchmarks/fe_ramp.py [--threads 1 2]
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import shutil
import subprocess
import sys
import time
from dataclasses import replace
from importlib.util import find_spec
from typing import Any

import numpy as np
from actuator.references import ACTUATORS, errors_percent, ramp, reference

from spavision.model.actuator_mesh import MESH_LEVELS
from spavision.model.geometry import ActuatorGeometry
from spavision.model.simulate import SimulationSettings, simulate

VOIDS, CRIMP_RATIO, LAST_KPA = 4, 0.3, 55.0
WHOLE_CRIMP_RATIO, WHOLE_LAST_KPA, WHOLE_REPEATS = 0.2, 65.0, 3
TIMES = f"{'':30s} {'threads':>7s} {'CPU s':>8s} {'wall s':>8s}"
FELUPE_STEPS_KPA = (5.0, 2.5, 1.25)
CCX_LIMIT_S = 900.0
MESH_LEVELS["finer walls"] = replace(MESH_LEVELS["default"], wall_length=2)


def whole(level: str, _threads: int, last_kPa: float) -> dict[str, Any]:
    """Time spavision's ramp of the whole actuator; a short one before it compiles the kernels."""
    ramp(MESH_LEVELS["draft"], voids=2, crimp_ratio=CRIMP_RATIO, last_kPa=5.0)
    runs = []
    for _ in range(WHOLE_REPEATS):
        cpu, wall = time.process_time(), time.perf_counter()
        result = simulate(
            ActuatorGeometry(),
            crimp_ratio=WHOLE_CRIMP_RATIO,
            pressures_kPa=np.arange(0.0, last_kPa + 1.0, 5.0),
            settings=SimulationSettings(mesh_level=level),
        )
        runs.append((time.perf_counter() - wall, time.process_time() - cpu))
    wall_s, cpu_s = min(runs)
    return {
        "cpu_s": cpu_s,
        "wall_s": wall_s,
        "unknowns": result.mesh.n_dofs,
        "factorisations": sum(step.newton_iterations for step in result.steps),
        "peak_GB": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20,
    }


def ours(level: str, _threads: int, last_kPa: float) -> dict[str, Any]:
    """Time spavision's ramp; a short one before it compiles the kernels."""
    ramp(MESH_LEVELS["draft"], voids=2, crimp_ratio=CRIMP_RATIO, last_kPa=5.0)
    path = ramp(MESH_LEVELS[level], voids=VOIDS, crimp_ratio=CRIMP_RATIO, last_kPa=last_kPa)
    return {"cpu_s": path.cpu_s, "wall_s": path.wall_s, "tip_mm": path.tip_mm.tolist(), "note": ""}


def felupe(level: str, threads: int, last_kPa: float) -> dict[str, Any]:
    """Time FElupe's ramp in the largest steps with which it arrives."""
    from actuator.felupe_ramp import felupe_ramp

    pressures = np.arange(5.0, last_kPa + 1.0, 5.0)
    settings = SimulationSettings(mesh_level=level)
    tip, cpu_s, wall_s = np.empty((0, 2)), 0.0, 0.0
    for step_kPa in FELUPE_STEPS_KPA:
        cpu, wall = time.process_time(), time.perf_counter()
        tip = felupe_ramp(
            ACTUATORS[VOIDS],
            crimp_ratio=CRIMP_RATIO,
            settings=settings,
            pressures_kPa=pressures,
            step_kPa=step_kPa,
            parallel=threads > 1,
        )
        cpu_s, wall_s = time.process_time() - cpu, time.perf_counter() - wall
        if len(tip) == len(pressures):
            break
    return {"cpu_s": cpu_s, "wall_s": wall_s, "tip_mm": tip.tolist(), "note": f"steps of {step_kPa:g} kPa"}


def ccx(level: str, threads: int, last_kPa: float) -> dict[str, Any]:
    """Time CalculiX; its tip is the deck's node nearest to the marker, taken there by our difference."""
    from actuator.ccx_ramp import ccx_ramp

    pressures = np.arange(0.0, last_kPa + 1.0, 5.0)
    settings = SimulationSettings(mesh_level=level)
    run = ccx_ramp(
        ACTUATORS[VOIDS],
        crimp_ratio=CRIMP_RATIO,
        settings=settings,
        pressures_kPa=pressures,
        threads=threads,
        limit_s=CCX_LIMIT_S,
    )
    own = simulate(ACTUATORS[VOIDS], crimp_ratio=CRIMP_RATIO, pressures_kPa=pressures, settings=settings)
    steps = len(run.displacement_mm)
    own_node = own.displacement_mm[:steps, run.node] - own.displacement_mm[0, run.node]
    offset = np.column_stack([own.tip_path.ux_mm, own.tip_path.uy_mm])[:steps] - own_node[:, :2]
    tip = (run.displacement_mm - run.displacement_mm[0])[1:, :2] + offset[1:]
    reached = pressures[steps - 1]
    return {
        "cpu_s": run.cpu_s,
        "wall_s": run.wall_s,
        "tip_mm": tip.tolist(),
        "note": f"up to {reached:g} kPa",
    }


CODES = {"whole": whole, "ours": ours, "felupe": felupe, "ccx": ccx}


def in_process(code: str, level: str, threads: int, last_kPa: float = LAST_KPA) -> dict[str, Any]:
    """Run one code in a process of its own, whose libraries take the number of threads."""
    variables = ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
    done = subprocess.run(
        [sys.executable, __file__, "--only", code, level, str(threads), str(last_kPa)],
        check=True,
        stdout=subprocess.PIPE,
        text=True,
        env=os.environ | dict.fromkeys(variables, str(threads)) | {"OPENBLAS_NUM_THREADS": "1"},
    )
    return dict(json.loads(done.stdout.splitlines()[-1]))


def row(name: str, run: dict[str, Any], threads: int, baseline: dict[str, Any]) -> str:
    """One line of the table."""
    tip = np.array(run["tip_mm"])
    error = errors_percent(tip, reference(VOIDS, CRIMP_RATIO)[: len(tip)]).max()
    ratios = f"{run['cpu_s'] / baseline['cpu_s']:7.1f} {run['wall_s'] / baseline['wall_s']:7.1f}"
    times = f"{run['cpu_s']:8.1f} {run['wall_s']:8.1f}"
    return f"{name:30s} {threads:7d} {times} {error:8.2f} {ratios}  {run['note']}"


def main() -> None:
    """Print the table, or run one code for it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--threads", type=int, nargs="+", default=(1, 2))
    parser.add_argument("--only", nargs=4, metavar=("CODE", "MESH", "THREADS", "KPA"), help=argparse.SUPPRESS)
    asked = parser.parse_args()
    if asked.only:
        code, level, threads, last_kPa = asked.only
        print(json.dumps(CODES[code](level, int(threads), float(last_kPa))))
        return
    print(f"Whole actuator, crimp ratio {WHOLE_CRIMP_RATIO}, 0 to {WHOLE_LAST_KPA:g} kPa")
    print(f"{TIMES} {'unknowns':>9s} {'factors':>8s} {'peak GB':>8s}")
    for threads in asked.threads:
        for level in ("draft", "default"):
            run = in_process("whole", level, threads, WHOLE_LAST_KPA)
            times = f"{run['cpu_s']:8.1f} {run['wall_s']:8.1f}"
            size = f"{run['unknowns']:9d} {run['factorisations']:8d} {run['peak_GB']:8.2f}"
            print(f"{'spavision, ' + level:30s} {threads:7d} {times} {size}", flush=True)
    print(f"\n{VOIDS} voids, crimp ratio {CRIMP_RATIO}, 0 to {LAST_KPA:g} kPa")
    print(f"{TIMES} {'error %':>8s} {'x CPU':>7s} {'x wall':>7s}  (ratios to spavision's default mesh)")
    for threads in asked.threads:
        baseline = in_process("ours", "default", threads)
        for level in ("draft", "default"):
            run = baseline if level == "default" else in_process("ours", level, threads)
            print(row(f"spavision, {level}", run, threads, baseline), flush=True)
        for level in ("default", "finer walls") if find_spec("felupe") else ():
            run = in_process("felupe", level, threads)
            print(row(f"FElupe, {level}", run, threads, baseline), flush=True)
        if shutil.which("ccx"):
            peer = in_process("ccx", "default", threads)
            reached = 5.0 * len(peer["tip_mm"])
            same_way = in_process("ours", "default", threads, reached)
            print(row(f"spavision, default, to {reached:g} kPa", same_way, threads, same_way), flush=True)
            print(row("CalculiX, default", peer, threads, same_way), flush=True)


if __name__ == "__main__":
    main()
