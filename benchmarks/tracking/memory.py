"""Peak memory and time of the tracker on photographs of 24 megapixels, each run in a process of its own.

Run: python benchmarks/tracking/memory.py [--cache FOLDER] [--output FOLDER]
"""

from __future__ import annotations

import argparse
import resource
import sys
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from multiprocessing import get_context
from pathlib import Path
from typing import TypeVar

import pandas as pd
from measure import told
from scenes import benchmark_sets
from truth import rendered

from spavision.vision.track import track

SET = "24-megapixels"
WORKERS = (1, 2)
LIMIT_GB = 1.5

Result = TypeVar("Result")


def main() -> None:
    """Measure each number of workers; print the table and save it as CSV."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cache", type=Path, help="folder to keep the rendered photos in")
    parser.add_argument("--output", type=Path, help="folder to save the table in")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        cache = options.cache or Path(scratch)
        _in_a_fresh_process(_render, cache)
        rows = [_in_a_fresh_process(_measure, cache, workers) for workers in WORKERS]
    table = pd.DataFrame(rows)
    print(table.to_string(index=False))
    if options.output is not None:
        options.output.mkdir(parents=True, exist_ok=True)
        table.to_csv(options.output / "memory.csv", index=False)


def _in_a_fresh_process(task: Callable[..., Result], *arguments: object) -> Result:
    """Run a task in a new process: its peak memory is its own, and this process stays small.

    Linux lets a child start with the peak of the process that it was forked from.
    """
    with ProcessPoolExecutor(max_workers=1, mp_context=get_context("spawn")) as pool:
        return pool.submit(task, *arguments).result()


def _render(cache: Path) -> None:
    rendered(next(benchmark_sets((SET,))), cache)


def _measure(cache: Path, workers: int) -> dict[str, object]:
    """Track the set; return what it took, and whether memory stayed below the limit."""
    benchmark = next(benchmark_sets((SET,)))
    truth = rendered(benchmark, cache)
    settings = replace(told(benchmark), workers=workers)
    start, cpu = time.perf_counter(), time.process_time()
    result = track(
        [photo.path for photo in truth.photos],
        [photo.pressure_kPa for photo in truth.photos],
        settings=settings,
    )
    megapixels = truth.megapixels * len(truth.photos)
    seconds, cpu_seconds = time.perf_counter() - start, time.process_time() - cpu
    # Linux counts in KiB, macOS in bytes.
    unit = 1.0 if sys.platform == "darwin" else 1024.0
    peak_GB = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit / 1e9
    return {
        "photos at a time": workers,
        "MP a photo": round(truth.megapixels, 1),
        "read": f"{sum(status == 'ok' for status in result.tip_path.status)}/{len(truth.photos)}",
        "peak GB": round(peak_GB, 2),
        "within": "yes" if peak_GB < LIMIT_GB else "no",
        "s/MP": round(seconds / megapixels, 2),
        "CPU s/MP": round(cpu_seconds / megapixels, 2),
    }


if __name__ == "__main__":
    main()
