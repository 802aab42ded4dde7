"""``spavision calibrate``: photographs of a whole board -> camera.toml."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from spavision.errors import InputError

from .options import results_options

if TYPE_CHECKING:
    from spavision.results import ResultsFolder
    from spavision.vision.calibration import Calibration, CalibrationSettings


@click.command()
@click.argument("photos", type=click.Path(path_type=Path))
@click.option("--corners", type=str, help="Inner corners of the board, such as 9x6 [default: found].")
@click.option("--square-mm", type=float, default=2.5, show_default=True, help="Side of one board square.")
@click.option("--fix-aspect-ratio", is_flag=True, help="Square pixels: fx = fy.")
@click.option(
    "--fix-principal-point", is_flag=True, help="Keep the principal point in the middle of the photo."
)
@click.option("--zero-tangential", is_flag=True, help="Keep p1 = p2 = 0.")
@click.option("--zero-k3", is_flag=True, help="Keep k3 = 0.")
@click.option(
    "--finder",
    type=click.Choice(["auto", "lattice", "opencv"]),
    default="auto",
    show_default=True,
    help="How corners are found: lattice, windows scaled to the squares, boards partly visible too; opencv, "
    "whole boards as in OpenCV's calibration sample with its 11 px window, comparable with calibrations made "
    "by it; auto, opencv where --corners names a sparse board and the photo shows all of it, else lattice.",
)
@click.option(
    "--largest-megapixels", type=float, default=200.0, show_default=True, help="Refuse larger photos."
)
@results_options
def calibrate(photos: Path, **given: Any) -> None:
    """Calibrate a camera from PHOTOS, a folder of 10 to 20 photographs of one flat checkerboard.

    Let the board fill the frame and reach its corners, tilted by 20 to 40° in several directions; do not
    touch zoom or focus between these photos and those of the actuator. Writes camera.toml, which
    `spavision track --camera` takes, and a coverage map.
    """
    from spavision.results import ResultsFolder
    from spavision.vision.calibrate import calibrate as run
    from spavision.vision.photos import find_photos
    from spavision.workflow.progress import progress_bar

    from . import output

    settings = _settings(given)
    name = photos.resolve().name
    results = ResultsFolder(given["output"] or output.default_output("calibrate", name), force=given["force"])
    paths = find_photos(photos)
    done = 0
    with progress_bar("photos", total=len(paths), quiet=given["quiet"]) as advance:

        def progress(photo: str) -> None:
            nonlocal done
            done += 1
            advance(photo, done)

        calibration = run(paths, settings, progress=progress)
    record = _record(calibration)
    _write(results, calibration, settings, record, paths)
    if given["as_json"]:
        output.print_json({**record, "output": str(results.path)})
    else:
        if not given["quiet"]:
            _print(calibration)
        output.print_lines([f"Camera: {results.path / 'camera.toml'}"])


def _settings(given: dict[str, Any]) -> CalibrationSettings:
    from spavision.vision.bundle import LensModel
    from spavision.vision.calibration import CalibrationSettings

    names = ("fix_aspect_ratio", "fix_principal_point", "zero_tangential", "zero_k3")
    return CalibrationSettings(
        corners=None if given["corners"] is None else _corners(given["corners"]),
        square_mm=given["square_mm"],
        finder=given["finder"],
        largest_megapixels=given["largest_megapixels"],
        model=LensModel(**{name: given[name] for name in names}),
    )


def _corners(text: str) -> tuple[int, int]:
    found = re.fullmatch(r"\s*(\d{1,4})\s*[x×X,]\s*(\d{1,4})\s*", text)
    if found is None:
        raise InputError(
            f"--corners {text!r}: expected columns and rows of inner corners, such as 9x6 for a board of "
            "10 by 7 squares"
        )
    return int(found[1]), int(found[2])


def _write(
    results: ResultsFolder,
    calibration: Calibration,
    settings: CalibrationSettings,
    record: dict[str, Any],
    paths: list[Path],
) -> None:
    import dataclasses

    from spavision.vision.camera_file import write_camera
    from spavision.vision.coverage_figure import coverage_figure
    from spavision.workflow.pictures import figure_bytes

    results.write("camera.toml", lambda path: write_camera(path, calibration))
    results.write_bytes("figures/coverage.png", figure_bytes(coverage_figure(calibration), "png"))
    results.record_inputs(paths)
    results.write_record(
        {
            "command": "calibrate",
            "settings": dataclasses.asdict(settings),
            "calibration": record,
        }
    )


def _record(calibration: Calibration) -> dict[str, Any]:
    import numpy as np

    from spavision.vision.bundle import PARAMETERS, parameter_values

    return {
        "width_px": calibration.camera.width,
        "height_px": calibration.camera.height,
        "parameters": dict(zip(PARAMETERS, parameter_values(calibration.camera), strict=True)),
        "sigma": dict(zip(PARAMETERS, np.sqrt(np.diag(calibration.covariance)).tolist(), strict=True)),
        "covariance": calibration.covariance.tolist(),
        "rms_px": calibration.rms_px,
        "sigma_corner_px": calibration.sigma_px,
        "board_corners": list(calibration.board),
        "photos": [
            {
                "photo": photo.photo,
                "corners": len(photo.corners.pixels),
                "rms_px": round(photo.rms_px, 6),
                "tilt_deg": round(float(tilt), 4),
                "distance_mm": round(abs(photo.pose.distance_mm), 4),
            }
            for photo, tilt in zip(calibration.photos, calibration.coverage.tilt_deg, strict=True)
        ],
        "left_out": [{"photo": name, "reason": reason} for name, reason in calibration.left_out],
        "frame_covered": calibration.coverage.share,
        "notes": list(calibration.notes),
    }


def _print(calibration: Calibration) -> None:
    from . import output

    record = _record(calibration)
    photos = [
        [
            each["photo"],
            str(each["corners"]),
            f"{each['rms_px']:.3f}",
            f"{each['tilt_deg']:.1f}",
            f"{each['distance_mm']:.1f}",
            "",
        ]
        for each in record["photos"]
    ]
    photos += [[name, "–", "–", "–", "–", f"left out: {reason}"] for name, reason in calibration.left_out]
    output.print_table("Photos", ["photo", "corners", "rms px", "tilt °", "distance mm", "remark"], photos)
    rows = [
        [name, f"{value:.{2 if name.endswith('_px') else 6}f}", _sigma_text(name, record["sigma"][name])]
        for name, value in record["parameters"].items()
    ]
    output.print_table("Camera", ["parameter", "value", "σ"], rows)
    camera, (columns, lines) = calibration.camera, calibration.board
    summary = (
        f"{camera.width}×{camera.height} px, board of {columns}×{lines} inner corners, "
        f"rms {calibration.rms_px:.4f} px"
    )
    output.print_lines([summary, *calibration.notes])


def _sigma_text(name: str, sigma: float) -> str:
    if sigma == 0:
        return "fixed"
    return f"{sigma:.{2 if name.endswith('_px') else 6}f}"
