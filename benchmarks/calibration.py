"""Calibration on renders with known truth, and on OpenCV's thirteen photographs where they are at hand.

For each seed a board of 11 by 8 squares is rendered in twelve poses (other tilts, noise and paper each
time), calibrated by both finders, and the deviation of every parameter from the truth is divided by its own
standard deviation. Trustworthy uncertainties give a root mean square near 1 and 95 % within 1.96.

Run: python benchmarks/calibration.py [--seeds 10] [--photos ../shared/data/photos/opencv_left]
"""

from __future__ import annotations

import argparse
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np
from PIL import Image

from spavision.render.render import render_photo
from spavision.render.settings import RenderSettings
from spavision.render.trajectory import sample_trajectory
from spavision.vision.bundle import PARAMETERS, LensModel, parameter_values
from spavision.vision.calibrate import calibrate
from spavision.vision.calibration import CalibrationSettings
from spavision.vision.photos import find_photos

SIZE = (960, 720)
FOCAL_PX = 1100.0
SQUARE_MM = 20.0
CORNERS = (10, 7)
TRUTH = np.array([FOCAL_PX, FOCAL_PX, 487.5, 354.5, -0.2, 0.05, 0.001, -0.0005, 0.0])
POSES = 12
DEFAULT_PHOTOS = Path(__file__).resolve().parents[2] / "shared" / "data" / "photos" / "opencv_left"


def random_settings(seed: int, photo: int) -> RenderSettings:
    """Return one pose: tilted up to 35° about either axis, the board anywhere in the frame."""
    random = np.random.default_rng([seed, photo])
    yaw, pitch = random.uniform(-35, 35, 2).tolist()
    distance = float(random.uniform(380, 480))
    base = RenderSettings(seed=1000 * seed + photo)
    camera = replace(
        base.camera,
        distance_mm=distance,
        square_px=FOCAL_PX * SQUARE_MM / distance,
        yaw_deg=yaw,
        pitch_deg=pitch,
        roll_deg=float(random.uniform(-20, 20)),
        aim_x_mm=float(random.uniform(-80, 80)),
        aim_y_mm=float(random.uniform(-60, 60)),
        cx_offset_px=float(TRUTH[2] - (SIZE[0] - 1) / 2),
        cy_offset_px=float(TRUTH[3] - (SIZE[1] - 1) / 2),
        k1=float(TRUTH[4]),
        k2=float(TRUTH[5]),
        p1=float(TRUTH[6]),
        p2=float(TRUTH[7]),
    )
    return replace(
        base,
        image=replace(base.image, width_px=SIZE[0], height_px=SIZE[1]),
        board=replace(base.board, columns=11, rows=8, square_mm=SQUARE_MM, margin_mm=15.0),
        actuator=replace(base.actuator, visible=False),
        camera=camera,
    )


def render_set(folder: Path, seed: int) -> list[Path]:
    """Render the photographs of one seed."""
    trajectory = sample_trajectory(0.3, np.array([0.0, 5.0]))
    paths = []
    for photo in range(POSES):
        paths.append(folder / f"s{seed}_{photo:02d}.jpg")
        pixels = render_photo(random_settings(seed, photo), trajectory, 0).pixels
        Image.fromarray(pixels).save(paths[-1], quality=92)
    return paths


def report_renders(seeds: int) -> None:
    """Print the pulls of every parameter over the seeds, for both finders."""
    pulls: dict[str, list[np.ndarray]] = {"lattice": [], "opencv": []}
    used = dict.fromkeys(pulls, 0)
    for seed in range(seeds):
        with tempfile.TemporaryDirectory() as folder:
            paths = render_set(Path(folder), seed)
            for finder, collected in pulls.items():
                found = calibrate(paths, CalibrationSettings(CORNERS, SQUARE_MM, finder))
                sigma = np.sqrt(np.diag(found.covariance))
                collected.append((np.array(parameter_values(found.camera)) - TRUTH) / sigma)
                used[finder] += len(found.photos)
    print(f"Renders, {seeds} seeds of {POSES} photos: deviation from the truth over its own sigma, rms")
    print(f"{'finder':<10}{'photos':>8}" + "".join(f"{name:>8}" for name in PARAMETERS) + "   within 1.96")
    for finder, collected in pulls.items():
        values = np.array(collected)
        rms = np.sqrt((values**2).mean(axis=0))
        inside = 100 * (np.abs(values) < 1.96).mean()
        print(
            f"{finder:<10}{used[finder]:>4}/{seeds * POSES:<3}"
            + "".join(f"{value:>8.2f}" for value in rms)
            + f"{inside:>10.0f} %"
        )


def report_real(folder: Path) -> None:
    """Print what both finders give on OpenCV's photographs, aspect ratio fixed."""
    print("\nOpenCV's photographs left01 to left14 (published: fx 535.916 px, rms 0.3926 px)")
    print(f"{'finder':<10}{'fx px':>10}{'sigma':>8}{'rms px':>9}{'corners':>9}")
    for finder in ("opencv", "lattice"):
        settings = CalibrationSettings((9, 6), 25.0, finder, LensModel(fix_aspect_ratio=True))
        found = calibrate(find_photos(folder), settings)
        sigma = float(np.sqrt(found.covariance[0, 0]))
        corners = sum(len(photo.corners.pixels) for photo in found.photos)
        print(f"{finder:<10}{found.camera.fx:>10.2f}{sigma:>8.2f}{found.rms_px:>9.4f}{corners:>9}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--photos", type=Path, default=DEFAULT_PHOTOS)
    arguments = parser.parse_args()
    report_renders(arguments.seeds)
    if arguments.photos.is_dir():
        report_real(arguments.photos)
    else:
        print(f"\nOpenCV's photographs are not at {arguments.photos}; name their folder with --photos")


if __name__ == "__main__":
    main()
