"""Accuracy of the actuator's centre line and tip angle on rendered sets that no constant was chosen by.

Run: python benchmarks/tracking/run_shapes.py [SET ...] [--seed N] [--cache FOLDER] [--write]

Rendering takes far longer than measuring: give a cache folder to run again quickly. --write puts the table
into docs/tracking.md.
"""

from __future__ import annotations

import argparse
import json
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from measure import told
from scenes import BenchmarkSet, benchmark_sets
from scipy.interpolate import CubicSpline
from truth import SetTruth, rendered

from spavision.vision.photos import read_photo
from spavision.vision.result import Track
from spavision.vision.shape import ShapeReading, shape_of
from spavision.vision.shape_series import agreeing_shapes
from spavision.vision.track import track

SETS = (
    *("clean", "clean-0.20", "oblique", "distorted", "noisy", "defocused", "small-squares", "low-light"),
    *("hard-shadow", "fringes", "low-contrast", "cable", "cut-left", "together"),
)
UNSEEN_SEED = 5
"""Constants were chosen on sets of seed 1."""

PAGE = Path(__file__).resolve().parents[2] / "docs" / "tracking.md"
BEGIN, END = "<!-- shapes: written by benchmarks/tracking/run_shapes.py -->", "<!-- shapes: end -->"
LINE_LIMIT_MM, ANGLE_LIMIT_DEG = 0.3, 0.5


@dataclass(frozen=True)
class ShapeScore:
    """One set: largest distance from the true line and error of the tip angle, a photo read, with sigmas."""

    photos: int
    line_mm: np.ndarray
    angle_deg: np.ndarray
    sigma_line_mm: np.ndarray
    sigma_angle_deg: np.ndarray
    line_within: np.ndarray

    def row(self, name: str) -> dict[str, object]:
        """One line of the table."""
        read = len(self.line_mm)
        if read == 0:
            return {"set": name, "read": f"0 of {self.photos}"}
        return {
            "set": name,
            "read": f"{read} of {self.photos}",
            "line, median mm": f"{np.median(self.line_mm):.3f}",
            "worst mm": f"{self.line_mm.max():.3f}",
            "stated σ mm": f"{np.median(self.sigma_line_mm):.3f}",
            "tip angle, rms °": f"{np.sqrt(np.mean(self.angle_deg**2)):.2f}",
            "worst °": f"{np.abs(self.angle_deg).max():.2f}",
            "stated σ °": f"{np.median(self.sigma_angle_deg):.2f}",
        }


def main() -> None:
    """Measure the wanted sets and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("sets", nargs="*", default=SETS, help="names of sets")
    parser.add_argument("--seed", type=int, default=UNSEEN_SEED, help="which set of each name")
    parser.add_argument("--cache", type=Path, help="folder to keep the rendered photos in")
    parser.add_argument("--write", action="store_true", help="put the table into docs/tracking.md")
    options = parser.parse_args()
    scores = {}
    with tempfile.TemporaryDirectory() as scratch:
        for benchmark in benchmark_sets(tuple(options.sets), seeds=(options.seed,)):
            scores[benchmark.name] = score(benchmark, rendered(benchmark, options.cache or Path(scratch)))
            print(scores[benchmark.name].row(benchmark.name), flush=True)
    text = _table(scores)
    print(f"\n{text}")
    if options.write:
        before, rest = PAGE.read_text(encoding="utf-8").split(BEGIN)
        page = f"{before}{BEGIN}\n\n{text}\n\n{END}{rest.split(END)[1]}"
        PAGE.write_text(page, encoding="utf-8")


def score(benchmark: BenchmarkSet, truth: SetTruth) -> ShapeScore:
    """Measure the shapes of a set and compare them with the truth."""
    paths = {photo.path.name: photo.path for photo in truth.photos}
    found = track(
        list(paths.values()), [photo.pressure_kPa for photo in truth.photos], settings=told(benchmark)
    )
    width_mm = benchmark.settings.actuator.thickness_mm
    shapes = agreeing_shapes(
        [
            shape_of(read_photo(paths[reading.photo]).rgb, reading, found, body_width_mm=width_mm)
            for reading in found.readings
        ]
    )
    folder = truth.photos[0].path.parent
    records = {photo["photo"]: photo for photo in json.loads((folder / "truth.json").read_text())["photos"]}
    rows = [
        _errors(shape, found, row, records[shape.photo]) for row, shape in enumerate(shapes) if shape.shape
    ]
    line, angle, sigma_line, sigma_angle, within = (np.array([row[k] for row in rows]) for k in range(5))
    return ShapeScore(len(shapes), line, angle, sigma_line, sigma_angle, within)


def _errors(reading: ShapeReading, found: Track, row: int, record: dict) -> tuple[float, ...]:
    """Largest distance and angle error of a photo, their sigmas, share of points within 1.96 sigma."""
    shape, marker = reading.shape, found.readings[row].marker_mm
    # The tracker's origin is an arbitrary corner of the board: both frames are laid on the dot.
    points = shape.points_mm[1:-1] - marker + np.array(record["dot_mm"][:2])
    distance = _distances(points, np.array(record["centre_line_mm"]))
    sigma = shape.sigma_across_mm[1:-1]
    return (
        float(distance.max()),
        shape.tip_angle_deg - record["tip_angle_deg"],
        float(np.median(sigma)),
        shape.sigma_tip_angle_deg,
        float(np.mean(distance < 1.96 * sigma)),
    )


def _distances(points: np.ndarray, true_line: np.ndarray) -> np.ndarray:
    """Distances from the true line, which a spline through its points is: chords would be 0.1 mm off."""
    spline = CubicSpline(np.arange(len(true_line)), true_line)
    line = spline(np.linspace(0, len(true_line) - 1, 100 * len(true_line)))
    start, step = line[:-1], np.diff(line, axis=0)
    share = ((points[:, None] - start) * step).sum(axis=2) / (step**2).sum(axis=1)
    nearest = start + np.clip(share, 0.0, 1.0)[..., None] * step
    return np.linalg.norm(points[:, None] - nearest, axis=2).min(axis=1)


def _table(scores: dict[str, ShapeScore]) -> str:
    rows = [score.row(name) for name, score in scores.items()]
    header = max(rows, key=len)
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    lines += ["| " + " | ".join(str(row.get(name, "–")) for name in header) + " |" for row in rows]
    line, angle, within = (
        np.concatenate([getattr(score, name) for score in scores.values()])
        for name in ("line_mm", "angle_deg", "line_within")
    )
    far, turned = int((line > LINE_LIMIT_MM).sum()), int((np.abs(angle) > ANGLE_LIMIT_DEG).sum())
    summary = (
        f"All {len(line)} shapes: line farther off than {LINE_LIMIT_MM} mm in {far}, tip angle by more than "
        f"{ANGLE_LIMIT_DEG}° in {turned}; {100 * within.mean():.0f} % of the points lie within 1.96 of their "
        "stated σ."
    )
    return "\n".join([*lines, "", summary])


if __name__ == "__main__":
    main()
