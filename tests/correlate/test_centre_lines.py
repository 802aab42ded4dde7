"""Bend angle and distance of centre lines, on arcs of circles whose geometry is known."""

import numpy as np
import pytest

from spavision.correlate.centre_lines import CentreLine, compare_centre_lines, distances_mm

LENGTH_MM = 157.5


def _arc(angle_deg, *, points=51, pressure_kPa=10.0, start=(0.0, -150.0)):
    """A hanging arc of constant curvature that turns by ``angle_deg`` over its length."""
    turn = np.radians(angle_deg)
    along = np.linspace(0.0, 1.0, points)
    radius = LENGTH_MM / turn
    x, y = radius * (1.0 - np.cos(turn * along)), radius * np.sin(turn * along)
    return CentreLine(pressure_kPa, np.column_stack([x, y]) + start)


@pytest.mark.parametrize("angle_deg", [-140.0, -30.0, 5.0, 60.0, 95.0])
@pytest.mark.parametrize("points", [51, 61, 200])
def test_the_bend_angle_of_an_arc_is_its_turn(angle_deg, points):
    assert _arc(angle_deg, points=points).bend_angle_deg == pytest.approx(angle_deg, abs=0.3)
    assert _arc(angle_deg, points=points).length_mm == pytest.approx(LENGTH_MM, rel=2e-3)


def test_waves_of_a_void_hardly_turn_the_angle():
    line = _arc(40.0, points=400)
    arc = np.linspace(0.0, LENGTH_MM, 400)
    heading = np.radians(40.0) * arc / LENGTH_MM
    rightward = np.column_stack([np.cos(heading), -np.sin(heading)])
    waved = CentreLine(10.0, line.points_mm + 0.2 * np.sin(2 * np.pi * arc / 10.5)[:, None] * rightward)
    # The end tangent of the wave itself is off by 0.2 · 2π / 10.5 rad, 6.9 degrees.
    assert waved.bend_angle_deg == pytest.approx(40.0, abs=1.5)


def test_concentric_arcs_are_as_far_apart_as_their_radii():
    turn = np.radians(np.linspace(0.0, 90.0, 91))
    inner, outer = (r * np.column_stack([np.cos(turn), np.sin(turn)]) for r in (50.0, 53.0))
    assert distances_mm(outer, inner) == pytest.approx(3.0, abs=2e-3)


def test_lines_are_compared_at_equal_pressures_alone():
    measured = [_arc(20.0, pressure_kPa=20.0), _arc(10.0, pressure_kPa=10.0), _arc(30.0, pressure_kPa=30.0)]
    modelled = [_arc(12.0, pressure_kPa=10.0), _arc(25.0, pressure_kPa=20.0), _arc(40.0, pressure_kPa=35.0)]
    found = compare_centre_lines(measured, modelled)
    assert found.pressure_kPa.tolist() == [10.0, 20.0]
    assert found.angle_error_deg == pytest.approx([2.0, 5.0], abs=0.1)
    # The tips of two arcs of 10 and 12 degrees from one clamp: (1 − cos θ) L/θ apart, 2.72 mm, in x.
    assert found.largest_distance_mm[0] == pytest.approx(2.72, abs=0.05)
    assert compare_centre_lines(measured, [_arc(1.0, pressure_kPa=99.0)]) is None
