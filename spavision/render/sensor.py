"""The sensor: electrons, noise, the colour filter array, and the camera's own development."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from .colours import blackbody
from .settings import LightSettings, SensorSettings

FloatImage = NDArray[np.float32]

CHANNEL_SENSITIVITY = np.array([0.62, 1.0, 0.72])
"""Response of the red, green and blue filters to white light, green = 1."""

BAYER = ((0, 1), (1, 2))
"""Channel of each site of the 2×2 pattern (RGGB)."""

GREEN_CROSS = np.array([[0, 1, 0], [1, 4, 1], [0, 1, 0]]) / 4
OTHER_BILINEAR = np.array([[1, 2, 1], [2, 4, 2], [1, 2, 1]]) / 4
GREEN_AT_OTHER = (
    np.array([[0, 0, -1, 0, 0], [0, 0, 2, 0, 0], [-1, 2, 4, 2, -1], [0, 0, 2, 0, 0], [0, 0, -1, 0, 0]]) / 8
)
OTHER_ALONG_ROW = (
    np.array(
        [[0, 0, 0.5, 0, 0], [0, -1, 0, -1, 0], [-1, 4, 5, 4, -1], [0, -1, 0, -1, 0], [0, 0, 0.5, 0, 0]],
    )
    / 8
)
OTHER_DIAGONAL = (
    np.array(
        [[0, 0, -1.5, 0, 0], [0, 2, 0, 2, 0], [-1.5, 0, 6, 0, -1.5], [0, 2, 0, 2, 0], [0, 0, -1.5, 0, 0]],
    )
    / 8
)


def expose(
    light: FloatImage, lamp: LightSettings, sensor: SensorSettings, random: np.random.Generator
) -> FloatImage:
    """Return the developed linear picture, shape (height, width, 3), 0 to 1.

    Photon noise is taken as Gaussian with the variance of the signal in electrons.
    """
    response = CHANNEL_SENSITIVITY * blackbody(lamp.temperature_K)
    raw_of_white = lamp.level * response / response[1]
    signal = light * raw_of_white.astype(np.float32)
    if sensor.demosaic == "none":
        developed = _read_out(signal, sensor, random)
    else:
        mosaic = _read_out(_mosaic(signal), sensor, random)
        developed = demosaic(mosaic, sensor.demosaic)
    assumed = CHANNEL_SENSITIVITY * blackbody(sensor.white_balance_K)
    developed *= (sensor.gain * assumed[1] / assumed).astype(np.float32)
    if sensor.sharpening > 0:
        soft = cv2.GaussianBlur(developed, (0, 0), 1.0)
        developed += sensor.sharpening * (developed - soft)
    return np.clip(developed, 0.0, 1.0)


def _read_out(signal: FloatImage, sensor: SensorSettings, random: np.random.Generator) -> FloatImage:
    """Add photon and read noise and clip at the full well; signal 1 is the full well."""
    if sensor.noise:
        electrons = np.maximum(signal, 0) * np.float32(sensor.full_well_e)
        spread = np.sqrt(electrons + np.float32(sensor.read_noise_e**2))
        electrons += spread * random.standard_normal(signal.shape, dtype=np.float32)
        signal = electrons / np.float32(sensor.full_well_e)
    return np.minimum(signal, np.float32(1.0))


def _mosaic(signal: FloatImage) -> FloatImage:
    """Keep one channel a pixel, in the pattern `BAYER`."""
    mosaic = np.empty(signal.shape[:2], dtype=np.float32)
    for row in (0, 1):
        for column in (0, 1):
            mosaic[row::2, column::2] = signal[row::2, column::2, BAYER[row][column]]
    return mosaic


def demosaic(mosaic: FloatImage, method: str) -> FloatImage:
    """Return the three channels of an RGGB mosaic, shape (height, width, 3).

    ``bilinear`` averages neighbours of the same colour and leaves coloured fringes; ``malvar`` is the
    gradient-corrected filter of Malvar, He and Cutler (ICASSP 2004).
    """
    return _bilinear(mosaic) if method == "bilinear" else _malvar(mosaic)


def _filter(image: FloatImage, taps: NDArray[np.floating]) -> FloatImage:
    return np.asarray(cv2.filter2D(image, -1, taps, borderType=cv2.BORDER_REFLECT_101))


def _bilinear(mosaic: FloatImage) -> FloatImage:
    result = np.empty((*mosaic.shape, 3), dtype=np.float32)
    for channel, taps in ((0, OTHER_BILINEAR), (1, GREEN_CROSS), (2, OTHER_BILINEAR)):
        plane = np.zeros_like(mosaic)
        for row, column in _sites(channel):
            plane[row::2, column::2] = mosaic[row::2, column::2]
        result[:, :, channel] = _filter(plane, taps)
    return result


def _malvar(mosaic: FloatImage) -> FloatImage:
    result = np.repeat(mosaic[:, :, None], 3, axis=2)
    green = _filter(mosaic, GREEN_AT_OTHER)
    along_row = _filter(mosaic, OTHER_ALONG_ROW)
    along_column = _filter(mosaic, np.ascontiguousarray(OTHER_ALONG_ROW.T))
    diagonal = _filter(mosaic, OTHER_DIAGONAL)
    for channel, (row, column) in ((0, (0, 0)), (2, (1, 1))):
        other_row, other_column = 1 - row, 1 - column
        result[row::2, column::2, 1] = green[row::2, column::2]
        result[row::2, other_column::2, channel] = along_row[row::2, other_column::2]
        result[other_row::2, column::2, channel] = along_column[other_row::2, column::2]
        result[other_row::2, other_column::2, channel] = diagonal[other_row::2, other_column::2]
    return result


def _sites(channel: int) -> list[tuple[int, int]]:
    return [(row, column) for row in (0, 1) for column in (0, 1) if BAYER[row][column] == channel]


def encode(linear: FloatImage, bits: int) -> NDArray[np.uint8] | NDArray[np.uint16]:
    """Apply the transfer curve of sRGB (IEC 61966-2-1) and round to whole numbers."""
    encoded = np.where(
        linear <= 0.0031308, 12.92 * linear, 1.055 * np.power(linear, np.float32(1 / 2.4)) - 0.055
    )
    top = 2**bits - 1
    rounded = np.rint(encoded * np.float32(top))
    return rounded.astype(np.uint8) if bits == 8 else rounded.astype(np.uint16)
