"""How strongly each pixel has the marker's colour, after white balance on the board's own squares."""

from __future__ import annotations

import re
from dataclasses import dataclass

import cv2
import numpy as np

from spavision.errors import InputError

from .arrays import FloatArray, FloatImage, RgbImage
from .board import BoardView
from .camera import project

NAMED_COLOURS = {
    "red": (190, 30, 30),
    "orange": (235, 120, 20),
    "yellow": (235, 205, 30),
    "green": (20, 140, 50),
    "cyan": (0, 160, 190),
    "blue": (25, 70, 190),
    "purple": (110, 40, 150),
    "magenta": (200, 30, 140),
}
"""sRGB of typical felt pens and stickers; a sampled colour (#rrggbb) serves as well."""

LEAST_CHROMA = 12.0
"""Less colour than this is grey, of which a checkerboard is full; in units of Lab."""

FOREIGN_HUE_COST = 0.9
"""What a unit of chroma across the marker's hue takes off a unit along it."""


Rgb = tuple[int, int, int]
"""sRGB, 0 to 255."""


@dataclass(frozen=True)
class MarkerColour:
    """Colour of a marker.

    Parameters
    ----------
    rgb : tuple of int
        sRGB, 0 to 255.
    sampled : bool
        Whether it was sampled from a photograph, whose light it then carries; else it is as in white light.
    """

    rgb: Rgb
    sampled: bool

    def in_white_light(self, levels: tuple[FloatArray, FloatArray]) -> Rgb:
        """Return the colour as white light would show it; ``levels`` come from `white_balance`."""
        if not self.sampled:
            return self.rgb
        balanced = _balanced(np.array(self.rgb, dtype=np.float32), levels)
        red, green, blue = np.rint(255.0 * balanced).astype(int).tolist()
        return red, green, blue


def parse_colour(text: str) -> MarkerColour:
    """Turn a colour's name or ``#rrggbb``, sampled from a photograph, into a colour.

    Raises
    ------
    InputError
        If the text is neither, or names a grey, which a checkerboard is full of.
    """
    name = text.strip().lower()
    if name in NAMED_COLOURS:
        return MarkerColour(NAMED_COLOURS[name], sampled=False)
    if not re.fullmatch(r"#[0-9a-f]{6}", name):
        raise InputError(
            f"--marker-colour is {text!r}; expected {', '.join(NAMED_COLOURS)} or a sampled colour as #rrggbb"
        )
    rgb = (int(name[1:3], 16), int(name[3:5], 16), int(name[5:7], 16))
    if colour_chroma(rgb) < LEAST_CHROMA:
        raise InputError(
            f"--marker-colour {text} is nearly grey like the board; choose a marker with more colour"
        )
    return MarkerColour(rgb, sampled=True)


def colour_chroma(rgb: Rgb) -> float:
    """Return the chroma of a colour given in sRGB, 0 to 255, in units of Lab."""
    _, a, b = _lab(np.array([[rgb]], np.float32) / 255.0)[0, 0]
    return float(np.hypot(a, b))


def white_balance(rgb: RgbImage, board: BoardView) -> tuple[FloatArray, FloatArray]:
    """Colours of the board's dark and bright squares, each of shape (3,), from their middles."""
    rows = np.linspace(0, len(board.indices) - 1, min(4000, len(board.indices))).astype(np.intp)
    nodes = board.indices[rows]
    middles = project(board.camera, board.pose, nodes.astype(float) + 0.5)
    column, row = np.rint(middles).astype(np.intp).T
    height, width = rgb.shape[:2]
    inside = (column >= 0) & (column < width) & (row >= 0) & (row < height)
    colours = rgb[row[inside], column[inside]].astype(float)
    bright = nodes[inside].sum(axis=1) % 2 == 0
    return np.median(colours[~bright], axis=0), np.median(colours[bright], axis=0)


def colour_strength(rgb: RgbImage, levels: tuple[FloatArray, FloatArray], target: Rgb) -> FloatImage:
    """Chroma along the target's hue less a share of the chroma across it, in units of Lab.

    Parameters
    ----------
    rgb : uint8 array, shape (height, width, 3)
        Photograph or part of one.
    levels : pair of arrays, shape (3,)
        Dark and bright squares from `white_balance`; bright is made neutral, so that warm or cold light does
        not turn into chroma.
    target : tuple of int
        Marker colour in white light, sRGB.
    """
    every_level = np.repeat(np.arange(256, dtype=np.float32)[:, None, None], 3, axis=2)
    table = np.rint(255.0 * _balanced(every_level, levels)).astype(np.uint8)
    # In whole numbers this takes a tenth of the time; they are finer than any camera's noise.
    lab = cv2.cvtColor(cv2.LUT(rgb, table), cv2.COLOR_RGB2LAB)
    _, a, b = _lab(np.array([[target]], np.float32) / 255.0)[0, 0] / colour_chroma(target)
    green_red, blue_yellow = (lab[:, :, channel].astype(np.float32) - 128.0 for channel in (1, 2))
    strength: FloatImage = green_red * a + blue_yellow * b
    strength -= FOREIGN_HUE_COST * np.abs(blue_yellow * a - green_red * b)
    return strength


def _balanced(rgb: FloatImage, levels: tuple[FloatArray, FloatArray]) -> FloatImage:
    """Colours from 0 to 1 in which bright squares are neutral."""
    dark, bright = levels
    # Half the dark level stays: glare lifts it, and taking it off whole would blow up noise in the shadows.
    floor = 0.5 * dark.min()
    gain = 0.85 / np.maximum(bright - floor, 8.0)
    return np.clip((rgb - np.float32(floor)) * gain.astype(np.float32), 0.0, 1.0)


def _lab(rgb: FloatImage) -> FloatImage:
    return np.asarray(cv2.cvtColor(rgb.astype(np.float32), cv2.COLOR_RGB2LAB), dtype=np.float32)
