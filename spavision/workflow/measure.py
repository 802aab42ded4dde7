"""From photos and an experiment to a track, and from a track to files."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from spavision.errors import InputError
from spavision.experiment import Experiment
from spavision.results import ResultsFolder
from spavision.table_text import csv_text, number
from spavision.tip_path import FloatArray

from .photo_series import PhotoSeries, photo_series
from .pictures import jpeg
from .progress import progress_bar
from .shapes import measure_shapes

if TYPE_CHECKING:
    from spavision.correlate.report import Picture
    from spavision.vision.arrays import RgbImage
    from spavision.vision.shape import ShapeReading
    from spavision.vision.track import Track


@dataclass(frozen=True)
class Measurement:
    """A track with the photos that it came from, and the shapes in them."""

    track: Track
    series: PhotoSeries
    shapes: tuple[ShapeReading, ...]
    rest_length_mm: float

    @property
    def notes(self) -> tuple[str, ...]:
        """What the user should know of photos, track and shapes, a sentence each."""
        from spavision.vision.shape_series import shape_notes

        of_shapes = shape_notes(self.shapes, expected_length_mm=self.rest_length_mm)
        return (*self.series.notes, *self.track.notes, *of_shapes)

    def record(self) -> dict[str, Any]:
        """Return what ``run.json`` keeps of the measurement."""
        track = self.track
        return {
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
            "notes": list(self.notes),
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


def measure(place: Path, experiment: Experiment, *, results: ResultsFolder, quiet: bool) -> Measurement:
    """Track the photos of a folder, or the frames of a video, which are written to ``results``.

    Raises
    ------
    InputError
        If there is no photo, no readable photo, no board, no marker, or no way to tell the pressures.
    """
    from spavision.vision.track import track

    from .observation_store import ObservationStore

    series = photo_series(place, experiment, results=results)
    done = 0
    with progress_bar("photos", total=len(series.photos), quiet=quiet) as advance:

        def progress(name: str) -> None:
            nonlocal done
            done += 1
            advance(name, done)

        try:
            found = track(
                series.photos,
                series.pressure_kPa,
                settings=series.settings,
                corrections=series.corrections,
                progress=progress,
                memory=ObservationStore(results.unfinished, series.settings),
            )
        except InputError:
            results.forget_unfinished()
            raise
    actuator = experiment.actuator
    shapes = measure_shapes(found, series, actuator, quiet=quiet)
    return Measurement(found, series, shapes, actuator.void_count * actuator.pitch_mm)


def write_measurement(
    results: ResultsFolder, measurement: Measurement, *, show: Callable[[int, RgbImage], None] | None = None
) -> Picture:
    """Write tables (track, budget, shape), overlays and the montage; return the montage.

    Each overlay is handed to ``show`` with its row, so that no photo need be read again.
    """
    from spavision.correlate.report import Picture
    from spavision.vision.overlay import montage, montage_layout, montage_tile, overlay
    from spavision.vision.photos import read_photo
    from spavision.vision.result import budget_table
    from spavision.vision.shape_series import shape_table

    track = measurement.track
    paths = {path.name: path for path in measurement.series.photos}
    largest = measurement.series.settings.largest_megapixels
    results.write_text("track.csv", csv_text(track.tip_path.table()))
    results.write_text("budget.csv", csv_text(budget_table(track)))
    results.write_text("shape.csv", csv_text(shape_table(measurement.shapes, track)))
    tiles = []
    tile_height_px, columns = montage_layout(len(track.readings))
    for row, reading in enumerate(track.readings):
        if not len(reading.corners_px):
            continue
        photo = read_photo(paths[reading.photo], largest_megapixels=largest).rgb
        drawn = overlay(photo, track, row, shape=measurement.shapes[row].shape)
        results.write_bytes(f"overlays/{Path(reading.photo).stem}.jpg", jpeg(drawn))
        tiles.append(montage_tile(photo, track, row, height_px=tile_height_px))
        if show is not None:
            show(row, drawn)
    sheet = jpeg(montage(tiles, columns=columns))
    results.write_bytes("figures/montage.jpg", sheet)
    return Picture(sheet, "image/jpeg", "The photos in order of pressure, the tip marked.")


def save_measurement(results: ResultsFolder, measurement: Measurement, experiment: Experiment) -> None:
    """Write everything that ``spavision track`` writes, the record last."""
    write_measurement(results, measurement)
    results.write_record(
        {"command": "track", "experiment": experiment.model_dump(), "track": measurement.record()}
    )


def _largest(sigma_mm: FloatArray) -> float:
    finite = sigma_mm[np.isfinite(sigma_mm)]
    return float(finite.max()) if len(finite) else float("nan")
