"""One reading a photograph: displacement, uncertainty, status, and everything that was measured in it."""

from __future__ import annotations

import numpy as np

from spavision.tip_path import TipPath

from .arrays import FloatArray
from .budget import BudgetEntry, SetUp, uncertainty_budget
from .camera import project
from .evidence import Evidence
from .places import Places
from .registration import SMALLEST_CERTAINTY
from .result import Reading


def displacements_mm(places: Places) -> FloatArray:
    """Return the displacement of the tip from the reference, less that of the base marker, shape (n, 2)."""
    tip = np.array([[np.nan] * 2 if place is None else place.circle.centre for place in places.tip])
    return tip - tip[places.reference] - base_motion_mm(places)


def base_motion_mm(places: Places) -> FloatArray:
    """Return the base marker's motion since the reference, shape (n, 2): 0 without one, NaN where unseen."""
    if not places.base:
        return np.zeros((len(places.tip), 2))
    base = np.array([[np.nan] * 2 if place is None else place.circle.centre for place in places.base])
    motion: FloatArray = base - base[places.reference]
    return motion


def budget_of(evidence: Evidence, places: Places) -> tuple[BudgetEntry, ...]:
    """Return the uncertainty of each displacement, source by source, the base marker's share at the end."""
    reference = places.tip[places.reference]
    assert reference is not None
    set_up = SetUp(evidence.fit, evidence.settings, evidence.standoff_mm)
    budget = uncertainty_budget(places.tip, reference, set_up)
    if not places.base:
        return budget
    base = places.base[places.reference]
    assert base is not None
    own = uncertainty_budget(places.base, base, set_up)
    unread = np.array([place is None for place in places.tip])
    sigma_ux, sigma_uy = (
        np.where(unread, np.nan, np.sqrt(np.sum([getattr(entry, name) ** 2 for entry in own], axis=0)))
        for name in ("sigma_ux_mm", "sigma_uy_mm")
    )
    basis = "the base marker's motion, which is taken off: all sources above, for it"
    return (*budget, BudgetEntry("base marker", basis, sigma_ux, sigma_uy))


def statuses(evidence: Evidence, places: Places) -> tuple[list[str], list[str]]:
    """Return the status of each photograph, and why it is not ``ok``."""
    found = [_status(evidence, places, photo) for photo in range(len(evidence.observations))]
    return [status for status, _ in found], [reason for _, reason in found]


def _status(evidence: Evidence, places: Places, photo: int) -> tuple[str, str]:
    observation, place = evidence.observations[photo], places.tip[photo]
    correction = evidence.corrections.get(observation.name)
    remark = "" if correction is None else correction.remark
    if correction is not None and correction.pixel is None:
        return "rejected", remark
    if observation.problem:
        return "missing", observation.problem
    if not places.base and evidence.stations.certainty[photo] < SMALLEST_CERTAINTY:
        return "missing", "camera moved, and nothing tells by how many squares: show the board's rim"
    if places.base and places.base[photo] is None:
        return "missing", "base marker not found, so its motion cannot be taken off"
    if place is None:
        return "missing", "no spot looks like the marker" if observation.candidates else "marker not found"
    if place.partial:
        return "partial", f"{100 * place.circle.coverage:.0f} % of the marker's rim is seen"
    base = places.base[photo] if places.base else None
    if base is not None and base.partial:
        return "partial", f"{100 * base.circle.coverage:.0f} % of the base marker's rim is seen"
    return "ok", remark


def reading(evidence: Evidence, places: Places, tip_path: TipPath, row: int) -> Reading:
    """Gather everything measured in one photograph."""
    board, place = evidence.observations[row].board, places.tip[row]
    base = places.base[row] if places.base else None
    empty = np.zeros((0, 2))
    pose, indices, residuals, rms = None, np.zeros((0, 2), dtype=np.intp), empty, np.nan
    if board is not None:
        adjustment, square_mm = evidence.fit.adjustment, evidence.settings.true_square_mm
        pose = adjustment.poses[evidence.station(row)]
        indices = board.indices + evidence.stations.shift[row]
        residuals = board.pixels - project(adjustment.camera, pose, indices * square_mm)
        rms = float(np.sqrt((residuals**2).sum(axis=1).mean()))
    return Reading(
        photo=evidence.observations[row].name,
        pressure_kPa=float(tip_path.pressure_kPa[row]),
        status=tip_path.status[row],
        reason=tip_path.reason[row],
        marker_px=None if place is None else place.centre_px,
        marker_mm=None if place is None else place.circle.centre,
        radius_mm=None if place is None or place.by_hand_sigma_px is not None else place.circle.radius,
        rim_px=empty if place is None else place.rim_px,
        base_px=None if base is None else base.centre_px,
        corners_px=empty if board is None else board.pixels,
        indices=indices,
        residuals_px=residuals,
        rms_px=rms,
        pose=pose,
    )
