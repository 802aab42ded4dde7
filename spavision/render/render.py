"""Render photographs of an actuator that hangs in front of a checkerboard, with their truth."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .body import CentreLine, bend_to
from .build import build_scene
from .camera import Camera, camera_for_photo
from .optics import through_lens
from .raycast import cast
from .scene import FaceState
from .sensor import encode, expose
from .settings import RenderSettings, check_settings
from .trajectory import Trajectory

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class PhotoTruth:
    """What is really in one photo.

    Parameters
    ----------
    pressure_kPa : float
    camera : Camera
        Intrinsics and pose of this photo.
    dot_mm : array, shape (3,)
        Centre of the dot in the board frame.
    dot_px : array, shape (2,)
        Its projection in the upright photo.
    base_dot_mm, base_dot_px : array, shape (3,) and (2,), or None
        The same of the second marker, where there is one.
    hidden : float
        Share of the dot's area that is covered.
    line : CentreLine
        Centre line of the actuator in the plane of its side face.
    """

    pressure_kPa: float
    camera: Camera
    dot_mm: FloatArray
    dot_px: FloatArray
    base_dot_mm: FloatArray | None
    base_dot_px: FloatArray | None
    hidden: float
    line: CentreLine


@dataclass(frozen=True)
class RenderedPhoto:
    """One photo, upright, shape (height, width, 3), red-green-blue, 8 or 16 bits; and its truth."""

    pixels: NDArray[np.uint8] | NDArray[np.uint16]
    truth: PhotoTruth


def render_photo(settings: RenderSettings, trajectory: Trajectory, photo: int) -> RenderedPhoto:
    """Render one photo of a set.

    Parameters
    ----------
    settings : RenderSettings
    trajectory : Trajectory
    photo : int
        Row of the trajectory; bumps, covers and rig shifts count photos the same way.

    Raises
    ------
    InputError
        If a setting is out of range.
    """
    check_settings(settings)
    camera = camera_for_photo(settings, photo)
    face = _face(settings, trajectory, photo)
    covers = tuple(cover for cover in settings.covers if cover.photo == photo)
    scene = build_scene(settings, camera, face, covers)
    light = cast(scene, settings.image.width_px, settings.image.height_px)
    light = through_lens(light, settings.optics)
    random = np.random.Generator(np.random.PCG64([settings.seed, photo]))
    developed = expose(light, settings.light, settings.sensor, random)
    pixels = encode(developed, settings.image.bits)
    base_dot = face.base_dot_mm if settings.marker.base_marker else None
    truth = PhotoTruth(
        pressure_kPa=float(trajectory.pressure_kPa[photo]),
        camera=camera,
        dot_mm=face.dot_mm,
        dot_px=camera.project(face.dot_mm)[0],
        base_dot_mm=base_dot,
        base_dot_px=None if base_dot is None else camera.project(base_dot)[0],
        hidden=max((cover.fraction for cover in covers), default=0.0),
        line=face.line,
    )
    return RenderedPhoto(pixels, truth)


def render_photos(settings: RenderSettings, trajectory: Trajectory) -> Iterator[RenderedPhoto]:
    """Render every photo of a set, one after the other."""
    for photo in range(len(trajectory)):
        yield render_photo(settings, trajectory, photo)


def _face(settings: RenderSettings, trajectory: Trajectory, photo: int) -> FaceState:
    """Bend the actuator for one photo and find its dots."""
    actuator, marker = settings.actuator, settings.marker
    slips = [shift for shift in settings.rig_shifts if shift.photo <= photo]
    base = (
        actuator.base_x_mm + sum(shift.dx_mm for shift in slips),
        actuator.base_y_mm + sum(shift.dy_mm for shift in slips),
    )
    move = (float(trajectory.ux_mm[photo]), float(trajectory.uy_mm[photo]))
    line = bend_to(actuator, marker, base, move)
    dot = line.point_on_face(actuator.length_mm - marker.from_tip_mm, marker.off_centre_mm)
    base_dot = line.point_on_face(marker.base_marker_from_base_mm, 0.0)
    height = actuator.standoff_mm
    highest = float(np.max(trajectory.pressure_kPa))
    return FaceState(
        line=line,
        base_mm=base,
        dot_mm=np.array([*dot, height + trajectory.uz_mm[photo]]),
        base_dot_mm=np.array([*base_dot, height]),
        swelling=float(trajectory.pressure_kPa[photo]) / highest if highest > 0 else 0.0,
    )
