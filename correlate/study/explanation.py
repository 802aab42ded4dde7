"""How much of the discrepancy each suspect can explain."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import differential_evolution

from spavision.experiment import Experiment
from spavision.tip_path import FloatArray, TipPath

from .emulator import Emulator
from .parameters import MEASUREMENT_KEYS, Value
from .suspects import Suspect

_SCAN_POINTS = 41
_INTERVAL = (0.025, 0.975)


@dataclass(frozen=True)
class Explanation:
    """The best that suspects can do inside their 95 % intervals, everything else nominal.

    Parameters
    ----------
    values : dict
        Of the suspects, where the model comes nearest to the measurement.
    rmse_mm : float
        Root mean square distance that remains there.
    nominal_rmse_mm : float
        The same with everything nominal.
    """

    values: dict[str, Value]
    rmse_mm: float
    nominal_rmse_mm: float

    @property
    def explained(self) -> float:
        """Share of the root mean square distance that goes away."""
        return 1.0 - self.rmse_mm / self.nominal_rmse_mm


@dataclass(frozen=True)
class Target:
    """A measured path and the nominal model beside it, at the same pressures.

    Parameters
    ----------
    measured_mm : array, shape (2, n_pressures)
        NaN where there is no reading.
    nominal_mm : array, shape (2, n_pressures)
        Of the best model at hand; the emulator gives the changes from it.
    experiment : Experiment
        With the nominal set-up of the camera.
    """

    measured_mm: FloatArray
    nominal_mm: FloatArray
    experiment: Experiment

    def rmse_mm(self, change_mm: FloatArray, factor: FloatArray) -> FloatArray:
        """Return the root mean square distance over the readings.

        Parameters
        ----------
        change_mm : array, shape (n, 2, n_pressures)
            Of the model from its nominal path.
        factor : array, shape (n,)
            On the measured displacements.
        """
        error = self.nominal_mm + change_mm - factor[:, None, None] * self.measured_mm
        return np.asarray(np.sqrt(np.nanmean(np.sum(error**2, axis=1), axis=1)))


def measured_target(measured: TipPath, nominal: TipPath, experiment: Experiment) -> Target:
    """Put a measured path, in the model's axes, beside the nominal one: gaps where either has none."""
    apart = np.abs(nominal.pressure_kPa[:, None] - measured.pressure_kPa[None, :])
    row = apart.argmin(axis=1)
    same = apart[np.arange(len(row)), row] < 1e-6
    pairs = (measured.ux_mm, measured.uy_mm)
    readings = np.array([np.where(same, values[row], np.nan) for values in pairs])
    return Target(readings, np.array([nominal.ux_mm, nominal.uy_mm]), experiment)


def reading_factor(experiment: Experiment, values: dict[str, Value]) -> float:
    """Return the factor on the measured displacements when set-up figures differ from the nominal ones.

    A reading in the marker's plane is the board's times scale (D − h)/D, with the camera's distance D and the
    stand-off h. Figures that neither the experiment nor the values give are left as they were.
    """
    nominal = {key: getattr(getattr(experiment, section), key) for key, section in MEASUREMENT_KEYS.items()}
    wanted = {key: values.get(key, nominal[key]) for key in nominal}
    known = {key: nominal[key] if nominal[key] is not None else wanted[key] for key in nominal}
    return _board_to_marker(wanted) / _board_to_marker(known)


def explain_alone(
    emulator: Emulator, target: Target, suspect: Suspect, *, nominal: FloatArray
) -> Explanation:
    """Find how near to the measurement one suspect of the emulator brings the model.

    Parameters
    ----------
    emulator : Emulator
    target : Target
    suspect : Suspect
        One of the emulator's, or one that moves the measurement.
    nominal : array, shape (n_suspects,)
        The nominal point in the emulator's unit cube.
    """
    options = [suspect.share(option) for option in suspect.options]
    shares = np.array(options) if options else np.linspace(*_INTERVAL, _SCAN_POINTS)
    values: list[dict[str, Value]] = [{suspect.name: suspect.value(float(share))} for share in shares]
    if suspect.moves_the_measurement:
        change = np.zeros((len(shares), *target.nominal_mm.shape))
        factor = np.array([reading_factor(target.experiment, each) for each in values])
    else:
        points = np.tile(nominal, (len(shares), 1))
        points[:, emulator.suspects.index(suspect)] = shares
        change, factor = _change(emulator, points, nominal), np.ones(len(shares))
    rmse = target.rmse_mm(change, factor)
    best = int(rmse.argmin())
    before = _nominal_rmse(target)
    if rmse[best] >= before:
        return Explanation({suspect.name: suspect.nominal}, before, before)
    return Explanation(values[best], float(rmse[best]), before)


def explain_forms(
    target: Target, forms: tuple[Suspect, ...], changes_mm: FloatArray
) -> dict[str, Explanation]:
    """Find how near to the measurement another form of the model brings it, from runs of each option.

    An option whose run does not reach every reading explains nothing.

    Parameters
    ----------
    target : Target
    forms : tuple of Suspect
    changes_mm : array, shape (n_options, 2, n_pressures)
        From the nominal path, the options of one form after those of another.

    Returns
    -------
    dict of str to Explanation
        By the name of the form.
    """
    rmse = target.rmse_mm(changes_mm, np.ones(len(changes_mm)))
    is_lacking = np.isnan(changes_mm) & np.isfinite(target.measured_mm)
    left = iter(np.where(is_lacking.any(axis=(1, 2)), np.inf, rmse).tolist())
    found, before = {}, _nominal_rmse(target)
    for form in forms:
        nearest, remaining = min(((option, next(left)) for option in form.options), key=lambda one: one[1])
        is_better = remaining < before
        found[form.name] = Explanation(
            {form.name: nearest if is_better else form.nominal}, min(remaining, before), before
        )
    return found


def explain_together(
    emulator: Emulator, target: Target, *, nominal: FloatArray, seed: int
) -> tuple[Explanation, FloatArray]:
    """Find how near to the measurement all suspects of the emulator together bring the model.

    Returns
    -------
    explanation : Explanation
    point : array, shape (n_suspects,)
        In the emulator's unit cube.
    """

    def rmse(points: FloatArray) -> FloatArray:
        return target.rmse_mm(_change(emulator, points.T, nominal), np.ones(points.shape[1]))

    found = differential_evolution(
        rmse,
        [_INTERVAL] * len(nominal),
        vectorized=True,
        updating="deferred",
        rng=np.random.default_rng(seed),
        maxiter=200,
        popsize=8,
        tol=1e-4,
        polish=False,
    )
    values = {one.name: one.value(float(at)) for one, at in zip(emulator.suspects, found.x, strict=True)}
    return Explanation(values, float(found.fun), _nominal_rmse(target)), np.asarray(found.x)


def _change(emulator: Emulator, points: FloatArray, nominal: FloatArray) -> FloatArray:
    return emulator.predict(points) - emulator.predict(nominal[None, :])


def _nominal_rmse(target: Target) -> float:
    return float(target.rmse_mm(np.zeros((1, *target.nominal_mm.shape)), np.ones(1))[0])


def _board_to_marker(figures: dict[str, Value]) -> float:
    distance, standoff = figures["distance_mm"], figures["standoff_mm"]
    parallax = 1.0
    if distance is not None and standoff is not None:
        parallax = (float(distance) - float(standoff)) / float(distance)
    return float(figures["scale"]) * parallax
