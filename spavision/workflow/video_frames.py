"""From a video and its pressure table to photos: the calmest frame of each hold, as files."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np

from spavision.errors import InputError
from spavision.results import ResultsFolder
from spavision.tables import numbers, read_columns
from spavision.tip_path import FloatArray


def frames_of_video(
    video: Path, table: Path | None, results: ResultsFolder
) -> tuple[list[Path], FloatArray, tuple[str, ...]]:
    """Write one frame a pressure hold into the folder ``frames`` of the results.

    Returns
    -------
    photos : list of Path
        The frames, as PNG.
    pressure_kPa : array, shape (frames,)
    notes : tuple of str
        What the user should know of the holds.

    Raises
    ------
    InputError
        If the video or the table cannot be used.
    """
    from spavision.vision.holds import first_holds, pressure_holds
    from spavision.vision.video import hold_frames

    if table is None:
        raise InputError(
            f"{video} is a video, whose pressures come from a table; "
            "give --pressures CSV with the columns time_s, pressure_kPa"
        )
    holds, repeated = first_holds(pressure_holds(*_read_table(table)))
    photos = []
    for frame in hold_frames(video, holds):
        name = f"frames/{video.stem}_{frame.time_s:08.3f}s_{frame.hold.pressure_kPa:07.3f}kPa.png"
        photos.append(results.write_bytes(name, _png(frame.rgb)))
    notes = [f"{video.name}: {len(holds)} holds found in {table.name}, the calmest frame of each was taken"]
    if repeated:
        listed = ", ".join(f"{pressure:g}" for pressure in repeated)
        notes.append(f"{table.name} holds a pressure more than once ({listed} kPa): the first hold was taken")
    return photos, np.array([hold.pressure_kPa for hold in holds]), tuple(notes)


def _read_table(path: Path) -> tuple[FloatArray, FloatArray]:
    columns = read_columns(path)
    for name in ("time_s", "pressure_kPa"):
        if name not in columns:
            raise InputError(f"{path}: column {name} is missing (it has {', '.join(columns)}); add it")
    return numbers(columns, "time_s", path), numbers(columns, "pressure_kPa", path)


def _png(rgb: np.ndarray[tuple[int, ...], np.dtype[np.uint8]]) -> bytes:
    return bytes(cv2.imencode(".png", cv2.cvtColor(rgb, cv2.COLOR_RGB2BGR))[1])
