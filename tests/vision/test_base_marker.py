"""A second marker at the fixed end, whose motion is taken off, against the renderer's truth."""

import numpy as np
import pytest

from spavision.errors import InputError
from spavision.render.settings import RigShift
from spavision.vision.track import track

from .conftest import SMALL, choose, render_set

WITH_BASE_IN_VIEW = choose(SMALL, image={"width_px": 520, "height_px": 660}, camera={"aim_y_mm": 0.0})
SLIP = (RigShift(photo=1, dx_mm=1.5, dy_mm=2.0), RigShift(photo=2, dx_mm=-3.0, dy_mm=2.5))


@pytest.fixture(scope="module", params=["red", "blue"])
def slipping_set(request, tmp_path_factory):
    """Two dots, the base's red like the tip's among other red things, or blue; the clamp slips twice."""
    clutter = {"red_bolt": True, "red_sticker": True} if request.param == "red" else {}
    settings = choose(
        WITH_BASE_IN_VIEW,
        marker={"base_marker": True, "base_marker_colour": request.param},
        clutter=clutter,
        rig_shifts=SLIP,
    )
    return render_set(tmp_path_factory.mktemp("slip"), settings, (0, 20, 40))


def test_the_base_markers_motion_is_taken_off(slipping_set):
    marker = slipping_set.settings.marker
    result = track(
        slipping_set.paths,
        slipping_set.pressures_kPa,
        settings=slipping_set.track_settings(
            base_marker_colour=marker.base_marker_colour, marker_diameter_mm=marker.diameter_mm
        ),
    )
    base = np.array([truth.base_dot_mm[:2] for truth in slipping_set.truth])
    expected = slipping_set.displacement_mm - (base - base[0])
    measured = np.column_stack([result.tip_path.ux_mm, result.tip_path.uy_mm])
    assert result.tip_path.status == ("ok", "ok", "ok")
    assert np.abs(measured - expected).max() < 0.06
    for reading, truth in zip(result.readings, slipping_set.truth, strict=True):
        np.testing.assert_allclose(reading.base_px, truth.base_dot_px, atol=0.3)
    entry = next(entry for entry in result.budget if entry.name == "base marker")
    assert 0.0 < entry.sigma_ux_mm[1] < result.tip_path.sigma_ux_mm[1]
    told = next(note for note in result.notes if "base marker's motion was taken off" in note)
    assert slipping_set.paths[2].name in told


def test_a_base_marker_that_is_not_there_is_refused(plain_set):
    for colour, message in (("red", "both the marker and the base marker"), ("blue", "no base marker")):
        with pytest.raises(InputError, match=message):
            track(
                plain_set.paths[:1],
                plain_set.pressures_kPa[:1],
                settings=plain_set.track_settings(base_marker_colour=colour),
            )
