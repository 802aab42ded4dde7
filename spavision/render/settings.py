"""Everything that can be chosen about a synthetic photograph: frozen dataclasses, checked before use."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from spavision.errors import InputError

from .setting import check_value, setting


@dataclass(frozen=True)
class ImageSettings:
    """Size and file format of the photograph, as seen upright."""

    width_px: int = setting(1280, "width of the upright photo", unit="px", low=64, high=20000)
    height_px: int = setting(960, "height of the upright photo", unit="px", low=64, high=20000)
    format: str = setting("jpeg", "file format", choices=("jpeg", "png", "tiff"))
    bits: int = setting(8, "bits a channel (16 needs png or tiff)", choices=(8, 16))
    quality: int = setting(90, "JPEG quality", low=1, high=100)
    chroma: str = setting("4:2:0", "JPEG chroma subsampling", choices=("4:4:4", "4:2:2", "4:2:0"))
    orientation: int = setting(1, "EXIF orientation the pixels are stored in", low=1, high=8)


@dataclass(frozen=True)
class CameraSettings:
    """Pinhole camera with OpenCV's radial-tangential distortion, and where it stands."""

    distance_mm: float = setting(
        750.0, "camera centre to board plane, perpendicular", unit="mm", low=100, high=5000
    )
    square_px: float = setting(
        10.0, "pitch of one square facing the camera; sets the focal length", unit="px", low=1, high=400
    )
    aspect: float = setting(1.0, "fy / fx", low=0.5, high=2)
    cx_offset_px: float = setting(0.0, "principal point right of the image centre", unit="px")
    cy_offset_px: float = setting(0.0, "principal point below the image centre", unit="px")
    k1: float = setting(-0.12, "radial distortion, r^2", low=-2, high=2)
    k2: float = setting(0.0, "radial distortion, r^4", low=-20, high=20)
    k3: float = setting(0.0, "radial distortion, r^6", low=-200, high=200)
    p1: float = setting(0.0, "tangential distortion", low=-0.1, high=0.1)
    p2: float = setting(0.0, "tangential distortion", low=-0.1, high=0.1)
    yaw_deg: float = setting(3.0, "camera stands to the left and looks right", unit="deg", low=-60, high=60)
    pitch_deg: float = setting(-3.0, "camera stands above and looks down", unit="deg", low=-60, high=60)
    roll_deg: float = setting(0.4, "camera turned about its axis", unit="deg", low=-180, high=180)
    aim_x_mm: float = setting(0.0, "board point on the optical axis, x", unit="mm")
    aim_y_mm: float = setting(0.0, "board point on the optical axis, y", unit="mm")
    sensor_width_mm: float = setting(
        23.5, "sensor width, for the EXIF focal length", unit="mm", low=1, high=100
    )


@dataclass(frozen=True)
class BoardSettings:
    """The printed checkerboard."""

    square_mm: float = setting(2.5, "side of one square", unit="mm", low=0.1, high=100)
    columns: int = setting(104, "squares across", low=2, high=2000)
    rows: int = setting(104, "squares down", low=2, high=2000)
    margin_mm: float = setting(9.0, "blank paper around the squares", unit="mm", low=0, high=500)
    white: float = setting(0.82, "reflectance of the paper", low=0, high=1)
    black: float = setting(0.045, "reflectance of the ink", low=0, high=1)
    tint: str = setting("#fffdf8", "colour of the paper", colour=True)
    mottle: float = setting(0.015, "uneven paper and ink, relative", low=0, high=0.5)
    wall: str = setting("#6d7276", "colour of the wall behind the board", colour=True)


@dataclass(frozen=True)
class ActuatorSettings:
    """The hanging actuator: where it is clamped, its sizes, its layers."""

    visible: bool = setting(True, "draw actuator, clamp and hose")
    base_x_mm: float = setting(0.0, "clamped end, x", unit="mm")
    base_y_mm: float = setting(-92.0, "clamped end, y", unit="mm")
    standoff_mm: float = setting(20.0, "side face with the marker, in front of the board", unit="mm", low=1)
    length_mm: float = setting(157.5, "length at rest", unit="mm", low=10, high=2000)
    thickness_mm: float = setting(15.0, "size out of the plane", unit="mm", low=0.1, high=500)
    composite_mm: float = setting(5.0, "depth of the crimped-paper composite", unit="mm", low=0.1)
    interface_mm: float = setting(1.0, "depth of the strip under the composite", unit="mm", low=0)
    body_mm: float = setting(17.5, "depth of the silicone body", unit="mm", low=1)
    strip_mm: float = setting(3.0, "depth of the strip of region B", unit="mm", low=0)
    crimp_ratio: float = setting(0.3, "crimp ratio of the paper", low=0.01, high=1)
    first_bend: str = setting("right", "side of the first bending mode", choices=("right", "left"))
    curvature_taper: float = setting(
        0.35, "bending gathers near the clamp (1) or the tip (-1)", low=-0.9, high=0.9
    )
    bulge_mm: float = setting(
        0.5, "swelling between the walls at the highest pressure", unit="mm", low=0, high=10
    )
    body_colour: str = setting("#4d9a4f", "colour of the silicone body", colour=True)
    strip_colour: str = setting("#418a52", "colour of the strip of region B", colour=True)
    composite_colour: str = setting("#d9d6c6", "colour of the composite", colour=True)


