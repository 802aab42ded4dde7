"""How far the ramp goes over crimp ratios, walls and region-B strips: 65 kPa, or where and why it stops.

Draft mesh, walls (between voids, side, roof, end) all alike, pressure control. Each finished run is kept in
the record, so that an interrupted grid goes on; delete the record to begin anew. At the end docs/reach.md is
written from the record.

Run: python benchmarks/fe_reach.py --record reach.json [--crimp 0.25 ...] [--wall 2 ...]   (105 of 5 to 60 s)
"""

from __future__ import annotations

import argparse
import json
import time
from dataclasses import asdict, dataclass
from itertools import product
from pathlib import Path

import numpy as np

from spavision import __version__
from spavision.model.geometry import ActuatorGeometry
from spavision.model.outputs import design_outputs
from spavision.model.simulate import Simulation, SimulationSettings, simulate

PAGE = Path(__file__).resolve().parents[1] / "docs" / "reach.md"
CRIMP_RATIOS = (0.15, 0.2, 0.25, 0.3, 0.35)
WALLS_MM = (2.0, 2.5, 3.0)
STRIPS = (
    (0.0, "Mold Star 15 two-term"),
    *product((1.0, 2.0, 3.0), ("Mold Star 15 two-term", "Smooth-Sil 950")),
)
PRESSURES_KPA = np.arange(0.0, 66.0, 5.0)

_INTRODUCTION = """\
Written by `python benchmarks/fe_reach.py` (spavision {version}); do not edit. Draft mesh, 15 voids, all walls
alike, pressure control. Of {variants} variants {finished} were run; {reached} of these reach 65 kPa.

A cell holds the tip's x in mm at 65 kPa, or where the ramp stops. ◎ is the first of 0, 5, … 65 kPa at which
the actuator has passed through itself in the plane of symmetry: contact is not modelled, and results from
there on are not a real actuator's. ↯ is the pressure in kPa at which it first snapped over a fold of the
path, mostly a corner of a thin wall folding in. A dash: not run."""


@dataclass(frozen=True)
class Outcome:
    """How a run ended; pressures are None where the thing did not happen."""

    stopped_at_kPa: float | None
    reason: str
    ux_mm: float
    uy_mm: float
    volume_ratio: float
    touches_itself_from_kPa: float | None
    snaps_from_kPa: float | None
    loses_stability_at_kPa: float | None
    cpu_seconds: float

    def sentence(self) -> str:
        """Say it in a line."""
        if self.stopped_at_kPa is not None:
            return f"stops at {self.stopped_at_kPa:.1f} kPa: {self.reason}"
        return f"65 kPa, tip at {self.ux_mm:.1f}, {self.uy_mm:.1f} mm, V/V0 {self.volume_ratio:.1f}"

    def cell(self) -> str:
        """Return the table's cell: tip x at 65 kPa with its marks, or where the ramp stops."""
        if self.stopped_at_kPa is not None:
            return f"**stops at {self.stopped_at_kPa:.1f} kPa**"
        marks = "".join(
            f" {mark} {pressure:.0f}"
            for mark, pressure in (("◎", self.touches_itself_from_kPa), ("↯", self.snaps_from_kPa))
            if pressure is not None
        )
        return f"{self.ux_mm:.0f}{marks}"


def run(crimp_ratio: float, wall_mm: float, strip: tuple[float, str]) -> Simulation:
    """Inflate one variant."""
    thickness_mm, silicone = strip
    geometry = ActuatorGeometry(
        wall_between_voids_mm=wall_mm,
        side_wall_mm=wall_mm,
        roof_mm=wall_mm,
        end_wall_mm=wall_mm,
        strip_b_mm=thickness_mm,
    )
    settings = SimulationSettings(mesh_level="draft", strip_b_material=silicone)
    return simulate(geometry, crimp_ratio=crimp_ratio, pressures_kPa=PRESSURES_KPA, settings=settings)


def outcome(result: Simulation, cpu_seconds: float) -> Outcome:
    """Read off how a run ended."""
    figures, last = design_outputs(result), int(np.flatnonzero(result.tip_path.has_reading)[-1])
    return Outcome(
        stopped_at_kPa=result.stopped_at_kPa,
        reason=result.stop_reason,
        ux_mm=float(result.tip_path.ux_mm[last]),
        uy_mm=float(result.tip_path.uy_mm[last]),
        volume_ratio=figures.volume_ratio,
        touches_itself_from_kPa=figures.touches_itself_from_kPa,
        snaps_from_kPa=figures.snaps_from_kPa,
        loses_stability_at_kPa=figures.loses_stability_at_kPa,
        cpu_seconds=cpu_seconds,
    )


def name_of(crimp_ratio: float, wall_mm: float, strip: tuple[float, str]) -> str:
    """Name a variant."""
    return f"crimp {crimp_ratio:.2f}, walls {wall_mm:g} mm, strip {strip_name(strip)}"


def strip_name(strip: tuple[float, str]) -> str:
    """Name a strip."""
    return f"{strip[0]:g} mm {strip[1]}" if strip[0] else "none"


def page(outcomes: dict[str, Outcome]) -> str:
    """Return the page with the table and the causes."""
    variants = len(CRIMP_RATIOS) * len(WALLS_MM) * len(STRIPS)
    reached = sum(one.stopped_at_kPa is None for one in outcomes.values())
    lines = [
        "# How far the ramp goes",
        "",
        _INTRODUCTION.format(version=__version__, reached=reached, finished=len(outcomes), variants=variants),
        "",
        "| crimp ratio | walls mm | " + " | ".join(f"strip {strip_name(strip)}" for strip in STRIPS) + " |",
        "|---|---|" + "---:|" * len(STRIPS),
    ]
    for crimp_ratio, wall_mm in product(CRIMP_RATIOS, WALLS_MM):
        names = [name_of(crimp_ratio, wall_mm, strip) for strip in STRIPS]
        cells = (outcomes[name].cell() if name in outcomes else "–" for name in names)
        lines.append(f"| {crimp_ratio:.2f} | {wall_mm:g} | " + " | ".join(cells) + " |")
    causes = [
        f"- {name}: {one.sentence()}" for name, one in outcomes.items() if one.stopped_at_kPa is not None
    ]
    return "\n".join([*lines, "", *(["Where it stops:", "", *causes] if causes else [])]).rstrip() + "\n"


def main() -> None:
    """Run what the record lacks, then write the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--record", type=Path, required=True)
    parser.add_argument("--crimp", type=float, nargs="+", default=CRIMP_RATIOS)
    parser.add_argument("--wall", type=float, nargs="+", default=WALLS_MM)
    asked = parser.parse_args()
    kept = json.loads(asked.record.read_text(encoding="utf-8")) if asked.record.exists() else {}
    found = {name: Outcome(**values) for name, values in kept.items()}
    for variant in product(asked.crimp, asked.wall, STRIPS):
        name = name_of(*variant)
        if name not in found:
            begin = time.process_time()
            result = run(*variant)
            found[name] = outcome(result, time.process_time() - begin)
            asked.record.write_text(
                json.dumps({key: asdict(one) for key, one in found.items()}), encoding="utf-8"
            )
        print(f"{name:66s} {found[name].cpu_seconds:5.1f} s  {found[name].sentence()}", flush=True)
    PAGE.write_text(page(found), encoding="utf-8")


if __name__ == "__main__":
    main()
