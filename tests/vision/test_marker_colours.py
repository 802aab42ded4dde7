"""Markers of other colours, named or sampled from a photo, against the renderer's truth."""

import numpy as np
import pytest

from spavision.errors import InputError
from spavision.vision.photos import read_photo
from spavision.vision.track import track

from .conftest import SMALL, choose, render_set

PRESSURES_KPA = (0, 40)


def dotted_set(folder, **groups):
    """Two photos of the board's right half, which the dot moves over."""
    return render_set(folder, choose(SMALL, image={"width_px": 520}, **groups), PRESSURES_KPA)


def sampled(rendered):
    """Colour that a user would pick in the first photo, as #rrggbb."""
    column, row = np.rint(rendered.truth[0].dot_px).astype(int)
    red, green, blue = read_photo(rendered.paths[0]).rgb[row, column].tolist()
    return f"#{red:02x}{green:02x}{blue:02x}"


def worst_error_mm(rendered, **options):
    result = track(rendered.paths, PRESSURES_KPA, settings=rendered.track_settings(**options))
    assert result.tip_path.status == ("ok", "ok")
    measured = np.column_stack([result.tip_path.ux_mm, result.tip_path.uy_mm])
    return np.linalg.norm(measured - rendered.displacement_mm, axis=1).max()


def test_a_blue_marker_is_read_by_name_with_or_without_its_diameter(tmp_path):
    rendered = dotted_set(tmp_path, marker={"colour": "blue"}, clutter={"red_sticker": True})
    assert worst_error_mm(rendered, marker_colour="blue") < 0.05
    assert worst_error_mm(rendered, marker_colour="blue", marker_diameter_mm=4.5) < 0.05


@pytest.mark.parametrize(("colour", "temperature_K"), [("#d0c020", 8500.0), ("magenta", 3000.0)])
def test_a_sampled_colour_is_read_whatever_the_light_it_was_sampled_in(tmp_path, colour, temperature_K):
    rendered = dotted_set(tmp_path, marker={"colour": colour}, light={"temperature_K": temperature_K})
    assert worst_error_mm(rendered, marker_colour=sampled(rendered)) < 0.06


def test_a_marker_of_the_actuators_own_colour_is_refused_not_guessed(tmp_path):
    rendered = dotted_set(tmp_path, marker={"colour": "green"})
    with pytest.raises(InputError, match="no marker was found"):
        worst_error_mm(rendered, marker_colour="green")


def test_a_grey_is_refused_and_a_sample_of_paper_in_warm_light_finds_nothing(hard_set):
    photo = read_photo(hard_set.paths[0]).rgb
    red, green, blue = photo.reshape(-1, 3)[photo.sum(axis=2).argmax()].tolist()
    assert red > blue + 20  # the light's own colour
    for colour, message in (("#808080", "nearly grey"), (f"#{red:02x}{green:02x}{blue:02x}", "no marker")):
        with pytest.raises(InputError, match=message):
            track(hard_set.paths[:1], [0.0], settings=hard_set.track_settings(marker_colour=colour))
