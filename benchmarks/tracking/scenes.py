"""Sets of rendered photographs that the tracker is measured on: each nuisance alone, then together.

The sets say what is in the photos and how well they ought to be read (the issue's figures); nothing here
is known to the tracker. A seed changes noise, paper, pose, aim and light of every set a little.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from spavision.render.scene_file import with_overrides
from spavision.render.settings import RenderSettings
from spavision.render.trajectory import Trajectory, sample_trajectory

PRESSURES_KPA = (0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 65.0)


@dataclass(frozen=True)
class Limits:
    """Largest error of a displacement that is allowed, in the marker's plane."""

    median_mm: float
    worst_mm: float


FINE = Limits(0.015, 0.04)
COARSE = Limits(0.04, 0.10)


@dataclass(frozen=True)
class Nuisance:
    """What sets one benchmark set apart: overrides of the renderer's settings, and the limits that hold.

    ``told`` overrides what the tracker is told of the set-up.
    """

    limits: Limits
    overrides: tuple[str, ...] = ()
    crimp_ratio: float = 0.3
    out_of_plane_mm: float = 0.0
    told: dict[str, object] = field(default_factory=dict)
    pressures_kPa: tuple[float, ...] = PRESSURES_KPA
    large: bool = False


SPLIT = ("clutter.cable=true",)
DISTRACTORS = ("clutter.red_cable=true", "clutter.red_sticker=true", "clutter.red_bolt=true")
OBLIQUE = ("camera.yaw_deg=20", "camera.pitch_deg=-15")
BARREL = (
    "camera.distance_mm=600",
    "camera.k1=-0.45",
    "camera.k2=0.2",
    "camera.p1=0.001",
    "camera.p2=-0.0008",
)
KNOCKS = (
    "bumps=[{photo=2, dx_mm=7.0, dy_mm=-4.0, roll_deg=0.4},"
    " {photo=4, dx_mm=-12.0, yaw_deg=0.8},"
    " {photo=6, dy_mm=9.0, dz_mm=6.0, pitch_deg=-0.6}]",
)
OFTEN_BUMPED = (
    "bumps=[{photo=1, dx_mm=8.0, dy_mm=5.0}, {photo=2, dx_mm=-6.0, dy_mm=7.0, roll_deg=-0.5},"
    " {photo=3, dy_mm=-10.0, yaw_deg=0.5}, {photo=4, dx_mm=11.0, dz_mm=-5.0},"
    " {photo=5, dx_mm=-9.0, dy_mm=-4.0}, {photo=6, dx_mm=3.0, dy_mm=10.0, pitch_deg=0.4},"
    " {photo=7, dx_mm=-12.0, dy_mm=-6.0}]",
)
HALF_COVERS = (
    "covers=[{photo=2, fraction=0.4, angle_deg=100}, {photo=4, fraction=0.5, angle_deg=200},"
    " {photo=6, fraction=0.5, angle_deg=320}]",
)
HIDDEN_PHOTOS = "covers=[{photo=2, fraction=1.0}, {photo=3, fraction=1.0}, {photo=6, fraction=1.0}]"
LOW_CONTRAST = ("board.white=0.42", "board.black=0.22")
NOISE = ("sensor.full_well_e=700", "sensor.read_noise_e=12")
HARD_SHADOW = (
    "light.size=0.02",
    "light.shadow=0.75",
    "light.edge_shadow=0.6",
    "light.edge_softness_mm=0.5",
)
BASE_MARKER = ("marker.base_marker=true", "rig_shifts=[{photo=3, dx_mm=1.5, dy_mm=0.8}]")

