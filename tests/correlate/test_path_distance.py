"""Discrete Fréchet distance on paths whose answer is plain."""

import numpy as np
import pytest

from spavision.correlate.path_distance import discrete_frechet_mm

from .paths import make_path


def test_parallel_paths_are_as_far_apart_as_their_offset():
    p = [0, 5, 10]
    assert discrete_frechet_mm(make_path(p, [0, 1, 2], [0, 0, 0]), make_path(p, [0, 1, 2], [3, 3, 3])) == 3


def test_speed_along_the_path_does_not_matter_but_direction_does():
    p = [0, 5, 10, 15]
    there = make_path(p, [0, 1, 2, 3], [0, 0, 0, 0])
    slow_start = make_path([0, 1, 2, 3, 4, 5], [0, 0, 0, 1, 2, 3], [0, 0, 0, 0, 0, 0])
    back = make_path(p, [3, 2, 1, 0], [0, 0, 0, 0])
    assert discrete_frechet_mm(there, slow_start) == 0
    assert discrete_frechet_mm(there, back) == pytest.approx(3.0)


def test_gaps_are_passed_over():
    p = [0, 5, 10]
    gappy = make_path(p, [0, np.nan, 2], [0, np.nan, 0])
    assert discrete_frechet_mm(gappy, make_path(p, [0, 1, 2], [0, 0, 0])) == pytest.approx(1.0)
