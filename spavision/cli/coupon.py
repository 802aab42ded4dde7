"""``spavision coupon``: virtual tensile test of the crimped-paper composite."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from .options import results_options

if TYPE_CHECKING:
    from spavision.model.coupon.coupon import Coupon


@click.command()
@click.option("--crimp", type=float, required=True, help="Crimp ratio: amplitude over wavelength, 0 to 0.5.")
@click.option("--wavelength-mm", type=float, help="Of the wave [default: 5, assumed].")
@click.option("--thickness-mm", type=float, help="Of the composite [default: 5, the article's].")
@click.option("--fold-radius-mm", type=float, help="Of the folds, 0 for sharp ones [default: 0.25, assumed].")
@click.option(
    "--hinged-folds", is_flag=True, help="The paper turns freely at its folds, as if creased through."
)
@click.option(
    "--matrix", default="Ecoflex 00-30", show_default=True, help="Material of the library, or a file."
)
@click.option("--paper", default="Bond paper 80 gsm", show_default=True, help="Sheet of the library.")
@click.option("--paper-thickness-mm", type=float, help="[default: the sheet's]")
@click.option(
    "--paper-modulus-mpa", type=float, help="Along the wave; 0 leaves the paper out [default: the sheet's]."
)
@click.option("--paper-strength-mpa", type=float, help="Tension at which it tears [default: the sheet's].")
@click.option(
    "--paper-yield-mpa",
    type=float,
    help="Yield stress that limits the bending moment; inf for elastic bending [default: the strength].",
)
@click.option(
    "--lateral",
    type=click.Choice(["plane-strain", "plane-stress"]),
    default="plane-strain",
    show_default=True,
    help="Width held, or free to change alike everywhere (generalised plane stress).",
)
@click.option("--paper-cross-ratio", type=float, help="Modulus along over across the folds, 0: none across.")
@click.option("--strain-step", type=float, help="From point to point of the curve [default: 0.005].")
@click.option("--end-strain", type=float, help="End of the test unless the paper tears before.")
@results_options
def coupon(**given: Any) -> None:
    """Pull a periodic cell of matrix and crimped paper until the paper tears.

    Gives the stress-strain curve of a crimp ratio that nobody tested, with primary and secondary modulus and
    the strain transition point by the article's procedure, and the slack-fibre law that stands for it in the
    actuator's model. Writes the curve, composite.toml, a figure, the fields as VTU files and run.json.
    """
    from spavision.results import ResultsFolder

    from . import output
    from .coupon_results import coupon_record, write_coupon

    name = f"crimp-{given['crimp']:.2f}"
    results = ResultsFolder(given["output"] or output.default_output("coupon", name), force=given["force"])
    pulled = _pull(given)
    write_coupon(results, pulled, options=given)
    if given["as_json"]:
        output.print_json({**coupon_record(pulled), "output": str(results.path)})
        return
    if not given["quiet"]:
        _report(pulled)
    output.print_lines([f"Results: {results.path}"])


def _pull(given: dict[str, Any]) -> Coupon:
    from spavision.model.coupon.cell import CellSettings
    from spavision.model.coupon.coupon import CouponSettings, pull_coupon
    from spavision.model.coupon.geometry import CouponGeometry
    from spavision.model.coupon.paper import paper_of_sheet
    from spavision.model.materials.library import find_material
    from spavision.workflow.progress import progress_bar

    geometry = CouponGeometry(
        given["crimp"], **_given(given, "wavelength_mm", "thickness_mm", "fold_radius_mm")
    )
    paper = paper_of_sheet(
        given["paper"],
        **{
            key: given[option]
            for option, key in (
                ("paper_thickness_mm", "thickness_mm"),
                ("paper_modulus_mpa", "modulus_MPa"),
                ("paper_strength_mpa", "strength_MPa"),
                ("paper_yield_mpa", "bending_yield_MPa"),
                ("paper_cross_ratio", "cross_ratio"),
            )
            if given[option] is not None
        },
    )
    cell = CellSettings(lateral=given["lateral"], hinged_folds=given["hinged_folds"])
    settings = CouponSettings(cell=cell, **_given(given, "strain_step", "end_strain"))
    matrix = find_material(given["matrix"]).solid()
    with progress_bar("coupon", total=settings.last_strain(geometry), quiet=given["quiet"]) as advance:
        return pull_coupon(
            geometry,
            matrix=matrix,
            paper=paper,
            settings=settings,
            progress=lambda strain: advance(f"{strain:.1%}", strain),
        )


def _given(given: dict[str, Any], *names: str) -> dict[str, Any]:
    return {name: given[name] for name in names if given[name] is not None}


def _report(pulled: Coupon) -> None:
    from . import output
    from .coupon_results import coupon_notes, coupon_rows

    output.print_table(
        f"Virtual tensile test, {pulled.name}", ["quantity", "value", "remark"], coupon_rows(pulled)
    )
    output.print_lines(coupon_notes(pulled))
