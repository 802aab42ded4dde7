"""The reduced model against the full one: first extremum, its pressure, processor time, in one thread.

Run: python benchmarks/study_reduced_model.py
"""

from __future__ import annotations

import os

os.environ.setdefault("NUMBA_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import time

import numpy as np

from spavision.correlate.modes import find_modes
from spavision.model.geometry import ActuatorGeometry
from spavision.model.reduced.ramp import simulate_reduced
from spavision.model.simulate import simulate

CRIMP_RATIOS = (0.2, 0.25, 0.3)
PRESSURES_KPA = np.arange(0.0, 66.0, 5.0)


def main() -> None:
    # Compiled kernels and loaded libraries are not part of a ramp.
    simulate_reduced(ActuatorGeometry(), crimp_ratio=0.2, pressures_kPa=PRESSURES_KPA[:2])
    print(
        "| crimp ratio | extremum, full | reduced | its pressure, full | reduced | seconds, full | reduced |"
    )
    print("|---|---|---|---|---|---|---|")
    for crimp_ratio in CRIMP_RATIOS:
        modes, seconds = [], []
        for run in (simulate, simulate_reduced):
            start = time.process_time()
            found = run(ActuatorGeometry(), crimp_ratio=crimp_ratio, pressures_kPa=PRESSURES_KPA)
            seconds.append(time.process_time() - start)
            modes.append(find_modes(found.tip_path))
        full, reduced = modes
        off = 100.0 * (reduced.first_extremum_mm / full.first_extremum_mm - 1.0)
        print(
            f"| {crimp_ratio:g} | {full.first_extremum_mm:.2f} mm "
            f"| {reduced.first_extremum_mm:.2f} mm ({off:+.1f} %) "
            f"| {full.first_extremum_kPa:.2f} kPa | {reduced.first_extremum_kPa:.2f} kPa "
            f"| {seconds[0]:.1f} | {seconds[1]:.2f} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
