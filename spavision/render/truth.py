"""What ``truth.json`` says of a set of photos."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import Any

from .render import PhotoTruth
from .settings import RenderSettings

FRAME = (
    "millimetres in the board's frame: origin in the middle of the board, x to the right, y down, z towards "
    "the camera; a point enters the camera's frame (x right, y down, z forwards) as "
    "rotation @ (x, y, -z) + translation"
)
PLANE = (
    "displacement_mm is the motion of the dot's centre in the plane of the side face, parallel to the board "
    "at the stand-off, relative to the first photo; it is not a reading in the plane of the board"
)


def truth_record(
    settings: RenderSettings, names: Sequence[str], truths: Sequence[PhotoTruth]
) -> dict[str, Any]:
    """Return the truth of a set as plain numbers and texts, ready for JSON."""
    camera = truths[0].camera
    board = settings.board
    return {
        "about": "Photographs rendered by spavision; this is what is really in them.",
        "frame": FRAME,
        "plane": PLANE,
        "standoff_mm": settings.actuator.standoff_mm,
        "camera_matrix_px": camera.matrix.tolist(),
        "distortion_k1_k2_p1_p2_k3": camera.distortion.tolist(),
        "board": {
            "square_mm": board.square_mm,
            "columns": board.columns,
            "rows": board.rows,
            "corners": "inner corner (i, j) lies at x = (i - columns/2) square_mm, "
            "y = (j - rows/2) square_mm, i = 1 .. columns-1, j = 1 .. rows-1",
        },
        "photos": [_photo_record(name, truth, truths[0]) for name, truth in zip(names, truths, strict=True)],
        "settings": dataclasses.asdict(settings),
    }


def _photo_record(name: str, truth: PhotoTruth, first: PhotoTruth) -> dict[str, Any]:
    move = truth.dot_mm - first.dot_mm
    record: dict[str, Any] = {
        "photo": name,
        "pressure_kPa": truth.pressure_kPa,
        "rotation": truth.camera.rotation.tolist(),
        "translation_mm": truth.camera.translation_mm.tolist(),
        "dot_mm": truth.dot_mm.tolist(),
        "dot_px": truth.dot_px.tolist(),
        "dot_hidden_share": truth.hidden,
        "displacement_mm": move[:2].tolist(),
        "out_of_plane_mm": float(move[2]),
        "centre_line_mm": truth.line.points_mm[::8].round(5).tolist(),
        "tip_angle_deg": truth.line.tip_angle_deg,
    }
    if truth.base_dot_mm is not None and truth.base_dot_px is not None:
        record["base_dot_mm"] = truth.base_dot_mm.tolist()
        record["base_dot_px"] = truth.base_dot_px.tolist()
    return record
