"""What the photographs say together, before the marker is placed in them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from .corrections import Corrections
from .observe import Observation
from .scale import CameraFit
from .settings import TrackSettings
from .stations import Stations


@dataclass(frozen=True)
class Evidence:
    """Photographs in one index system, their camera, and what people say of the set-up.

    Parameters
    ----------
    observations : sequence of Observation
        One a photograph, in order of pressure.
    stations : Stations
        Their camera positions.
    fit : CameraFit
        Their camera.
    settings : TrackSettings
        What the user knows.
    corrections : mapping of str to Correction
        What a person said of single photographs.
    """

    observations: Sequence[Observation]
    stations: Stations
    fit: CameraFit
    settings: TrackSettings
    corrections: Corrections

    @property
    def standoff_mm(self) -> float:
        """Distance from the board of the plane that displacements are measured in; 0 where uncorrected."""
        given = self.settings.standoff_mm
        return 0.0 if given is None or self.fit.source == "none" else given

    def station(self, photo: int) -> int:
        """Return the camera position of a photograph."""
        return int(self.stations.number[photo])
