"""Cases a minute of a study of the reduced model, in this process, with one worker and with two; a kill.

A worker that is one process more costs its start, some seconds; so the rates are of the cases alone, from the
first result on, and the whole time stands beside them. With ``--kill`` a worker is killed half-way; the study
must still come to a result for every case.

Run: python benchmarks/study_throughput.py [--cases 40] [--kill]
"""

from __future__ import annotations

import argparse
import multiprocessing
import tempfile
import time
from pathlib import Path

import numpy as np

from spavision.correlate.study.case import Case
from spavision.correlate.study.case_files import CaseFolder, finished_cases
from spavision.correlate.study.execution import Machine
from spavision.experiment import Experiment

PRESSURES_KPA = tuple(float(p) for p in range(0, 70, 5))


def cases(count: int) -> list[Case]:
    """Return reduced cases that differ in the body's stiffness."""
    nominal = Experiment()
    return [
        Case(
            "reduced",
            nominal.with_options({"actuator": {"crimp_ratio": 0.25, "body_stiffness": float(factor)}}),
            PRESSURES_KPA,
            {"body_stiffness": float(factor)},
        )
        for factor in np.linspace(0.9, 1.2, count)
    ]


def run(count: int, *, workers: int, kill: bool = False) -> str:
    """Run a study and return the row of the table."""
    first = [0.0]
    start = time.perf_counter()

    def advance(text: str, done: float) -> None:  # noqa: ARG001
        if done == 1:
            first[0] = time.perf_counter()
        if kill and done == count // 2:
            multiprocessing.active_children()[0].kill()

    with tempfile.TemporaryDirectory() as folder:
        study = CaseFolder(Path(folder) / "study")
        results = finished_cases(study, cases(count), machine=Machine(workers=workers), advance=advance)
        kept = len(list((Path(folder) / "study" / "cases").iterdir()))
    end = time.perf_counter()
    rate = 60.0 * (count - 1) / (end - first[0])
    good = sum(result.status == "ok" for result in results)
    stopped = sum(result.status == "stopped" for result in results)
    processor = np.mean([result.seconds for result in results])
    name = f"{workers} worker{'s' if workers > 1 else ''}{', one killed half-way' if kill else ''}"
    return (
        f"| {name} | {rate:.0f} | {end - start:.1f} | {processor:.2f} | {good} ok, {stopped} stopped early, "
        f"{len(results) - good - stopped} failed | {kept} of {count} |"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--cases", type=int, default=40)
    parser.add_argument("--kill", action="store_true", help="also kill a worker half-way")
    given = parser.parse_args()
    print(f"{given.cases} cases of the reduced model, 0 to {PRESSURES_KPA[-1]:g} kPa\n")
    print("| | cases a minute | seconds in all | processor seconds a case | results | files |")
    print("|---|---|---|---|---|---|", flush=True)
    print(run(given.cases, workers=1), flush=True)
    print(run(given.cases, workers=2), flush=True)
    if given.kill:
        print(run(given.cases, workers=2, kill=True), flush=True)


if __name__ == "__main__":
    main()
