"""One setting: a dataclass field that knows its unit, meaning and range, and the check of a value."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from typing import Any

from spavision.errors import InputError

from .colours import NAMED_COLOURS, parse_colour


def setting(
    default: Any,
    meaning: str,
    *,
    unit: str = "",
    low: float = -math.inf,
    high: float = math.inf,
    choices: tuple[Any, ...] = (),
    colour: bool = False,
) -> Any:
    """Return a dataclass field that knows its unit, its meaning and its range."""
    metadata = {
        "meaning": meaning,
        "unit": unit,
        "low": low,
        "high": high,
        "choices": choices,
        "colour": colour,
    }
    return dataclasses.field(default=default, metadata=metadata)


def check_value(name: str, value: Any, field: dataclasses.Field[Any]) -> None:
    """Raise `InputError` if one value has the wrong type or lies out of its range."""
    rule = field.metadata
    kind = str(field.type)
    accepted = {"int": (int,), "float": (float, int), "bool": (bool,), "str": (str,)}[kind]
    if type(value) not in accepted:
        raise InputError(f"{name}: expected {kind}, got {value!r}")
    if kind == "float" and not math.isfinite(value):
        raise InputError(f"{name}: expected a finite number, got {value}")
    if rule["choices"] and value not in rule["choices"]:
        raise InputError(f"{name}: {value!r} is none of {', '.join(map(str, rule['choices']))}")
    if kind in ("int", "float") and not rule["low"] <= value <= rule["high"]:
        raise InputError(f"{name}: {value} is not {_range(rule)}")
    if rule["colour"] and parse_colour(value) is None:
        raise InputError(f"{name}: {value!r} is neither #rrggbb nor one of {', '.join(NAMED_COLOURS)}")


def _range(rule: Mapping[str, Any]) -> str:
    """Say a setting's range in words."""
    unit = f" {rule['unit']}" if rule["unit"] else ""
    if math.isinf(rule["high"]):
        return f"at least {rule['low']:g}{unit}"
    return f"between {rule['low']:g} and {rule['high']:g}{unit}"
