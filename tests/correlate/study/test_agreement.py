"""A study serves a comparison only if it is of the same actuator, model and path."""

from __future__ import annotations

import json

import numpy as np
import pytest

from spavision.correlate.study.agreement import first_difference, same_path
from spavision.correlate.study.case import model_description
from spavision.experiment import Experiment
from spavision.tip_path import TipPath

NOMINAL = Experiment().with_options({"actuator": {"crimp_ratio": 0.2}})


def described(**sections):
    """Return the description as a study's record keeps it."""
    return json.loads(json.dumps(model_description(NOMINAL.with_options(sections))))


@pytest.mark.parametrize(
    ("sections", "sentence"),
    [
        ({"actuator": {"crimp_ratio": 0.3}}, "its [actuator] crimp_ratio is 0.3, the comparison's 0.2"),
        ({"actuator": {"side_wall_mm": 2.0}}, "its [actuator] side_wall_mm is 2.0, the comparison's 2.5"),
        ({"composite": {"law": "ogden"}}, "its [composite] law is 'ogden', the comparison's 'slack-fibre'"),
        ({"gauge": {"pressure_scale": 1.2}}, "its [gauge] pressure_scale is 1.2, the comparison's 1.0"),
        (
            {"actuator": {"body_material": "Smooth-Sil 950"}},
            "its [actuator] body_material is 'Smooth-Sil 950', the comparison's 'Mold Star 15 two-term' "
            "(1 more key differs)",
        ),
    ],
)
def test_key_that_differs_is_named(sections, sentence):
    assert first_difference(described(**sections), model_description(NOMINAL)) == sentence


def test_what_does_not_touch_the_scatter_may_differ():
    other = described(actuator={"first_bend": "left"}, model={"mesh": "draft"}, camera={"standoff_mm": 20.0})
    assert first_difference(other, model_description(NOMINAL)) is None


def test_material_file_that_has_changed_is_told():
    theirs = described()
    theirs["materials"]["body_material"] = "another law"
    assert (
        first_difference(theirs, model_description(NOMINAL)) == "the law behind body_material is another now"
    )


def test_path_is_known_again_reading_by_reading():
    unknown = np.full(3, np.nan)
    path = TipPath(
        np.array([0.0, 5.0, 10.0]),
        np.array([0.0, np.nan, 2.0]),
        np.array([0.0, np.nan, 1.0]),
        unknown,
        unknown,
    )
    kept = {"pressure_kPa": [0.0, 10.0], "ux_mm": [0.0, 2.001], "uy_mm": [0.0, 1.0]}
    assert same_path(kept, path)
    assert not same_path({**kept, "ux_mm": [0.0, 2.1]}, path)
    assert not same_path({}, path)
