"""One reading a photograph: its status, and everything that was measured in it."""

from __future__ import annotations

import numpy as np

from spavision.tip_path import TipPath

from .camera import project
from .displacement import Place
from .observe import Observation
from .registration import SMALLEST_CERTAINTY
from .result import Reading
from .scale import CameraFit
from .settings import TrackSettings
from .stations import Stations


def statuses(
    observations: list[Observation], stations: Stations, places: list[Place | None]
) -> tuple[list[str], list[str]]:
    """Return the status of each photograph, and why it is not ``ok``."""
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


def reading(
    observation: Observation,
    place: Place | None,
    tip_path: TipPath,
    row: int,
    stations: Stations,
    fit: CameraFit,
    settings: TrackSettings,
) -> Reading:
    """Gather everything measured in one photograph."""
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
