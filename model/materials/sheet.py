"""Thin sheets such as bond paper: linear elastic, read from the data files beside this module."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from functools import cache
from importlib.resources import files


@dataclass(frozen=True)
class Sheet:
    """A thin elastic sheet.

    Parameters
    ----------
    name : str
    thickness_mm : float
    youngs_modulus_MPa : float
        Along the machine direction.
    youngs_modulus_range_MPa : tuple of float
        Lowest and highest value of the sources.
    cross_direction_modulus_MPa : float
    poissons_ratio : float
    density_g_per_cm3 : float
    strength_MPa : float
        In tension along the machine direction.
    source, uncertain : str
    """

    name: str
    thickness_mm: float
    youngs_modulus_MPa: float
    youngs_modulus_range_MPa: tuple[float, float]
    cross_direction_modulus_MPa: float
    poissons_ratio: float
    density_g_per_cm3: float
    strength_MPa: float
    source: str
    uncertain: str


@cache
def published_sheets() -> dict[str, Sheet]:
    """Return every sheet of the library by name, in alphabetical order."""
    folder = files(__package__) / "data" / "sheets"
    sheets = []
    for entry in folder.iterdir():
        if entry.name.endswith(".toml"):
            content = tomllib.loads(entry.read_text(encoding="utf-8"))
            low, high = content.pop("youngs_modulus_range_MPa")
            sheets.append(Sheet(youngs_modulus_range_MPa=(low, high), **content))
    return {sheet.name: sheet for sheet in sorted(sheets, key=lambda one: one.name)}
