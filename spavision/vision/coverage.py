"""How well calibration photographs cover the frame and the tilts, and what is missing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .arrays import FloatArray, IntArray
from .camera import Camera, Pose

CELLS_ALONG = 8
CELLS_ACROSS = 6
"""Cells of the coverage map along the longer and the shorter side of the frame."""

LEAST_SHARE = 0.6
LARGEST_GAP = 0.35
TILTED_DEG = 15.0
LEAST_TILTED = 4
LEAST_SPREAD_DEG = 8.0

FRAME_CORNERS = {"upper left": (0, 0), "upper right": (1, 0), "lower left": (0, 1), "lower right": (1, 1)}


@dataclass(frozen=True)
class Coverage:
    """Where in the frame corners were seen, and how the board was tilted.

    Parameters
    ----------
    counts : int array, shape (rows, columns)
        Corners in each cell of the frame.
    gap : dict
        For each corner of the frame, how far the nearest corner of a board is, over half the diagonal.
    tilt_deg : array, shape (photographs,)
        Angle between the optical axis and the board's normal.
    slope_deg : array, shape (photographs, 2)
        That angle's parts to the right and down: the direction in which the board falls away.
    """

    counts: IntArray
    gap: dict[str, float]
    tilt_deg: FloatArray
    slope_deg: FloatArray

    @property
    def share(self) -> float:
        """Share of the cells that hold a corner."""
        return float((self.counts > 0).mean())

    @property
    def spread_deg(self) -> float:
        """Scatter of the tilts (one standard deviation) about the axis that they scatter least about."""
        if len(self.slope_deg) < 2:
            return 0.0
        return float(np.sqrt(max(np.linalg.eigvalsh(np.cov(self.slope_deg.T))[0], 0.0)))


def cover(camera: Camera, pixels: Sequence[FloatArray], poses: Sequence[Pose]) -> Coverage:
    """Count corners in the cells of the frame and collect the board's tilts.

    Parameters
    ----------
    camera : Camera
        Gives the size of the frame.
    pixels : sequence of array, shape (n, 2)
        Corners of each photograph.
    poses : sequence of Pose
        The board before the camera in each.
    """
    size = np.array([camera.width, camera.height], dtype=float)
    cells = (CELLS_ALONG, CELLS_ACROSS) if camera.width >= camera.height else (CELLS_ACROSS, CELLS_ALONG)
    places = (np.concatenate(list(pixels)) + 0.5) / size
    column, row = np.clip((places * cells).astype(np.intp), 0, np.array(cells) - 1).T
    counts = np.zeros(cells[::-1], dtype=np.intp)
    np.add.at(counts, (row, column), 1)
    gap = {
        name: float(np.linalg.norm((places - corner) * size, axis=1).min() / (0.5 * np.linalg.norm(size)))
        for name, corner in FRAME_CORNERS.items()
    }
    normals = np.array([pose.matrix[:, 2] for pose in poses])
    normals *= np.where(normals[:, 2:] < 0, -1.0, 1.0)
    tilt = np.degrees(np.arccos(np.clip(normals[:, 2], -1.0, 1.0)))
    flat = np.linalg.norm(normals[:, :2], axis=1, keepdims=True)
    slope = tilt[:, None] * normals[:, :2] / np.maximum(flat, 1e-12)
    return Coverage(counts, gap, tilt, slope)


def coverage_notes(coverage: Coverage) -> tuple[str, ...]:
    """Return what further photographs are needed, a sentence each; none when the set is good."""
    notes = []
    far = [name for name, gap in coverage.gap.items() if gap > LARGEST_GAP]
    if far:
        notes.append(
            f"poor coverage: no corner near the {_joined(far)} corner of the frame, where the distortion "
            "is a guess; add photos with the board there"
        )
    if coverage.share < LEAST_SHARE:
        notes.append(
            f"poor coverage: corners in {100 * coverage.share:.0f} % of the frame's cells, "
            f"{100 * LEAST_SHARE:.0f} % or more is better; let the board fill the frame"
        )
    tilted = int((coverage.tilt_deg >= TILTED_DEG).sum())
    if tilted < LEAST_TILTED:
        notes.append(
            f"too few tilts: the board is tilted by {TILTED_DEG:.0f}° or more in {tilted} of "
            f"{len(coverage.tilt_deg)} photos, {LEAST_TILTED} or more are needed to tell focal length from "
            "distance; add photos tilted by 20 to 40°"
        )
    elif coverage.spread_deg < LEAST_SPREAD_DEG:
        notes.append(
            "too few tilts: the board is tilted about one axis only; add photos tilted about the other"
        )
    return tuple(notes)


def _joined(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"
