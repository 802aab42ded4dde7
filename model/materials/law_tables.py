"""Laws as they stand in material files: the kind, the parameters, and Ogden's convention."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any

from spavision.errors import InputError

from .arruda_boyce import ArrudaBoyce
from .conventions import MU_OVER_ALPHA, convention_of, ogden_from
from .gent import Gent
from .mooney_rivlin import MooneyRivlin
from .neo_hooke import NeoHooke
from .ogden import Ogden
from .solid import IsotropicLaw
from .yeoh import Yeoh

OGDEN = "ogden"

_OF_SCALARS: dict[str, type] = {
    "neo-hooke": NeoHooke,
    "mooney-rivlin": MooneyRivlin,
    "yeoh": Yeoh,
    "gent": Gent,
    "arruda-boyce": ArrudaBoyce,
}
"""Kinds whose parameters are numbers named as in the law's class."""

LAW_KINDS = (OGDEN, *_OF_SCALARS)


def law_from_table(table: Mapping[str, Any], *, source: str) -> IsotropicLaw:
    """Build a law from a ``[law]`` table.

    Parameters
    ----------
    table : mapping
        ``kind`` and the parameters: for ``ogden`` the keys convention, mu_MPa and alpha, else the names of
        the fields of the law's class, such as c10_MPa.
    source : str
        The file's name for messages.

    Raises
    ------
    InputError
        If the kind or a key is unknown, a parameter is missing, not a number or out of its range.
    """
    given = dict(table)
    kind = given.pop("kind", None)
    if kind not in LAW_KINDS:
        raise InputError(f"{source}: [law] kind is {kind!r}, expected one of {', '.join(LAW_KINDS)}")
    try:
        return _ogden(given, source) if kind == OGDEN else _of_scalars(_OF_SCALARS[kind], given, source)
    except (ValueError, InputError) as error:
        message = str(error)
        raise InputError(message if message.startswith(source) else f"{source}: [law] {message}") from error


def law_to_table(law: IsotropicLaw) -> dict[str, Any]:
    """Write a law as a ``[law]`` table; Ogden's in the convention of `Ogden`."""
    if isinstance(law, Ogden):
        return {
            "kind": OGDEN,
            "convention": MU_OVER_ALPHA.name,
            "mu_MPa": list(law.mu_MPa),
            "alpha": list(law.alpha),
        }
    for kind, law_class in _OF_SCALARS.items():
        if isinstance(law, law_class):
            parameters = {field.name: getattr(law, field.name) for field in dataclasses.fields(law_class)}
            return {"kind": kind, **parameters}
    raise TypeError(f"{type(law).__name__} has no form in material files")


def _ogden(given: dict[str, Any], source: str) -> Ogden:
    _check_keys(given, required={"convention", "mu_MPa", "alpha"}, optional=set(), source=source)
    moduli, exponents = (
        tuple(_number(value, key, source) for value in _list(given[key], key, source))
        for key in ("mu_MPa", "alpha")
    )
    return ogden_from(moduli, exponents, convention_of(given["convention"]))


def _of_scalars(law_class: type, given: dict[str, Any], source: str) -> IsotropicLaw:
    fields = dataclasses.fields(law_class)
    optional = {field.name for field in fields if field.default is not dataclasses.MISSING}
    required = {field.name for field in fields} - optional
    _check_keys(given, required=required, optional=optional, source=source)
    law: IsotropicLaw = law_class(**{key: _number(value, key, source) for key, value in given.items()})
    return law


def _check_keys(given: dict[str, Any], *, required: set[str], optional: set[str], source: str) -> None:
    for key in sorted(required - set(given)):
        raise InputError(f"{source}: [law] {key} is missing; add it")
    for key in sorted(set(given) - required - optional):
        expected = ", ".join(sorted(required | optional))
        raise InputError(f"{source}: [law] unknown key {key}, expected {expected}")


def _list(value: Any, key: str, source: str) -> list[Any]:
    if not isinstance(value, list) or not value:
        raise InputError(f"{source}: [law] {key} is {value!r}, expected a list of numbers, one a term")
    return value


def _number(value: Any, key: str, source: str) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise InputError(f"{source}: [law] {key} holds {value!r}, expected a number")
    return float(value)
