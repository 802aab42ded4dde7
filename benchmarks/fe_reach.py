"""How far the ramp goes over crimp ratios, walls and region-B strips: 65 kPa, or where and why it stops.

Draft mesh, walls (between voids, side, roof, end) all alike. A run under pressure control that stops is
followed under volume control with ``--follow``.

Run: python benchmarks/fe_reach.py [--crimp 0.25 ...] [--wall 2 ...] [--follow]   (105 runs of some 6 s)
"""

from __future__ import annotations

import argparse
import time
from itertools import product

import numpy as np

from spavision.model.geometry import ActuatorGeometry
from spavision.model.simulate import Simulation, SimulationSettings, simulate

CRIMP_RATIOS = (0.15, 0.2, 0.25, 0.3, 0.35)
WALLS_MM = (2.0, 2.5, 3.0)
STRIPS = (
    (0.0, "Mold Star 15 two-term"),
    *product((1.0, 2.0, 3.0), ("Mold Star 15 two-term", "Smooth-Sil 950")),
)
PRESSURES_KPA = np.arange(0.0, 66.0, 5.0)


def run(crimp_ratio: float, wall_mm: float, strip: tuple[float, str], *, control: str) -> Simulation:
    """Inflate one variant."""
    thickness_mm, silicone = strip
    geometry = ActuatorGeometry(
        wall_between_voids_mm=wall_mm,
        side_wall_mm=wall_mm,
        roof_mm=wall_mm,
        end_wall_mm=wall_mm,
        strip_b_mm=thickness_mm,
    )
    settings = SimulationSettings(mesh_level="draft", strip_b_material=silicone, control=control)
    return simulate(geometry, crimp_ratio=crimp_ratio, pressures_kPa=PRESSURES_KPA, settings=settings)


def verdict(result: Simulation) -> str:
    """Say how the run ended."""
    if result.stopped_at_kPa is None:
        return f"65 kPa, tip at {result.tip_path.ux_mm[-1]:.1f}, {result.tip_path.uy_mm[-1]:.1f} mm"
    return f"stops at {result.stopped_at_kPa:.1f} kPa: {result.stop_reason}"


def main() -> None:
    """Print one line for each variant, and how many arrive."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--crimp", type=float, nargs="+", default=CRIMP_RATIOS)
    parser.add_argument("--wall", type=float, nargs="+", default=WALLS_MM)
    parser.add_argument("--follow", action="store_true", help="also go on under volume control")
    asked = parser.parse_args()
    arrived = variants = 0
    for crimp_ratio, wall_mm, strip in product(asked.crimp, asked.wall, STRIPS):
        begin = time.process_time()
        result = run(crimp_ratio, wall_mm, strip, control="pressure")
        variants += 1
        arrived += result.stopped_at_kPa is None
        strip_name = f"{strip[0]:g} mm {strip[1]}" if strip[0] else "none"
        name = f"crimp {crimp_ratio:.2f}, walls {wall_mm:g} mm, strip {strip_name}"
        print(f"{name:66s} {time.process_time() - begin:5.1f} s  {verdict(result)}", flush=True)
        if asked.follow and result.stopped_at_kPa is not None:
            followed = run(crimp_ratio, wall_mm, strip, control="volume")
            print(f"{'':66s} {'':7s}  by volume: {verdict(followed)}", flush=True)
    print(f"{arrived} of {variants} reach 65 kPa")


if __name__ == "__main__":
    main()
