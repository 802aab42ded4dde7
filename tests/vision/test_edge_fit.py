"""The line fitted to both edges: against circles, beside swelling walls, and its stated uncertainty."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from spavision.vision.centre_line import STATIONS, CentreLine, line_through
from spavision.vision.edge_fit import (
    HEADING_SIGMA_RAD,
    SYSTEMATIC_MM,
    SYSTEMATIC_STATIONS,
    Edge,
    fit_edges,
)

RADIUS_MM = 120.0
LENGTH_MM = 150.0
DRAWS = 30


def _arc_points(count: int) -> np.ndarray:
    """Points of a circle that starts at (3, 5) straight down and turns to the right."""
    angle = np.linspace(0.0, LENGTH_MM / RADIUS_MM, count)
    return np.array([3.0, 5.0]) + RADIUS_MM * np.column_stack([1.0 - np.cos(angle), np.sin(angle)])


def _distances_to_circle(line: CentreLine) -> np.ndarray:
    centre = np.array([3.0 + RADIUS_MM, 5.0])
    return np.linalg.norm(line.points_mm - centre, axis=1) - RADIUS_MM


def _edges_of_circle(line: CentreLine, half_width_mm: float) -> tuple[Edge, Edge]:
    """Cross the line's normals with the two circles that are the arc's edges."""
    to_centre = np.array([3.0 + RADIUS_MM, 5.0]) - line.points_mm
    along = (to_centre * line.rightward).sum(axis=1)
    off = (to_centre**2).sum(axis=1) - along**2
    distances = [along - np.sqrt((RADIUS_MM + side * half_width_mm) ** 2 - off) for side in (1.0, -1.0)]
    weight = np.ones(STATIONS)
    return Edge(-distances[0], weight), Edge(distances[1], weight)


def test_fit_moves_a_wrong_line_onto_the_circle() -> None:
    wrong = _arc_points(60) + np.column_stack([np.linspace(-1.0, 2.0, 60), np.zeros(60)])
    line = line_through(wrong, 11.0)
    for _ in range(4):
        fit = fit_edges(line, *_edges_of_circle(line, 13.0))
        line = fit.line
    assert np.abs(_distances_to_circle(line)).max() < 0.02
    assert np.allclose(line.curvature_per_mm, 1.0 / RADIUS_MM, atol=2e-4)
    assert np.allclose(line.half_width_mm, 13.0, atol=0.02)
    assert np.nanmax(np.abs(fit.residuals_mm)) < 0.02


def test_outliers_and_gaps_in_one_edge_do_not_move_the_line() -> None:
    line = line_through(_arc_points(60), 13.0)
    left, right = _edges_of_circle(line, 13.0)
    spoilt = left.distance_mm.copy()
    spoilt[40:50] += 2.0
    spoilt[90:130] = np.nan
    fitted = fit_edges(line, Edge(spoilt, left.weight), right).line
    assert np.abs(_distances_to_circle(fitted)).max() < 0.03


def test_a_swelling_edge_seen_only_over_every_other_square_does_not_bend_the_line() -> None:
    line = line_through(_arc_points(60), 13.0)
    left, right = _edges_of_circle(line, 13.0)
    swelling = 0.3 * np.cos(2.0 * np.pi * line.arc_mm / 10.5)
    seen = np.sin(2.0 * np.pi * line.arc_mm / 9.0) > 0
    half = np.where(seen, left.distance_mm + swelling, np.nan)
    fit = fit_edges(line, Edge(half, left.weight), Edge(right.distance_mm + swelling, right.weight))
    assert np.abs(_distances_to_circle(fit.line)).max() < 0.03
    assert abs(fit.line.heading_rad[-1] - line.heading_rad[-1]) < np.radians(0.15)


def _uneven_edges(base: CentreLine, true: CentreLine, random: np.random.Generator) -> list[Edge]:
    """Edges of a body along one line as measured from another, noisy, and uneven over longer stretches."""
    away = ((true.points_mm - base.points_mm) * base.rightward).sum(axis=1)
    edges = []
    for sign in (-1.0, 1.0):
        steps = random.normal(0.0, SYSTEMATIC_MM, STATIONS // SYSTEMATIC_STATIONS + 1)
        noise = np.repeat(steps, SYSTEMATIC_STATIONS)[:STATIONS] + random.normal(0.0, 0.07, STATIONS)
        edges.append(Edge(13.0 + sign * away + noise, np.ones(STATIONS)))
    return edges


def test_stated_uncertainty_of_heading_and_place_is_that_of_uneven_bodies() -> None:
    # Bodies whose curvature is as uneven, and whose edges are as rough, as the fit assumes beforehand.
    random = np.random.default_rng(4)
    base = line_through(_arc_points(60), 13.0)
    ripple = np.nan_to_num(np.array(HEADING_SIGMA_RAD), posinf=0.01)
    headings, places = [], []
    for _ in range(DRAWS):
        true = replace(base, heading=base.heading * [1, 1, 1, 0, 0, 0, 0] + random.normal(0.0, ripple))
        fit = fit_edges(base, *_uneven_edges(base, true, random))
        across = ((fit.line.points_mm - true.points_mm) * base.rightward).sum(axis=1)
        headings.append((fit.line.heading_rad[-1] - true.heading_rad[-1]) / fit.sigma_heading_rad[-1])
        places.append(across[::20] / fit.sigma_across_mm[::20])
    assert 0.7 < np.sqrt(np.mean(np.square(headings))) < 1.3
    assert 0.7 < np.sqrt(np.mean(np.square(places))) < 1.3
