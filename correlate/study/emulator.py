"""A cheap stand-in for the model, learned from the cases of a study."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from sklearn.decomposition import PCA
from sklearn.exceptions import ConvergenceWarning
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import RBF, ConstantKernel, WhiteKernel

from spavision.errors import InputError
from spavision.tip_path import FloatArray

from .case import CaseResult, displacements
from .suspects import Suspect

_VARIANCE_KEPT = 0.9995
_MOST_COMPONENTS = 8
FEWEST_CASES = 12
_SMALLEST_SCATTER_MM = 1e-6


@dataclass(frozen=True)
class Emulator:
    """Gaussian processes for the principal components of the tip path.

    Parameters
    ----------
    suspects : tuple of Suspect
    n_pressures : int
    """

    suspects: tuple[Suspect, ...]
    n_pressures: int
    _scale_mm: FloatArray
    _components: PCA
    _processes: tuple[GaussianProcessRegressor, ...]

    def predict(self, points: FloatArray) -> FloatArray:
        """Return the tip displacements, shape (n, 2, n_pressures), in mm.

        Parameters
        ----------
        points : array, shape (n, n_suspects)
            In the unit cube of the suspects' probabilities.
        """
        inputs = _features(self.suspects, points)
        scores = np.column_stack([process.predict(inputs) for process in self._processes])
        flat = self._components.inverse_transform(scores) * self._scale_mm
        return np.asarray(flat).reshape(len(points), 2, self.n_pressures)


@dataclass(frozen=True)
class EmulatorCheck:
    """How far the emulator is from cases that it was not fitted to.

    Parameters
    ----------
    error_mm : array, shape (n_cases, 2, n_pressures)
        Emulated minus computed.
    scatter_mm : array, shape (2, n_pressures)
        Standard deviation of the computed ones.
    """

    error_mm: FloatArray
    scatter_mm: FloatArray

    @property
    def rmse_mm(self) -> FloatArray:
        """Root mean square error, shape (2, n_pressures)."""
        return np.asarray(np.sqrt(np.mean(self.error_mm**2, axis=0)))

    @property
    def predictivity(self) -> float:
        """Q²: share of the held-out cases' variance that the emulator predicts, over the whole path."""
        return float(1.0 - np.sum(self.rmse_mm**2) / np.sum(self.scatter_mm**2))


def fit_emulator(
    suspects: tuple[Suspect, ...], points: FloatArray, results: Sequence[CaseResult], *, seed: int
) -> Emulator:
    """Learn the tip path as a function of the suspects.

    Cases that did not reach every pressure cannot be learned from and are left out.

    Parameters
    ----------
    suspects : tuple of Suspect
    points : array, shape (n, n_suspects)
        Where the cases are in the unit cube.
    results : sequence of CaseResult
    seed : int

    Raises
    ------
    InputError
        If fewer than twelve cases reached every pressure.
    """
    values = displacements(results)
    whole = np.isfinite(values).all(axis=(1, 2))
    if np.count_nonzero(whole) < FEWEST_CASES:
        raise InputError(
            f"only {np.count_nonzero(whole)} of {len(results)} cases reached every pressure, {FEWEST_CASES} "
            "are needed to learn from; add cases, lower the highest pressure, or narrow the suspects"
        )
    flat = values[whole].reshape(np.count_nonzero(whole), -1)
    scale = np.maximum(flat.std(axis=0), _SMALLEST_SCATTER_MM)
    components = PCA(n_components=_VARIANCE_KEPT, svd_solver="full").fit(flat / scale)
    scores = components.transform(flat / scale)[:, :_MOST_COMPONENTS]
    if components.n_components_ > _MOST_COMPONENTS:
        components = PCA(n_components=_MOST_COMPONENTS, svd_solver="full").fit(flat / scale)
    inputs = _features(suspects, points[whole])
    processes = tuple(_process(inputs, score, seed) for score in scores.T)
    return Emulator(suspects, values.shape[2], scale, components, processes)


def check_emulator(emulator: Emulator, points: FloatArray, results: Sequence[CaseResult]) -> EmulatorCheck:
    """Hold the emulator against cases that it was not fitted to; those that stopped early are left out."""
    values = displacements(results)
    whole = np.isfinite(values).all(axis=(1, 2))
    error = emulator.predict(points[whole]) - values[whole]
    return EmulatorCheck(error, values[whole].std(axis=0))


def _process(inputs: FloatArray, score: FloatArray, seed: int) -> GaussianProcessRegressor:
    kernel = ConstantKernel(1.0, (1e-2, 1e3)) * RBF(
        np.full(inputs.shape[1], 2.0), (0.2, 200.0)
    ) + WhiteKernel(1e-4, (1e-8, 1.0))
    process = GaussianProcessRegressor(kernel, normalize_y=True, random_state=seed)
    with warnings.catch_warnings():
        # A length scale at its upper bound is a suspect without influence: nothing to warn of.
        warnings.simplefilter("ignore", ConvergenceWarning)
        return process.fit(inputs, score)


def _features(suspects: tuple[Suspect, ...], points: FloatArray) -> FloatArray:
    """Scale numbers so that their 95 % interval is −1 to 1; one column for each option but the last."""
    columns: list[FloatArray] = []
    for one, shares in zip(suspects, points.T, strict=True):
        if one.is_choice:
            chosen = [one.value(float(share)) for share in shares]
            columns += [np.array([value == option for value in chosen], float) for option in one.options[:-1]]
            continue
        low, high = (float(value) for value in one.interval)
        columns.append((one.distribution.ppf(shares) - 0.5 * (low + high)) / (0.5 * (high - low)))
    return np.column_stack(columns)
