"""Settings and result of a calibration."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from spavision.errors import InputError

from .arrays import FloatArray
from .bundle import LensModel
from .calibration_corners import BoardCorners
from .camera import Camera, Pose
from .coverage import Coverage
from .photos import LARGEST_MEGAPIXELS

FINDERS = ("auto", "lattice", "opencv")


@dataclass(frozen=True)
class CalibrationSettings:
    """Settings of `calibrate`.

    Parameters
    ----------
    corners : pair of int or None
        Inner corners of the board, columns and rows; found when None.
    square_mm : float
        Side of a square: scales the distances, leaves the intrinsic parameters alone.
    finder : str
        ``lattice``: the tracker's own, for whole or partly visible boards, sub-pixel window scaled to the
        squares. ``opencv``: OpenCV's calibration sample to the letter; needs ``corners``. ``auto``:
        ``opencv`` where ``corners`` names a sparse board and the photo shows all of it, else ``lattice``.
    model : LensModel
        Which parameters are free.
    largest_megapixels : float
        Larger photographs are not decoded.
    """

    corners: tuple[int, int] | None = None
    square_mm: float = 2.5
    finder: str = "auto"
    model: LensModel = field(default_factory=LensModel)
    largest_megapixels: float = LARGEST_MEGAPIXELS

    def __post_init__(self) -> None:
        if not (np.isfinite(self.square_mm) and self.square_mm > 0):
            raise InputError(f"--square-mm is {self.square_mm:g}; expected a length above 0")
        if not (np.isfinite(self.largest_megapixels) and self.largest_megapixels > 0):
            raise InputError(
                f"--largest-megapixels is {self.largest_megapixels:g}; expected a number above 0, such as 200"
            )
        if self.corners is not None and not 3 <= min(self.corners) <= max(self.corners) <= 1000:
            raise InputError(
                f"--corners is {self.corners[0]}x{self.corners[1]}; expected inner corners, 3 to 1000 a "
                "side, such as 9x6 for a board of 10 by 7 squares"
            )
        if self.finder not in FINDERS:
            raise InputError(f"--finder is {self.finder!r}; expected one of {', '.join(FINDERS)}")
        if self.finder == "opencv" and self.corners is None:
            raise InputError("--finder opencv needs --corners, such as 9x6; OpenCV does not find the number")


@dataclass(frozen=True)
class CalibrationPhoto:
    """What one photograph contributed.

    Parameters
    ----------
    photo : str
        File name.
    corners : BoardCorners
        Its corners.
    pose : Pose
        The board before the camera, mm.
    residuals_px : array, shape (n, 2)
        Corners less their projections.
    """

    photo: str
    corners: BoardCorners
    pose: Pose
    residuals_px: FloatArray

    @property
    def rms_px(self) -> float:
        """Root mean square length of the residuals."""
        return float(np.sqrt((self.residuals_px**2).sum(axis=1).mean()))


@dataclass(frozen=True)
class Calibration:
    """Result of `calibrate`.

    Parameters
    ----------
    camera : Camera
        Intrinsic parameters.
    covariance : array, shape (9, 9)
        Of `spavision.vision.bundle.PARAMETERS`.
    rms_px : float
        Root mean square distance of corners from their projections.
    sigma_px : float
        Standard deviation of one corner coordinate.
    board : pair of int
        Inner corners of the board, asked for or found.
    photos : tuple of CalibrationPhoto
        The photographs used.
    left_out : tuple of (str, str)
        File name and reason of each photograph left out.
    coverage : Coverage
    notes : tuple of str
        What the user should know.
    """

    camera: Camera
    covariance: FloatArray
    rms_px: float
    sigma_px: float
    board: tuple[int, int]
    photos: tuple[CalibrationPhoto, ...]
    left_out: tuple[tuple[str, str], ...]
    coverage: Coverage
    notes: tuple[str, ...]
