"""Figures of studies: the tolerance band, attribution, posterior."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from spavision.correlate.figures import MEASURED_COLOUR, MODELLED_COLOUR
from spavision.tip_path import TipPath

from .band import Band


def band_figure(found: Band, *, title: str, measured: TipPath | None = None) -> Figure:
    """Draw the band of x and y against pressure, and a measured path where there is one."""
    figure = Figure(figsize=(7.5, 6.5), layout="constrained")
    pressure = found.nominal.pressure_kPa
    rows = zip(figure.subplots(2, 1, sharex=True), "xy", strict=True)
    for index, (axes, name) in enumerate(rows):
        low, middle, high = found.quantiles_mm[:, index]
        axes.fill_between(
            pressure, low, high, color=MODELLED_COLOUR, alpha=0.25, label="95 % of the cases", linewidth=0
        )
        axes.plot(pressure, middle, color=MODELLED_COLOUR, linestyle="--", label="median")
        nominal = (found.nominal.ux_mm, found.nominal.uy_mm)[index]
        axes.plot(pressure, nominal, color=MODELLED_COLOUR, marker="s", markersize=4, label="nominal")
        if measured is not None:
            displacement = (measured.ux_mm, measured.uy_mm)[index]
            axes.plot(
                measured.pressure_kPa, displacement, color=MEASURED_COLOUR, marker="o", label="measured"
            )
        axes.set_ylabel(f"{name} displacement of the tip, mm")
        axes.grid(alpha=0.3)
    figure.axes[0].set_title(title)
    figure.axes[0].legend()
    figure.axes[1].set_xlabel("pressure, kPa")
    _mark_incomplete(found, figure)
    return figure


def sweep_figure(paths: list[TipPath], labels: list[str], *, title: str) -> Figure:
    """Draw the tip paths of a sweep in the x-y plane."""
    import matplotlib as mpl

    figure = Figure(figsize=(7.5, 6.0), layout="constrained")
    axes = figure.add_subplot()
    colours = mpl.colormaps["viridis"](np.linspace(0.0, 0.9, len(paths)))
    for path, label, colour in zip(paths, labels, colours, strict=True):
        axes.plot(path.ux_mm, path.uy_mm, color=colour, marker=".", label=label)
    axes.set_xlabel("x displacement of the tip, mm (positive: first bending direction)")
    axes.set_ylabel("y displacement of the tip, mm (positive: down)")
    axes.set_title(title)
    axes.invert_yaxis()
    axes.grid(alpha=0.3)
    if len(paths) <= 12:
        axes.legend(fontsize="small")
    return figure


def _mark_incomplete(found: Band, figure: Figure) -> None:
    incomplete = found.nominal.pressure_kPa[found.n_reached < found.n_cases]
    if len(incomplete):
        figure.axes[0].annotate(
            f"from {incomplete[0]:g} kPa on some cases stopped: the band is too narrow there",
            (0.02, 0.04),
            xycoords="axes fraction",
            fontsize="small",
        )
