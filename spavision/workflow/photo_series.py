"""What a folder of photos, or a video, and the experiment give the tracker."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from spavision.errors import InputError
from spavision.experiment import Experiment
from spavision.results import ResultsFolder
from spavision.tables import numbers, read_columns
from spavision.tip_path import FloatArray

if TYPE_CHECKING:
    import pandas as pd

    from spavision.vision.corrections import Correction
    from spavision.vision.settings import TrackSettings

CORRECTIONS_NAME = "corrections.csv"


@dataclass(frozen=True)
class PhotoSeries:
    """Photos with their pressures, and everything said of them.

    Parameters
    ----------
    photos : list of Path
        The files.
    pressure_kPa : array, shape (photos,)
    settings : TrackSettings
    corrections : dict of str to Correction
        By file name.
    notes : tuple of str
        What the user should know, a sentence each.
    """

    photos: list[Path]
    pressure_kPa: FloatArray
    settings: TrackSettings
    corrections: dict[str, Correction] = field(default_factory=dict)
    notes: tuple[str, ...] = ()


def photo_series(place: Path, experiment: Experiment, *, results: ResultsFolder) -> PhotoSeries:
    """Collect photos, pressures, corrections and settings.

    Parameters
    ----------
    place : Path
        A folder of photos, or a video, whose frames are then written to ``results`` and become the photos.
    experiment : Experiment
        What is said of the set-up.
    results : ResultsFolder
        Where the frames of a video go, and the digests of all files that are read.

    Raises
    ------
    InputError
        If there is no photo, no way to tell the pressures, or a file beside the photos cannot be used.
    """
    from spavision.vision.photos import find_photos
    from spavision.vision.video import is_video

    from .video_frames import frames_of_video

    beside = _Beside(place.parent if is_video(place) else place, experiment)
    settings, corrections = beside.settings(), beside.corrections()
    if is_video(place):
        photos, pressure_kPa, notes = frames_of_video(place, beside.table(), results)
    else:
        photos, notes = find_photos(place), ()
        pressure_kPa = beside.pressures([path.name for path in photos])
    results.record_inputs([*beside.files(), *([place] if is_video(place) else [])])
    digests = results.record_inputs(photos)
    return PhotoSeries(photos, pressure_kPa, settings, corrections, (*notes, *_twins(photos, digests)))


@dataclass(frozen=True)
class _Beside:
    """The files beside the photos, in the folder ``home`` or where the experiment says."""

    home: Path
    experiment: Experiment

    def table(self) -> Path | None:
        """Return the pressure table."""
        how = self.experiment.photos
        return None if how.pressures != "table" or how.table is None else self._find(how.table)

    def camera(self) -> Path | None:
        """Return the camera file."""
        name = self.experiment.camera.file
        return None if name is None else self._find(name)

    def files(self) -> list[Path]:
        """Return every file that is read apart from the photos."""
        named = [path for path in (self.table(), self.camera()) if path is not None]
        corrections = self.home / CORRECTIONS_NAME
        return [*named, corrections] if corrections.is_file() else named

    def corrections(self) -> dict[str, Correction]:
        """Read the corrections, where there are any."""
        from .corrections_file import read_corrections

        path = self.home / CORRECTIONS_NAME
        return read_corrections(path) if path.exists() else {}

    def pressures(self, names: list[str]) -> FloatArray:
        """Return the pressure of each photo in the way that the experiment says."""
        from spavision.vision import pressures as ways

        how, table = self.experiment.photos, self.table()
        if table is not None:
            return ways.pressures_from_table(_pressure_table(table), names)
        if how.pressures == "list" and how.list_kPa is not None:
            return ways.pressures_from_list(names, how.list_kPa)
        if how.pressures == "step" and how.step_kPa is not None:
            return ways.pressures_from_step(names, how.step_kPa)
        return ways.pressures_from_names(names)

    def settings(self) -> TrackSettings:
        """Return the tracker's settings."""
        from spavision.vision.camera_file import read_camera
        from spavision.vision.settings import TrackSettings

        board, camera, marker = self.experiment.board, self.experiment.camera, self.experiment.marker
        file = self.camera()
        calibrated = None if file is None else read_camera(file)
        return TrackSettings(
            square_mm=board.square_mm,
            board_scale=board.scale,
            standoff_mm=camera.standoff_mm,
            distance_mm=camera.distance_mm,
            camera=None if calibrated is None else calibrated.camera,
            camera_covariance=None if calibrated is None else calibrated.covariance,
            marker_colour=marker.colour,
            marker_diameter_mm=marker.diameter_mm,
            base_marker_colour=marker.base_colour,
            base_marker_diameter_mm=marker.base_diameter_mm,
            sigma_standoff_mm=camera.sigma_standoff_mm,
            sigma_distance_mm=camera.sigma_distance_mm,
            sigma_board_scale=board.sigma_scale,
            sigma_out_of_plane_mm=marker.sigma_out_of_plane_mm,
            largest_megapixels=self.experiment.photos.largest_megapixels,
        )

    def _find(self, name: str) -> Path:
        """Return a file named in an option or beside the photos; the working directory comes first."""
        path = Path(name)
        return path if path.is_file() or path.is_absolute() else self.home / path


def _pressure_table(path: Path) -> pd.DataFrame:
    import pandas as pd

    columns = read_columns(path)
    for column in ("photo", "pressure_kPa"):
        if column not in columns:
            raise InputError(f"{path}: column {column} is missing (it has {', '.join(columns)}); add it")
    pressure_kPa = numbers(columns, "pressure_kPa", path)
    return pd.DataFrame({"photo": columns["photo"], "pressure_kPa": pressure_kPa})


def _twins(photos: list[Path], digests: list[str]) -> list[str]:
    """Say which photos are the same file twice."""
    alike: dict[str, list[str]] = defaultdict(list)
    for path, digest in zip(photos, digests, strict=True):
        alike[digest].append(path.name)
    return [
        f"{' and '.join(names)} are the same file, byte for byte: at most one of their pressures is right"
        for names in alike.values()
        if len(names) > 1
    ]
