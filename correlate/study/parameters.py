"""The parameters that a study can vary: keys of the experiment file."""

from __future__ import annotations

from typing import Any

from spavision.checked_settings import did_you_mean
from spavision.errors import InputError
from spavision.experiment import Experiment

Value = float | int | str

MODEL_SECTIONS = ("actuator", "composite")
"""Sections of the experiment file that the model depends on, the mesh apart."""

MEASUREMENT_KEYS = {"standoff_mm": "camera", "distance_mm": "camera", "scale": "board"}
"""Keys that move the measured path instead of the modelled one, with their sections."""

_NOT_UNCERTAIN = ("first_bend", "void_count")


def parameter_sections() -> dict[str, str]:
    """Return every parameter that a study can vary, with its section of the experiment file."""
    fields = Experiment.model_fields
    found: dict[str, str] = {}
    for section in MODEL_SECTIONS:
        annotation: Any = fields[section].annotation
        found |= {key: section for key in annotation.model_fields if key not in _NOT_UNCERTAIN}
    return found | MEASUREMENT_KEYS


def nominal_value(name: str, nominal: Experiment, *, where: str) -> tuple[str, Value | None]:
    """Return section and nominal value of a parameter.

    Raises
    ------
    InputError
        If there is no parameter of that name.
    """
    sections = parameter_sections()
    if name not in sections:
        raise InputError(
            f"{where}: suspect {name!r} is unknown; {did_you_mean(name, list(sections), at_most=3)}"
        )
    return sections[name], getattr(getattr(nominal, sections[name]), name)


def laid_over(nominal: Experiment, values: dict[str, Value]) -> Experiment:
    """Return the experiment with other values of some parameters.

    Raises
    ------
    InputError
        If a value is out of its range.
    """
    sections = parameter_sections()
    options: dict[str, dict[str, Value]] = {}
    for name, value in values.items():
        options.setdefault(sections[name], {})[name] = value
    return nominal.with_options(options)
