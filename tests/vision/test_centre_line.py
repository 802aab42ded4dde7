"""The centre line against circles, and which edge of a thick body a camera sees, against geometry."""

from __future__ import annotations

import numpy as np
import pytest

from spavision.vision.camera import Pose
from spavision.vision.centre_line import CentreLine, line_through
from spavision.vision.sight import line_of_sight

RADIUS_MM = 120.0
LENGTH_MM = 150.0


def _arc_points(count: int) -> np.ndarray:
    """Points of a circle that starts at (3, 5) straight down and turns to the right."""
    angle = np.linspace(0.0, LENGTH_MM / RADIUS_MM, count)
    return np.array([3.0, 5.0]) + RADIUS_MM * np.column_stack([1.0 - np.cos(angle), np.sin(angle)])


def _distances_to_circle(line: CentreLine) -> np.ndarray:
    centre = np.array([3.0 + RADIUS_MM, 5.0])
    return np.linalg.norm(line.points_mm - centre, axis=1) - RADIUS_MM


def test_line_through_points_of_a_circle_keeps_its_curvature() -> None:
    line = line_through(_arc_points(60), 13.0)
    assert np.abs(_distances_to_circle(line)).max() < 0.05
    assert np.degrees(line.heading_rad[-1]) == pytest.approx(np.degrees(LENGTH_MM / RADIUS_MM), abs=0.5)


def test_trimmed_line_is_a_part_of_the_line() -> None:
    line = line_through(_arc_points(60), 13.0)
    part = line.trimmed(-2.0, 100.0)
    assert part.length_mm == pytest.approx(102.0)
    assert np.abs(_distances_to_circle(part)).max() < 0.05
    assert np.linalg.norm(part.points_mm[0] - line.points_mm[0]) == pytest.approx(2.0, abs=0.01)


def test_camera_sees_the_rear_edge_where_the_side_wall_faces_it() -> None:
    # Camera 700 mm before the board, foot at the origin; side face 20 mm, rear face 5 mm before the board.
    sight = line_of_sight(Pose((0.0, 0.0, 0.0), (0.0, 0.0, 700.0)), standoff_mm=20.0, body_width_mm=15.0)
    edge = np.array([[100.0, 0.0], [100.0, 0.0]])
    outward = np.array([[1.0, 0.0], [-1.0, 0.0]])
    seen = sight.seen_at(edge, outward)
    assert seen[0, 0] == pytest.approx(100.0 * 700.0 / 680.0)
    assert seen[1, 0] == pytest.approx(100.0 * 700.0 / 695.0)
    np.testing.assert_allclose(sight.touched_at(seen, outward), edge)
