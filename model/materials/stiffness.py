"""A law made stiffer or softer as a whole, for scatter from batch to batch."""

from __future__ import annotations

from dataclasses import fields, is_dataclass, replace
from typing import Any

from .solid import IsotropicLaw

_UNIT = "_MPa"


def stiffened(law: IsotropicLaw, factor: float) -> IsotropicLaw:
    """Return the law with its energy, hence every stress, multiplied.

    The energy of each law is proportional to those of its parameters that are stresses, whose names end in
    the unit; exponents and limits keep their values.

    Parameters
    ----------
    law : IsotropicLaw
    factor : float

    Raises
    ------
    TypeError
        If the law is no dataclass of parameters.
    """
    if factor == 1.0:
        return law
    if not is_dataclass(law) or isinstance(law, type):
        raise TypeError(f"{law!r} is no dataclass of parameters")
    changes = {
        one.name: _times(getattr(law, one.name), factor) for one in fields(law) if one.name.endswith(_UNIT)
    }
    return replace(law, **changes)


def _times(value: Any, factor: float) -> Any:
    return tuple(factor * each for each in value) if isinstance(value, tuple) else factor * value
