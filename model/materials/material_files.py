"""Material files: one TOML file a parameter set, read and written."""

from __future__ import annotations

import json
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from spavision.errors import InputError

from .law_tables import law_from_table, law_to_table
from .solid import BULK_TO_SHEAR, IsotropicLaw, SolidMaterial

_TONNE_PER_MM3_PER_G_PER_CM3 = 1e-9

_DENSITY_RANGE = (0.1, 10.0)
"""In g/cm³; anything else is a slip of the unit."""

_TEXTS = ("name", "source", "uncertain", "alternative_to")
_KEYS = (*_TEXTS, "density_g_per_cm3", "strain_range", "law")


@dataclass(frozen=True)
class Material:
    """A hyperelastic material with what is known of it.

    Parameters
    ----------
    name : str
        What experiment files call it.
    law : IsotropicLaw
    density_g_per_cm3 : float
    source : str
        Where the parameters come from.
    uncertain : str
        What is not certain about them; may be empty.
    strain_range : tuple of float or None
        Engineering strains between which they were fitted.
    alternative_to : str
        Name of the material of which this is another set of parameters; empty for the default set.
    """

    name: str
    law: IsotropicLaw
    density_g_per_cm3: float
    source: str
    uncertain: str = ""
    strain_range: tuple[float, float] | None = None
    alternative_to: str = ""

    def solid(self, *, bulk_to_shear: float = BULK_TO_SHEAR) -> SolidMaterial:
        """Return the material as the solver takes it."""
        return SolidMaterial(
            law=self.law,
            bulk_modulus_MPa=bulk_to_shear * self.law.shear_modulus_MPa,
            density_tonne_per_mm3=self.density_g_per_cm3 * _TONNE_PER_MM3_PER_G_PER_CM3,
        )


def read_material(path: Path) -> Material:
    """Read a material file.

    Raises
    ------
    InputError
        If it cannot be read, is not TOML, or a key is missing, unknown or out of its range.
    """
    try:
        return parse_material(path.read_text(encoding="utf-8-sig"), source=str(path))
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror}); name an existing file") from error
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: is not UTF-8 text; save the material file as UTF-8") from error


def parse_material(text: str, *, source: str) -> Material:
    """Build a material from the text of its file.

    Raises
    ------
    InputError
        As `read_material`.
    """
    try:
        content = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{source}: is not valid TOML ({error}); correct that line") from error
    for key in content:
        if key not in _KEYS:
            raise InputError(f"{source}: unknown key {key}, expected {', '.join(_KEYS)}")
    for key in ("name", "source", "density_g_per_cm3", "law"):
        if key not in content:
            raise InputError(f"{source}: {key} is missing; add it")
    for key in _TEXTS:
        if not isinstance(content.get(key, ""), str):
            raise InputError(f"{source}: {key} is {content[key]!r}, expected text in quotes")
    if not isinstance(content["law"], dict):
        raise InputError(f"{source}: law is {content['law']!r}, expected a table [law]")
    return Material(
        name=content["name"],
        law=law_from_table(content["law"], source=source),
        density_g_per_cm3=checked_density(content["density_g_per_cm3"], source=source),
        source=content["source"],
        uncertain=content.get("uncertain", ""),
        strain_range=_strain_range(content.get("strain_range"), source),
        alternative_to=content.get("alternative_to", ""),
    )


def material_text(material: Material) -> str:
    """Write a material as the text of its file, which `parse_material` reads back the same."""
    head: dict[str, Any] = {
        "name": material.name,
        "alternative_to": material.alternative_to,
        "density_g_per_cm3": material.density_g_per_cm3,
        "strain_range": list(material.strain_range) if material.strain_range else "",
        "source": material.source,
        "uncertain": material.uncertain,
    }
    lines = [_line(key, value) for key, value in head.items() if value != ""]
    lines += ["", "[law]", *(_line(key, value) for key, value in law_to_table(material.law).items())]
    return "\n".join(lines) + "\n"


def _line(key: str, value: Any) -> str:
    """One entry; texts, numbers and lists of numbers are written in TOML as in JSON."""
    return f"{key} = {json.dumps(value, ensure_ascii=False)}"


def checked_density(value: Any, *, source: str) -> float:
    """Return a density in g/cm³.

    Raises
    ------
    InputError
        If it is not a number, or that of no rubber.
    """
    low, high = _DENSITY_RANGE
    if isinstance(value, bool) or not isinstance(value, int | float) or not low <= value <= high:
        raise InputError(
            f"{source}: density_g_per_cm3 is {value!r}, expected {low:g} to {high:g} g/cm³; correct the value"
        )
    return float(value)


def _strain_range(value: Any, source: str) -> tuple[float, float] | None:
    if value is None:
        return None
    numbers = isinstance(value, list) and all(
        isinstance(each, int | float) and not isinstance(each, bool) for each in value
    )
    if not numbers or len(value) != 2 or not -1.0 < value[0] < value[1]:
        raise InputError(
            f"{source}: strain_range is {value!r}, expected two engineering strains such as [-0.3, 2.0]"
        )
    return float(value[0]), float(value[1])
