"""From photographs to the tip path: the tracker's main road."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

from spavision.errors import InputError
from spavision.tip_path import TipPath

from .arrays import FloatArray
from .colour import parse_colour
from .displacement import Place, uncertainty_budget
from .notes import correction_text, track_notes
from .observe import Observation, observe
from .places import find_places
from .readings import reading, statuses
from .result import Track
from .scale import CameraFit, fit_camera
from .settings import TrackSettings
from .stations import Stations, group_stations
from .suitable import refuse_hopeless, set_aside_strangers


def track(
    paths: Sequence[Path],
    pressures_kPa: Sequence[float] | FloatArray,
    *,
    settings: TrackSettings,
    progress: Callable[[str], None] | None = None,
) -> Track:
    """Measure the tip's displacement in a series of photographs.

    Parameters
    ----------
    paths : sequence of Path
        The photographs.
    pressures_kPa : array, shape (photographs,)
        Pressure in each.
    settings : TrackSettings
        What is known of the set-up.
    progress : callable, optional
        Called with a photograph's name after it has been measured.

    Raises
    ------
    InputError
        If no photograph is readable, none shows a board, or none shows a marker.
    """
    colour = parse_colour(settings.marker_colour)
    order = np.argsort(np.asarray(pressures_kPa, dtype=float), kind="stable")
    pressures = np.asarray(pressures_kPa, dtype=float)[order]
    observations = _observe_all([paths[k] for k in order], colour, settings, progress)
    observations = set_aside_strangers(observations)
    refuse_hopeless(observations)
    origin = next(k for k, observation in enumerate(observations) if observation.board is not None)
    stations = group_stations(observations, origin)
    fit = _fit(observations, origin, stations, settings)
    corrected = settings.standoff_mm is not None and fit.source != "none"
    standoff = settings.standoff_mm if corrected and settings.standoff_mm is not None else 0.0
    places, radius = find_places(observations, stations, fit, settings, standoff)
    return _assemble(pressures, observations, stations, fit, places, radius, settings, standoff)


def _observe_all(
    paths: list[Path],
    colour: tuple[int, int, int],
    settings: TrackSettings,
    progress: Callable[[str], None] | None,
) -> list[Observation]:
    diameter = settings.marker_diameter_mm
    squares = None if diameter is None else diameter / settings.true_square_mm
    workers = settings.workers or os.cpu_count() or 1
    observations = []
    # Nearly all the time is spent in OpenCV and NumPy, which let other threads run meanwhile.
    with ThreadPoolExecutor(max_workers=max(1, min(workers, len(paths)))) as pool:
        for observation in pool.map(
            lambda path: observe(path, colour=colour, diameter_squares=squares), paths
        ):
            observations.append(observation)
            if progress is not None:
                progress(observation.name)
    return observations


def _fit(
    observations: list[Observation], origin: int, stations: Stations, settings: TrackSettings
) -> CameraFit:
    focals = [o.focal_px for o in observations if o.focal_px is not None and o.board is not None]
    size = (observations[origin].width, observations[origin].height)
    return fit_camera(stations, settings, size, float(np.median(focals)) if focals else None)


def _assemble(
    pressures: FloatArray,
    observations: list[Observation],
    stations: Stations,
    fit: CameraFit,
    places: list[Place | None],
    radius: float | None,
    settings: TrackSettings,
    standoff: float,
) -> Track:
    first = next((k for k, place in enumerate(places) if place is not None), None)
    if first is None:
        raise InputError("no marker was found in any photograph that is round enough to be measured")
    reference = places[first]
    assert reference is not None
    status, reason = statuses(observations, stations, places)
    budget = uncertainty_budget(places, reference, fit, settings, standoff)
    sigma_ux = np.sqrt(np.sum([entry.sigma_ux_mm**2 for entry in budget], axis=0))
    sigma_uy = np.sqrt(np.sum([entry.sigma_uy_mm**2 for entry in budget], axis=0))
    centres = np.array([[np.nan] * 2 if p is None else p.circle.centre for p in places])
    displacement = centres - reference.circle.centre
    tip_path = TipPath(
        pressure_kPa=pressures,
        ux_mm=displacement[:, 0],
        uy_mm=displacement[:, 1],
        sigma_ux_mm=sigma_ux,
        sigma_uy_mm=sigma_uy,
        photo=tuple(o.name for o in observations),
        status=tuple(status),
        reason=tuple(reason),
    )
    readings = tuple(
        reading(observation, place, tip_path, row, stations, fit, settings)
        for row, (observation, place) in enumerate(zip(observations, places, strict=True))
    )
    factor = 1.0 - standoff / fit.distance_mm
    return Track(
        tip_path=tip_path,
        camera=fit.adjustment.camera,
        distance_mm=fit.distance_mm,
        sigma_distance_mm=fit.sigma_distance_mm,
        distance_source=fit.source,
        standoff_mm=settings.standoff_mm,
        parallax_factor=factor,
        correction=correction_text(fit, settings, factor),
        square_mm=settings.true_square_mm,
        marker_diameter_mm=None if radius is None else 2.0 * radius,
        readings=readings,
        budget=budget,
        notes=track_notes(observations, stations, places, first, fit, settings),
    )
