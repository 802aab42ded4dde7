"""Render settings from tables and from ``key=value`` texts, with one sentence for each mistake."""

from __future__ import annotations

import dataclasses
import difflib
import tomllib
from collections.abc import Iterable, Mapping
from typing import Any

from spavision.errors import InputError

from .settings import EVENTS, RenderSettings, check_settings, walk


def settings_from_table(table: Mapping[str, Any], *, source: str) -> RenderSettings:
    """Return the settings that a table (as read from a scene TOML) asks for, defaults elsewhere.

    Raises
    ------
    InputError
        If a key is unknown or a value out of range; the message names ``source``.
    """
    try:
        return check_settings(_merged(RenderSettings(), table))
    except InputError as error:
        raise InputError(f"{source}: {error}") from error


def with_overrides(settings: RenderSettings, assignments: Iterable[str]) -> RenderSettings:
    """Return the settings with ``section.key=value`` texts laid over them.

    The value is written as in TOML; a bare word is a text. Lists of events are given whole:
    ``bumps=[{photo=3, dx_mm=8.0}]``.

    Raises
    ------
    InputError
        If a text has no ``=``, or as `settings_from_table`.
    """
    for assignment in assignments:
        name, equals, text = assignment.partition("=")
        if not equals:
            raise InputError(f"--set {assignment}: expected key=value, such as optics.defocus_px=2")
        table: dict[str, Any] = {}
        inner = table
        *sections, key = name.strip().split(".")
        for section in sections:
            inner = inner.setdefault(section, {})
        inner[key] = _value(text.strip())
        try:
            settings = check_settings(_merged(settings, table))
        except InputError as error:
            raise InputError(f"--set {assignment}: {error}") from error
    return settings


def settings_list() -> list[tuple[str, str, str, str]]:
    """Return name, default, unit and meaning of every setting, events with their own keys."""
    rows = [
        (name, repr(value), field.metadata["unit"], field.metadata["meaning"])
        for name, value, field in walk(RenderSettings())
    ]
    for name, event in EVENTS.items():
        rows += [
            (f"{name}[].{field.name}", repr(field.default), field.metadata["unit"], field.metadata["meaning"])
            for field in dataclasses.fields(event)
        ]
    return rows


def _merged(settings: RenderSettings, table: Mapping[str, Any]) -> RenderSettings:
    changes: dict[str, Any] = {}
    for key, value in table.items():
        _refuse_unknown(key, settings, "")
        current = getattr(settings, key)
        if key in EVENTS:
            changes[key] = _events(key, value)
        elif dataclasses.is_dataclass(current) and not isinstance(current, type):
            changes[key] = _section(key, current, value)
        else:
            changes[key] = value
    return dataclasses.replace(settings, **changes)


def _section(name: str, current: Any, value: Any) -> Any:
    if not isinstance(value, Mapping):
        raise InputError(f"{name} is a section, expected keys such as {name}.{_first_key(current)}")
    for key in value:
        _refuse_unknown(key, current, f"{name}.")
    return dataclasses.replace(current, **_as_floats(current, value))


def _events(name: str, value: Any) -> tuple[Any, ...]:
    if not isinstance(value, list) or not all(isinstance(entry, Mapping) for entry in value):
        raise InputError(f"{name}: expected a list of tables, such as [{{photo = 3}}]")
    for entry in value:
        for key in entry:
            _refuse_unknown(key, EVENTS[name](), f"{name}[].")
    return tuple(EVENTS[name](**_as_floats(EVENTS[name](), entry)) for entry in value)


def _as_floats(current: Any, values: Mapping[str, Any]) -> dict[str, Any]:
    """Take a whole number for a number, as people write it."""
    return {
        key: float(value) if type(value) is int and isinstance(getattr(current, key), float) else value
        for key, value in values.items()
    }


def _refuse_unknown(key: str, holder: Any, prefix: str) -> None:
    names = [field.name for field in dataclasses.fields(holder)]
    if key not in names:
        close = difflib.get_close_matches(key, names, n=1, cutoff=0.4)
        hint = f"did you mean {prefix}{close[0]}?" if close else f"expected one of {', '.join(names)}"
        raise InputError(f"unknown setting {prefix}{key}; {hint}")


def _first_key(section: Any) -> str:
    return dataclasses.fields(section)[0].name


def _value(text: str) -> Any:
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        return text
