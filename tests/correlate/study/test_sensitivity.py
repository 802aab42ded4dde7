"""Sobol indices against a published function, bands against arithmetic, set-up factors against optics."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from scipy import stats

from spavision.correlate.study.band import band
from spavision.correlate.study.case import CaseResult
from spavision.correlate.study.explanation import Target, explain_alone, explain_forms, reading_factor
from spavision.correlate.study.sampling import draw_shares
from spavision.correlate.study.sensitivity import (
    LocalSensitivity,
    likenesses,
    local_sensitivities,
    sobol_indices,
)
from spavision.correlate.study.study_file import StudyFile
from spavision.correlate.study.suspects import Suspect, suspects_of
from spavision.experiment import Experiment
from spavision.model.materials.library import find_material
from spavision.tip_path import FloatArray, TipPath


def number(name: str, low: float, high: float, nominal: float = 0.0) -> Suspect:
    return Suspect(name, "actuator", nominal, "", stats.uniform(low, high - low))


@dataclass(frozen=True)
class Formula:
    """Stands in for an emulator: x by a formula of the suspects' values, y does not move."""

    suspects: tuple[Suspect, ...]
    formula: object

    def predict(self, points: FloatArray) -> FloatArray:
        values = [one.distribution.ppf(shares) for one, shares in zip(self.suspects, points.T, strict=True)]
        ux = self.formula(*values)  # type: ignore[operator]
        return np.stack([ux, np.zeros_like(ux)], axis=1)[:, :, None]


def test_sobol_indices_of_the_ishigami_function() -> None:
    """Ishigami and Homma (1990), a = 7, b = 0.1: S = 0.3139, 0.4424, 0; T = 0.5576, 0.4424, 0.2437."""
    suspects = tuple(number(name, -np.pi, np.pi) for name in "abc")
    ishigami = Formula(suspects, lambda x, y, z: np.sin(x) + 7 * np.sin(y) ** 2 + 0.1 * z**4 * np.sin(x))
    found = sobol_indices(ishigami, np.array([10.0]), seed=1)  # type: ignore[arg-type]
    np.testing.assert_allclose(found.first[:, 0, 0], [0.3139, 0.4424, 0.0], atol=0.03)
    np.testing.assert_allclose(found.total[:, 0, 0], [0.5576, 0.4424, 0.2437], atol=0.03)
    assert np.isnan(found.total[:, 1, 0]).all()


def test_band_counts_the_cases_that_did_not_get_there() -> None:
    """Of 0, 1, 2, 3, 4 the standard deviation is √2.5; where one case is missing, of 0 to 3, √(5/3)."""
    nan = float("nan")
    results = [
        CaseResult("ok", "", (0.0, float(k), float(k) if k < 4 else nan), (0.0, 0.0, 0.0), 0.0)
        for k in range(5)
    ]
    flat = np.zeros(3)
    found = band(TipPath(np.array([0.0, 5.0, 10.0]), flat, flat, flat, flat), results)
    np.testing.assert_allclose(found.sigma_mm[0], [0.0, np.sqrt(2.5), np.sqrt(5.0 / 3.0)])
    assert found.n_reached.tolist() == [5, 5, 4]
    assert found.table()["median_ux_mm"].tolist() == [0.0, 2.0, 1.5]


def test_stand_off_moves_the_reading_as_similar_triangles_say() -> None:
    """A reading is (D − h)/D of the board's: at D = 750, h from 20 to 25 takes it to 725/730."""
    experiment = Experiment().with_options({"camera": {"standoff_mm": 20.0, "distance_mm": 750.0}})
    assert reading_factor(experiment, {"standoff_mm": 25.0}) == pytest.approx(725.0 / 730.0)
    assert reading_factor(experiment, {"scale": 1.01}) == pytest.approx(1.01)


def test_suspect_explains_what_lies_within_its_interval() -> None:
    """Model a·p against 3·p: a from 0 to 4 explains all of it; from 0 to 2, nominal 1, up to 97.5 % of 2."""
    target = Target(np.array([[3.0], [0.0]]), np.array([[1.0], [0.0]]), Experiment())
    for high, left in ((4.0, 0.0), (2.0, 3.0 - 1.95)):
        slope = number("a", 0.0, high, nominal=1.0)
        model = Formula((slope,), lambda a: a)
        found = explain_alone(model, target, slope, nominal=np.array([1.0 / high]))  # type: ignore[arg-type]
        assert found.rmse_mm == pytest.approx(left, abs=0.05)
        assert found.nominal_rmse_mm == pytest.approx(2.0)