@dataclass(frozen=True)
class MarkerSettings:
    """The dot on the side face, and a second one at the base."""

    colour: str = setting("red", "name or #rrggbb", colour=True)
    diameter_mm: float = setting(4.5, "diameter", unit="mm", low=0.2, high=100)
    from_tip_mm: float = setting(5.0, "centre of the dot from the tip, at rest", unit="mm", low=0)
    off_centre_mm: float = setting(1.5, "centre of the dot right of the centre line, at rest", unit="mm")
    highlight: float = setting(0.0, "strength of a specular highlight on the dot", low=0, high=1)
    highlight_size: float = setting(0.35, "its radius over the dot's radius", low=0.05, high=2)
    highlight_angle_deg: float = setting(
        225.0, "its direction from the centre (0 right, 90 down)", unit="deg"
    )
    base_marker: bool = setting(False, "a second dot at the clamped end")
    base_marker_colour: str = setting("red", "its colour", colour=True)
    base_marker_from_base_mm: float = setting(8.0, "its centre below the clamped end", unit="mm", low=0)


@dataclass(frozen=True)
class LightSettings:
    """Brightness, colour and evenness of the light, and the shadows."""

    level: float = setting(
        0.85, "signal of a perfectly white sheet over the sensor's full well", low=0.001, high=5
    )
    temperature_K: float = setting(5200.0, "colour temperature", unit="K", low=1500, high=20000)
    gradient_x: float = setting(0.04, "relative change of brightness a 100 mm, rightwards", low=-1, high=1)
    gradient_y: float = setting(-0.05, "relative change of brightness a 100 mm, downwards", low=-1, high=1)
    from_x: float = setting(-0.55, "light comes from: x over z", low=-5, high=5)
    from_y: float = setting(-0.45, "light comes from: y over z", low=-5, high=5)
    size: float = setting(0.45, "size of the light over its distance: 0.02 hard, 0.5 soft shadows", low=0.005)
    shadow: float = setting(0.45, "how dark the actuator's shadow is", low=0, high=1)
    edge_shadow: float = setting(0.0, "how dark a straight shadow across the board is", low=0, high=1)
    edge_offset_mm: float = setting(40.0, "its edge from the board's origin", unit="mm")
    edge_angle_deg: float = setting(20.0, "its direction (0: dark on the right)", unit="deg")
    edge_softness_mm: float = setting(2.0, "width of its edge", unit="mm", low=0.05)


@dataclass(frozen=True)
class ClutterSettings:
    """Things in the picture that are neither board nor actuator."""

    cable: bool = setting(False, "a dark cable across the whole board")
    cable_colour: str = setting("#1d1f22", "its colour", colour=True)
    cable_diameter_mm: float = setting(7.0, "its diameter", unit="mm", low=0.2)
    cable_x_mm: float = setting(-62.0, "where it crosses the board's x axis", unit="mm")
    cable_angle_deg: float = setting(84.0, "its direction (0: along x, 90: along y)", unit="deg")
    red_cable: bool = setting(False, "a thin red cable beside the actuator")
    red_sticker: bool = setting(False, "a round red sticker on the board, of the marker's diameter")
    red_bolt: bool = setting(False, "a red bolt head on the clamp")
    sticker_x_mm: float = setting(45.0, "sticker, x", unit="mm")
    sticker_y_mm: float = setting(-55.0, "sticker, y", unit="mm")
    sticker_diameter_mm: float = setting(5.0, "sticker, diameter", unit="mm", low=0.2)


@dataclass(frozen=True)
class OpticsSettings:
    """The lens, distortion apart."""

    blur_px: float = setting(0.55, "sigma of the lens's own blur", unit="px", low=0, high=20)
    defocus_px: float = setting(0.0, "radius of the defocus disc", unit="px", low=0, high=40)
    vignetting: float = setting(0.18, "loss of light in the corners", low=0, high=0.95)


