"""The parameters that a study can vary: keys of the experiment file."""

from __future__ import annotations

import math
from typing import Any

from pydantic.fields import FieldInfo

from spavision.checked_settings import did_you_mean
from spavision.errors import InputError
from spavision.experiment import Experiment

Value = float | int | str

MODEL_SECTIONS = ("actuator", "composite", "model", "gauge")
"""Sections of the experiment file that the model depends on."""

MEASUREMENT_KEYS = {"standoff_mm": "camera", "distance_mm": "camera", "scale": "board"}
"""Keys that move the measured path instead of the modelled one, with their sections."""

FORM_KEYS = ("law",)
"""Keys that choose the form of the model, which a discrepancy may accuse but which has no scatter."""

OF_THE_PHOTOS = ("first_bend",)
"""Keys of these sections that say something of the photographs alone."""


def parameter_sections() -> dict[str, str]:
    """Return every parameter that a study can vary, with its section of the experiment file."""
    fields = Experiment.model_fields
    found: dict[str, str] = {}
    for section in MODEL_SECTIONS:
        annotation: Any = fields[section].annotation
        found |= {key: section for key in annotation.model_fields if key not in OF_THE_PHOTOS}
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


def is_whole_number(name: str) -> bool:
    """Whether a parameter counts something."""
    return _field(name).annotation is int


def bounds(name: str) -> tuple[float, float]:
    """Return the lowest and highest value that the experiment file allows for a number."""
    limits = [-math.inf, math.inf]
    for one in _field(name).metadata:
        for attribute, side in (("ge", 0), ("gt", 0), ("le", 1), ("lt", 1)):
            value = getattr(one, attribute, None)
            if value is not None:
                limits[side] = float(value)
    return limits[0], limits[1]


def _field(name: str) -> FieldInfo:
    section: Any = Experiment.model_fields[parameter_sections()[name]].annotation
    found: FieldInfo = section.model_fields[name]
    return found
