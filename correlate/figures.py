"""The article's Figures 6 to 8 for one experiment, and displacement against pressure."""

from __future__ import annotations

from typing import TYPE_CHECKING

from matplotlib.figure import Figure

from spavision.tip_path import TipPath

from .discrepancy import Discrepancy

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MEASURED_COLOUR = "#0072B2"
MODELLED_COLOUR = "#D55E00"
# Okabe and Ito's blue and vermilion: told apart by colour-blind readers too.

COVERAGE = 1.96
"""Error bars show the 95 % interval."""


def path_figure(discrepancy: Discrepancy, *, title: str) -> Figure:
    """Draw both tip paths in the x-y plane, the pressure in kPa beside each point (article, Figures 6-8).

    The y axis points down, as in the photographs.
    """
    figure, axes = _path_axes()
    _draw_path(axes, "measured", discrepancy.measured, MEASURED_COLOUR, "o", (6, 5))
    _draw_path(axes, "modelled", discrepancy.modelled, MODELLED_COLOUR, "s", (6, -11))
    axes.set_title(title)
    axes.legend()
    return figure


def single_path_figure(path: TipPath, *, label: str) -> Figure:
    """Draw one tip path in the x-y plane, the pressure in kPa beside each point; the y axis points down."""
    figure, axes = _path_axes()
    _draw_path(axes, label, path, MEASURED_COLOUR, "o", (6, 5))
    axes.legend()
    return figure


def pressure_figure(discrepancy: Discrepancy, *, title: str) -> Figure:
    """Draw each displacement component against pressure, measured readings with their 95 % interval."""
    figure = Figure(figsize=(7.5, 6.5), layout="constrained")
    upper, lower = figure.subplots(2, 1, sharex=True)
    components = (
        (upper, "x", "ux_mm", "sigma_ux_mm"),
        (lower, "y", "uy_mm", "sigma_uy_mm"),
    )
    for axes, name, column, sigma in components:
        measured = discrepancy.measured.readings()
        axes.errorbar(
            measured.pressure_kPa,
            getattr(measured, column),
            yerr=COVERAGE * getattr(measured, sigma),
            color=MEASURED_COLOUR,
            marker="o",
            markersize=4.5,
            capsize=2,
            label="measured (95 %)",
        )
        modelled = discrepancy.modelled.readings()
        axes.plot(
            modelled.pressure_kPa,
            getattr(modelled, column),
            color=MODELLED_COLOUR,
            marker="s",
            markersize=4.5,
            label="modelled",
        )
        axes.set_ylabel(f"{name} displacement, mm")
        axes.grid(alpha=0.3)
    upper.set_title(title)
    upper.legend()
    lower.set_xlabel("pressure, kPa")
    lower.invert_yaxis()
    return figure


def _path_axes() -> tuple[Figure, Axes]:
    figure = Figure(figsize=(7.5, 6.0), layout="constrained")
    axes = figure.add_subplot()
    axes.set_xlabel("x displacement of the tip, mm (positive: first bending direction)")
    axes.set_ylabel("y displacement of the tip, mm (positive: down)")
    axes.invert_yaxis()
    axes.set_aspect("equal", adjustable="datalim")
    axes.grid(alpha=0.3)
    return figure, axes


def _draw_path(
    axes: Axes, label: str, path: TipPath, colour: str, marker: str, offset: tuple[int, int]
) -> None:
    readings = path.readings()
    axes.plot(readings.ux_mm, readings.uy_mm, marker=marker, color=colour, label=label, markersize=4.5)
    _write_pressures(axes, readings, colour, offset)


def _write_pressures(axes: Axes, path: TipPath, colour: str, offset: tuple[int, int]) -> None:
    for pressure, x, y in zip(path.pressure_kPa, path.ux_mm, path.uy_mm, strict=True):
        axes.annotate(
            f"{pressure:g}", (x, y), xytext=offset, textcoords="offset points", fontsize=7.5, color=colour
        )
