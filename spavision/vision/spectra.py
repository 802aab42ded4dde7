"""Square pitch and lattice directions from local spectra, before any corner is known."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.fft import fft2, fftshift

from .arrays import BoolArray, FloatArray, FloatImage, IntArray

TILE_PX = 64
LOWEST_CYCLES = 2.6
"""Cycles across a tile below which a peak is shading, not squares."""

PITCH_RANGE_PX = (4.2, 15.5)
"""Pitches a tile can tell: from the sampling limit to about four squares a tile."""


@dataclass(frozen=True)
class LatticeField:
    """Local lattice vectors as linear functions of position.

    Parameters
    ----------
    coefficients : array, shape (3, 4)
        (1, x, y) @ coefficients gives a1x, a1y, a2x, a2y in px: one step along the lattice's first (to
        the right) and second (down) direction.
    centre_px, scale_px : array of shape (2,), float
        Positions are centred and scaled by these before they enter.
    """

    coefficients: FloatArray
    centre_px: FloatArray
    scale_px: float

    def vectors(self, points_px: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return both lattice vectors at the given points, each of shape (n, 2), px."""
        local = (np.asarray(points_px, dtype=float) - self.centre_px) / self.scale_px
        values = np.column_stack([np.ones(len(local)), local]) @ self.coefficients
        return values[:, :2], values[:, 2:]

    @property
    def pitch_px(self) -> float:
        """Pitch at the field's centre."""
        a1x, a1y, a2x, a2y = self.coefficients[0]
        return float(np.sqrt(abs(a1x * a2y - a1y * a2x)))


@dataclass(frozen=True)
class TileSpectra:
    """What each tile of one image says: centre (n, 2), lattice vectors (n, 4), trust between 0 and 1 (n,)."""

    centre_px: FloatArray
    vectors_px: FloatArray
    trust: FloatArray

    @property
    def pitch_px(self) -> FloatArray:
        """Square root of the area of a lattice cell, shape (n,)."""
        v = self.vectors_px
        return np.sqrt(np.abs(v[:, 0] * v[:, 3] - v[:, 1] * v[:, 2]))


def tile_spectra(gray: FloatImage, *, largest_number: int = 400) -> TileSpectra:
    """Find the two strongest crossing gratings in each tile and turn them into lattice vectors.

    A checkerboard of pitch p is, to first order, two gratings along its diagonals with
    wave vectors f1, f2 of length 1/(√2 p); one step along either lattice direction is half a wave of both.

    Parameters
    ----------
    gray : float32 array, shape (height, width)
        The photograph at a scale where squares measure within `PITCH_RANGE_PX`.
    largest_number : int
        Tiles are spread more thinly when the image would give more than this number.
    """
    corners = _tile_corners(gray.shape, largest_number)
    if len(corners) == 0:
        return TileSpectra(np.zeros((0, 2)), np.zeros((0, 4)), np.zeros(0))
    windows = np.lib.stride_tricks.sliding_window_view(gray, (TILE_PX, TILE_PX))
    tiles = windows[corners[:, 1], corners[:, 0]]
    hann = np.hanning(TILE_PX + 2)[1:-1].astype(np.float32)
    tiles = (tiles - tiles.mean(axis=(1, 2), keepdims=True)) * np.outer(hann, hann)
    power = np.abs(fft2(tiles)) ** 2
    first, second, share = _two_gratings(fftshift(power, axes=(1, 2)))
    vectors, sane = _lattice_vectors(first / TILE_PX, second / TILE_PX)
    trust = np.where(sane, share, 0.0)
    return TileSpectra(corners.astype(float) + (TILE_PX - 1) / 2.0, vectors, trust)


def fit_field(tiles: TileSpectra, pitch_px: float) -> LatticeField | None:
    """Fit lattice vectors to the tiles that agree with ``pitch_px`` within a third; None if too few do."""
    agree = (np.abs(np.log(np.maximum(tiles.pitch_px, 1e-3) / pitch_px)) < 0.35) & (tiles.trust > 0.15)
    if agree.sum() < 2:
        return None
    centres, vectors, trust = tiles.centre_px[agree], tiles.vectors_px[agree], tiles.trust[agree]
    middle, scale = centres.mean(axis=0), max(float(np.ptp(centres, axis=0).max()), TILE_PX) / 2.0
    local = (centres - middle) / scale
    design = np.column_stack([np.ones(len(local)), local])
    weights = trust.copy()
    coefficients = np.zeros((3, 4))
    # Weak shrinking towards a constant field: a handful of tiles cannot tell a gradient.
    shrink = np.diag([1e-9, 0.3, 0.3])
    for _ in range(8):
        normal = design.T @ (weights[:, None] * design) + shrink
        coefficients = np.linalg.solve(normal, design.T @ (weights[:, None] * vectors))
        error = np.linalg.norm(vectors - design @ coefficients, axis=1) / pitch_px
        weights = trust / (1.0 + (error / 0.08) ** 2) ** 2
    return LatticeField(coefficients, middle, scale)


