"""The actuator's shape in each photo of a track: reads the photos, leaves the measuring to vision."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from spavision.experiment import ActuatorSection

from .photo_series import PhotoSeries
from .progress import progress_bar

if TYPE_CHECKING:
    from spavision.vision.shape import ShapeReading
    from spavision.vision.track import Track


def measure_shapes(
    track: Track, series: PhotoSeries, actuator: ActuatorSection, *, quiet: bool
) -> tuple[ShapeReading, ...]:
    """Measure the shape in every photo of a track, in order; one that contradicts the rest is left out."""
    from spavision.vision.photos import read_photo
    from spavision.vision.result import Reading
    from spavision.vision.shape import NO_BOARD, ShapeReading, shape_of
    from spavision.vision.shape_series import agreeing_shapes
    from spavision.vision.threads import in_threads

    paths: dict[str, Path] = {path.name: path for path in series.photos}

    def measured(reading: Reading) -> ShapeReading:
        if reading.pose is None:
            return ShapeReading(reading.photo, reading.pressure_kPa, None, NO_BOARD)
        photo = read_photo(paths[reading.photo], largest_megapixels=series.settings.largest_megapixels)
        return shape_of(photo.rgb, reading, track, body_width_mm=actuator.width_mm)

    shapes = []
    with progress_bar("shapes", total=len(track.readings), quiet=quiet) as advance:
        for shape in in_threads(measured, track.readings, workers=series.settings.workers):
            shapes.append(shape)
            advance(shape.photo, len(shapes))
    return agreeing_shapes(shapes)
