"""Accuracy of the tracker on rendered sets of photographs, beside ready-made chessboard detectors.

Run: python benchmarks/tracking/run.py [SET ...] [--seeds N ...] [--large] [--cache FOLDER] [--output FOLDER]

Rendering takes far longer than tracking: give a cache folder to run again quickly. calib-targets takes part
where it is installed.
"""

from __future__ import annotations

import argparse
import importlib.util
import tempfile
from pathlib import Path

import numpy as np
import pandas as pd
from measure import SetScore, measure
from peers import PEERS, measure_peer
from scenes import BenchmarkSet, benchmark_sets
from truth import rendered

PEER_PHOTO = 0


def main() -> None:
    """Measure the wanted sets; print both tables and save them as CSV."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("sets", nargs="*", help="names of sets; all if none is given")
    parser.add_argument("--seeds", type=int, nargs="+", default=[1], help="seeds of each set")
    parser.add_argument("--large", action="store_true", help="sets of very large photos too")
    parser.add_argument("--no-peers", action="store_true", help="leave out the other detectors")
    parser.add_argument("--cache", type=Path, help="folder to keep the rendered photos in")
    parser.add_argument("--output", type=Path, help="folder to save the tables in")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        cache = options.cache or Path(scratch)
        tracker, peers = [], []
        for benchmark in benchmark_sets(tuple(options.sets), seeds=tuple(options.seeds), large=options.large):
            truth = rendered(benchmark, cache)
            result = measure(benchmark, truth)
            tracker.append((benchmark, result))
            print(_row(benchmark, result), flush=True)
            if not options.no_peers:
                peers += _peer_rows(benchmark, truth)
    tables = {"tracker": pd.DataFrame([_row(*item) for item in tracker])}
    if peers:
        tables["peers"] = _summary(pd.DataFrame(peers))
    for name, table in tables.items():
        print(f"\n{name}\n{_markdown(table)}")
        if options.output is not None:
            options.output.mkdir(parents=True, exist_ok=True)
            table.to_csv(options.output / f"{name}.csv", index=False)
    print(f"\n{_overall([result for _, result in tracker])}")


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


def _peer_rows(benchmark: BenchmarkSet, truth) -> list[dict[str, object]]:
    rows = []
    for name, detector in PEERS.items():
        if name == "calib-targets" and importlib.util.find_spec("calib_targets") is None:
            continue
        corners, seconds = measure_peer(detector, benchmark, truth, PEER_PHOTO)
        square_error = float((corners.errors_px**2).sum())
        rows.append(
            {
                "detector": name,
                "corners": corners.number,
                "right": len(corners.errors_px),
                "square error": square_error,
                "wrong": corners.wrong,
                "s/MP": seconds,
            }
        )
    return rows


def _summary(rows: pd.DataFrame) -> pd.DataFrame:
    """One line a detector over all sets: share of photos read, corners, rms, wrong ones, time."""
    lines = []
    for name, group in rows.groupby("detector", sort=False):
        rms = np.sqrt(group["square error"].sum() / max(group["right"].sum(), 1))
        lines.append(
            {
                "detector": name,
                "photos read": f"{int((group['corners'] > 0).sum())}/{len(group)}",
                "corners a photo": int(group["corners"].mean()),
                "corner rms px": round(float(rms), 3) if group["right"].sum() else np.nan,
                "wrong": int(group["wrong"].sum()),
                "s/MP": round(float(group["s/MP"].mean()), 2),
            }
        )
    return pd.DataFrame(lines)


def _overall(results: list[SetScore]) -> str:
    normalised = np.concatenate([result.normalised for result in results])
    errors = np.concatenate([result.errors_mm for result in results])
    return (
        f"all sets: {len(errors)} readings, median {np.median(errors):.4f} mm, worst {errors.max():.4f} mm; "
        f"the 95 % interval holds the truth in {100 * np.mean(np.abs(normalised) < 1.96):.1f} %"
    )


def _markdown(table: pd.DataFrame) -> str:
    lines = ["| " + " | ".join(map(str, table.columns)) + " |", "|" + "---|" * len(table.columns)]
    lines += ["| " + " | ".join(map(str, row)) + " |" for row in table.itertuples(index=False)]
    return "\n".join(lines)


if __name__ == "__main__":
    main()
