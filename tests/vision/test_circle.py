"""Circles through edge points: exact ones, noisy ones, half ones."""

import numpy as np
import pytest

from spavision.vision.circle import fit_circle


def ring(n, centre, radius, start=0.0, end=2 * np.pi):
    angle = np.linspace(start, end, n, endpoint=False)
    return np.array(centre) + radius * np.column_stack([np.cos(angle), np.sin(angle)])


def test_an_exact_circle_is_found_exactly():
    circle = fit_circle(ring(96, (3.0, -7.0), 2.25))
    np.testing.assert_allclose(circle.centre, (3.0, -7.0), atol=1e-9)
    assert circle.radius == pytest.approx(2.25, abs=1e-9)
    assert circle.coverage == 1.0


def test_the_stated_covariance_matches_the_scatter():
    # 300 noisy rims: the mean square error of the centre against the mean stated variance.
    random = np.random.default_rng(1)
    circles = [fit_circle(ring(96, (0, 0), 2.0) + random.normal(0, 0.02, (96, 2))) for _ in range(300)]
    scatter = np.mean([circle.centre**2 for circle in circles], axis=0)
    stated = np.mean([np.diag(circle.covariance) for circle in circles], axis=0)
    np.testing.assert_allclose(scatter, stated, rtol=0.35)


def test_a_known_radius_finds_the_centre_behind_a_straight_cover():
    # The lower half is cut off by a straight edge, whose points lie on a chord.
    arc = ring(48, (0, 0), 2.0, np.pi, 2 * np.pi)
    chord = np.column_stack([np.linspace(1.9, -1.9, 48), np.zeros(48)])
    circle = fit_circle(np.concatenate([arc, chord]), radius=2.0)
    np.testing.assert_allclose(circle.centre, (0, 0), atol=0.01)
    assert 0.4 < circle.coverage < 0.65


def test_outliers_and_missing_rays_do_not_pull():
    points = ring(96, (1, 1), 2.0)
    points[:20] *= 1.4
    points[30:36] = np.nan
    circle = fit_circle(points)
    np.testing.assert_allclose(circle.centre, (1, 1), atol=1e-3)


def test_too_few_points_give_nothing():
    assert fit_circle(ring(7, (0, 0), 1.0)) is None
    assert fit_circle(np.full((96, 2), np.nan)) is None
