"""Where the marker is in each photograph: the spot chosen over the series, its circle in its plane."""

from __future__ import annotations

import numpy as np

from .arrays import FloatArray
from .camera import project
from .circle import Circle
from .displacement import Place, common_radius_mm, fit_place, rim_in_plane
from .observe import Observation
from .scale import CameraFit
from .selection import select_markers
from .settings import TrackSettings
from .stations import Stations


def find_places(
    observations: list[Observation],
    stations: Stations,
    fit: CameraFit,
    settings: TrackSettings,
    standoff: float,
) -> tuple[list[Place | None], float | None]:
    """Choose the marker in each photograph and fit its circle in its plane."""
    diameter = settings.marker_diameter_mm
    expected = None if diameter is None else 0.5 * diameter / settings.true_square_mm
    spots = [
        np.array([c.place_squares + stations.shift[k] for c in o.candidates]).reshape(-1, 2)
        for k, o in enumerate(observations)
    ]
    chosen = select_markers([o.candidates for o in observations], spots, radius_squares=expected)
    rims: list[FloatArray | None] = []
    for k, (observation, choice) in enumerate(zip(observations, chosen, strict=True)):
        station = int(stations.number[k])
        rims.append(
            None
            if choice is None
            else rim_in_plane(fit, station, observation.candidates[choice].rim_px, standoff)
        )
    radius = common_radius_mm(rims)
    if radius is None and diameter is not None:
        radius = 0.5 * diameter
    places: list[Place | None] = []
    for k, rim in enumerate(rims):
        found = None if rim is None else fit_place(rim, radius)
        places.append(None if found is None else _place(*found, int(stations.number[k]), fit, standoff))
    return places, radius


def _place(circle: Circle, partial: bool, station: int, fit: CameraFit, standoff: float) -> Place:
    point = np.array([[*circle.centre, -standoff]])
    centre_px = project(fit.adjustment.camera, fit.adjustment.poses[station], point)[0]
    return Place(circle, station, centre_px, partial)
