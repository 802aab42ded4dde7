"""From photographs to the tip path: the tracker's main road."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from types import MappingProxyType

import numpy as np

from spavision.quiet_threads import quiet_blas
from spavision.tip_path import TipPath

from .arrays import FloatArray
from .colour import parse_colour
from .corrections import (
    Corrections,
    refuse_outside_pixels,
    refuse_unknown_photos,
    without_corrected_spots,
)
from .evidence import Evidence
from .notes import correction_text, track_notes
from .observe import MarkerLook, Observation, ObservationMemory, observe
from .orientation import set_aside_turned
from .places import Places, find_places
from .readings import budget_of, displacements_mm, reading, statuses
from .result import Track
from .scale import CameraFit, fit_camera
from .settings import TrackSettings
from .stations import Stations, group_stations
from .suitable import refuse_hopeless, set_aside_strangers
from .threads import in_threads

NO_CORRECTIONS: Corrections = MappingProxyType({})


def track(
    paths: Sequence[Path],
    pressures_kPa: Sequence[float] | FloatArray,
    *,
    settings: TrackSettings,
    corrections: Corrections = NO_CORRECTIONS,
    progress: Callable[[str], None] | None = None,
    memory: ObservationMemory | None = None,
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
    corrections : mapping of str to Correction, optional
        What a person says of single photographs, by file name.
    progress : callable, optional
        Called with a photograph's name after it has been measured.
    memory : ObservationMemory, optional
        What an interrupted run has measured already, and where this one's photographs are kept.

    Raises
    ------
    InputError
        If no photograph is readable, none shows a board, none shows a marker, or a correction does not fit.
    """
    refuse_unknown_photos(corrections, [path.name for path in paths])
    observations = observe_photos(paths, settings=settings, progress=progress, memory=memory)
    return track_observations(observations, pressures_kPa, settings=settings, corrections=corrections)


def track_observations(
    observations: Sequence[Observation],
    pressures_kPa: Sequence[float] | FloatArray,
    *,
    settings: TrackSettings,
    corrections: Corrections = NO_CORRECTIONS,
) -> Track:
    """Measure the tip's displacement in photographs that have each been measured on its own.

    The photographs need not be measured again to see what another stand-off or distance would mean.

    Parameters
    ----------
    observations : sequence of Observation
        From `observe_photos`.
    pressures_kPa, settings, corrections
        As in `track`.

    Raises
    ------
    InputError
        As in `track`.
    """
    order = np.argsort(np.asarray(pressures_kPa, dtype=float), kind="stable")
    pressures = np.asarray(pressures_kPa, dtype=float)[order]
    with quiet_blas():
        evidence = _evidence([observations[k] for k in order], settings, corrections)
        return _assemble(pressures, evidence, find_places(evidence))


def _evidence(observations: list[Observation], settings: TrackSettings, corrections: Corrections) -> Evidence:
    """Bring photographs in order of pressure into one lattice, and fit the camera to all of them."""
    refuse_outside_pixels(corrections, observations)
    observations = set_aside_strangers(observations)
    refuse_hopeless(observations, given_by_hand=any(c.pixel is not None for c in corrections.values()))
    observations = without_corrected_spots(corrections, observations)
    observations, origin, stations = _in_one_lattice(observations)
    fit = _fit(observations, origin, stations, settings)
    return Evidence(observations, stations, fit, settings, corrections)


def _in_one_lattice(observations: list[Observation]) -> tuple[list[Observation], int, Stations]:
    """Bring the photographs to the indices of the first that shows the board; set turned ones aside."""
    while True:
        origin = next(k for k, o in enumerate(observations) if o.board is not None)
        stations = group_stations(observations, origin)
        upright = set_aside_turned(observations, stations, origin)
        if [o.problem for o in upright] == [o.problem for o in observations]:
            return observations, origin, stations
        observations = upright


def observe_photos(
    paths: Sequence[Path],
    *,
    settings: TrackSettings,
    progress: Callable[[str], None] | None = None,
    memory: ObservationMemory | None = None,
) -> list[Observation]:
    """Measure board and marker candidates of each photograph on its own, several at a time."""
    tip = _look(settings.marker_colour, settings.marker_diameter_mm, settings)
    base = None
    if settings.base_marker_colour is not None:
        base = _look(settings.base_marker_colour, settings.base_diameter_mm, settings)

    def observed(path: Path) -> Observation:
        found = None if memory is None else memory.recall(path)
        if found is None:
            found = observe(path, tip=tip, base=base, largest_megapixels=settings.largest_megapixels)
            if memory is not None:
                memory.keep(path, found)
        return found

    observations = []
    for observation in in_threads(observed, paths, workers=settings.workers):
        observations.append(observation)
        if progress is not None:
            progress(observation.name)
    return observations


def _look(colour: str, diameter_mm: float | None, settings: TrackSettings) -> MarkerLook:
    squares = None if diameter_mm is None else diameter_mm / settings.true_square_mm
    return MarkerLook(parse_colour(colour), squares)


def _fit(
    observations: list[Observation], origin: int, stations: Stations, settings: TrackSettings
) -> CameraFit:
    focals = [o.focal_px for o in observations if o.focal_px is not None and o.board is not None]
    size = (observations[origin].width, observations[origin].height)
    return fit_camera(stations, settings, size, float(np.median(focals)) if focals else None)


def _assemble(pressures: FloatArray, evidence: Evidence, places: Places) -> Track:
    fit, settings, standoff = evidence.fit, evidence.settings, evidence.standoff_mm
    displacement = displacements_mm(places)
    budget = budget_of(evidence, places)
    status, reason = statuses(evidence, places)
    tip_path = TipPath(
        pressure_kPa=pressures,
        ux_mm=displacement[:, 0],
        uy_mm=displacement[:, 1],
        sigma_ux_mm=np.sqrt(np.sum([entry.sigma_ux_mm**2 for entry in budget], axis=0)),
        sigma_uy_mm=np.sqrt(np.sum([entry.sigma_uy_mm**2 for entry in budget], axis=0)),
        photo=tuple(o.name for o in evidence.observations),
        status=tuple(status),
        reason=tuple(reason),
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
        marker_diameter_mm=None if places.radius_mm is None else 2.0 * places.radius_mm,
        readings=tuple(reading(evidence, places, tip_path, row) for row in range(len(pressures))),
        budget=budget,
        notes=track_notes(evidence, places),
    )