def test_form_of_the_model_is_judged_by_its_runs() -> None:
    """Measured 3, nominal 1 mm: the option 1.5 mm further leaves 0.5; one that stops explains nothing."""
    law = Suspect("law", "composite", "a", "", options=("a", "b", "c"))
    target = Target(np.array([[3.0, 3.0], [0.0, 0.0]]), np.array([[1.0, 1.0], [0.0, 0.0]]), Experiment())
    stopped = [2.0, np.nan]
    changes = np.array([[ux, np.zeros(2)] for ux in (np.zeros(2), np.full(2, 1.5), stopped)])
    found = explain_forms(target, (law,), changes)["law"]
    assert found.values == {"law": "b"}
    assert found.explained == pytest.approx(0.75)
    worse = explain_forms(target, (law,), -changes)["law"]
    assert worse.values == {"law": "a"}
    assert worse.explained == 0.0


def test_sobol_sequence_is_the_same_again_and_even() -> None:
    points = draw_shares(3, 64, sampling="sobol", seed=5)
    np.testing.assert_array_equal(points, draw_shares(3, 64, sampling="sobol", seed=5))
    # A property of the sequence: each of 64 equal slices of an axis holds one of 64 points.
    assert [sorted((64 * column).astype(int).tolist()) for column in points.T] == [list(range(64))] * 3


def test_normal_suspect_ends_where_the_parameter_does() -> None:
    """A stiffness factor may not fall below 0.1; far from that end the quantiles are the normal law's."""
    content = {"suspects": {"body_stiffness": {"distribution": "normal", "sigma": 0.3}}}
    (suspect,) = suspects_of(StudyFile.model_validate(content), Experiment(), source="study")
    assert suspect.value(1e-9) >= 0.1
    assert suspect.value(0.975) == pytest.approx(1.0 + 1.96 * 0.3, abs=2e-3)


def test_material_without_options_takes_the_alternatives_of_the_library() -> None:
    content = {"suspects": {"matrix_material": {"distribution": "choice"}}}
    (suspect,) = suspects_of(StudyFile.model_validate(content), Experiment(), source="study")
    stiffness = [find_material(str(name)).law.shear_modulus_MPa for name in suspect.options]
    assert len(stiffness) > 3
    assert stiffness == sorted(stiffness)
    assert suspect.value(suspect.share("Ecoflex 00-30")) == "Ecoflex 00-30"


def test_choice_goes_between_the_options_that_are_furthest_apart() -> None:
    """Options at 1, 5 and 2 mm: from the first to the second, by 4 mm; a number goes from end to end."""
    law = Suspect("law", "composite", "a", "", options=("a", "b", "c"))
    slope = number("slope", 0.0, 1.0)
    results = [CaseResult("ok", "", (0.0, x), (0.0, 0.0), 0.0) for x in (1.0, 5.0, 2.0, 3.0, -3.0)]
    choice, line = local_sensitivities((law, slope), results)
    assert choice.ends == ("a", "b")
    assert choice.change_mm.tolist() == [[0.0, 4.0], [0.0, 0.0]]
    assert line.ends == pytest.approx((0.025, 0.975))
    assert line.change_mm[0, 1] == -6.0


def test_suspects_that_move_the_tip_in_proportion_are_named() -> None:
    """(1, 2, 3), −2·(1, 2, 3) and (1, 2, 2.5), cos 0.996; a right angle and a thousandth are not."""
    ramp = np.array([1.0, 2.0, 3.0])
    changes = {
        "gauge": ramp,
        "stiffness": -2.0 * ramp,
        "side wall": np.array([1.0, 2.0, 2.5]),
        "roof": np.array([3.0, 0.0, -1.0]),
        "bulk": 1e-3 * ramp,
    }
    (found,) = likenesses(
        [
            LocalSensitivity(number(name, 0.0, 1.0), (0.0, 1.0), np.array([change, 0.0 * change]))
            for name, change in changes.items()
        ]
    )
    assert found.names == ("gauge", "stiffness", "side wall")
    assert found.cosine == pytest.approx(12.5 / np.sqrt(14.0 * 11.25))
    assert "gauge, stiffness and side wall move the tip alike (cosine 0.996 or more)" in found.sentence()


def test_form_of_the_model_and_the_measurement_are_no_inputs() -> None:
    content = {
        "law": {"distribution": "choice", "options": ["slack-fibre", "ogden"]},
        "standoff_mm": {"distribution": "normal", "mean": 20, "sigma": 1},
        "pressure_scale": {"distribution": "normal", "sigma": 0.05},
    }
    study = StudyFile.model_validate({"suspects": content})
    found = suspects_of(study, Experiment(), source="study")
    assert [one.name for one in found if one.is_input] == ["pressure_scale"]
    assert [one.name for one in found if not one.moves_the_measurement] == ["law", "pressure_scale"]
