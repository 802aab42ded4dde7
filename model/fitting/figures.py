"""Measured curves, fitted laws and the strain transition in one figure."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Protocol

import numpy as np
from matplotlib.figure import Figure

from spavision.model.materials.curves import MODES, Mode

from .measured_curve import FloatArray, MeasuredCurve
from .statistics import Goodness
from .transition import StrainTransition

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_COLOURS = ("#D55E00", "#0072B2", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
"""Okabe and Ito's colours: told apart by colour-blind readers too."""

_DASHES = ("-", "--", "-.", ":")
_MOST_LAWS = 4
"""More lines than this on one picture hide the data."""

_LINE_POINTS = 200


class Fitted(Protocol):
    """What a figure shows of a fit."""

    @property
    def label(self) -> str:
        """What the law is called."""
        ...

    @property
    def curves(self) -> tuple[MeasuredCurve, ...]:
        """What it was fitted to."""
        ...

    @property
    def goodness(self) -> Goodness:
        """How well it fits."""
        ...

    def stress_of(self, curve: MeasuredCurve) -> FloatArray:
        """Return the law's nominal stress at a curve's stretches, in MPa."""
        ...


def fit_figure(fits: Sequence[Fitted], *, transitions: Sequence[tuple[str, StrainTransition]] = ()) -> Figure:
    """Draw nominal stress against strain, one panel a mode: the measured points and the best laws.

    Parameters
    ----------
    fits : sequence of Fitted
        Of the same curves, the best first; the first four are drawn.
    transitions : sequence of (str, StrainTransition), optional
        With what each belongs to; drawn into the uniaxial panel.
    """
    curves = fits[0].curves
    modes = [mode for mode in MODES.values() if any(curve.mode == mode for curve in curves)]
    figure = Figure(figsize=(5.5 * len(modes), 4.5), layout="constrained")
    panels = figure.subplots(1, len(modes), squeeze=False)[0]
    for axes, mode in zip(panels, modes, strict=True):
        _draw_points(axes, [curve for curve in curves if curve.mode == mode])
        _draw_laws(axes, fits[:_MOST_LAWS], mode)
        axes.set_title(mode.name)
        axes.set_xlabel("engineering strain, %")
        axes.grid(alpha=0.3)
    for name, transition in transitions:
        _draw_transition(panels[0], name, transition)
    panels[0].set_ylabel("nominal stress, kPa")
    for axes in panels:
        axes.legend(fontsize="small")
    return figure


def _draw_points(axes: Axes, curves: Sequence[MeasuredCurve]) -> None:
    for number, curve in enumerate(curves):
        axes.plot(
            100.0 * curve.strain,
            1e3 * curve.stress_MPa,
            linestyle="none",
            marker="o^sv"[number % 4],
            markersize=3.5,
            markerfacecolor="none",
            color="0.45",
            label=curve.name,
        )


def _draw_laws(axes: Axes, fits: Sequence[Fitted], mode: Mode) -> None:
    stretches = np.concatenate([curve.stretch for curve in fits[0].curves if curve.mode == mode])
    stretch = np.linspace(min(stretches.min(), 1.0), max(stretches.max(), 1.0), _LINE_POINTS)
    line = MeasuredCurve("line", mode, stretch, np.zeros(_LINE_POINTS))
    for number, fit in enumerate(fits):
        axes.plot(
            100.0 * (stretch - 1.0),
            1e3 * fit.stress_of(line),
            color=_COLOURS[number],
            linestyle=_DASHES[number],
            label=f"{fit.label}, R² {fit.goodness.r_squared:.4f}",
        )


def _draw_transition(axes: Axes, name: str, transition: StrainTransition) -> None:
    """Both lines from the axis to a little beyond their crossing, where they are told."""
    low, high = axes.get_ylim()
    end = axes.get_xlim()[1] / 100.0
    strain = np.linspace(0.0, end, 50)
    for line in (transition.primary, transition.secondary):
        stress = 1e3 * (line.modulus_MPa * strain + line.intercept_MPa)
        shown = (stress >= low) & (stress <= high)
        axes.plot(100.0 * strain[shown], stress[shown], color="0.6", linewidth=0.9)
    axes.plot(
        100.0 * transition.strain,
        1e3 * transition.stress_MPa,
        linestyle="none",
        marker="*",
        markersize=9,
        color="0.2",
        label=f"transition, {name}: {transition.strain:.1%}",
    )
    axes.set_ylim(low, high)