def pitch_votes(tiles: TileSpectra) -> list[tuple[float, float]]:
    """Return candidate pitches of one image, px, each with the share of tiles behind it, heaviest first."""
    usable = (tiles.trust > 0.2) & (tiles.pitch_px < PITCH_RANGE_PX[1] - 1.0)
    logs, weights = np.log(tiles.pitch_px[usable]), tiles.trust[usable] ** 2
    votes: list[tuple[float, float]] = []
    while len(logs) and len(votes) < 3:
        near = np.abs(logs[:, None] - logs[None, :]) < 0.15
        support = near @ weights
        best = int(np.argmax(support))
        members = near[best]
        votes.append(
            (
                float(np.exp(np.average(logs[members], weights=weights[members]))),
                float(support[best]) / len(tiles.trust),
            )
        )
        far = np.abs(logs - logs[best]) > 0.35
        logs, weights = logs[far], weights[far]
    return votes


def _tile_corners(shape: tuple[int, int], largest_number: int) -> IntArray:
    height, width = shape
    if min(height, width) < TILE_PX:
        return np.zeros((0, 2), dtype=np.intp)
    step = TILE_PX // 2
    step = max(step, int(np.sqrt(height * width / largest_number)))
    columns = np.unique(np.append(np.arange(0, width - TILE_PX + 1, step), width - TILE_PX))
    rows = np.unique(np.append(np.arange(0, height - TILE_PX + 1, step), height - TILE_PX))
    return np.stack(np.meshgrid(columns, rows), axis=-1).reshape(-1, 2)


def _two_gratings(power: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Wave vectors (cycles a tile) of the strongest grating and its best partner; their share of power."""
    places, crossing, counted = _wave_band()
    flat = power.reshape(len(power), -1)
    total = (flat @ counted) / 2.0 + 1e-12
    searched = flat[:, places]
    best = searched.argmax(axis=1)
    partner = (searched * crossing[best]).argmax(axis=1)
    first, energy_1 = _refine_peak(power, places[best])
    second, energy_2 = _refine_peak(power, places[partner])
    share = 2.0 * np.minimum(energy_1, energy_2) / total
    return first, second, np.clip(share, 0.0, 1.0)


@cache
def _wave_band() -> tuple[IntArray, BoolArray, FloatArray]:
    """Places in a tile's spectrum where a grating is looked for, and which of them may be a pair.

    Returns
    -------
    places : int array, shape (m,)
        Places in the flattened spectrum.
    crossing : bool array, shape (m, m)
        Pairs of about the same length that cross at a wide angle.
    counted : array, shape (TILE_PX², )
        1 where power counts towards the whole.
    """
    half = TILE_PX // 2
    fy, fx = np.mgrid[-half:half, -half:half]
    radius = np.hypot(fx, fy)
    lowest = max(LOWEST_CYCLES, TILE_PX / (np.sqrt(2.0) * PITCH_RANGE_PX[1]))
    highest = TILE_PX / (np.sqrt(2.0) * PITCH_RANGE_PX[0])
    places = np.flatnonzero((radius > lowest) & (radius < highest) & (fy >= 0))
    x, y, length = fx.ravel()[places], fy.ravel()[places], radius.ravel()[places]
    ratio = length[None, :] / length[:, None]
    cosine = (np.outer(x, x) + np.outer(y, y)) / np.outer(length, length)
    crossing = (ratio > 0.6) & (ratio < 1.67) & (np.abs(cosine) < 0.6)
    counted = (radius > 1.5) & (radius < half - 1)
    return places, crossing, counted.ravel().astype(np.float32)


def _refine_peak(power: FloatArray, flat: IntArray) -> tuple[FloatArray, FloatArray]:
    """Interpolate each tile's peak by parabolas through log power; also the power within one cell of it."""
    half = TILE_PX // 2
    row, column = np.unravel_index(flat, (TILE_PX, TILE_PX))
    row, column = np.clip(row, 1, TILE_PX - 2), np.clip(column, 1, TILE_PX - 2)
    tile = np.arange(len(power))
    log = [[np.log(power[tile, row + dr, column + dc] + 1e-12) for dc in (-1, 0, 1)] for dr in (-1, 0, 1)]

    def offset(before: FloatArray, middle: FloatArray, after: FloatArray) -> FloatArray:
        curvature = before - 2.0 * middle + after
        return np.clip(0.5 * (before - after) / np.where(curvature < -1e-6, curvature, -1e9), -0.6, 0.6)

    dx = offset(log[1][0], log[1][1], log[1][2])
    dy = offset(log[0][1], log[1][1], log[2][1])
    energy = np.sum([[np.exp(value) for value in line] for line in log], axis=(0, 1))
    return np.column_stack([column - half + dx, row - half + dy]), energy


def _lattice_vectors(first: FloatArray, second: FloatArray) -> tuple[FloatArray, BoolArray]:
    """Lattice vectors from the two wave vectors (cycles/px), ordered right and down; and which are sane."""
    determinant = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
    sane = np.abs(determinant) > 1e-5
    determinant = np.where(sane, determinant, 1.0)
    # Columns of the inverse of [f1; f2]: u has f1·u = 1, f2·u = 0; v the other way round.
    u = np.column_stack([second[:, 1], -second[:, 0]]) / determinant[:, None]
    v = np.column_stack([-first[:, 1], first[:, 0]]) / determinant[:, None]
    one, other = 0.5 * (u + v), 0.5 * (u - v)
    across = np.where((np.abs(one[:, 0]) >= np.abs(other[:, 0]))[:, None], one, other)
    down = np.where((np.abs(one[:, 0]) >= np.abs(other[:, 0]))[:, None], other, one)
    across = across * np.where(across[:, :1] < 0, -1.0, 1.0)
    down = down * np.where(down[:, 1:] < 0, -1.0, 1.0)
    return np.column_stack([across, down]), sane
