"""The silicones with published parameters, read from the data files beside this module."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

from spavision.errors import InputError

from .ogden import Ogden
from .solid import BULK_TO_SHEAR, SolidMaterial

_TONNE_PER_MM3_PER_G_PER_CM3 = 1e-9


@dataclass(frozen=True)
class PublishedMaterial:
    """A silicone's published parameters.

    Parameters
    ----------
    name : str
    law : Ogden
    density_g_per_cm3 : float
    source : str
    """

    name: str
    law: Ogden
    density_g_per_cm3: float
    source: str

    def solid(self, *, bulk_to_shear: float = BULK_TO_SHEAR) -> SolidMaterial:
        """Return the material as the solver takes it."""
        return SolidMaterial(
            law=self.law,
            bulk_modulus_MPa=bulk_to_shear * self.law.shear_modulus_MPa,
            density_tonne_per_mm3=self.density_g_per_cm3 * _TONNE_PER_MM3_PER_G_PER_CM3,
        )


@cache
def published_materials() -> dict[str, PublishedMaterial]:
    """Return every material of the library by name, in alphabetical order."""
    folder = files(__package__) / "data"
    materials = [
        _from_toml(entry.read_text(encoding="utf-8"))
        for entry in folder.iterdir()
        if entry.name.endswith(".toml")
    ]
    return {material.name: material for material in sorted(materials, key=lambda one: one.name)}


def find_material(name: str) -> PublishedMaterial:
    """Return the material of that name.

    Raises
    ------
    InputError
        If the library holds none.
    """
    library = published_materials()
    if name not in library:
        raise InputError(f"material {name!r} is not in the library, expected one of {', '.join(library)}")
    return library[name]


def _from_toml(text: str) -> PublishedMaterial:
    data = tomllib.loads(text)
    law = data["law"]
    if law["kind"] != "ogden" or law["convention"] != "mu/alpha":
        raise ValueError(f"{data['name']}: expected an Ogden law in the convention mu/alpha")
    return PublishedMaterial(
        name=data["name"],
        law=Ogden(tuple(law["mu_MPa"]), tuple(law["alpha"])),
        density_g_per_cm3=data["density_g_per_cm3"],
        source=data["source"],
    )
