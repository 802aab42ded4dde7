"""Options that several commands share, and how they lie over the experiment file."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import click
import numpy as np

from spavision.errors import InputError
from spavision.experiment import FILE_NAME, Experiment, read_experiment
from spavision.tip_path import FloatArray

Command = TypeVar("Command", bound=Callable[..., Any])

PHOTO_OPTIONS = {
    "square_mm": ("board", "square_mm"),
    "board_scale": ("board", "scale"),
    "standoff_mm": ("camera", "standoff_mm"),
    "distance_mm": ("camera", "distance_mm"),
    "camera": ("camera", "file"),
    "sigma_standoff_mm": ("camera", "sigma_standoff_mm"),
    "sigma_distance_mm": ("camera", "sigma_distance_mm"),
    "sigma_board_scale": ("board", "sigma_scale"),
    "sigma_out_of_plane_mm": ("marker", "sigma_out_of_plane_mm"),
    "marker_colour": ("marker", "colour"),
    "marker_diameter_mm": ("marker", "diameter_mm"),
    "base_marker_colour": ("marker", "base_colour"),
    "base_marker_diameter_mm": ("marker", "base_diameter_mm"),
    "pressures": ("photos", "table"),
    "pressures_kpa": ("photos", "list_kPa"),
    "pressure_step_kpa": ("photos", "step_kPa"),
    "largest_megapixels": ("photos", "largest_megapixels"),
}
"""Option name to section and key of the experiment file."""

PRESSURE_OPTIONS = {"pressures": "table", "pressures_kpa": "list", "pressure_step_kpa": "step"}
"""Option name to the way of knowing the pressures that it stands for."""

MODEL_OPTIONS = {
    "crimp": ("actuator", "crimp_ratio"),
    "mesh": ("model", "mesh"),
    "control": ("model", "control"),
    "composite": ("composite", "law"),
    "composite_curve": ("composite", "curve"),
}


def results_options(command: Command) -> Command:
    """Add the options of every command that writes a results folder."""
    for option in (
        click.option("--json", "as_json", is_flag=True, help="Print the result as JSON on standard output."),
        click.option(
            "--quiet", "-q", is_flag=True, help="Show no progress and print only the result's place."
        ),
        click.option("--force", is_flag=True, help="Replace the files of an earlier run."),
        click.option(
            "--output",
            "-o",
            type=click.Path(path_type=Path),
            help="Results folder [default: results/<command>-<input>].",
        ),
    ):
        command = option(command)
    return command


def experiment_option(command: Command) -> Command:
    """Add the option that names an experiment file."""
    return click.option(
        "--experiment",
        type=click.Path(path_type=Path),
        help=f"Experiment file [default: {FILE_NAME} beside the photos].",
    )(command)


def _sigma_options() -> list[Callable[[Command], Command]]:
    """Return the options that say how well the set-up is known; the experiment file's defaults are theirs."""
    known = Experiment()
    texts = {
        "--sigma-out-of-plane-mm": (
            "the marker's motion towards the camera",
            known.marker.sigma_out_of_plane_mm,
        ),
        "--sigma-board-scale": ("--board-scale", known.board.sigma_scale),
        "--sigma-distance-mm": ("--distance-mm", known.camera.sigma_distance_mm),
        "--sigma-standoff-mm": ("--standoff-mm", known.camera.sigma_standoff_mm),
    }
    return [
        click.option(name, type=float, help=f"Standard uncertainty of {what} [default: {value:g}].")
        for name, (what, value) in texts.items()
    ]


def photo_options(command: Command) -> Command:
    """Add the options that describe the photographs and the set-up."""
    for option in (
        click.option("--largest-megapixels", type=float, help="Refuse larger photos [default: 200]."),
        *_sigma_options(),
        click.option(
            "--pressure-step-kpa",
            type=float,
            help="Photos in natural order, one every so many kPa from 0; refused where the numbering skips.",
        ),
        click.option(
            "--pressures-kpa",
            type=str,
            help="Photos in natural order: from:to:step or a list; refused unless it fits their number.",
        ),
        click.option(
            "--pressures", type=str, help="CSV with photo, pressure_kPa; for a video time_s, pressure_kPa."
        ),
        click.option("--base-marker-diameter-mm", type=float, help="Its diameter [default: the marker's]."),
        click.option(
            "--base-marker-colour",
            type=str,
            help="Colour of a second marker at the fixed end, whose motion is taken off.",
        ),
        click.option("--marker-diameter-mm", type=float, help="Diameter of the marker."),
        click.option("--marker-colour", type=str, help="Named colour, or #rrggbb sampled from a photo."),
        click.option("--camera", type=str, help="camera.toml of spavision calibrate."),
        click.option("--distance-mm", type=float, help="Camera to board along the board's normal."),
        click.option("--standoff-mm", type=float, help="Marker plane in front of the board."),
        click.option("--board-scale", type=float, help="True over nominal length of 100 squares, by ruler."),
        click.option("--square-mm", type=float, help="Side of one board square."),
    ):
        command = option(command)
    return command


