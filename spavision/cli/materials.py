"""``spavision materials``: the material library."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from spavision.table_text import number

if TYPE_CHECKING:
    from spavision.model.materials.material_files import Material


@click.command()
@click.argument("name", required=False)
@click.option(
    "--materials",
    "folder",
    type=click.Path(path_type=Path),
    help="Folder with material files of your own [default: the variable SPAVISION_MATERIALS].",
)
@click.option("--json", "as_json", is_flag=True, help="Print the result as JSON on standard output.")
def materials(name: str | None, folder: Path | None, as_json: bool) -> None:
    """List the materials, or show the one called NAME with parameters, source and what is uncertain.

    Sets of parameters that disagree on one material stand below it as alternatives.
    """
    from spavision.model.materials.library import all_materials, find_material
    from spavision.model.materials.sheet import published_sheets

    from . import output

    sheets = published_sheets()
    if name in sheets:
        output.print_json(vars(sheets[name])) if as_json else output.print_lines(_lines(vars(sheets[name])))
        return
    shown = [find_material(name, folder)] if name else list(all_materials(folder).values())
    if as_json:
        output.print_json({"materials": [_record(each) for each in shown], "sheets": _sheets(name)})
    elif name:
        output.print_lines(_details(shown[0]))
    else:
        _print_tables(shown)


def _print_tables(shown: list[Material]) -> None:
    from spavision.model.materials.sheet import published_sheets

    from . import output

    rows = [
        [
            f"- {each.name}" if each.alternative_to else each.name,
            _record(each)["law"]["kind"],
            number(1e3 * each.law.shear_modulus_MPa, 1),
            _range(each),
            f"{each.density_g_per_cm3:g}",
            each.source,
        ]
        for each in shown
    ]
    header = ["material", "law", "G0 kPa", "strain %", "density g/cm³", "remark"]
    output.print_table("Hyperelastic materials", header, rows)
    sheets = [
        [
            each.name,
            f"{each.thickness_mm:g}",
            f"{each.youngs_modulus_MPa:g}",
            "{:g} to {:g}".format(*each.youngs_modulus_range_MPa),
            each.source,
        ]
        for each in published_sheets().values()
    ]
    output.print_table("Sheets", ["sheet", "thickness mm", "E MPa", "sources MPa", "remark"], sheets)


def _details(material: Material) -> list[str]:
    from spavision.model.materials.conventions import CONVENTIONS, moduli_in
    from spavision.model.materials.ogden import Ogden
    from spavision.model.materials.stability import stable_ranges

    record = _record(material)
    law = record.pop("law")
    lines = _lines({**record, **law})
    if isinstance(material.law, Ogden):
        for convention in CONVENTIONS.values():
            moduli = ", ".join(f"{value:.6g}" for value in moduli_in(material.law, convention))
            lines.append(f"as {convention.name} ({convention.used_by}): {moduli}")
    return [*lines, *(f"stable, {each}" for each in stable_ranges(material.law).values())]


def _record(material: Material) -> dict[str, Any]:
    from spavision.model.materials.law_tables import law_to_table

    return {
        "name": material.name,
        "alternative_to": material.alternative_to,
        "law": law_to_table(material.law),
        "shear_modulus_MPa": material.law.shear_modulus_MPa,
        "density_g_per_cm3": material.density_g_per_cm3,
        "strain_range": material.strain_range,
        "source": material.source,
        "uncertain": material.uncertain,
    }


def _sheets(name: str | None) -> list[dict[str, Any]]:
    from spavision.model.materials.sheet import published_sheets

    return [] if name else [vars(sheet) for sheet in published_sheets().values()]


def _range(material: Material) -> str:
    if material.strain_range is None:
        return "–"
    return "{:.0f} to {:.0f}".format(*(100.0 * end for end in material.strain_range))


def _lines(record: dict[str, Any]) -> list[str]:
    return [f"{key}: {value}" for key, value in record.items() if value not in ("", None)]