NUISANCES: dict[str, Nuisance] = {
    "clean": Nuisance(FINE),
    "clean-0.20": Nuisance(FINE, ("actuator.crimp_ratio=0.2",), crimp_ratio=0.2),
    "oblique": Nuisance(FINE, OBLIQUE),
    "oblique-other-way": Nuisance(FINE, ("camera.yaw_deg=-25", "camera.pitch_deg=2")),
    "oblique-from-above": Nuisance(FINE, ("camera.yaw_deg=4", "camera.pitch_deg=-25")),
    "distorted": Nuisance(FINE, BARREL),
    "tangential": Nuisance(FINE, ("camera.p1=0.004", "camera.p2=-0.003")),
    "pincushion": Nuisance(FINE, ("camera.k1=0.2", "camera.k3=0.05", "camera.p1=-0.001")),
    "bumped": Nuisance(FINE, KNOCKS),
    "bumped-often": Nuisance(FINE, OFTEN_BUMPED),
    "cluttered": Nuisance(FINE, (*SPLIT, *DISTRACTORS)),
    "cable": Nuisance(FINE, SPLIT),
    "red-cable": Nuisance(FINE, ("clutter.red_cable=true",)),
    "red-sticker": Nuisance(FINE, ("clutter.red_sticker=true",)),
    "red-bolt": Nuisance(FINE, ("clutter.red_bolt=true",)),
    "cut-left": Nuisance(FINE, ("camera.square_px=12", "camera.aim_x_mm=30", "camera.aim_y_mm=0")),
    "cut-right": Nuisance(FINE, ("camera.square_px=12", "camera.aim_x_mm=-30", "camera.aim_y_mm=0")),
    "cut-top": Nuisance(FINE, ("camera.square_px=11", "camera.aim_y_mm=40")),
    "cut-bottom": Nuisance(FINE, ("camera.square_px=9", "camera.aim_y_mm=-20")),
    "cut-all-round": Nuisance(FINE, ("camera.square_px=20", "camera.aim_x_mm=30", "camera.aim_y_mm=50")),
    "middle-hidden": Nuisance(FINE, ("actuator.body_mm=45", "actuator.composite_mm=15")),
    "base-marker": Nuisance(FINE, BASE_MARKER),
    "blue-marker": Nuisance(FINE, ('marker.colour="blue"',)),
    "yellow-marker": Nuisance(FINE, ('marker.colour="yellow"',)),
    "sampled-marker": Nuisance(
        FINE, ('marker.colour="#c2452d"', "light.temperature_K=4300"), told={"marker_colour": "#c2452d"}
    ),
    "large-marker": Nuisance(FINE, ("marker.diameter_mm=7.0",)),
    "known-diameter": Nuisance(FINE, told={"marker_diameter_mm": 4.5}),
    "vignetting": Nuisance(FINE, ("optics.vignetting=0.55",)),
    "soft-shadow": Nuisance(FINE, ("light.size=0.8", "light.shadow=0.7")),
    **{f"orientation-{tag}": Nuisance(FINE, (f"image.orientation={tag}",)) for tag in range(2, 9)},
    "png": Nuisance(FINE, ('image.format="png"',)),
    "png-16": Nuisance(FINE, ('image.format="png"', "image.bits=16", "image.orientation=5")),
    "tiff-16": Nuisance(FINE, ('image.format="tiff"', "image.bits=16")),
    "grey-16": Nuisance(FINE, (*LOW_CONTRAST, 'image.format="png"', "image.bits=16")),
    "out-of-plane": Nuisance(COARSE, out_of_plane_mm=0.5, told={"sigma_out_of_plane_mm": 0.35}),
    "hard-shadow": Nuisance(COARSE, HARD_SHADOW),
    "noisy": Nuisance(COARSE, NOISE),
    "defocused": Nuisance(COARSE, ("optics.defocus_px=2.5",)),
    "small-squares": Nuisance(COARSE, ("camera.square_px=7",)),
    "low-light": Nuisance(COARSE, ("light.level=0.05", "sensor.gain=14")),
    "dark": Nuisance(COARSE, ("light.level=0.1",)),
    "warm": Nuisance(COARSE, ("light.temperature_K=2900",)),
    "cold": Nuisance(COARSE, ("light.temperature_K=10000",)),
    "fringes": Nuisance(COARSE, ('sensor.demosaic="bilinear"',)),
    "low-contrast": Nuisance(COARSE, LOW_CONTRAST),
    "poor-jpeg": Nuisance(COARSE, ("image.quality=50",)),
    "highlight": Nuisance(COARSE, ("marker.highlight=0.9",)),
    "half-hidden": Nuisance(COARSE, ("covers=[{photo=3, fraction=0.5, angle_deg=30}]",)),
    "half-hidden-often": Nuisance(COARSE, HALF_COVERS),
    "hidden": Nuisance(FINE, ("covers=[{photo=3, fraction=1.0}, {photo=5, fraction=1.0}]",)),
    "hidden-among-red": Nuisance(FINE, ("covers=[{photo=3, fraction=1.0}]", *DISTRACTORS)),
    "hidden-often-among-red": Nuisance(FINE, (HIDDEN_PHOTOS, *DISTRACTORS, *SPLIT)),
    "together": Nuisance(
        COARSE,
        (
            *("camera.yaw_deg=10", "camera.pitch_deg=-8", "camera.k1=-0.25", *SPLIT, *DISTRACTORS, *KNOCKS),
            *("sensor.full_well_e=4000", "optics.defocus_px=1.0", "light.temperature_K=4000"),
            "covers=[{photo=5, fraction=1.0}]",
        ),
    ),
    "one-megapixel": Nuisance(FINE, ("image.width_px=1152", "image.height_px=864", "camera.square_px=9")),
    "40-px-squares": Nuisance(
        FINE,
        (
            *("image.width_px=2400", "image.height_px=1800", "camera.square_px=40"),
            *("camera.aim_x_mm=32", "camera.aim_y_mm=55"),
        ),
        pressures_kPa=(0.0, 30.0, 40.0, 65.0),
    ),
    "24-megapixels": Nuisance(
        FINE,
        ("image.width_px=6000", "image.height_px=4000", "camera.square_px=40"),
        pressures_kPa=(0.0, 20.0, 40.0, 65.0),
        large=True,
    ),
}


