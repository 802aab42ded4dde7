"""Figures of an attribution: what each suspect can explain, and what moves the tip at which pressure."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from spavision.correlate.figures import MEASURED_COLOUR, MODELLED_COLOUR

from .explanation import Explanation
from .parameters import Value
from .sensitivity import SobolIndices

_SHOWN = 6
_FILLS = ("#0072B2", "#E69F00", "#009E73", "#D55E00", "#56B4E9", "#CC79A7")
# Okabe and Ito's palette.


def attribution_figure(alone: Sequence[Explanation], together: Explanation, *, title: str) -> Figure:
    """Draw how much of the root mean square distance each suspect can explain, the largest on top."""
    ordered = sorted(alone, key=lambda one: one.explained)
    names = [next(iter(one.values)) for one in ordered]
    removed = [one.nominal_rmse_mm - one.rmse_mm for one in ordered]
    figure = Figure(figsize=(7.5, 1.6 + 0.32 * (len(ordered) + 1)), layout="constrained")
    axes = figure.add_subplot()
    axes.barh(range(len(ordered)), removed, color=MODELLED_COLOUR)
    axes.barh([len(ordered)], [together.nominal_rmse_mm - together.rmse_mm], color=MEASURED_COLOUR)
    axes.set_yticks(range(len(ordered) + 1), [*names, "all inputs of the model together"])
    for row, one in enumerate(ordered):
        text = f" {100 * one.explained:.0f} % at {_text(next(iter(one.values.values())))}"
        axes.text(
            removed[row], row, text if one.explained >= 0.005 else " nothing", va="center", fontsize="small"
        )
    axes.text(
        together.nominal_rmse_mm - together.rmse_mm,
        len(ordered),
        f" {100 * together.explained:.0f} %",
        va="center",
        fontsize="small",
    )
    axes.axvline(together.nominal_rmse_mm, color="black", linestyle="--", linewidth=1)
    axes.set_xlim(0, 1.3 * together.nominal_rmse_mm)
    axes.set_xlabel("root mean square distance that goes away, mm (dashed: all of it)")
    axes.set_title(title)
    return figure


def sobol_figure(found: SobolIndices) -> Figure:
    """Draw the total indices of x and y against pressure, the most important suspects by name."""
    figure = Figure(figsize=(7.5, 6.5), layout="constrained")
    importance = np.nan_to_num(found.total).max(axis=(1, 2))
    order = np.argsort(-importance, kind="stable")[:_SHOWN]
    for axis, (axes, name) in enumerate(zip(figure.subplots(2, 1, sharex=True), "xy", strict=True)):
        for index, colour in zip(order, _FILLS, strict=False):
            axes.errorbar(
                found.pressure_kPa,
                found.total[index, axis],
                yerr=found.total_half_width[index, axis],
                color=colour,
                marker="o",
                markersize=3.5,
                capsize=2,
                label=found.names[index],
            )
        axes.set_ylabel(f"total Sobol index of {name}")
        axes.set_ylim(0, None)
        axes.grid(alpha=0.3)
    figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="outside upper center", ncols=3)
    figure.axes[1].set_xlabel("pressure, kPa")
    return figure


def _text(value: Value) -> str:
    return value if isinstance(value, str) else f"{value:.3g}"
