"""Stated uncertainty against the scatter of synthetic measurements, a source of the distance at a time."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from spavision.vision.budget import SetUp, uncertainty_budget
from spavision.vision.bundle import parameter_values
from spavision.vision.camera import Camera, Pose, project
from spavision.vision.camera_variants import camera_with, one_sigma_cameras
from spavision.vision.circle import Circle
from spavision.vision.displacement import Place, fit_place, rim_in_plane
from spavision.vision.scale import CameraFit, fit_camera
from spavision.vision.settings import TrackSettings
from spavision.vision.stations import Stations

SIZE = (1280, 960)
CAMERA = Camera(3000.0, 3000.0, 645.0, 472.0, (-0.12, 0.05, 0.0005, -0.0003, 0.0), *SIZE)
POSE = Pose((0.05, -0.06, 0.01), (-75.0, -70.0, 750.0))
STANDOFF_MM = 20.0
DOTS_MM = np.array([[70.0, 120.0], [135.0, 60.0]])
"""The marker at rest and bent, in its plane."""

CORNER_SIGMA_PX = 0.04
DRAWS = 24


def _covariance() -> np.ndarray:
    """A calibration's: focal lengths hang together, and with the principal point."""
    sigma = np.array([9.0, 9.0, 6.0, 6.0, 0.01, 0.05, 0.0005, 0.0005, 0.02])
    correlation = np.eye(9)
    correlation[0, 1] = correlation[1, 0] = 0.98
    correlation[0, 2] = correlation[2, 0] = 0.3
    correlation[1, 2] = correlation[2, 1] = 0.3
    correlation[4, 5] = correlation[5, 4] = -0.9
    return correlation * np.outer(sigma, sigma)


@dataclass(frozen=True)
class _Scene:
    """What one draw of the camera's noise shows: the board's corners and the marker's rims."""

    stations: Stations
    rims_px: tuple[np.ndarray, ...]

    def fit(self, settings: TrackSettings, focal_px: float | None) -> CameraFit:
        return fit_camera(self.stations, settings, SIZE, focal_px)

    def places(self, fit: CameraFit, standoff_mm: float) -> list[Place]:
        places = []
        for rim in self.rims_px:
            fitted = fit_place(rim_in_plane(fit, 0, rim, standoff_mm), None)
            assert fitted is not None
            circle: Circle = fitted[0]
            centre = np.array([[*circle.centre, -standoff_mm]])
            pixel = project(fit.adjustment.camera, fit.adjustment.poses[0], centre)[0]
            places.append(Place(circle, 0, pixel, False, rim))
        return places


def _scene(random: np.random.Generator) -> _Scene:
    indices = np.stack(np.meshgrid(np.arange(0, 62, 3), np.arange(0, 58, 3)), axis=-1).reshape(-1, 2)
    corners = project(CAMERA, POSE, indices * 2.5)
    corners += random.normal(0.0, CORNER_SIGMA_PX, corners.shape)
    angle = np.linspace(0.0, 2.0 * np.pi, 96, endpoint=False)
    ring = 2.25 * np.column_stack([np.cos(angle), np.sin(angle)])
    rims = tuple(
        project(CAMERA, POSE, np.column_stack([dot + ring, np.full(96, -STANDOFF_MM)])) for dot in DOTS_MM
    )
    nothing = np.zeros((1, 2), dtype=np.intp)
    return _Scene(Stations(np.zeros(1, dtype=np.intp), nothing, np.zeros(1), (indices,), (corners,)), rims)


def _told(source: str, random: np.random.Generator) -> tuple[TrackSettings, float | None]:
    """What a user says of the set-up, one thing off by its own stated uncertainty; EXIF's focal length."""
    error = float(random.standard_normal())
    settings = TrackSettings(standoff_mm=STANDOFF_MM)
    if source == "exif":
        # Focus near enlarges the focal length by the magnification: 36 mm of sensor over its view.
        at_infinity = CAMERA.fx / (1.0 + CAMERA.fx / POSE.distance_mm * 36.0 / max(SIZE))
        return settings, at_infinity * (1.0 + 0.07 * error)
    if source == "calibration":
        covariance = _covariance()
        drawn = camera_with(CAMERA, random.multivariate_normal(parameter_values(CAMERA), covariance))
        return replace(settings, camera=drawn, camera_covariance=covariance), None
    wrong = {
        "distance": {"distance_mm": POSE.distance_mm + error * settings.sigma_distance_mm},
        "stand-off": {"standoff_mm": STANDOFF_MM + error * settings.sigma_standoff_mm},
        "print scale": {"board_scale": 1.0 + error * settings.sigma_board_scale},
    }
    return replace(settings, **{"distance_mm": POSE.distance_mm, **wrong[source]}), None


@pytest.mark.parametrize("source", ["calibration", "distance", "exif", "stand-off", "print scale"])
def test_displacements_scatter_as_the_budget_states(source: str) -> None:
    # As mrcal tests its own, without a renderer: the truth is the scene's, and one source at a time is wrong.
    # The rims are exact, so the marker's share of the budget is left out.
    random = np.random.default_rng(11)
    own = "distance" if source == "exif" else source
    normalised = []
    for _ in range(DRAWS):
        scene = _scene(random)
        settings, focal_px = _told(source, random)
        fit = scene.fit(settings, focal_px)
        reference, bent = scene.places(fit, settings.standoff_mm)
        error = bent.circle.centre - reference.circle.centre - (DOTS_MM[1] - DOTS_MM[0])
        budget = uncertainty_budget([reference, bent], reference, SetUp(fit, settings, settings.standoff_mm))
        sigma = {entry.name: np.array([entry.sigma_ux_mm[1], entry.sigma_uy_mm[1]]) for entry in budget}
        assert sigma[own].max() > 0.008
        normalised.append(error / np.hypot(sigma[own], sigma["corners and camera"]))
    # The two components move together: some 24 independent draws, whose rms scatters by 14 %.
    assert 0.7 < np.sqrt(np.mean(np.square(normalised))) < 1.3


def test_one_sigma_cameras_rebuild_the_covariance() -> None:
    covariance = _covariance()
    covariance[8], covariance[:, 8] = 0.0, 0.0  # k3 held fixed
    steps = [
        np.subtract(parameter_values(camera), parameter_values(CAMERA))
        for camera in one_sigma_cameras(CAMERA, covariance)
    ]
    assert len(steps) == 8
    np.testing.assert_allclose(sum(np.outer(s, s) for s in steps), covariance, atol=1e-9 * 81.0)


def test_a_calibrated_camera_without_covariance_is_said_to_be_taken_for_exact() -> None:
    scene = _scene(np.random.default_rng(3))
    settings = TrackSettings(camera=CAMERA, standoff_mm=STANDOFF_MM)
    fit = scene.fit(settings, None)
    places = scene.places(fit, STANDOFF_MM)
    budget = uncertainty_budget(places, places[0], SetUp(fit, settings, STANDOFF_MM))
    entry = next(entry for entry in budget if entry.name == "calibration")
    assert entry.sigma_ux_mm[1] == 0.0
    assert "exact" in entry.basis


def test_in_the_boards_plane_the_stand_off_adds_nothing() -> None:
    scene = _scene(np.random.default_rng(3))
    settings = TrackSettings(distance_mm=POSE.distance_mm)
    fit = scene.fit(settings, None)
    places = scene.places(fit, 0.0)
    budget = uncertainty_budget(places, places[0], SetUp(fit, settings, 0.0))
    entry = next(entry for entry in budget if entry.name == "stand-off")
    assert entry.sigma_ux_mm[1] == 0.0
    assert "board's plane" in entry.basis
