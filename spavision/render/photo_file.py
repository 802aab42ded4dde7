"""A rendered photo as the bytes of an image file: format, bit depth, EXIF, orientation."""

from __future__ import annotations

import io
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray
from PIL import ExifTags, Image
from PIL.TiffImagePlugin import IFDRational

from .camera import focal_px
from .settings import ImageSettings, RenderSettings

Pixels = NDArray[np.integer]

ENDINGS = {"jpeg": "jpg", "png": "png", "tiff": "tif"}
CHROMA = {"4:4:4": 0, "4:2:2": 1, "4:2:0": 2}
FULL_FRAME_WIDTH_MM = 36.0


def photo_bytes(pixels: Pixels, settings: RenderSettings, *, photo: int) -> bytes:
    """Encode an upright photo as the settings ask.

    Parameters
    ----------
    pixels : uint8 or uint16 array, shape (height, width, 3)
        Red, green, blue, upright.
    settings : RenderSettings
    photo : int
        Number of the photo in its set; sets the minute of the EXIF time.
    """
    image = settings.image
    stored = stored_pixels(pixels, image.orientation)
    if image.bits == 16:
        return _deep_bytes(stored, image, _exif(settings, photo))
    options: dict[str, Any] = {}
    if image.format == "jpeg":
        options = {"quality": image.quality, "subsampling": CHROMA[image.chroma]}
    buffer = io.BytesIO()
    Image.fromarray(stored.astype(np.uint8)).save(
        buffer, format=image.format.upper(), exif=_exif(settings, photo), **options
    )
    return buffer.getvalue()


def stored_pixels(pixels: Pixels, orientation: int) -> Pixels:
    """Turn an upright picture into the one that EXIF's ``orientation`` turns upright again.

    The tag's value says what the file's first row and first column are (EXIF 2.32, 4.6.4 A): 1 top, left;
    2 top, right; 3 bottom, right; 4 bottom, left; 5 left, top; 6 right, top; 7 right, bottom; 8 left, bottom.
    """
    if orientation >= 5:
        pixels = np.swapaxes(pixels, 0, 1)
    if orientation in (3, 4, 6, 7):
        pixels = pixels[::-1]
    if orientation in (2, 3, 7, 8):
        pixels = pixels[:, ::-1]
    return np.ascontiguousarray(pixels)


def _deep_bytes(stored: Pixels, image: ImageSettings, exif: Image.Exif) -> bytes:
    """Encode 16 bits a channel, which Pillow cannot; a TIFF is written without EXIF."""
    blue_first = np.ascontiguousarray(stored[:, :, ::-1])
    ending = f".{ENDINGS[image.format]}"
    if image.format == "png":
        # A PNG's eXIf chunk holds the bare TIFF structure, without JPEG's «Exif» prefix.
        metadata = np.frombuffer(exif.tobytes().removeprefix(b"Exif\x00\x00"), np.uint8)
        _, encoded = cv2.imencodeWithMetadata(ending, blue_first, [cv2.IMAGE_METADATA_EXIF], [metadata])
    else:
        _, encoded = cv2.imencode(ending, blue_first)
    return bytes(encoded)


def _exif(settings: RenderSettings, photo: int) -> Image.Exif:
    """Return what a camera would write; the time is the photo's number in minutes, so that bytes repeat."""
    image, view = settings.image, settings.camera
    exif = Image.Exif()
    exif[ExifTags.Base.Make] = "spavision"
    exif[ExifTags.Base.Model] = "synthetic camera"
    exif[ExifTags.Base.Orientation] = image.orientation
    exif[ExifTags.Base.DateTime] = f"2026:01:01 {12 + photo // 60:02d}:{photo % 60:02d}:00"
    longer_side_px = max(image.width_px, image.height_px)
    image_distance_mm = focal_px(settings) * view.sensor_width_mm / longer_side_px
    # The lens's own focal length: focused at the board, the image lies behind it (thin lens equation).
    focal_mm = 1.0 / (1.0 / image_distance_mm + 1.0 / view.distance_mm)
    details = exif.get_ifd(ExifTags.IFD.Exif)
    details[ExifTags.Base.FocalLength] = IFDRational(round(100 * focal_mm), 100)
    details[ExifTags.Base.FocalLengthIn35mmFilm] = round(
        focal_mm * FULL_FRAME_WIDTH_MM / view.sensor_width_mm
    )
    return exif
