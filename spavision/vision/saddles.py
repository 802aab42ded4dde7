"""Corner candidates: saddle response scaled to the square pitch, sub-pixel position, ring test."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from .arrays import BoolArray, FloatArray, FloatImage, IntArray, blur, sample
from .saddle_fit import fit_saddles
from .spectra import LatticeField

RING_SAMPLES = 24
RING_RADII = (0.28, 0.42)
"""Radii of the two sampled rings, in squares: clear of the blurred corner, short of the next one."""

WORST_QUADRANT = 0.2
"""Least brightness difference of any one quadrant, over that of all four."""


@dataclass(frozen=True)
class Candidates:
    """Corner candidates of one image.

    Parameters
    ----------
    pixels : array, shape (n, 2)
        Sub-pixel positions.
    parity : array of +1 or −1, shape (n,)
        +1 where the square to the lower right is bright.
    quality : array, shape (n,)
        Correlation of the ring with an ideal corner's, 0 to 1.
    contrast : array, shape (n,)
        Half the difference between bright and dark squares, grey levels.
    """

    pixels: FloatArray
    parity: NDArray[np.int8]
    quality: FloatArray
    contrast: FloatArray

    def take(self, rows: IntArray | BoolArray) -> Candidates:
        """Return the candidates at the given rows."""
        return Candidates(self.pixels[rows], self.parity[rows], self.quality[rows], self.contrast[rows])


def find_saddles(gray: FloatImage, pitch_px: float) -> FloatArray:
    """Return pixel positions of local maxima of the saddle response, shape (n, 2).

    The response is Ixy² − Ixx Iyy of the image smoothed by a fifth of a square: positive only where the
    surface bends up one way and down the other, whatever the corner's orientation.
    """
    smooth = blur(gray, max(0.18 * pitch_px, 0.7))
    ixx = cv2.Sobel(smooth, cv2.CV_32F, 2, 0, ksize=3, scale=0.25)
    iyy = cv2.Sobel(smooth, cv2.CV_32F, 0, 2, ksize=3, scale=0.25)
    ixy = cv2.Sobel(smooth, cv2.CV_32F, 1, 1, ksize=3, scale=0.25)
    response = ixy * ixy - ixx * iyy
    reach = 2 * max(1, round(0.32 * pitch_px)) + 1
    highest = cv2.dilate(response, cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (reach, reach)))
    # A corner is compared with the strongest of its surroundings: a shaded part of the board counts too.
    step = max(1, round(pitch_px))
    coarse = cv2.resize(highest, None, fx=1 / step, fy=1 / step, interpolation=cv2.INTER_AREA)
    local = cv2.resize(cv2.blur(cv2.dilate(coarse, np.ones((7, 7))), (7, 7)), gray.shape[::-1])
    peaks = (response >= highest) & (response > 0.06 * local) & (response > 1e-3)
    border = max(2, round(0.45 * pitch_px))
    peaks[:border] = peaks[-border:] = False
    peaks[:, :border] = peaks[:, -border:] = False
    rows, columns = np.nonzero(peaks)
    return np.column_stack([columns, rows]).astype(float)


def ring_test(
    gray: FloatImage, pixels: FloatArray, field_vectors: tuple[FloatArray, FloatArray]
) -> tuple[NDArray[np.int8], FloatArray, FloatArray]:
    """Compare rings about each point with an ideal corner's.

    The rings are ellipses in the local lattice vectors, so that an ideal corner gives sign(sin 2φ) whatever
    the board's perspective.

    Parameters
    ----------
    gray : float32 array
        The photograph, smoothed a little where it is noisy.
    pixels : array, shape (n, 2)
        Points to test.
    field_vectors : pair of arrays, shape (n, 2)
        Lattice vectors at those points.

    Returns
    -------
    parity, quality, contrast : arrays, shape (n,)
        As in `Candidates`.
    """
    angle = (np.arange(RING_SAMPLES) + 0.5) * (2.0 * np.pi / RING_SAMPLES)
    across, down = field_vectors
    quality, contrast = np.zeros(len(pixels)), np.zeros(len(pixels))
    quadrants = np.zeros((len(pixels), 4))
    template = np.sin(2.0 * angle).astype(np.float32)
    template /= np.linalg.norm(template)
    for radius in RING_RADII:
        points = (
            pixels[:, None, :]
            + radius * np.cos(angle)[None, :, None] * across[:, None, :]
            + radius * np.sin(angle)[None, :, None] * down[:, None, :]
        )
        values = sample(gray, points)
        values -= values.mean(axis=1, keepdims=True)
        projection = values @ template
        norm = np.linalg.norm(values, axis=1)
        # A square wave correlates with its own sine at 0.9: that is the best a sharp corner can reach.
        quality += projection / np.maximum(norm, 1e-6) / len(RING_RADII)
        quadrants += values.reshape(len(pixels), 4, RING_SAMPLES // 4).mean(axis=2)
        contrast += np.abs(projection) * np.sqrt(2.0 / RING_SAMPLES) / len(RING_RADII)
    parity = np.where(quality >= 0, 1, -1).astype(np.int8)
    quality = np.clip(np.abs(quality) / 0.95, 0.0, 1.0)
    # At the board's border and along occluders one quadrant or two have the wrong colour.
    agreeing = quadrants * (parity[:, None] * np.array([1.0, -1.0, 1.0, -1.0]))
    quality[agreeing.min(axis=1) < WORST_QUADRANT * agreeing.mean(axis=1)] = 0.0
    return parity, quality, contrast


def find_candidates(gray: FloatImage, field: LatticeField) -> Candidates:
    """Find all corner candidates of an image whose lattice field is known."""
    pitch = field.pitch_px
    saddles = find_saddles(gray, pitch)
    pixels = fit_saddles(gray, saddles, *field.vectors(saddles))
    pixels = pixels[np.isfinite(pixels).all(axis=1)]
    tested = blur(gray, max(0.1 * pitch, 0.5))
    parity, quality, contrast = ring_test(tested, pixels, field.vectors(pixels))
    good = quality > 0.6
    return Candidates(pixels[good], parity[good], quality[good], contrast[good])
