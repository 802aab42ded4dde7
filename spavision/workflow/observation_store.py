"""What was measured in single photos, kept while a run lasts, so that an interrupted one can be taken up."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import os
import zipfile
from pathlib import Path
from typing import Any

import numpy as np

from spavision import __version__
from spavision.results import sha256
from spavision.vision.board import BoardView
from spavision.vision.camera import Camera, Pose
from spavision.vision.marker import Candidate
from spavision.vision.observe import BoardMap, Observation
from spavision.vision.settings import TrackSettings

KEPT = {kind.__name__: kind for kind in (Observation, BoardView, BoardMap, Candidate, Camera, Pose)}
"""What a file may hold beside numbers, texts and arrays."""


class ObservationStore:
    """Files of observations, one a photo, in a folder of their own.

    A file counts only for the same photo, byte for byte, the same version of the program and settings.

    Parameters
    ----------
    folder : Path
        The folder; made when the first observation is kept.
    settings : TrackSettings
        Settings of the run.
    """

    def __init__(self, folder: Path, settings: TrackSettings) -> None:
        self.folder = folder
        looked_for = (
            settings.marker_colour,
            settings.marker_diameter_mm,
            settings.base_marker_colour,
            settings.base_diameter_mm,
            settings.true_square_mm,
        )
        self._settings = f"{__version__} {looked_for!r}"

    def recall(self, photo: Path) -> Observation | None:
        """Return what is kept of a photo; None where there is nothing, or nothing whole."""
        try:
            with np.load(self._file(photo), allow_pickle=False) as content:
                observation = _decoded(json.loads(str(content["text"])), content)
        except (OSError, ValueError, KeyError, TypeError, zipfile.BadZipFile):
            return None
        return observation if isinstance(observation, Observation) else None

    def keep(self, photo: Path, observation: Observation) -> None:
        """Keep an observation in which a board was found: the others are quickly made again."""
        if observation.board is None:
            return
        arrays: dict[str, Any] = {}
        text = json.dumps(_encoded(observation, arrays))
        file = self._file(photo)
        self.folder.mkdir(parents=True, exist_ok=True)
        partial = file.with_name(f".partial-{os.getpid()}-{file.name}")
        np.savez(partial, text=np.array(text), **arrays)
        partial.replace(file)

    def _file(self, photo: Path) -> Path:
        key = f"{self._settings} {photo.name} {sha256(photo)}"
        return self.folder / f"{hashlib.sha256(key.encode()).hexdigest()[:32]}.npz"


def _encoded(value: Any, arrays: dict[str, Any]) -> Any:
    """Return a value as JSON takes it, its arrays put aside under numbered names."""
    if dataclasses.is_dataclass(value):
        fields = {f.name: _encoded(getattr(value, f.name), arrays) for f in dataclasses.fields(value)}
        return {"kind": type(value).__name__, "fields": fields}
    if isinstance(value, np.ndarray):
        name = f"array{len(arrays)}"
        arrays[name] = value
        return {"array": name}
    if isinstance(value, tuple):
        return {"tuple": [_encoded(each, arrays) for each in value]}
    return value.item() if isinstance(value, np.generic) else value


def _decoded(value: Any, arrays: Any) -> Any:
    if not isinstance(value, dict):
        return value
    if "array" in value:
        return arrays[value["array"]]
    if "tuple" in value:
        return tuple(_decoded(each, arrays) for each in value["tuple"])
    return KEPT[value["kind"]](**{name: _decoded(each, arrays) for name, each in value["fields"].items()})
