"""Suspects: parameters that may explain a discrepancy, each with its distribution."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy import stats

from spavision.errors import InputError
from spavision.experiment import Experiment
from spavision.model.materials.library import alternatives, find_material
from spavision.tip_path import FloatArray

from .parameters import FORM_KEYS, MEASUREMENT_KEYS, Value, bounds, is_whole_number, nominal_value
from .study_file import StudyFile, SuspectSection

_INTERVAL = (0.025, 0.975)


@dataclass(frozen=True)
class Suspect:
    """An uncertain parameter.

    Parameters
    ----------
    name : str
        Key of the experiment file.
    section : str
        Where it stands there.
    nominal : float or str
    description : str
    distribution : object or None
        A frozen distribution of `scipy.stats`; None for a choice.
    options : tuple
        What is chosen among, equally likely, the softest material first; empty for a number.
    """

    name: str
    section: str
    nominal: Value
    description: str
    distribution: Any = None
    options: tuple[Value, ...] = field(default=())

    @property
    def moves_the_measurement(self) -> bool:
        """Whether it acts on the measured path, not on the model."""
        return self.name in MEASUREMENT_KEYS

    @property
    def is_form(self) -> bool:
        """Whether it chooses the form of the model, not one of its inputs.

        The validation uncertainty of V&V 20 takes in the scatter of inputs; whether the form of the model is
        right is what the comparison error then says.
        """
        return self.name in FORM_KEYS

    @property
    def is_input(self) -> bool:
        """Whether its scatter makes the modelled path uncertain."""
        return not self.moves_the_measurement and not self.is_form

    @property
    def is_choice(self) -> bool:
        """Whether it is one of several options, not a number on a scale."""
        return bool(self.options)

    def value(self, share: float) -> Value:
        """Return the value below which the given share of the probability lies (0 to 1)."""
        if self.options:
            return self.options[min(int(share * len(self.options)), len(self.options) - 1)]
        return float(self.distribution.ppf(share))

    def share(self, value: Value) -> float:
        """Return the probability below a value; for an option, the middle of its share."""
        if self.options:
            return (self.options.index(value) + 0.5) / len(self.options)
        return float(self.distribution.cdf(value))

    @property
    def interval(self) -> tuple[Value, Value]:
        """The values between which 95 % of the probability lies; first and last option of a choice."""
        return self.value(_INTERVAL[0]), self.value(_INTERVAL[1])

    @property
    def sigma(self) -> float:
        """Standard deviation; NaN for a choice."""
        return float("nan") if self.options else float(self.distribution.std())


def suspects_of(study: StudyFile, nominal: Experiment, *, source: str) -> tuple[Suspect, ...]:
    """Return the suspects of a study about the nominal values of an experiment.

    Raises
    ------
    InputError
        If a name is no key of the experiment file, or a distribution does not fit its parameter.
    """
    return tuple(
        _suspect(name, section, nominal, f"{source}: [suspects.{name}]")
        for name, section in study.suspects.items()
    )


def nominal_point(suspects: tuple[Suspect, ...]) -> FloatArray:
    """Return the place of the nominal values in the unit cube, shape (n_suspects,)."""
    return np.array([one.share(one.nominal) for one in suspects])


def _suspect(name: str, section: SuspectSection, experiment: Experiment, where: str) -> Suspect:
    place, nominal = nominal_value(name, experiment, where=where)
    field_of = type(getattr(experiment, place)).model_fields[name]
    common: dict[str, Any] = {"name": name, "section": place, "description": field_of.description or ""}
    if section.distribution == "choice":
        options = _options(section, name, nominal, where)
        return Suspect(nominal=options[0] if nominal is None else nominal, options=options, **common)
    if isinstance(nominal, str) or is_whole_number(name):
        raise InputError(f'{where}: {name} is {nominal!r}, expected a choice; use distribution = "choice"')
    centre = next((one for one in (section.mode, section.mean, nominal) if one is not None), None)
    if centre is None:
        raise InputError(f"{where}: {name} has no nominal value; give it in the experiment file, or mean")
    distribution = _distribution(section, float(centre), bounds(name), where)
    low, high = distribution.support()
    middle = float(centre if nominal is None else nominal)
    if not low <= middle <= high:
        raise InputError(
            f"{where}: the nominal {name} is {middle:g}, outside {low:g} to {high:g}; widen the distribution "
            "or correct the experiment file"
        )
    return Suspect(nominal=middle, distribution=distribution, **common)


def _distribution(section: SuspectSection, centre: float, allowed: tuple[float, float], where: str) -> Any:
    """Return the distribution; a normal one ends where the parameter's allowed values end."""
    if section.distribution == "normal":
        ends = [(limit - centre) / (section.sigma or 1.0) for limit in allowed]
        return stats.truncnorm(*ends, centre, section.sigma)
    low = section.low if section.low is not None else centre - (section.plus_minus or 0.0)
    high = section.high if section.high is not None else centre + (section.plus_minus or 0.0)
    if low < allowed[0] or high > allowed[1]:
        raise InputError(
            f"{where}: goes from {low:g} to {high:g}, allowed are {allowed[0]:g} to {allowed[1]:g}; narrow it"
        )
    if section.distribution == "uniform":
        return stats.uniform(low, high - low)
    if not low <= centre <= high:
        raise InputError(f"{where}: mode is {centre:g}, expected {low:g} to {high:g}; correct it")
    return stats.triang((centre - low) / (high - low), low, high - low)


def _options(section: SuspectSection, name: str, nominal: Value | None, where: str) -> tuple[Value, ...]:
    is_material = name.endswith("_material")
    options = section.options
    if options is None:
        if not is_material:
            raise InputError(f"{where}: a choice of {name} needs options = [...]; add it")
        family = find_material(str(nominal)).alternative_to or str(nominal)
        options = (family, *(each.name for each in alternatives(family)))
        if len(options) < 2:
            raise InputError(f"{where}: {nominal} has no alternatives in the library; give options = [...]")
    if nominal is not None and nominal not in options:
        raise InputError(f"{where}: the nominal {name} is {nominal!r}, expected it among the options; add it")
    return tuple(sorted(options, key=_shear_modulus_MPa)) if is_material else options


def _shear_modulus_MPa(name: Value) -> float:
    return find_material(str(name)).law.shear_modulus_MPa
