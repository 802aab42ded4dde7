"""From a folder of photos and an experiment to a track, and from a track to files."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from spavision.errors import InputError
from spavision.experiment import Experiment
from spavision.results import ResultsFolder, sha256
from spavision.tables import numbers, read_columns
from spavision.tip_path import FloatArray

from .output import csv_text, number
from .pictures import jpeg
from .progress import progress_bar

if TYPE_CHECKING:
    from spavision.correlate.report import Picture
    from spavision.vision.settings import TrackSettings
    from spavision.vision.track import Track

REPORT_PHOTO_PX = 900
"""Longest side of the photos in the report: readable, and the page stays small enough to send."""


@dataclass(frozen=True)
class Measurement:
    """A track with the photos and the set-up that it came from."""

    track: Track
    photos: dict[str, Path]
    experiment: Experiment

    def record(self) -> dict[str, Any]:
        """Return what ``run.json`` keeps of the measurement."""
        track = self.track
        return {
            "inputs": sha256(self.photos.values()),
            "camera_distance_mm": track.distance_mm,
            "camera_distance_source": track.distance_source,
            "standoff_mm": track.standoff_mm,
            "parallax_factor": track.parallax_factor,
            "focal_length_px": [track.camera.fx, track.camera.fy],
            "marker_diameter_mm": track.marker_diameter_mm,
            "budget": [
                {
                    "source": entry.name,
                    "basis": entry.basis,
                    "largest_sigma_ux_mm": _largest(entry.sigma_ux_mm),
                    "largest_sigma_uy_mm": _largest(entry.sigma_uy_mm),
                }
                for entry in track.budget
            ],
            "notes": list(track.notes),
        }

    def budget_rows(self) -> list[list[str]]:
        """Return the uncertainty budget as rows of text, the header first."""
        header = ["source", "largest σ x mm", "largest σ y mm", "basis"]
        rows = [
            [
                entry.name,
                number(_largest(entry.sigma_ux_mm), 4),
                number(_largest(entry.sigma_uy_mm), 4),
                entry.basis,
            ]
            for entry in self.track.budget
        ]
        return [header, *rows]


@dataclass(frozen=True)
class DrawnPhotos:
    """Small pictures kept from the overlays for the report: one a pressure, and the montage."""

    by_pressure_kPa: dict[float, Picture]
    montage: Picture


def measure(folder: Path, experiment: Experiment, *, quiet: bool) -> Measurement:
    """Track the photos of a folder.

    Raises
    ------
    InputError
        If there is no photo, no readable photo, no board, no marker, or no way to tell the pressures.
    """
    from spavision.vision.photos import find_photos
    from spavision.vision.track import track

    photos = find_photos(folder)
    pressure_kPa = _pressures([path.name for path in photos], folder, experiment)
    settings = _track_settings(folder, experiment)
    done = 0
    with progress_bar("photos", total=len(photos), quiet=quiet) as advance:

        def progress(name: str) -> None:
            nonlocal done
            done += 1
            advance(name, done)

        found = track(photos, pressure_kPa, settings=settings, progress=progress)
    return Measurement(found, {path.name: path for path in photos}, experiment)


def write_measurement(results: ResultsFolder, measurement: Measurement) -> DrawnPhotos:
    """Write ``track.csv``, one overlay a photo and the montage; return what the report shows of them."""
    from spavision.correlate.report import Picture
    from spavision.vision.overlay import montage, montage_tile, overlay
    from spavision.vision.photos import read_photo

    track = measurement.track
    results.write_text("track.csv", csv_text(track.tip_path.table()))
    tiles, small = [], {}
    for row, reading in enumerate(track.readings):
        if not len(reading.corners_px):
            continue
        photo = read_photo(measurement.photos[reading.photo]).rgb
        drawn = overlay(photo, track, row)
        results.write_bytes(f"overlays/{Path(reading.photo).stem}.jpg", jpeg(drawn))
        tiles.append(montage_tile(photo, track, row))
        small[reading.pressure_kPa] = Picture(
            jpeg(drawn, longest_side_px=REPORT_PHOTO_PX),
            "image/jpeg",
            f"{reading.photo} with what was measured",
        )
    sheet = jpeg(montage(tiles))
    results.write_bytes("figures/montage.jpg", sheet)
    return DrawnPhotos(
        small, Picture(sheet, "image/jpeg", "The photos in order of pressure, the tip marked.")
    )


def _pressures(names: list[str], folder: Path, experiment: Experiment) -> FloatArray:
    from spavision.vision.pressures import pressures_from_names, pressures_from_step, pressures_from_table

    how = experiment.photos
    if how.pressures == "step" and how.step_kPa is not None:
        return pressures_from_step(names, how.step_kPa)
    if how.pressures == "table" and how.table is not None:
        import pandas as pd

        table = _beside(folder, how.table)
        columns = read_columns(table)
        for column in ("photo", "pressure_kPa"):
            if column not in columns:
                raise InputError(f"{table}: column {column} is missing (it has {', '.join(columns)}); add it")
        pressure_kPa = numbers(columns, "pressure_kPa", table)
        frame = pd.DataFrame({"photo": columns["photo"], "pressure_kPa": pressure_kPa})
        return pressures_from_table(frame, names)
    return pressures_from_names(names)


def _track_settings(folder: Path, experiment: Experiment) -> TrackSettings:
    from spavision.vision.camera_file import read_camera
    from spavision.vision.settings import TrackSettings

    file = experiment.camera.file
    return TrackSettings(
        square_mm=experiment.board.square_mm,
        board_scale=experiment.board.scale,
        standoff_mm=experiment.camera.standoff_mm,
        distance_mm=experiment.camera.distance_mm,
        camera=None if file is None else read_camera(_beside(folder, file)).camera,
        marker_colour=experiment.marker.colour,
        marker_diameter_mm=experiment.marker.diameter_mm,
    )


def _beside(folder: Path, name: str) -> Path:
    """Return a file named in an option or beside the photos; the working directory comes first."""
    path = Path(name)
    return path if path.is_file() or path.is_absolute() else folder / path


def _largest(sigma_mm: FloatArray) -> float:
    finite = sigma_mm[np.isfinite(sigma_mm)]
    return float(finite.max()) if len(finite) else float("nan")
