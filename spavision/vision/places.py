"""Where the markers are in each photograph: spots chosen over the series, their circles in their plane."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from spavision.errors import InputError

from .arrays import FloatArray
from .camera import project, to_plane
from .circle import Circle, fit_circle
from .displacement import Place, common_radius_mm, fit_place, rim_in_plane
from .evidence import Evidence
from .marker import Candidate
from .registration import SMALLEST_CERTAINTY
from .selection import BASE_MOTION, TIP_MOTION, Motion, select_markers

Spots = list[tuple[Candidate, ...]]
Choice = list[Candidate | None]


@dataclass(frozen=True)
class Places:
    """The markers in all photographs.

    Parameters
    ----------
    tip : tuple of Place or None
        The marker; None where there is no reading.
    base : tuple of Place or None
        The base marker; empty when there is none in the set-up.
    radius_mm : float or None
        Radius of the marker.
    """

    tip: tuple[Place | None, ...]
    base: tuple[Place | None, ...]
    radius_mm: float | None

    @property
    def reference(self) -> int:
        """The photograph that displacements are relative to: the first with a reading."""
        return next(photo for photo, place in enumerate(self.tip) if place is not None)


def find_places(evidence: Evidence) -> Places:
    """Choose the markers in each photograph and fit their circles in their plane.

    A reading whose base marker is not seen is no reading, for nobody knows how far the clamp had slipped.

    Raises
    ------
    InputError
        If no photograph shows the marker, or the base marker that was said to be there.
    """
    tips, bases = _choose(evidence)
    tip, radius = _fit_all(evidence, tips, evidence.settings.marker_diameter_mm)
    tip = [_by_hand(evidence, photo, place) for photo, place in enumerate(tip)]
    if evidence.settings.base_marker_colour is None:
        # What may be off by whole squares is no reading; two markers would be off by the same.
        certain = evidence.stations.certainty >= SMALLEST_CERTAINTY
        tip = [place if certain[photo] else None for photo, place in enumerate(tip)]
        return Places(tuple(_required(tip)), (), radius)
    base, _ = _fit_all(evidence, bases, evidence.settings.base_diameter_mm)
    if not any(base):
        raise InputError(
            "no base marker was found in any photograph; expected a second round spot at the fixed end "
            "(--base-marker-colour, --base-marker-diameter-mm)"
        )
    tip = [place if base[photo] else None for photo, place in enumerate(tip)]
    if not any(tip):
        raise InputError(
            "no photograph shows both the marker and the base marker; leave out --base-marker-colour "
            "where there is one marker only"
        )
    return Places(tuple(tip), tuple(base), radius)


def _choose(evidence: Evidence) -> tuple[Choice, Choice]:
    """Choose marker and base marker, one spot or none in each photograph.

    The base marker is chosen first, for it hardly moves. Where both look alike and the tip does not move
    either, the one that hangs lower at the lowest pressure is the tip.
    """
    observations = evidence.observations
    tip_spots = [o.candidates for o in observations]
    if evidence.settings.base_marker_colour is None:
        nobody: Choice = [None] * len(observations)
        return _select(evidence, tip_spots, evidence.settings.marker_diameter_mm, TIP_MOTION), nobody
    base_spots = [o.base_candidates for o in observations]
    bases = _select(evidence, base_spots, evidence.settings.base_diameter_mm, BASE_MOTION)
    rest = [_without(spots, base) for spots, base in zip(tip_spots, bases, strict=True)]
    tips = _select(evidence, rest, evidence.settings.marker_diameter_mm, TIP_MOTION)
    alike = all(tip is base for tip, base in zip(tip_spots, base_spots, strict=True))
    both = [(tip, base) for tip, base in zip(tips, bases, strict=True) if tip and base]
    if alike and both and both[0][0].place_squares[1] < both[0][1].place_squares[1]:
        return bases, tips
    return tips, bases


def _select(evidence: Evidence, spots: Spots, diameter_mm: float | None, motion: Motion) -> Choice:
    radius = None if diameter_mm is None else 0.5 * diameter_mm / evidence.settings.true_square_mm
    places = [
        np.array([spot.place_squares + shift for spot in photo]).reshape(-1, 2)
        for photo, shift in zip(spots, evidence.stations.shift, strict=True)
    ]
    chosen = select_markers(spots, places, radius_squares=radius, motion=motion)
    return [None if k is None else photo[k] for photo, k in zip(spots, chosen, strict=True)]


def _without(spots: tuple[Candidate, ...], taken: Candidate | None) -> tuple[Candidate, ...]:
    """Return the spots that do not lie on one that is taken."""
    if taken is None:
        return spots
    return tuple(
        spot
        for spot in spots
        if np.linalg.norm(spot.place_squares - taken.place_squares) > taken.radius_squares
    )


def _fit_all(
    evidence: Evidence, choice: Choice, diameter_mm: float | None
) -> tuple[list[Place | None], float | None]:
    """Fit the circles of one marker; return them and their common radius."""
    rims: list[FloatArray | None] = [
        None
        if spot is None
        else rim_in_plane(evidence.fit, evidence.station(photo), spot.rim_px, evidence.standoff_mm)
        for photo, spot in enumerate(choice)
    ]
    radius = common_radius_mm(rims)
    if radius is None and diameter_mm is not None:
        radius = 0.5 * diameter_mm
    places: list[Place | None] = []
    for photo, (rim, spot) in enumerate(zip(rims, choice, strict=True)):
        found = None if rim is None else fit_place(rim, radius)
        places.append(None if found is None or spot is None else _place(evidence, photo, *found, spot=spot))
    return places, radius


def _place(evidence: Evidence, photo: int, circle: Circle, partial: bool, *, spot: Candidate) -> Place:
    """Place a marker: by the disc fitted to its pixels where it is seen whole, else by its edge points."""
    adjustment, station = evidence.fit.adjustment, evidence.station(photo)
    sigma_px = None
    if spot.disc_px is not None and not partial:
        outline = fit_circle(rim_in_plane(evidence.fit, station, spot.disc_px, evidence.standoff_mm))
        if outline is not None:
            circle, sigma_px = outline, spot.disc_sigma_px
    point = np.array([[*circle.centre, -evidence.standoff_mm]])
    centre_px = project(adjustment.camera, adjustment.poses[station], point)[0]
    return Place(circle, station, centre_px, partial, spot.rim_px, sigma_px)


def _by_hand(evidence: Evidence, photo: int, place: Place | None) -> Place | None:
    """Put a person's pixel in the place of what was found, where there is one and the board is seen."""
    observation = evidence.observations[photo]
    correction = evidence.corrections.get(observation.name)
    if correction is None or correction.pixel is None or observation.board is None:
        return place
    adjustment, station = evidence.fit.adjustment, evidence.station(photo)
    pixel = np.array(correction.pixel)
    centre = to_plane(
        adjustment.camera, adjustment.poses[station], pixel[None], standoff_mm=evidence.standoff_mm
    )[0]
    circle = Circle(centre, np.nan, np.nan, np.zeros((2, 2)), np.zeros(2), np.zeros(0, dtype=bool), 1.0)
    return Place(
        circle,
        station,
        pixel,
        partial=False,
        rim_px=np.zeros((0, 2)),
        by_hand_sigma_px=evidence.settings.sigma_by_hand_px,
    )


def _required(places: list[Place | None]) -> list[Place | None]:
    if not any(places):
        raise InputError("no marker was found in any photograph that is round enough to be measured")
    return places
