"""What the tracker makes of one set, against the truth."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from operator import ne

import numpy as np
from corners import CornerScore, score
from scenes import BenchmarkSet
from scipy.stats import norm, qmc
from truth import SetTruth

from spavision.tip_path import TipPath
from spavision.vision.observe import Observation
from spavision.vision.settings import TrackSettings
from spavision.vision.track import observe_photos, track_observations

DRAWS = 8
"""Set-ups told to the tracker, each a little wrong, from which the coverage of its intervals is found."""

WIDTH_95 = 1.96


@dataclass(frozen=True)
class SetScore:
    """What the tracker made of a set.

    ``errors_mm`` (n,) are lengths, one a reading but the reference; ``normalised`` holds the errors of single
    components over their stated sigma, over all draws; ``falsely_read`` counts readings where none can be,
    ``lost`` good photos without a reading, ``other_status`` photos whose status is not the expected one.
    """

    errors_mm: np.ndarray
    normalised: np.ndarray
    photos: int
    read: int
    falsely_read: int
    lost: int
    other_status: int
    corners: tuple[CornerScore, ...]
    seconds_per_megapixel: float
    cpu_seconds_per_megapixel: float

    @property
    def coverage(self) -> float:
        """Share of components whose 95 % interval holds the truth."""
        return float(np.mean(np.abs(self.normalised) < WIDTH_95)) if len(self.normalised) else float("nan")

    @property
    def corner_rms_px(self) -> float:
        """Root mean square length of the corners' errors."""
        errors = np.concatenate([corners.errors_px for corners in self.corners])
        return float(np.sqrt((errors**2).sum(axis=1).mean())) if len(errors) else float("nan")


def measure(benchmark: BenchmarkSet, truth: SetTruth) -> SetScore:
    """Track a set and compare."""
    settings = told(benchmark)
    paths = [photo.path for photo in truth.photos]
    pressures = [photo.pressure_kPa for photo in truth.photos]
    start, cpu = time.perf_counter(), time.process_time()
    observations = observe_photos(paths, settings=settings)
    result = track_observations(observations, pressures, settings=settings)
    seconds, cpu_seconds = time.perf_counter() - start, time.process_time() - cpu
    error = _errors_mm(result.tip_path, truth)
    measured = np.isfinite(error).all(axis=1)
    expected = np.array([status != "missing" for status in benchmark.expected_status])
    megapixels = truth.megapixels * len(paths)
    return SetScore(
        errors_mm=np.linalg.norm(_without_reference(error), axis=1),
        normalised=_normalised_errors(benchmark, truth, observations, pressures),
        photos=len(paths),
        read=int(measured.sum()),
        falsely_read=int((measured & ~expected).sum()),
        lost=int((~measured & expected).sum()),
        other_status=sum(map(ne, result.tip_path.status, benchmark.expected_status)),
        corners=tuple(
            score(truth, photo, reading.corners_px, reading.indices)
            for photo, reading in enumerate(result.readings)
        ),
        seconds_per_megapixel=seconds / megapixels,
        cpu_seconds_per_megapixel=cpu_seconds / megapixels,
    )


def told(benchmark: BenchmarkSet) -> TrackSettings:
    """What a careful user would say of the set-up."""
    marker, settings = benchmark.settings.marker, benchmark.settings
    settled = TrackSettings(
        square_mm=settings.board.square_mm,
        standoff_mm=settings.actuator.standoff_mm,
        distance_mm=settings.camera.distance_mm,
        marker_colour=marker.colour,
        base_marker_colour=marker.base_marker_colour if marker.base_marker else None,
        sigma_out_of_plane_mm=0.0,
    )
    return replace(settled, **benchmark.told)


def _normalised_errors(
    benchmark: BenchmarkSet, truth: SetTruth, observations: list[Observation], pressures: list[float]
) -> np.ndarray:
    """Errors over stated sigmas when the set-up is told with errors drawn from their own stated sigmas."""
    random = np.random.default_rng([benchmark.seed, *benchmark.name.encode()])
    # In strata: so few draws would else be far from the distributions that they stand for.
    draws = norm.ppf(qmc.LatinHypercube(3, rng=random).random(DRAWS))
    exact = told(benchmark)
    normalised = []
    for distance, standoff, scale in draws:
        settings = replace(
            exact,
            distance_mm=exact.distance_mm + distance * exact.sigma_distance_mm,
            standoff_mm=exact.standoff_mm + standoff * exact.sigma_standoff_mm,
            board_scale=1.0 + scale * exact.sigma_board_scale,
        )
        path = track_observations(observations, pressures, settings=settings).tip_path
        error = _without_reference(_errors_mm(path, truth))
        sigma = _without_reference(
            np.column_stack([path.sigma_ux_mm, path.sigma_uy_mm]), np.isfinite(path.ux_mm)
        )
        normalised.append((error / sigma).ravel())
    return np.concatenate(normalised)


def _errors_mm(path: TipPath, truth: SetTruth) -> np.ndarray:
    """Measured less true displacement, shape (photos, 2); NaN without a reading."""
    measured = np.column_stack([path.ux_mm, path.uy_mm])
    reference = int(np.flatnonzero(np.isfinite(measured).all(axis=1))[0])
    return measured - truth.displacement_mm(reference)


def _without_reference(values: np.ndarray, read: np.ndarray | None = None) -> np.ndarray:
    """Rows with a reading, but for the first of them, whose displacement is zero by definition."""
    rows = np.isfinite(values).all(axis=1) if read is None else read
    return values[np.flatnonzero(rows)[1:]]
