"""Finding and reading photographs: natural order, upright pixels, what EXIF knows of the lens."""

from __future__ import annotations

import re
import warnings
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from PIL import ExifTags, Image, ImageOps, UnidentifiedImageError

from spavision.errors import InputError, InputWarning

from .arrays import FloatImage, RgbImage

PHOTO_SUFFIXES = (".jpg", ".jpeg", ".png", ".tif", ".tiff", ".bmp", ".webp")
UNREAD_SUFFIXES = (".heic", ".heif", ".dng", ".cr2", ".cr3", ".nef", ".arw", ".raf", ".orf", ".rw2")
"""Photographs too, in formats that are not understood."""

LARGEST_MEGAPIXELS = 200.0
FULL_FRAME_WIDTH_MM = 36.0

BRIGHT_PERCENTILE, CLIPPED_LEVEL = 98.0, 253.0
"""A channel counts as clipped where the brightest squares, a large part of any photo, are as bright."""

# Sizes are checked below, before any pixel is decoded; Pillow's own limit is lower and only warns.
Image.MAX_IMAGE_PIXELS = None


@dataclass(frozen=True)
class Photo:
    """One photograph, upright.

    Parameters
    ----------
    name : str
        File name.
    rgb : uint8 array, shape (height, width, 3)
        Colours, sRGB.
    gray : float32 array, shape (height, width)
        Grey levels from the full bit depth, 0 to 255: what the colour filters of a sensor see on average, or
        green alone where red or blue are clipped.
    focal_px : float or None
        Focal length that EXIF gives, in pixels, for focus at infinity.
    """

    name: str
    rgb: RgbImage
    gray: FloatImage
    focal_px: float | None


def natural_key(name: str) -> list[tuple[int, int, str]]:
    """Sort key that orders the numbers inside names by value: p2 before p10."""
    parts = re.split(r"(\d+)", name.casefold())
    return [(0, int(part), "") if part.isdigit() else (1, 0, part) for part in parts if part]


def find_photos(folder: Path) -> list[Path]:
    """Return the photographs of a folder in natural order of their names; other files are left alone.

    Raises
    ------
    InputError
        If the folder does not exist, is not a folder or holds no photograph.
    """
    if not folder.exists():
        raise InputError(f"{folder}: no such folder; give the folder that holds the photographs")
    if not folder.is_dir():
        raise InputError(f"{folder} is a file; give the folder that holds the photographs")
    photos = [
        path
        for path in folder.iterdir()
        if path.suffix.lower() in PHOTO_SUFFIXES and path.is_file() and not path.name.startswith(".")
    ]
    unread = sorted(path.name for path in folder.iterdir() if path.suffix.lower() in UNREAD_SUFFIXES)
    if photos and unread:
        message = f"{unread[0]} and others of its kind are not read; convert them to JPEG, PNG or TIFF"
        warnings.warn(message, InputWarning, stacklevel=2)
    if not photos:
        kinds = ", ".join(suffix[1:] for suffix in PHOTO_SUFFIXES)
        raise InputError(f"{folder} holds no photograph; expected files of one of these kinds: {kinds}")
    return sorted(photos, key=lambda path: (natural_key(path.name), path.name))


