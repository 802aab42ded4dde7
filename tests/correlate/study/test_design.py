"""Designs on a formula whose answer is known: ux = p (2 t − p) turns at t."""

from __future__ import annotations

import numpy as np
import pytest

from spavision.correlate.study.case import CaseResult
from spavision.correlate.study.design import Choices, Strip, design, mode_change_score, strips_of
from spavision.correlate.study.plan import Plan
from spavision.correlate.study.study_file import StudyFile
from spavision.correlate.study.suspects import suspects_of
from spavision.errors import InputError
from spavision.experiment import Experiment

PRESSURES = tuple(float(p) for p in range(0, 80, 5))
SOFT, STIFF = "Mold Star 15 two-term", "Smooth-Sil 950"
SUSPECTS = {
    "strip_b_mm": {"distribution": "uniform", "plus_minus": 0.2},
    "strip_b_material": {"distribution": "choice"},
    "law": {"distribution": "choice", "options": ["slack-fibre", "ogden"]},
}


def turning_pressure(values):
    """200 CR, a quarter more with the stiff silicone, 2 % less without a strip."""
    factor = 0.98 if values["strip_b_mm"] == 0.0 else 1.25 if values["strip_b_material"] == STIFF else 1.0
    return 200.0 * factor * values["crimp_ratio"]


def run(values, model="", crimp_ratio=None):  # noqa: ARG001
    return [
        CaseResult("ok", "", tuple(p * (2.0 * turning_pressure(one) - p) for p in PRESSURES), PRESSURES, 0.0)
        for one in values
    ]


def found_among(strips, wished_kPa, suspects=()):
    plan = Plan(suspects, Experiment(), PRESSURES, n_cases=8, n_full=0, sampling="sobol", seed=1)
    choices = Choices((0.15, 0.2, 0.25, 0.3), strips)
    return design(plan, choices, mode_change_score(wished_kPa), run, unit="kPa")


def test_every_strip_has_the_crimp_ratio_that_turns_where_it_is_wished():
    """46 kPa: crimp ratio 0.23 with the soft strip, 0.184 with the stiff one, 0.2347 without."""
    strips = strips_of((0.0, 2.0), (SOFT, STIFF))
    assert strips == (Strip(0.0, ""), Strip(2.0, SOFT), Strip(2.0, STIFF))
    found = found_among(strips, 46.0)
    ratios = {one.strip: one.crimp_ratio for one in found.candidates}
    assert [ratios[strip] for strip in strips] == pytest.approx([0.2347, 0.23, 0.184], abs=5e-4)
    assert found.candidates[0].score < 0.1
    assert set(found.table()["strip_b_material"]) == {"", SOFT, STIFF}


def test_scatter_is_of_the_strip_that_was_chosen():
    """The thickness scatters about the chosen one; silicone and the law of the model stay."""
    seen = []

    def remembered(values, model="", crimp_ratio=None):  # noqa: ARG001
        seen.extend(values)
        return run(values)

    study = StudyFile.model_validate({"suspects": SUSPECTS})
    suspects = suspects_of(study, Experiment(), source="study")
    plan = Plan(suspects, Experiment(), PRESSURES, n_cases=8, n_full=0, sampling="sobol", seed=1)
    for strip, low, high in ((Strip(2.0, STIFF), 1.8, 2.2), (Strip(0.0, ""), 0.0, 0.0)):
        seen.clear()
        found = design(plan, Choices((0.15, 0.3), (strip,)), mode_change_score(46.0), remembered, unit="kPa")
        drawn = seen[-len(found.scatter) :] if found.scatter else []
        assert {one.get("strip_b_material", "") for one in seen} == {strip.material}
        assert all("law" not in one for one in seen)
        assert all(low <= one["strip_b_mm"] <= high for one in drawn)
        assert np.ptp([one["strip_b_mm"] for one in drawn] or [0.0]) > 0.5 * (high - low) or high == low
        assert bool(found.scatter) == bool(strip.material), "nothing scatters about no strip"


def test_strip_of_an_unknown_silicone_is_refused():
    with pytest.raises(InputError, match="'Molten Star' is unknown"):
        strips_of((1.0,), ("Molten Star",))
