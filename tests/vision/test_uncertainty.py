"""Stated uncertainty against real errors: set-ups told with errors drawn from their own stated sigmas."""

from dataclasses import replace

import numpy as np
import pytest

from spavision.vision.track import observe_photos, track_observations

DRAWS = 40


@pytest.mark.slow
def test_the_95_percent_interval_holds_the_truth_about_that_often(tmp_path, render_variant):
    # As mrcal tests its own: noise, light and pose differ from seed to seed, and what the user measures is
    # off by its own standard uncertainty. Normalised errors of all components must be near one in the mean.
    random = np.random.default_rng(5)
    normalised = []
    for seed in range(4):
        rendered = render_variant(tmp_path / str(seed), seed)
        exact = rendered.track_settings(sigma_out_of_plane_mm=0.0)
        observations = observe_photos(rendered.paths, settings=exact)
        for _ in range(DRAWS):
            distance, standoff, scale = random.standard_normal(3)
            told = replace(
                exact,
                distance_mm=exact.distance_mm + distance * exact.sigma_distance_mm,
                standoff_mm=exact.standoff_mm + standoff * exact.sigma_standoff_mm,
                board_scale=1.0 + scale * exact.sigma_board_scale,
            )
            path = track_observations(observations, rendered.pressures_kPa, settings=told).tip_path
            error = np.column_stack([path.ux_mm, path.uy_mm]) - rendered.displacement_mm
            sigma = np.column_stack([path.sigma_ux_mm, path.sigma_uy_mm])
            normalised.append((error[1:] / sigma[1:]).ravel())
    pooled = np.concatenate(normalised)
    assert np.isfinite(pooled).all()
    assert 0.6 < np.sqrt(np.mean(pooled**2)) < 1.25
    assert 0.90 < np.mean(np.abs(pooled) < 1.96) < 0.998
