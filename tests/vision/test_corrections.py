"""What a person says of single photographs, against the renderer's truth."""

import numpy as np
import pytest

from spavision.errors import InputError
from spavision.vision.corrections import Correction
from spavision.vision.track import track


def tracked(rendered, corrections, **options):
    return track(
        rendered.paths,
        rendered.pressures_kPa,
        settings=rendered.track_settings(**options),
        corrections=corrections,
    )


def test_a_given_pixel_replaces_the_detection_as_it_is(plain_set):
    name = plain_set.paths[1].name
    # The dot of this photo is hidden; the truth is the renderer's, moved 3 px to the right.
    pixel = plain_set.truth[1].dot_px + np.array([3.0, 0.0])
    result = tracked(plain_set, {name: Correction(tuple(pixel), "seen through the tape")})
    assert result.tip_path.status == ("ok", "ok", "ok")
    assert result.tip_path.reason[1] == "marker given by hand: seen through the tape"
    np.testing.assert_array_equal(result.readings[1].marker_px, pixel)
    settings = plain_set.settings
    mm_per_px = settings.board.square_mm / settings.camera.square_px
    mm_per_px *= 1 - settings.actuator.standoff_mm / settings.camera.distance_mm
    error = np.array([result.tip_path.ux_mm[1], result.tip_path.uy_mm[1]]) - plain_set.displacement_mm[1]
    assert error == pytest.approx([3 * mm_per_px, 0.0], abs=0.04)
    assert result.tip_path.sigma_ux_mm[1] == pytest.approx(1.0 * mm_per_px, rel=0.1)
    assert any("by hand" in note and name in note for note in result.notes)


def test_a_correction_outweighs_a_good_detection_and_a_rejection_removes_it(plain_set):
    first, _, last = (path.name for path in plain_set.paths)
    given = Correction(tuple(plain_set.truth[2].dot_px))
    result = tracked(plain_set, {first: Correction(None, "tube was kinked"), last: given})
    assert result.tip_path.status == ("rejected", "missing", "ok")
    assert result.tip_path.reason[0] == "tube was kinked"
    assert result.tip_path.reason[2] == "marker given by hand"
    assert np.isnan(result.tip_path.ux_mm[:2]).all()
    assert result.tip_path.ux_mm[2] == 0.0  # it has become the reference
    assert any(f"{last} is the reference" in note for note in result.notes)


def test_a_pixel_serves_where_no_marker_was_found_at_all(plain_set):
    name = plain_set.paths[0].name
    result = tracked(plain_set, {name: Correction(tuple(plain_set.truth[0].dot_px))}, marker_colour="blue")
    assert result.tip_path.status == ("ok", "missing", "missing")


def test_corrections_that_fit_no_photo_are_refused(plain_set):
    with pytest.raises(InputError, match=r"name other\.jpg, which is not among"):
        tracked(plain_set, {"other.jpg": Correction(None)})
    with pytest.raises(InputError, match=r"\(640, 20\) px, outside the photo of 640×560 px"):
        tracked(plain_set, {plain_set.paths[0].name: Correction((640.0, 20.0))})