def model_options(command: Command) -> Command:
    """Add the options of the finite-element model."""
    for option in (
        click.option(
            "--composite-curve", type=str, help="Tension test of the composite, for slack-fibre or ogden."
        ),
        click.option(
            "--composite",
            type=str,
            help="slack-fibre, ogden (the article's way) or resolved (a coupon) [default: slack-fibre].",
        ),
        click.option(
            "--control", type=str, help="pressure or volume (passes limit points) [default: pressure]."
        ),
        click.option("--mesh", type=str, help="Mesh level: draft, default or fine."),
        click.option(
            "--crimp", type=float, help="Crimp ratio of the paper (amplitude over wavelength), 0.1 to 0.4."
        ),
    ):
        command = option(command)
    return command


def experiment_for(
    photos: Path | None, named: Path | None, given: dict[str, Any], names: dict[str, tuple[str, str]]
) -> Experiment:
    """Read the experiment file where there is one and lay the options that were given over it.

    Parameters
    ----------
    photos : Path or None
        Folder, or video, beside whose photos the file is looked for.
    named : Path or None
        File asked for by ``--experiment``.
    given : dict
        Option values, None where not given.
    names : dict
        Option name to section and key, such as `PHOTO_OPTIONS`.

    Raises
    ------
    InputError
        If the file or an option is not valid.
    """
    file = experiment_file(photos, named)
    experiment = Experiment() if file is None else read_experiment(file)
    overlay: dict[str, dict[str, Any]] = {}
    for option, (section, key) in names.items():
        if given.get(option) is not None:
            overlay.setdefault(section, {})[key] = given[option]
    ways = [option for option in PRESSURE_OPTIONS if given.get(option) is not None and option in names]
    if len(ways) > 1:
        first, second = (f"--{option.replace('_', '-')}" for option in ways[:2])
        raise InputError(f"{first} and {second} both tell the pressures; give one of them")
    if ways:
        overlay["photos"]["pressures"] = PRESSURE_OPTIONS[ways[0]]
    if ways == ["pressures_kpa"]:
        overlay["photos"]["list_kPa"] = parse_pressures(given["pressures_kpa"]).tolist()
    return experiment.with_options(overlay)


def experiment_file(photos: Path | None, named: Path | None) -> Path | None:
    """Return the experiment file asked for, or the one beside the photos; None where there is none."""
    if named is not None or photos is None:
        return named
    beside = _home(photos) / FILE_NAME
    return beside if beside.is_file() else None


def _home(photos: Path) -> Path:
    """Return the folder of the photos, or the one that a video lies in."""
    return photos.parent if photos.is_file() else photos


def parse_pressures(text: str) -> FloatArray:
    """Read pressures given as ``from:to:step`` or as a list separated by commas, in kPa.

    Raises
    ------
    InputError
        If the text is neither, or the pressures do not increase.
    """
    try:
        if ":" in text:
            start, stop, step = (float(part) for part in text.split(":"))
            if not (
                step > 0 and stop >= start and math.isfinite(stop - start) and (stop - start) / step < 1e4
            ):
                raise ValueError(text)
            values: FloatArray = start + step * np.arange(math.floor((stop - start) / step + 1e-9) + 1.0)
        else:
            values = np.array([float(part) for part in text.split(",")])
    except ValueError as error:
        raise InputError(
            f"--pressures-kpa {text!r}: expected from:to:step such as 0:65:5, or a list such as 0,10,20"
        ) from error
    if not np.all(np.isfinite(values)) or np.any(np.diff(values) <= 0):
        raise InputError(f"--pressures-kpa {text!r}: expected increasing pressures; put them in order")
    return values
