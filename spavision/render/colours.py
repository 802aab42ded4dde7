"""Colours of things and of light, as linear red, green, blue."""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

NAMED_COLOURS = {
    "red": "#c8161d",
    "orange": "#e07a10",
    "yellow": "#e6c914",
    "green": "#1f9a3a",
    "cyan": "#14a5b8",
    "blue": "#1c3fb4",
    "magenta": "#c21a8c",
    "black": "#141414",
    "white": "#ececec",
}

CHANNEL_WAVELENGTHS_NM = np.array([610.0, 540.0, 465.0])
SECOND_RADIATION_CONSTANT_NM_K = 1.438776877e7


def parse_colour(text: str) -> FloatArray | None:
    """Return the linear colour of a name or ``#rrggbb``, shape (3,), or None if it is neither."""
    code = NAMED_COLOURS.get(text.lower(), text)
    if not re.fullmatch(r"#[0-9a-fA-F]{6}", code):
        return None
    encoded = np.array([int(code[k : k + 2], 16) for k in (1, 3, 5)]) / 255.0
    return srgb_to_linear(encoded)


def linear_colour(text: str) -> FloatArray:
    """Return the linear colour of a checked setting, shape (3,)."""
    colour = parse_colour(text)
    if colour is None:
        raise ValueError(f"{text!r} is no colour")
    return colour


def srgb_to_linear(encoded: FloatArray) -> FloatArray:
    """Undo the transfer curve of IEC 61966-2-1 (sRGB), values 0 to 1."""
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


def blackbody(temperature_K: float) -> FloatArray:
    """Return the colour of a black body by Planck's law at three wavelengths, green = 1, shape (3,)."""
    exponent = SECOND_RADIATION_CONSTANT_NM_K / (CHANNEL_WAVELENGTHS_NM * temperature_K)
    radiance = CHANNEL_WAVELENGTHS_NM**-5.0 / np.expm1(exponent)
    return np.asarray(radiance / radiance[1])