@dataclass(frozen=True)
class BenchmarkSet:
    """One set to render and track.

    ``expected_status`` gives, a photo, what an honest tracker says: ``missing`` where the dot is covered,
    ``partial`` where a good part of it is, else ``ok``. ``told`` is what the tracker is told otherwise than
    the settings say.
    """

    name: str
    seed: int
    settings: RenderSettings
    trajectory: Trajectory
    limits: Limits
    expected_status: tuple[str, ...]
    told: dict[str, object]


def benchmark_sets(
    names: tuple[str, ...] = (), *, seeds: tuple[int, ...] = (1,), large: bool = False
) -> Iterator[BenchmarkSet]:
    """Yield the sets of the given names (all if none is given), each with the given seeds.

    Sets of very large photos come only when named or when ``large`` asks for them.
    """
    unknown = set(names) - set(NUISANCES)
    if unknown:
        raise SystemExit(f"no set called {', '.join(sorted(unknown))}; there are {', '.join(NUISANCES)}")
    for name, nuisance in NUISANCES.items():
        if name in names or (not names and (large or not nuisance.large)):
            for seed in seeds:
                yield _benchmark_set(name, nuisance, seed)


def _benchmark_set(name: str, nuisance: Nuisance, seed: int) -> BenchmarkSet:
    settings = _varied(with_overrides(RenderSettings(), nuisance.overrides), name, seed)
    pressures = np.array(nuisance.pressures_kPa)
    path = sample_trajectory(nuisance.crimp_ratio, pressures)
    swing = nuisance.out_of_plane_mm * np.sin(np.pi * pressures / pressures[-1])
    statuses = ["ok"] * len(path)
    for cover in settings.covers:
        statuses[cover.photo] = "missing" if cover.fraction >= 1 else "partial"
    return BenchmarkSet(
        name=name,
        seed=seed,
        settings=settings,
        trajectory=replace(path, uz_mm=swing),
        limits=nuisance.limits,
        expected_status=tuple(statuses),
        told=nuisance.told,
    )


def _varied(settings: RenderSettings, name: str, seed: int) -> RenderSettings:
    """Return the settings with pose, aim and light moved a little, differently in every set and seed."""
    random = np.random.default_rng([seed, *name.encode()])
    turn = random.uniform(-1.0, 1.0, 3).tolist()
    shift = random.uniform(-3.0, 3.0, 2).tolist()
    lamp = random.uniform(-0.1, 0.1, 2).tolist()
    camera, light = settings.camera, settings.light
    camera = replace(
        camera,
        yaw_deg=camera.yaw_deg + turn[0],
        pitch_deg=camera.pitch_deg + turn[1],
        roll_deg=camera.roll_deg + turn[2],
        aim_x_mm=camera.aim_x_mm + shift[0],
        aim_y_mm=camera.aim_y_mm + shift[1],
    )
    light = replace(light, from_x=light.from_x + lamp[0], from_y=light.from_y + lamp[1])
    return replace(settings, seed=1000 * seed + int(random.integers(1000)), camera=camera, light=light)
