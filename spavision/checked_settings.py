"""Settings files checked key by key, and one sentence about the first thing that is wrong with one."""

from __future__ import annotations

import difflib
from typing import Any, TypeVar, get_args

from pydantic import BaseModel, ConfigDict, ValidationError

from spavision.errors import InputError

Settings = TypeVar("Settings", bound=BaseModel)


class Section(BaseModel):
    """A section of a file: unknown keys are refused, values are fixed once read."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=False)


def checked(settings: type[Settings], content: dict[str, Any], *, source: str) -> Settings:
    """Build settings from the content of a file.

    Parameters
    ----------
    settings : type
        What the file describes.
    content : dict
    source : str
        Name of the file, for the message.

    Raises
    ------
    InputError
        If a key is unknown or a value out of range: the first of them, and how to mend it.
    """
    try:
        return settings.model_validate(content)
    except ValidationError as error:
        raise InputError(f"{source}: {_sentence(settings, error)}") from error


def did_you_mean(name: str, names: list[str], *, at_most: int = 1) -> str:
    """Offer the nearest of the known names, or all of them where none is near."""
    close = difflib.get_close_matches(name, names, n=at_most, cutoff=0.5)
    return f"did you mean {' or '.join(close)}?" if close else f"expected one of {', '.join(names)}"


def _sentence(settings: type[BaseModel], error: ValidationError) -> str:
    first = error.errors()[0]
    *sections, key = [str(part) for part in first["loc"]] or ["file"]
    where = f"[{'.'.join(sections)}] {key}" if sections else f"[{key}]"
    known = _fields(settings, sections)
    if first["type"] == "extra_forbidden":
        return f"unknown key {where}; {did_you_mean(key, list(known))}"
    message = first["msg"].removeprefix("Value error, ")
    message = message[:1].lower() + message[1:]
    description = known[key].description if key in known else None
    value = "" if isinstance(first["input"], dict) else f" is {first['input']!r}:"
    return f"{where}{value} {message}{f' ({description})' if description else ''}; correct the value"


def _fields(settings: type[BaseModel], sections: list[str]) -> dict[str, Any]:
    """Return the fields of a section, by key; none where the names lead to no section."""
    found: Any = settings
    for name in sections:
        if isinstance(found, type) and issubclass(found, BaseModel):
            found = found.model_fields[name].annotation if name in found.model_fields else None
        else:
            # A table of tables or a list of tables: its members are all alike.
            found = get_args(found)[-1] if get_args(found) else None
    is_section = isinstance(found, type) and issubclass(found, BaseModel)
    return dict(found.model_fields) if is_section else {}
