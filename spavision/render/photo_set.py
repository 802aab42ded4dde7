"""A whole set of photos as files: the photos, their truth and the experiment file that goes with them."""

from __future__ import annotations

import json
from collections.abc import Iterator

import numpy as np

from .photo_file import ENDINGS, photo_bytes
from .render import render_photo
from .settings import RenderSettings
from .trajectory import Trajectory
from .truth import truth_record


def photo_set(settings: RenderSettings, trajectory: Trajectory) -> Iterator[tuple[str, bytes]]:
    """Render a set, file by file.

    Yields
    ------
    name : str
        ``IMG_0003_015kPa.jpg`` and so on; last ``truth.json`` and ``experiment.toml``.
    content : bytes

    Raises
    ------
    InputError
        If a setting is out of range.
    """
    names, truths = [], []
    for photo in range(len(trajectory)):
        rendered = render_photo(settings, trajectory, photo)
        names.append(photo_name(photo, float(trajectory.pressure_kPa[photo]), settings.image.format))
        truths.append(rendered.truth)
        yield names[-1], photo_bytes(rendered.pixels, settings, photo=photo)
    record = truth_record(settings, names, truths)
    yield "truth.json", (json.dumps(record, indent=1) + "\n").encode()
    yield "experiment.toml", experiment_text(settings).encode()


def photo_name(photo: int, pressure_kPa: float, image_format: str) -> str:
    """Return a photo's file name, with its number and its pressure."""
    whole = float(np.round(pressure_kPa, 6)).is_integer()
    pressure = f"{pressure_kPa:03.0f}" if whole else f"{pressure_kPa:g}"
    return f"IMG_{photo:04d}_{pressure}kPa.{ENDINGS[image_format]}"


def experiment_text(settings: RenderSettings) -> str:
    """Return the experiment file that a laboratory would write beside these photos."""
    marker, actuator, view = settings.marker, settings.actuator, settings.camera
    return f"""\
[board]
square_mm = {settings.board.square_mm}

[camera]
standoff_mm = {actuator.standoff_mm}
distance_mm = {view.distance_mm}

[marker]
colour = "{marker.colour}"
diameter_mm = {marker.diameter_mm}

[photos]
pressures = "names"

[actuator]
crimp_ratio = {actuator.crimp_ratio}
first_bend = "{actuator.first_bend}"
strip_b_mm = {actuator.strip_mm}
"""
