"""Finding the board in one photograph: pitch, candidates, growth, guided refill."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from .adjustment import Adjustment, Priors
from .arrays import BoolArray, FloatArray, FloatImage, IntArray, shrink, shrunk_place
from .camera import Camera, Pose, project
from .lattice import grow_lattice
from .refill import FIT_CORNERS, Corners, drop_outliers, expected_corners, fit_corners, guided_refill
from .saddle_fit import fit_saddles
from .saddles import find_candidates
from .spectra import LatticeField, fit_field, pitch_votes, tile_spectra

FEWEST_CORNERS = 20
COMFORTABLE_PITCH_PX = 6.5
"""Among scales that show the same lattice, the one with squares of this size or a little more is the best."""

LARGEST_RMS_SQUARES = 0.06
TYPICAL_FOCAL_WIDTHS = 1.2
"""Focal length of a common camera over the photograph's longer side: a start value and a weak prior."""


@dataclass(frozen=True)
class BoardView:
    """The board as one photograph shows it.

    Parameters
    ----------
    indices : int array, shape (n, 2)
        Column and row of each corner in the lattice; column + row is even where the square to the lower
        right is bright. The origin is arbitrary.
    pixels : array, shape (n, 2)
        Sub-pixel positions, px.
    camera, pose
        Camera and pose that fit this photograph alone, for a square of unit length: good for looking up
        where a pixel lies in the lattice, not for distances.
    rms_px : float
        Root mean square distance of the corners from that fit.
    pitch_px : float
        Side of a square in the middle of the board.
    contrast : float
        Half the difference between bright and dark squares, grey levels.
    """

    indices: IntArray
    pixels: FloatArray
    camera: Camera
    pose: Pose
    rms_px: float
    pitch_px: float
    contrast: float


def find_board(gray: FloatImage) -> BoardView | None:
    """Find the checkerboard's lattice, whatever hides its middle or cuts its border; None without a board.

    Parameters
    ----------
    gray : float32 array, shape (height, width)
        Grey levels 0 to 255.
    """
    for factor, small, field in _scales(gray):
        corners = _grow(small, field)
        if corners is None:
            continue
        view = _complete(gray, small, factor, corners)
        if view is not None:
            return view
    return None


def provisional_priors(width: int, height: int) -> Priors:
    """Weak priors for a photograph about whose camera nothing is known."""
    longer = max(width, height)
    focal = TYPICAL_FOCAL_WIDTHS * longer
    camera = Camera(focal, focal, (width - 1) / 2.0, (height - 1) / 2.0, (0.0,) * 5, width, height)
    return Priors(camera, sigma_log_focal=0.4, sigma_centre_px=0.02 * longer, sigma_radial=0.3)


def _scales(gray: FloatImage) -> list[tuple[float, FloatImage, LatticeField]]:
    """Return scales at which a lattice may be seen, the likeliest first: factor, image, lattice field."""
    found = []
    small, factor = gray, 1.0
    while min(small.shape) >= 64:
        tiles = tile_spectra(small)
        for pitch, share in pitch_votes(tiles)[:2]:
            field = fit_field(tiles, pitch)
            if field is not None:
                found.append((share * min(1.0, pitch / COMFORTABLE_PITCH_PX), factor, small, field))
        factor /= 2.0
        small = shrink(small, 0.5)
    found.sort(key=lambda item: -item[0])
    return [(factor, small, field) for _, factor, small, field in found[:5]]


def _grow(small: FloatImage, field: LatticeField) -> Corners | None:
    candidates = find_candidates(small, field)
    if len(candidates.pixels) < FEWEST_CORNERS:
        return None
    typical = (
        np.median(candidates.contrast[candidates.quality > 0.85]) if (candidates.quality > 0.85).any() else 0
    )
    candidates = candidates.take(candidates.contrast > 0.2 * typical)
    rows, indices = grow_lattice(candidates, field)
    if len(rows) < FEWEST_CORNERS:
        return None
    chosen = candidates.take(rows)
    # Colour fixes the origin's parity: even where the square to the lower right is bright.
    odd = np.mean(chosen.parity * (1 - 2 * (indices.sum(axis=1) % 2))) < 0
    middle = np.rint(indices.mean(axis=0)).astype(np.intp)
    shift = middle + np.array([(middle.sum() + odd) % 2, 0])
    return Corners(indices - shift, chosen.pixels, float(np.median(chosen.contrast)))


def _complete(gray: FloatImage, small: FloatImage, factor: float, corners: Corners) -> BoardView | None:
    """Fill the lattice at the small scale, then refine and fit it at full resolution."""
    corners = guided_refill(small, corners, provisional_priors(small.shape[1], small.shape[0]))
    if len(corners.indices) < FEWEST_CORNERS:
        return None
    priors = provisional_priors(gray.shape[1], gray.shape[0])
    if factor < 1.0:
        corners = replace(corners, pixels=shrunk_place(corners.pixels, 1.0 / factor))
        rough = fit_corners(corners, priors, largest=FIT_CORNERS)
        _, vectors = expected_corners(rough.camera, rough.poses[0], corners.indices)
        pixels = fit_saddles(gray, corners.pixels, *vectors)
        seen: BoolArray = np.all(np.isfinite(pixels), axis=1)
        corners = replace(corners, pixels=pixels).take(seen)
    corners, fit = drop_outliers(corners, priors, last=True)
    if fit is None or len(corners.indices) < FEWEST_CORNERS:
        return None
    return _view(corners, fit)


def _view(corners: Corners, fit: Adjustment) -> BoardView | None:
    residual = corners.pixels - project(fit.camera, fit.poses[0], corners.indices.astype(float))
    rms = float(np.sqrt((residual**2).sum(axis=1).mean()))
    pitch = corners.pitch_px()
    if rms > LARGEST_RMS_SQUARES * pitch:
        return None
    return BoardView(corners.indices, corners.pixels, fit.camera, fit.poses[0], rms, pitch, corners.contrast)
