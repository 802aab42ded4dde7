"""What a measured path says about parameters: best values, and how far they are known (Bayes, emcee)."""

from __future__ import annotations

from dataclasses import dataclass

import emcee
import numpy as np
from scipy.optimize import least_squares
from scipy.stats import norm, qmc

from spavision.tip_path import FloatArray

from .emulator import Emulator
from .explanation import Target
from .suspects import Suspect

_EDGE = 0.005
_STARTS = 8
_INSIDE = 1e-6
_LARGEST_LOG = 15.0
_BURN_IN = 0.25
_LENGTHS_NEEDED = 50
"""Autocorrelation times that a chain must be long (emcee's documentation)."""


@dataclass(frozen=True)
class Misfit:
    """Distance of the emulated from a measured path, reading by reading.

    Parameters
    ----------
    emulator : Emulator
    target : Target
    nominal : array, shape (n_parameters,)
        Nominal point of the emulator's unit cube.
    sigma_mm : array, shape (2, n_pressures)
        Standard uncertainty of the measurement (u_D) and of the emulator, together.
    """

    emulator: Emulator
    target: Target
    nominal: FloatArray
    sigma_mm: FloatArray

    def residuals_mm(self, points: FloatArray) -> FloatArray:
        """Return modelled minus measured of every reading, shape (n, n_readings)."""
        change = self.emulator.predict(points) - self.emulator.predict(self.nominal[None])
        error = self.target.nominal_mm + change - self.target.measured_mm
        return np.asarray(error[:, self._has_reading])

    @property
    def sigma_of_readings_mm(self) -> FloatArray:
        """Standard uncertainty of every reading, shape (n_readings,)."""
        return np.asarray(self.sigma_mm[self._has_reading])

    @property
    def _has_reading(self) -> np.ndarray[tuple[int, int], np.dtype[np.bool_]]:
        # The reference, zero by definition on either side, tells nothing.
        is_reference = np.all(self.target.nominal_mm == 0.0, axis=0)
        return np.isfinite(self.target.measured_mm - self.target.nominal_mm) & ~is_reference


def best_point(misfit: Misfit, *, seed: int) -> FloatArray:
    """Find the point of the unit cube nearest to the measurement: least squares from several starts."""
    n = len(misfit.nominal)
    starts = [
        misfit.nominal,
        *qmc.Sobol(n, rng=np.random.default_rng(seed)).random_base2(int(np.log2(_STARTS))),
    ]
    found = [
        least_squares(
            lambda point: misfit.residuals_mm(point[None])[0],
            np.clip(start, 2.0 * _EDGE, 1.0 - 2.0 * _EDGE),
            bounds=(_EDGE, 1.0 - _EDGE),
            diff_step=1e-3,
        )
        for start in starts
    ]
    return np.asarray(min(found, key=lambda one: one.cost).x)


@dataclass(frozen=True)
class Posterior:
    """Draws from the posterior of the parameters and of the model error.

    Parameters
    ----------
    suspects : tuple of Suspect
        The parameters; their distributions are the prior.
    points : array, shape (n_draws, n_parameters)
        In the unit cube.
    model_error_mm : array, shape (n_draws,)
        Standard deviation of what the model gets wrong at each reading whatever the parameters.
    is_converged : bool
        Whether the chains are long enough, against their autocorrelation.
    """

    suspects: tuple[Suspect, ...]
    points: FloatArray
    model_error_mm: FloatArray
    is_converged: bool

    @property
    def values(self) -> FloatArray:
        """The draws in the parameters' own units, shape (n_draws, n_parameters)."""
        columns = zip(self.suspects, self.points.T, strict=True)
        return np.column_stack([one.distribution.ppf(shares) for one, shares in columns])

    @property
    def correlation(self) -> FloatArray:
        """Correlations of the parameters, shape (n_parameters, n_parameters)."""
        return np.atleast_2d(np.corrcoef(self.values, rowvar=False))


def sample_posterior(misfit: Misfit, start: FloatArray, *, steps: int, seed: int) -> Posterior:
    """Draw from the posterior with emcee's affine-invariant ensemble.

    The prior is the suspects' distributions: uniform in the unit cube, walked through in standard normal
    coordinates, in which it has no edges. Readings scatter normally with
    u_D² + model error²; the model error is unknown, its prior half-normal with the nominal distance as scale.

    Parameters
    ----------
    misfit : Misfit
    start : array, shape (n_parameters,)
    steps : int
        Of each walker; the first quarter is thrown away.
    seed : int
    """
    n = len(start)
    random = np.random.RandomState(seed)
    scale = float(np.sqrt(np.mean(misfit.residuals_mm(misfit.nominal[None]) ** 2)))
    variance = misfit.sigma_of_readings_mm**2

    def log_probability(walkers: FloatArray) -> FloatArray:
        places, log_error = walkers[:, :n], np.clip(walkers[:, n], -_LARGEST_LOG, _LARGEST_LOG)
        error = np.exp(log_error)[:, None]
        total = variance + error**2
        residual = misfit.residuals_mm(_shares(places))
        likelihood = -0.5 * np.sum(residual**2 / total + np.log(total), axis=1)
        # Half-normal in the error itself: the last term is the Jacobian of its logarithm.
        prior = -0.5 * np.sum(places**2, axis=1) - 0.5 * (error[:, 0] / scale) ** 2 + log_error
        return np.asarray(likelihood + prior)

    n_walkers = 2 * max(16, 2 * (n + 1))
    residual = np.sqrt(np.mean(misfit.residuals_mm(start[None]) ** 2))
    first = np.empty((n_walkers, n + 1))
    first[:, :n] = norm.ppf(np.clip(start, 0.02, 0.98)) + 0.3 * random.standard_normal((n_walkers, n))
    first[:, n] = np.log(max(residual, 1e-3)) + 0.1 * random.standard_normal(n_walkers)
    moves = [(emcee.moves.DEMove(), 0.8), (emcee.moves.DESnookerMove(), 0.2)]
    sampler = emcee.EnsembleSampler(n_walkers, n + 1, log_probability, moves=moves, vectorize=True)
    sampler.random_state = random.get_state()
    sampler.run_mcmc(first, steps)
    burn_in = int(_BURN_IN * steps)
    draws = sampler.get_chain(discard=burn_in, thin=max(1, steps // 400), flat=True)
    lengths = sampler.get_autocorr_time(discard=burn_in, tol=0)
    long_enough = bool(np.all(_LENGTHS_NEEDED * lengths < steps - burn_in))
    return Posterior(misfit.emulator.suspects, _shares(draws[:, :n]), np.exp(draws[:, n]), long_enough)


def _shares(places: FloatArray) -> FloatArray:
    """Return points of the unit cube from standard normal coordinates."""
    return np.asarray(np.clip(norm.cdf(places), _INSIDE, 1.0 - _INSIDE))
