"""Rendered sets of photographs, each made once a session."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from spavision.render.render import PhotoTruth, render_photo
from spavision.render.settings import Bump, Cover, RenderSettings
from spavision.render.trajectory import sample_trajectory
from spavision.vision.settings import TrackSettings


@dataclass(frozen=True)
class RenderedSet:
    """Files, pressures and truth of a set of photographs."""

    paths: list[Path]
    pressures_kPa: np.ndarray
    truth: list[PhotoTruth]
    settings: RenderSettings

    @property
    def displacement_mm(self):
        """True displacement of the dot in its plane, from the first photo, shape (n, 2)."""
        dots = np.array([truth.dot_mm[:2] for truth in self.truth])
        return dots - dots[0]

    def track_settings(self, **options):
        """What a careful user would say of the set-up."""
        told = {
            "standoff_mm": self.settings.actuator.standoff_mm,
            "distance_mm": self.settings.camera.distance_mm,
        }
        return TrackSettings(**(told | options))


def choose(settings: RenderSettings, **groups) -> RenderSettings:
    """Replace values inside groups of settings."""
    for name, values in groups.items():
        new = replace(getattr(settings, name), **values) if isinstance(values, dict) else values
        settings = replace(settings, **{name: new})
    return settings


def render_set(folder: Path, settings: RenderSettings, pressures_kPa) -> RenderedSet:
    """Render a set of the crimp ratio 0.3 into a folder, as JPEG."""
    pressures = np.asarray(pressures_kPa, dtype=float)
    trajectory = sample_trajectory(0.3, pressures)
    paths, truth = [], []
    for photo, pressure in enumerate(pressures):
        rendered = render_photo(settings, trajectory, photo)
        paths.append(folder / f"IMG_{photo:04d}_{pressure:03.0f}kPa.jpg")
        Image.fromarray(rendered.pixels).save(paths[-1], quality=settings.image.quality)
        truth.append(rendered.truth)
    return RenderedSet(paths, pressures, truth, settings)


SMALL = choose(
    RenderSettings(seed=7),
    image={"width_px": 640, "height_px": 560},
    camera={"square_px": 8.0, "aim_x_mm": 25.0, "aim_y_mm": 20.0},
)
"""A board of 104 squares of 8 px, cut by the frame."""


@pytest.fixture(scope="session")
def plain_set(tmp_path_factory):
    """Three photos from an unmoved, near-frontal camera; the dot of the second is hidden."""
    settings = choose(SMALL, covers=(Cover(photo=1, fraction=1.0),))
    return render_set(tmp_path_factory.mktemp("plain"), settings, (0, 20, 40))


@pytest.fixture(scope="session")
def hard_set(tmp_path_factory):
    """Three photos: tilted, barrel distortion, clutter, a bumped camera, noise, a half-hidden dot."""
    settings = choose(
        SMALL,
        image={"width_px": 760, "height_px": 640},
        camera={"yaw_deg": 14.0, "pitch_deg": -12.0, "k1": -0.3, "p1": 0.001},
        clutter={"cable": True, "red_cable": True, "red_sticker": True, "red_bolt": True},
        sensor={"full_well_e": 5000.0},
        light={"temperature_K": 3200.0, "size": 0.05},
        bumps=(Bump(photo=1, dx_mm=7.0, dy_mm=-3.0, yaw_deg=0.2),),
        covers=(Cover(photo=2, fraction=0.4, angle_deg=60.0),),
    )
    return render_set(tmp_path_factory.mktemp("hard"), settings, (0, 15, 40))


@pytest.fixture
def render_variant():
    """Render four photos of the small board with noise, light and pose that differ from seed to seed."""

    def render(folder: Path, seed: int) -> RenderedSet:
        folder.mkdir(parents=True)
        random = np.random.default_rng(seed)
        yaw, pitch = random.uniform(-8.0, 8.0, 2).tolist()
        settings = choose(
            replace(SMALL, seed=100 + seed),
            camera={"yaw_deg": yaw, "pitch_deg": pitch},
            sensor={"full_well_e": float(random.choice([1500.0, 6000.0, 18000.0]))},
        )
        return render_set(folder, settings, (0, 15, 30, 45))

    return render
