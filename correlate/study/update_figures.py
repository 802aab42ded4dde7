"""Figures of an update: prior against posterior, and every path before and after."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from spavision.correlate.figures import MEASURED_COLOUR, MODELLED_COLOUR

from .update import Update

_PRIOR_COLOUR = "#999999"


def posterior_figure(found: Update) -> Figure:
    """Draw the posterior of each parameter over its prior."""
    count = len(found.parameters)
    figure = Figure(figsize=(3.4 * min(count, 3), 2.8 * int(np.ceil(count / 3))), layout="constrained")
    grid = figure.subplots(int(np.ceil(count / 3)), min(count, 3), squeeze=False).ravel()
    for index, (one, axes) in enumerate(zip(found.parameters, grid, strict=False)):
        low, high = (float(value) for value in one.suspect.interval)
        span = np.linspace(low - 0.15 * (high - low), high + 0.15 * (high - low), 200)
        axes.plot(span, one.suspect.distribution.pdf(span), color=_PRIOR_COLOUR, label="prior")
        axes.hist(
            found.posterior.values[:, index],
            bins=40,
            density=True,
            color=MODELLED_COLOUR,
            alpha=0.6,
            label="posterior",
        )
        axes.axvline(float(found.best[one.suspect.name]), color="black", linewidth=1, label="least squares")
        axes.set_xlabel(one.suspect.name)
        axes.set_title(one.verdict, fontsize="small")
        axes.set_yticks([])
    for axes in grid[count:]:
        axes.set_axis_off()
    grid[0].legend(fontsize="x-small")
    return figure


def comparison_figure(found: Update) -> Figure:
    """Draw every measured path with the model before and after, in the x-y plane."""
    count = len(found.comparisons)
    figure = Figure(figsize=(4.2 * count, 4.2), layout="constrained")
    for one, axes in zip(found.comparisons, figure.subplots(1, count, squeeze=False)[0], strict=True):
        paths = (
            ("measured", one.measured.path.readings(), MEASURED_COLOUR, "o-"),
            ("nominal", one.nominal, _PRIOR_COLOUR, "s--"),
            ("updated", one.updated, MODELLED_COLOUR, "s-"),
        )
        for label, path, colour, style in paths:
            axes.plot(path.ux_mm, path.uy_mm, style, color=colour, label=label, markersize=3.5)
        axes.set_title(f"{one.measured.name} ({'fitted' if one.is_fitted else 'check'})", fontsize="small")
        axes.set_xlabel("x, mm")
        axes.set_ylabel("y, mm (down)")
        axes.invert_yaxis()
        axes.grid(alpha=0.3)
    figure.axes[0].legend(fontsize="small")
    return figure
