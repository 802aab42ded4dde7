"""Accuracy of the tracker on rendered sets of photographs, beside ready-made chessboard detectors.

Run: python benchmarks/tracking/run.py [SET ...] [--seeds N ...] [--large] [--cache FOLDER] [--output FOLDER]

Rendering takes far longer than tracking: give a cache folder to run again quickly. Tables are saved set by
set; rows of sets that are not run again stay.
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

import numpy as np
from measure import SetScore, measure
from peers import PEERS, measure_peer
from scenes import BenchmarkSet, benchmark_sets
from tables import RESULTS, page, save_rows
from truth import SetTruth, rendered

PEER_PHOTO = 0


def main() -> None:
    """Measure the wanted sets; print both tables and save them as CSV."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("sets", nargs="*", help="names of sets; all if none is given")
    parser.add_argument("--seeds", type=int, nargs="+", default=[1], help="seeds of each set")
    parser.add_argument("--large", action="store_true", help="sets of very large photos too")
    parser.add_argument("--skip", choices=("tracker", "peers"), help="leave one of the two out")
    parser.add_argument("--cache", type=Path, help="folder to keep the rendered photos in")
    parser.add_argument("--output", type=Path, default=RESULTS, help="folder to save the tables in")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        for benchmark in benchmark_sets(tuple(options.sets), seeds=tuple(options.seeds), large=options.large):
            truth = rendered(benchmark, options.cache or Path(scratch))
            if options.skip != "tracker":
                row = _row(benchmark, measure(benchmark, truth))
                print(row, flush=True)
                save_rows(options.output / "tracker.csv", [row])
            if options.skip != "peers":
                save_rows(options.output / "peers.csv", _peer_rows(benchmark, truth))
    print(page(options.output))


def _row(benchmark: BenchmarkSet, result: SetScore) -> dict[str, object]:
    """One line of the tracker's table."""
    errors, limits = result.errors_mm, benchmark.limits
    median, worst = (float(np.median(errors)), float(errors.max())) if len(errors) else (np.nan, np.nan)
    accurate = median <= limits.median_mm and worst <= limits.worst_mm
    sound = not (result.lost or result.falsely_read or result.other_status)
    return {
        "set": benchmark.name,
        "seed": benchmark.seed,
        "read": f"{result.read}/{result.photos}",
        "lost": result.lost,
        "false": result.falsely_read,
        "status": result.other_status,
        "readings": len(errors),
        "median mm": round(median, 4),
        "worst mm": round(worst, 4),
        "within": "yes" if accurate and sound else "no",
        "corners": int(np.mean([corners.number for corners in result.corners])),
        "corner rms px": round(result.corner_rms_px, 3),
        "wrong": sum(corners.wrong for corners in result.corners),
        "z rms": round(float(np.sqrt(np.mean(result.normalised**2))), 2),
        "95 % holds": round(result.coverage, 3),
        "s/MP": round(result.seconds_per_megapixel, 2),
        "CPU s/MP": round(result.cpu_seconds_per_megapixel, 2),
    }


def _peer_rows(benchmark: BenchmarkSet, truth: SetTruth) -> list[dict[str, object]]:
    rows = []
    for name, detector in PEERS.items():
        corners, seconds = measure_peer(detector, benchmark, truth, PEER_PHOTO)
        row = {
            "set": benchmark.name,
            "seed": benchmark.seed,
            "detector": name,
            "corners": corners.number,
            "right": len(corners.errors_px),
            "square error px2": round(float((corners.errors_px**2).sum()), 3),
            "wrong": corners.wrong,
            "s/MP": round(seconds, 2),
        }
        rows.append(row)
    return rows


if __name__ == "__main__":
    main()