@dataclass(frozen=True)
class SensorSettings:
    """The sensor and the camera's own processing."""

    full_well_e: float = setting(
        18000.0, "electrons at saturation; fewer is noisier", unit="e", low=20, high=1e7
    )
    read_noise_e: float = setting(6.0, "read noise", unit="e", low=0, high=1e5)
    gain: float = setting(1.0, "brightening after exposure (low light needs it)", low=0.01, high=1000)
    noise: bool = setting(True, "photon and read noise")
    demosaic: str = setting(
        "malvar", "colour filter array; none: three sensors", choices=("none", "bilinear", "malvar")
    )
    white_balance_K: float = setting(
        5200.0, "colour temperature the camera assumes", unit="K", low=1500, high=20000
    )
    sharpening: float = setting(0.25, "the camera's own sharpening", low=0, high=3)


@dataclass(frozen=True)
class Bump:
    """A knock to the tripod: from this photo on the camera stands elsewhere."""

    photo: int = setting(0, "first photo after the knock, counted from 0", low=0)
    dx_mm: float = setting(0.0, "camera moves right", unit="mm")
    dy_mm: float = setting(0.0, "camera moves down", unit="mm")
    dz_mm: float = setting(0.0, "camera moves away from the board", unit="mm")
    yaw_deg: float = setting(0.0, "change of yaw", unit="deg")
    pitch_deg: float = setting(0.0, "change of pitch", unit="deg")
    roll_deg: float = setting(0.0, "change of roll", unit="deg")


@dataclass(frozen=True)
class Cover:
    """A strip of tape that hides a part of the dot, in one photo."""

    photo: int = setting(0, "the photo, counted from 0", low=0)
    fraction: float = setting(0.5, "hidden share of the dot's area", low=0, high=1)
    angle_deg: float = setting(0.0, "side it comes from (0 right, 90 down)", unit="deg")
    colour: str = setting("#b9a46c", "colour of the tape", colour=True)


@dataclass(frozen=True)
class RigShift:
    """The clamp slips: from this photo on the whole actuator hangs elsewhere."""

    photo: int = setting(0, "first photo after the slip, counted from 0", low=0)
    dx_mm: float = setting(0.0, "rightwards", unit="mm")
    dy_mm: float = setting(0.0, "downwards", unit="mm")


@dataclass(frozen=True)
class RenderSettings:
    """All settings of a set of photographs; the same settings give the same bytes."""

    seed: int = setting(1, "seed of every random number", low=0)
    image: ImageSettings = dataclasses.field(default_factory=ImageSettings)
    camera: CameraSettings = dataclasses.field(default_factory=CameraSettings)
    board: BoardSettings = dataclasses.field(default_factory=BoardSettings)
    actuator: ActuatorSettings = dataclasses.field(default_factory=ActuatorSettings)
    marker: MarkerSettings = dataclasses.field(default_factory=MarkerSettings)
    light: LightSettings = dataclasses.field(default_factory=LightSettings)
    clutter: ClutterSettings = dataclasses.field(default_factory=ClutterSettings)
    optics: OpticsSettings = dataclasses.field(default_factory=OpticsSettings)
    sensor: SensorSettings = dataclasses.field(default_factory=SensorSettings)
    bumps: tuple[Bump, ...] = ()
    covers: tuple[Cover, ...] = ()
    rig_shifts: tuple[RigShift, ...] = ()


EVENTS: dict[str, type] = {"bumps": Bump, "covers": Cover, "rig_shifts": RigShift}
"""The settings that are lists of events, and what each entry is."""


def check_settings(settings: RenderSettings) -> RenderSettings:
    """Return the settings unchanged, or raise `InputError` naming the first value out of range."""
    for name, value, field in walk(settings):
        check_value(name, value, field)
    if settings.image.bits == 16 and settings.image.format == "jpeg":
        raise InputError("image.bits: JPEG holds 8 bits a channel; choose image.format png or tiff for 16")
    if settings.camera.distance_mm <= settings.actuator.standoff_mm + 50:
        raise InputError("camera.distance_mm: the camera must stand at least 50 mm in front of the actuator")
    if settings.actuator.standoff_mm < settings.actuator.thickness_mm:
        raise InputError(
            "actuator.standoff_mm: smaller than actuator.thickness_mm, the body would cut the board"
        )
    if settings.marker.from_tip_mm >= settings.actuator.length_mm:
        raise InputError("marker.from_tip_mm: the dot must lie between clamp and tip")
    return settings


def walk(settings: RenderSettings) -> Iterator[tuple[str, Any, dataclasses.Field[Any]]]:
    """Yield (dotted name, value, field) of every single setting."""
    for field in dataclasses.fields(settings):
        value = getattr(settings, field.name)
        if field.name in EVENTS:
            for number, event in enumerate(value):
                for inner in dataclasses.fields(event):
                    yield f"{field.name}[{number}].{inner.name}", getattr(event, inner.name), inner
        elif dataclasses.is_dataclass(value):
            for inner in dataclasses.fields(value):
                yield f"{field.name}.{inner.name}", getattr(value, inner.name), inner
        else:
            yield field.name, value, field
