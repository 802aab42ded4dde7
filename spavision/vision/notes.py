"""What the tracker tells its user in words."""

from __future__ import annotations

from .displacement import Place
from .observe import Observation
from .scale import CameraFit
from .settings import TrackSettings
from .stations import Stations


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


def track_notes(
    observations: list[Observation],
    stations: Stations,
    places: list[Place | None],
    first: int,
    fit: CameraFit,
    settings: TrackSettings,
) -> tuple[str, ...]:
    """Return what the user should know of a track, a sentence each."""
    notes = [correction_text(fit, settings, 1.0 - (settings.standoff_mm or 0.0) / fit.distance_mm)]
    if first > 0:
        notes.append(f"{observations[first].name} is the reference, because no lower pressure has a reading")
    moved = [o.name for o, number in zip(observations, stations.number, strict=True) if number > 0]
    if moved:
        notes.append(
            f"the camera moved against the reference photo in {', '.join(moved)}; this was taken into account"
        )
    unread = sum(place is None for place in places)
    if unread:
        notes.append(f"{unread} of {len(places)} photographs gave no reading")
    return tuple(notes)
