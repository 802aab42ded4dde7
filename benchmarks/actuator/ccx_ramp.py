"""The actuator's ramp in CalculiX: the deck that `spavision simulate --write-deck` writes, run as it is."""

from __future__ import annotations

import os
import resource
import subprocess
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from spavision.model.deck import write_deck
from spavision.model.geometry import ActuatorGeometry
from spavision.model.simulation import SimulationSettings


@dataclass(frozen=True)
class DeckRun:
    """How far CalculiX came.

    Parameters
    ----------
    node : int
        The deck's node nearest to the marker, an index into the mesh's nodes.
    displacement_mm : array, shape (n_steps, 3)
        Of that node from the unstressed shape, the first row under the weight alone.
    cpu_s, wall_s : float
    """

    node: int
    displacement_mm: np.ndarray
    cpu_s: float
    wall_s: float


def ccx_ramp(
    geometry: ActuatorGeometry,
    *,
    crimp_ratio: float,
    settings: SimulationSettings,
    pressures_kPa: np.ndarray,
    threads: int,
    limit_s: float,
) -> DeckRun:
    """Run the deck up to the end, to where CalculiX stops or for so many seconds of its CPU time."""
    with tempfile.TemporaryDirectory() as folder:
        deck = Path(folder) / "actuator.inp"
        write_deck(deck, geometry, crimp_ratio=crimp_ratio, pressures_kPa=pressures_kPa, settings=settings)
        lines = deck.read_text().splitlines()
        node = int(lines[lines.index("*NSET, NSET=MARKER") + 1]) - 1
        before, wall = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
        subprocess.run(
            ["ccx", deck.stem],
            cwd=folder,
            check=False,
            stdout=subprocess.DEVNULL,
            env=os.environ | {"OMP_NUM_THREADS": str(threads)},
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (int(limit_s), int(limit_s))),
        )
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        rows = [line.split() for line in deck.with_suffix(".dat").read_text().splitlines()]
    displacement = np.array([row[1:] for row in rows if len(row) == 4 and row[0].isdigit()], dtype=float)
    cpu_s = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return DeckRun(node, displacement, cpu_s, time.perf_counter() - wall)
