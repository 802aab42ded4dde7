"""The material library: what comes with the program, and what stands in the user's folder."""

from __future__ import annotations

import os
from functools import cache
from importlib.resources import files
from pathlib import Path

from spavision.errors import InputError

from .material_files import Material, parse_material, read_material

FOLDER_VARIABLE = "SPAVISION_MATERIALS"
"""Environment variable that names the user's folder of material files."""

_ENDING = ".toml"


@cache
def published_materials() -> dict[str, Material]:
    """Return the materials that come with the program by name, each followed by its alternatives."""
    data = files(__package__) / "data"
    entries = [entry for folder in (data, data / "alternatives") for entry in folder.iterdir()]
    materials = [
        parse_material(entry.read_text(encoding="utf-8"), source=entry.name)
        for entry in entries
        if entry.name.endswith(_ENDING)
    ]
    return {material.name: material for material in sorted(materials, key=_family_order)}


def user_materials(folder: Path | None = None) -> dict[str, Material]:
    """Return the materials of the user's folder by name.

    Parameters
    ----------
    folder : Path, optional
        The folder that `FOLDER_VARIABLE` names unless given; without either there are none.

    Raises
    ------
    InputError
        If the folder does not exist, a file in it is not valid, or two bear one name.
    """
    if folder is None:
        named = os.environ.get(FOLDER_VARIABLE, "")
        if not named:
            return {}
        folder = Path(named)
    if not folder.is_dir():
        raise InputError(
            f"{folder}: is not a folder, expected one with material files; correct --materials or "
            f"the variable {FOLDER_VARIABLE}"
        )
    found: dict[str, Material] = {}
    for path in sorted(folder.glob(f"*{_ENDING}")):
        material = read_material(path)
        if material.name in found:
            raise InputError(f"{path}: the name {material.name!r} stands in another file too; change one")
        found[material.name] = material
    return found


def all_materials(folder: Path | None = None) -> dict[str, Material]:
    """Return every material by name, each followed by its alternatives.

    One of the user's replaces a packaged one of the same name.
    """
    materials = published_materials() | user_materials(folder)
    return {material.name: material for material in sorted(materials.values(), key=_family_order)}


def find_material(name: str, folder: Path | None = None) -> Material:
    """Return the material of that name, or that of the file where the name ends in ``.toml``.

    Raises
    ------
    InputError
        If there is none, or a file is not valid.
    """
    if name.endswith(_ENDING):
        return read_material(Path(name))
    materials = all_materials(folder)
    if name not in materials:
        raise InputError(
            f"material {name!r} is unknown, expected one of {', '.join(materials)}, or the path of "
            "a material file"
        )
    return materials[name]


def alternatives(name: str, folder: Path | None = None) -> tuple[Material, ...]:
    """Return the other sets of parameters for a material, which a study can sweep."""
    return tuple(each for each in all_materials(folder).values() if each.alternative_to == name)


def _family_order(material: Material) -> tuple[str, bool, str]:
    return material.alternative_to or material.name, bool(material.alternative_to), material.name