def read_photo(path: Path, *, largest_megapixels: float = LARGEST_MEGAPIXELS) -> Photo:
    """Read a photograph, 8 or 16 bit, grey or colour, and turn it upright as EXIF says.

    Raises
    ------
    InputError
        If the file is missing, no image, truncated, corrupt or larger than ``largest_megapixels``.
    """
    try:
        with Image.open(path) as image:
            width, height = image.size
            if width * height > largest_megapixels * 1e6:
                raise InputError(
                    f"{path.name} has {width * height / 1e6:.3g} megapixels, more than the "
                    f"{largest_megapixels:g} allowed; scale it down, or raise --largest-megapixels"
                )
            exif = image.getexif()
            deep = _deep_pixels(path, image)
            if deep is None:
                rgb = np.asarray(ImageOps.exif_transpose(image).convert("RGB"))
                gray = _gray(rgb)
            else:
                deep = _transpose(deep, int(exif.get(ExifTags.Base.Orientation, 1)))
                rgb = np.clip(np.rint(deep), 0, 255).astype(np.uint8)
                gray = _gray(deep)
    except (UnidentifiedImageError, FileNotFoundError, IsADirectoryError) as error:
        raise InputError(f"{path.name} is not a photograph that can be read; replace or remove it") from error
    except (OSError, SyntaxError, ValueError, cv2.error) as error:
        raise InputError(f"{path.name} is corrupt or truncated; copy it again from the camera") from error
    return Photo(path.name, rgb, gray, _exif_focal_px(exif, max(width, height)))


def _gray(rgb: RgbImage | FloatImage) -> FloatImage:
    """Weigh the channels for the sharpest edges.

    A sensor has one red, two green and one blue site in four, and demosaicing shifts edges in red and blue
    by opposite amounts: with equal weights they cancel. A clipped channel moves edges by itself.
    """
    bright = np.percentile(rgb[::7, ::7].reshape(-1, 3), BRIGHT_PERCENTILE, axis=0)
    weights = (0.0, 1.0, 0.0) if max(bright[0], bright[2]) >= CLIPPED_LEVEL else (0.25, 0.5, 0.25)
    gray = rgb[:, :, 1].astype(np.float32) * np.float32(weights[1])
    for channel in (0, 2):
        if weights[channel]:
            gray += np.float32(weights[channel]) * rgb[:, :, channel]
    return gray


def _deep_pixels(path: Path, image: Image.Image) -> FloatImage | None:
    """Pixels of a 16-bit file as float RGB from 0 to 255, not yet upright; None for 8-bit files."""
    if image.format not in ("PNG", "TIFF"):
        return None
    flags = cv2.IMREAD_UNCHANGED | cv2.IMREAD_IGNORE_ORIENTATION
    raw = cv2.imdecode(np.frombuffer(path.read_bytes(), np.uint8), flags)
    if raw is None or raw.dtype != np.uint16:
        return None
    # Twelve- and fourteen-bit cameras often leave the upper bits of the file empty.
    bits = max(8, int(raw.max()).bit_length())
    pixels = raw.astype(np.float32) * (255.0 / (2**bits - 1))
    if pixels.ndim == 2:
        return np.repeat(pixels[:, :, None], 3, axis=2)
    return np.ascontiguousarray(pixels[:, :, 2::-1])


def _transpose(pixels: FloatImage, orientation: int) -> FloatImage:
    """Apply EXIF orientation 1-8 to an array."""
    if orientation in (5, 6, 7, 8):
        pixels = pixels.transpose(1, 0, 2)
    if orientation in (2, 3, 6, 7):
        pixels = pixels[:, ::-1]
    if orientation in (3, 4, 7, 8):
        pixels = pixels[::-1]
    return np.ascontiguousarray(pixels)


def _exif_focal_px(exif: Image.Exif, longer_side_px: int) -> float | None:
    """Focal length from the 35 mm equivalent, or from the focal-plane resolution."""
    details = exif.get_ifd(ExifTags.IFD.Exif)
    equivalent = details.get(ExifTags.Base.FocalLengthIn35mmFilm)
    if equivalent:
        return float(equivalent) / FULL_FRAME_WIDTH_MM * longer_side_px
    focal_mm = details.get(ExifTags.Base.FocalLength)
    resolution = details.get(ExifTags.Base.FocalPlaneXResolution)
    unit_mm = {2: 25.4, 3: 10.0, 4: 1.0}.get(
        int(details.get(ExifTags.Base.FocalPlaneResolutionUnit, 2) or 2), 25.4
    )
    if focal_mm and resolution:
        return float(focal_mm) * float(resolution) / unit_mm
    return None
