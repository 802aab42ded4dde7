"""Pictures of a virtual tensile test."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

from spavision.model.fitting.transition import StrainTransition

from .coupon import Coupon

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_RIM = [0, 3, 6, 7, 8, 5, 2, 1]
"""Nodes round a nine-node quadrilateral whose nodes are numbered column by column."""

_PANELS = 4


def coupon_figure(coupon: Coupon, transition: StrainTransition | None) -> Figure:
    """Draw the stress-strain curve with the transition's two lines, and the cell on its way.

    Parameters
    ----------
    coupon : Coupon
    transition : StrainTransition or None
        As the coupon has one or not.
    """
    figure = Figure(figsize=(10.0, 4.6), layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=(1.2, 1.0))
    _draw_curve(left, coupon, transition)
    _draw_cells(right, coupon)
    return figure


def _draw_curve(axes: Axes, coupon: Coupon, transition: StrainTransition | None) -> None:
    axes.plot(100.0 * coupon.strain, 1e3 * coupon.stress_MPa, color="#0072B2", marker=".", markersize=4)
    top = 1e3 * float(coupon.stress_MPa.max())
    if transition is not None:
        strain = np.linspace(0.0, float(coupon.strain.max()), 200)
        for line, name in ((transition.primary, "primary"), (transition.secondary, "secondary")):
            stress = 1e3 * (line.modulus_MPa * strain + line.intercept_MPa)
            shown = (stress > -0.05 * top) & (stress < top)
            label = f"{name} modulus {1e3 * line.modulus_MPa:.0f} kPa"
            axes.plot(100.0 * strain[shown], stress[shown], linewidth=0.9, label=label)
        axes.plot(
            100.0 * transition.strain,
            1e3 * transition.stress_MPa,
            "k*",
            markersize=9,
            label=f"transition {transition.strain:.1%}",
        )
    straight = 100.0 * coupon.cell.geometry.straight_strain
    axes.axvline(straight, color="0.6", linestyle=":", label=f"paper straight, {straight:.1f} %")
    axes.set(xlabel="engineering strain, %", ylabel="nominal stress, kPa", title=coupon.name)
    axes.grid(alpha=0.3)
    axes.legend(fontsize="small")


def _draw_cells(axes: Axes, coupon: Coupon) -> None:
    """Half a wave at a few strains, one above the other; paper in black."""
    mesh = coupon.cell.mesh
    rows = np.linspace(0, len(coupon.states) - 1, _PANELS).round().astype(int)
    pitch = 1.1 * coupon.cell.geometry.thickness_mm
    for place, row in enumerate(rows):
        displacement, _ = coupon.cell.fields(coupon.states[row])
        position = mesh.nodes_mm + displacement[:, :2] - np.array([0.0, place * pitch])
        cells = PolyCollection(
            list(position[mesh.elements[:, _RIM]]), facecolors="#cfe8dc", edgecolors="#7fb79c", linewidths=0.3
        )
        axes.add_collection(cells)
        axes.plot(*position[mesh.paper_nodes].T, color="black", linewidth=1.4)
        axes.annotate(
            f"{coupon.strain[row]:.1%}",
            (0.0, -place * pitch),
            xytext=(-38, 0),
            textcoords="offset points",
            va="center",
            fontsize="small",
        )
    axes.autoscale_view()
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.set_title("half a wave, bonded paper in black", fontsize="medium")
