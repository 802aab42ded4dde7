"""What the tracker tells its user in words."""

from __future__ import annotations

import numpy as np

from .evidence import Evidence
from .places import Places
from .readings import base_motion_mm
from .scale import CameraFit
from .settings import TrackSettings

UNLIKELY_SIGMAS = 5.0
"""Standard uncertainties by which a given length may be off before it is called in question."""

LARGEST_DIAMETER_ERROR = 0.15
"""Relative error of a marker's size that its soft edge explains."""


def correction_text(fit: CameraFit, settings: TrackSettings, factor: float) -> str:
    """One sentence on the parallax correction."""
    sources = {
        "calibration": "from the calibrated camera",
        "given": "as measured",
        "fit": "from the fit to the tilted board",
        "exif": f"from the EXIF focal length, ±{100 * fit.sigma_distance_mm / fit.distance_mm:.0f} %",
    }
    if settings.standoff_mm is None:
        return "uncorrected: displacements are in the board's plane, because no --standoff-mm was given"
    if fit.source == "none":
        return (
            "uncorrected: displacements are in the board's plane, because the camera's distance is unknown; "
            "give --distance-mm or --camera"
        )
    return (
        f"displacements are in the marker's plane, {settings.standoff_mm:g} mm before the board: readings × "
        f"{factor:.5f}, camera at {fit.distance_mm:.1f} mm ({sources[fit.source]})"
    )


def track_notes(evidence: Evidence, places: Places) -> tuple[str, ...]:
    """Return what the user should know of a track, a sentence each."""
    observations, stations, fit = evidence.observations, evidence.stations, evidence.fit
    factor = 1.0 - evidence.standoff_mm / fit.distance_mm
    notes = [correction_text(fit, evidence.settings, factor)]
    if places.reference > 0:
        name = observations[places.reference].name
        notes.append(f"{name} is the reference, because no lower pressure has a reading")
    rows = zip(observations, stations.number, places.tip, strict=True)
    moved = [o.name for o, number, place in rows if number > 0 and place is not None]
    if moved:
        notes.append(
            f"the camera moved against the reference photo in {', '.join(moved)}; this was taken into account"
        )
    notes += _contradictions(evidence, places)
    notes += _base_marker_note(evidence, places)
    notes += _by_hand_note(evidence)
    unread = sum(place is None for place in places.tip)
    if unread:
        notes.append(f"{unread} of {len(places.tip)} photographs gave no reading")
    return tuple(notes)


def _contradictions(evidence: Evidence, places: Places) -> list[str]:
    """Say where what was given and what is seen exclude each other."""
    fit, settings = evidence.fit, evidence.settings
    notes = []
    given = settings.distance_mm
    if (
        fit.source in ("given", "calibration")
        and given is not None
        and abs(fit.distance_mm - given) > UNLIKELY_SIGMAS * settings.sigma_distance_mm
    ):
        speaks = "the calibrated camera" if fit.source == "calibration" else "the board's perspective"
        notes.append(
            f"{speaks} speaks for a distance of {fit.distance_mm:.0f} mm against the "
            f"{given:g} mm that were given: check the distance, the square size, and that all photos are of "
            "one set-up"
        )
    diameter = settings.marker_diameter_mm
    found = None if places.radius_mm is None else 2.0 * places.radius_mm
    if diameter is not None and found is not None and abs(found / diameter - 1.0) > LARGEST_DIAMETER_ERROR:
        notes.append(
            f"the marker measures {found:.2f} mm against the {diameter:g} mm that were given: "
            "check the marker, the square size and the stand-off"
        )
    return notes


def _base_marker_note(evidence: Evidence, places: Places) -> list[str]:
    if not places.base:
        return []
    motion = base_motion_mm(places)
    motion[[place is None for place in places.tip]] = np.nan
    furthest = int(np.nanargmax(np.linalg.norm(motion, axis=1)))
    x, y = motion[furthest]
    return [
        "the base marker's motion was taken off: "
        f"at most {x:.3f} mm in x and {y:.3f} mm in y, in {evidence.observations[furthest].name}"
    ]


def _by_hand_note(evidence: Evidence) -> list[str]:
    given = [name for name, correction in evidence.corrections.items() if correction.pixel is not None]
    rejected = [name for name, correction in evidence.corrections.items() if correction.pixel is None]
    notes = []
    if given:
        sigma_px = evidence.settings.sigma_by_hand_px
        notes.append(f"the marker was given by hand, ±{sigma_px:g} px, in {', '.join(given)}")
    if rejected:
        notes.append(f"rejected by hand: {', '.join(rejected)}")
    return notes
