"""From photographs to the tip path: the tracker's main road."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import numpy as np

from spavision.errors import InputError
from spavision.tip_path import TipPath

from .arrays import FloatArray
from .camera import project
from .circle import Circle
from .colour import parse_colour
from .displacement import (
    Place,
    common_radius_mm,
    fit_place,
    rim_in_plane,
    uncertainty_budget,
)
from .notes import correction_text, track_notes
from .observe import Observation, observe
from .registration import SMALLEST_CERTAINTY
from .result import Reading, Track
from .scale import CameraFit, fit_camera
from .selection import select_markers
from .settings import TrackSettings
from .stations import Stations, group_stations


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
    observations = _same_size(observations)
    _refuse_hopeless(observations)
    origin = next(k for k, observation in enumerate(observations) if observation.board is not None)
    stations = group_stations(observations, origin)
    fit = _fit(observations, origin, stations, settings)
    corrected = settings.standoff_mm is not None and fit.source != "none"
    standoff = settings.standoff_mm if corrected and settings.standoff_mm is not None else 0.0
    places, radius = _places(observations, stations, fit, settings, standoff)
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


def _same_size(observations: list[Observation]) -> list[Observation]:
    """Set aside photographs whose size differs from that of most: another camera, or turned."""
    sizes = Counter((o.width, o.height) for o in observations if o.board is not None)
    if not sizes:
        return observations
    common = sizes.most_common(1)[0][0]
    return [
        o
        if o.board is None or (o.width, o.height) == common
        else replace(
            o,
            problem=f"{o.name} has {o.width}×{o.height} px, most photos {common[0]}×{common[1]} px",
            board=None,
            candidates=(),
            map=None,
        )
        for o in observations
    ]


def _refuse_hopeless(observations: list[Observation]) -> None:
    if not observations:
        raise InputError("no photograph was given; expected at least one")
    if all(o.width == 0 for o in observations):
        raise InputError(f"no photograph could be read: {observations[0].problem}")
    if all(o.board is None for o in observations):
        raise InputError(
            "no checkerboard was found in any photograph; "
            "the board's squares must measure 7 px or more and be in focus"
        )
    if not any(o.candidates for o in observations):
        raise InputError(
            "no marker was found in any photograph; expected a round spot of the marker's colour "
            "(--marker-colour, --marker-diameter-mm) near the tip"
        )


def _fit(
    observations: list[Observation], origin: int, stations: Stations, settings: TrackSettings
) -> CameraFit:
    focals = [o.focal_px for o in observations if o.focal_px is not None and o.board is not None]
    size = (observations[origin].width, observations[origin].height)
    return fit_camera(stations, settings, size, float(np.median(focals)) if focals else None)


def _places(
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
    status, reason = _statuses(observations, stations, places)
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
        _reading(observation, place, tip_path, row, stations, fit, settings)
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


def _statuses(
    observations: list[Observation], stations: Stations, places: list[Place | None]
) -> tuple[list[str], list[str]]:
    status, reason = [], []
    for k, (observation, place) in enumerate(zip(observations, places, strict=True)):
        if observation.problem:
            status.append("missing")
            reason.append(observation.problem)
        elif place is None:
            status.append("missing")
            reason.append(
                "marker not found" if not observation.candidates else "no spot looks like the marker"
            )
        elif place.partial:
            status.append("partial")
            reason.append(f"{100 * place.circle.coverage:.0f} % of the marker's rim is seen")
        elif stations.certainty[k] < SMALLEST_CERTAINTY:
            status.append("partial")
            reason.append("camera moved and the board's shift is uncertain")
        else:
            status.append("ok")
            reason.append("")
    return status, reason


def _reading(
    observation: Observation,
    place: Place | None,
    tip_path: TipPath,
    row: int,
    stations: Stations,
    fit: CameraFit,
    settings: TrackSettings,
) -> Reading:
    board, empty = observation.board, np.zeros((0, 2))
    pose, indices, residuals, rms = None, np.zeros((0, 2), dtype=np.intp), empty, np.nan
    if board is not None:
        pose = fit.adjustment.poses[int(stations.number[row])]
        indices = board.indices + stations.shift[row]
        expected = project(fit.adjustment.camera, pose, indices * settings.true_square_mm)
        residuals = board.pixels - expected
        rms = float(np.sqrt((residuals**2).sum(axis=1).mean()))
    rim = empty
    if place is not None:
        nearest = min(
            observation.candidates, key=lambda c: float(np.linalg.norm(c.centre_px - place.centre_px))
        )
        rim = nearest.rim_px
    return Reading(
        photo=observation.name,
        pressure_kPa=float(tip_path.pressure_kPa[row]),
        status=tip_path.status[row],
        reason=tip_path.reason[row],
        marker_px=None if place is None else place.centre_px,
        marker_mm=None if place is None else place.circle.centre,
        radius_mm=None if place is None else place.circle.radius,
        rim_px=rim,
        corners_px=empty if board is None else board.pixels,
        indices=indices,
        residuals_px=residuals,
        rms_px=rms,
        pose=pose,
    )
