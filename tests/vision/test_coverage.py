"""What is said of photographs that leave parts of the frame or of the tilts out."""

import numpy as np
import pytest

from spavision.vision.camera import Camera, Pose
from spavision.vision.coverage import cover, coverage_notes

SIZE = (640, 480)


def tilted(*slopes_deg):
    return [
        Pose((np.radians(-down), np.radians(right), 0.0), (0.0, 0.0, 300.0)) for right, down in slopes_deg
    ]


CAMERA = Camera(700.0, 700.0, 319.5, 239.5, (0.0,) * 5, *SIZE)
EVERYWHERE = np.stack(np.meshgrid(np.linspace(10, 630, 30), np.linspace(10, 470, 25)), axis=-1).reshape(-1, 2)
GOOD_TILTS = tilted((30, 0), (-30, 0), (0, 30), (0, -30))


def test_good_coverage_needs_no_note():
    coverage = cover(CAMERA, [EVERYWHERE] * 4, GOOD_TILTS)
    assert coverage.share == 1.0
    np.testing.assert_allclose(coverage.tilt_deg, 30.0)
    np.testing.assert_allclose(np.abs(coverage.slope_deg).max(axis=1), 30.0)
    assert coverage_notes(coverage) == ()


def test_a_corner_of_the_frame_without_corners_is_named():
    seen = EVERYWHERE[~((EVERYWHERE > [400, 300]).all(axis=1))]
    (note,) = coverage_notes(cover(CAMERA, [seen] * 4, GOOD_TILTS))
    assert "poor coverage" in note
    assert "near the lower right corner" in note


def test_a_small_board_in_the_middle_covers_poorly():
    notes = coverage_notes(cover(CAMERA, [0.3 * EVERYWHERE + [200, 150]] * 4, GOOD_TILTS))
    assert any("of the frame's cells" in note for note in notes)


@pytest.mark.parametrize(
    ("slopes", "words"),
    [
        (((0, 0), (2, 1), (30, 0), (0, 30)), "in 2 of 4 photos"),
        (((20, 0), (30, 1), (-30, 0), (-20, 1)), "about one axis only"),
    ],
)
def test_too_few_tilts_are_told(slopes, words):
    (note,) = coverage_notes(cover(CAMERA, [EVERYWHERE] * 4, tilted(*slopes)))
    assert note.startswith("too few tilts")
    assert words in note
