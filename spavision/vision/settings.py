"""What the user knows of the set-up, and how well."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from spavision.errors import InputError

from .arrays import FloatArray
from .camera import Camera
from .photos import LARGEST_MEGAPIXELS


@dataclass(frozen=True)
class TrackSettings:
    """Settings of `spavision.vision.track.track`.

    Parameters
    ----------
    square_mm : float
        Nominal side of a square of the board.
    board_scale : float
        Printed size over nominal size, e.g. the ruler's reading of 100 squares over 100 ``square_mm``.
    standoff_mm : float or None
        Distance of the marker's plane from the board. Without it displacements stay in the board's plane.
    distance_mm : float or None
        Measured perpendicular distance from the camera to the board.
    camera : Camera or None
        Calibrated camera; its parameters are then kept.
    camera_covariance : array, shape (9, 9), or None
        Covariance of its `spavision.vision.bundle.PARAMETERS`; None where it is not known, and the camera is
        taken for exact.
    marker_colour : str
        A colour's name or ``#rrggbb``.
    marker_diameter_mm : float or None
        Diameter of the marker; found from the photographs when absent.
    base_marker_colour : str or None
        Colour of a second marker, on the clamp or the actuator's fixed end and in the plane of the first,
        whose motion is taken off; None where there is none.
    base_marker_diameter_mm : float or None
        Its diameter; the first marker's when absent.
    sigma_standoff_mm, sigma_distance_mm : float
        Standard uncertainty of the two lengths above.
    sigma_board_scale : float
        Relative standard uncertainty of the print's size.
    sigma_out_of_plane_mm : float
        Standard uncertainty of the marker's motion towards the camera between two photographs.
    sigma_by_hand_px : float
        Standard uncertainty of a pixel that a person gave, in each direction.
    largest_megapixels : float
        Larger photographs are not decoded.
    workers : int or None
        Photographs measured at a time; None for as many as there are processors.
    """

    square_mm: float = 2.5
    board_scale: float = 1.0
    standoff_mm: float | None = None
    distance_mm: float | None = None
    camera: Camera | None = None
    camera_covariance: FloatArray | None = None
    marker_colour: str = "red"
    marker_diameter_mm: float | None = None
    base_marker_colour: str | None = None
    base_marker_diameter_mm: float | None = None
    sigma_standoff_mm: float = 0.5
    sigma_distance_mm: float = 5.0
    sigma_board_scale: float = 0.0005
    sigma_out_of_plane_mm: float = 0.2
    sigma_by_hand_px: float = 1.0
    largest_megapixels: float = LARGEST_MEGAPIXELS
    workers: int | None = None

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if not isinstance(value, (int, float)) or field.name == "workers":
                continue
            may_vanish = field.name.startswith("sigma_") or field.name == "standoff_mm"
            if not np.isfinite(value) or value < 0 or (value == 0 and not may_vanish):
                raise InputError(
                    f"{field.name} is {value:g}; "
                    f"expected a number {'of at least' if may_vanish else 'above'} 0"
                )
        if not 0.5 <= self.board_scale <= 2.0:
            raise InputError(
                f"board_scale is {self.board_scale:g}; expected the printed size over the nominal, near 1"
            )
        if (
            self.distance_mm is not None
            and self.standoff_mm is not None
            and self.standoff_mm > 0.5 * self.distance_mm
        ):
            raise InputError(
                f"standoff_mm is {self.standoff_mm:g} and distance_mm {self.distance_mm:g}; "
                "the marker cannot stand that near the camera"
            )

    @property
    def true_square_mm(self) -> float:
        """Side of a square as printed."""
        return self.square_mm * self.board_scale

    @property
    def base_diameter_mm(self) -> float | None:
        """Diameter of the base marker: the marker's own unless another was given."""
        given = self.base_marker_diameter_mm
        return self.marker_diameter_mm if given is None else given
