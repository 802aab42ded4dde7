"""Posterior against Bayes by hand, identifiability, and a design on a formula."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from scipy import stats

from spavision.correlate.study.explanation import Target
from spavision.correlate.study.identifiability import identified
from spavision.correlate.study.posterior import Misfit, best_point, sample_posterior
from spavision.correlate.study.suspects import Suspect
from spavision.experiment import Experiment
from spavision.tip_path import FloatArray

PRESSURES = np.arange(1.0, 21.0)


@dataclass(frozen=True)
class Linear:
    """Stands in for an emulator: ux = (2 a + b) p, uy = c p with weights of the suspects' values."""

    suspects: tuple[Suspect, ...]
    weights_x: FloatArray
    weights_y: FloatArray

    def predict(self, points: FloatArray) -> FloatArray:
        columns = zip(self.suspects, points.T, strict=True)
        values = np.column_stack([one.distribution.ppf(shares) for one, shares in columns])
        slopes = np.stack([values @ self.weights_x, values @ self.weights_y], axis=1)
        return slopes[:, :, None] * PRESSURES


def misfit_of(model: Linear, truth: FloatArray, *, noise_mm: float) -> Misfit:
    n = len(model.suspects)
    shares = np.array([[one.share(value) for one, value in zip(model.suspects, truth, strict=True)]])
    noise = noise_mm * np.random.default_rng(3).standard_normal((2, len(PRESSURES)))
    middle = np.full(n, 0.5)
    target = Target(model.predict(shares)[0] + noise, model.predict(middle[None])[0], Experiment())
    return Misfit(model, target, middle, np.full((2, len(PRESSURES)), noise_mm))  # type: ignore[arg-type]


def test_posterior_of_a_slope_is_that_of_linear_regression() -> None:
    """y = c p with known noise s: the posterior's standard deviation is s/√Σp²; no model error is found."""
    slope = Suspect("c", "actuator", 1.0, "", stats.uniform(0.0, 2.0))
    noise_mm = 1.0
    misfit = misfit_of(Linear((slope,), np.zeros(1), np.ones(1)), np.array([1.2]), noise_mm=noise_mm)
    best = best_point(misfit, seed=1)
    expected = float(PRESSURES @ misfit.target.measured_mm[1] / (PRESSURES @ PRESSURES))
    assert slope.value(float(best[0])) == pytest.approx(expected, abs=1e-3)
    found = sample_posterior(misfit, best, steps=700, seed=1)
    width = noise_mm / np.sqrt(PRESSURES @ PRESSURES)
    assert found.values.mean() == pytest.approx(expected, abs=0.3 * width)
    # The unknown model error can only widen it, here by less than half.
    assert width < found.values.std() < 1.5 * width
    assert np.median(found.model_error_mm) < noise_mm
    assert identified(found, 0).verdict == "identified"


def test_parameters_of_which_only_a_combination_is_seen_are_told() -> None:
    suspects = tuple(Suspect(name, "actuator", 1.0, "", stats.uniform(0.0, 2.0)) for name in "abc")
    model = Linear(suspects, np.array([1.0, 1.0, 0.0]), np.zeros(3))
    found = sample_posterior(
        misfit_of(model, np.array([1.0, 1.0, 1.0]), noise_mm=0.1), np.full(3, 0.5), steps=800, seed=1
    )
    assert found.correlation[0, 1] < -0.95
    assert identified(found, 2).verdict == "not identified"
