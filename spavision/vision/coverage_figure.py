"""The picture of a calibration: where corners were seen, what is left of them, how the board was tilted."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

from .calibration import Calibration

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LONGEST_ARROW = 0.04
"""Of the frame's width: the 95th percentile of the residuals is drawn that long."""

EMPTY_COLOUR = "#E69F00"
# Okabe and Ito's orange; residuals use viridis: both are told apart by colour-blind readers.


def coverage_figure(calibration: Calibration) -> Figure:
    """Draw the coverage map with residual vectors, and the board's tilts beside it."""
    figure = Figure(figsize=(11.0, 5.4), layout="constrained")
    frame, tilts = figure.subplots(1, 2, width_ratios=(1.9, 1.0))
    _draw_frame(figure, frame, calibration)
    _draw_tilts(tilts, calibration)
    return figure


def _draw_frame(figure: Figure, axes: Axes, calibration: Calibration) -> None:
    camera, counts = calibration.camera, calibration.coverage.counts
    extent = (-0.5, camera.width - 0.5, camera.height - 0.5, -0.5)
    empty = np.where(counts == 0, 1.0, np.nan)
    axes.imshow(
        empty,
        extent=extent,
        cmap=ListedColormap([EMPTY_COLOUR]),
        alpha=0.35,
        interpolation="nearest",
        aspect="equal",
    )
    pixels = np.concatenate([photo.corners.pixels for photo in calibration.photos])
    residuals = np.concatenate([photo.residuals_px for photo in calibration.photos])
    length = np.linalg.norm(residuals, axis=1)
    typical = max(float(np.percentile(length, 95)), 1e-9)
    enlargement = LONGEST_ARROW * camera.width / typical
    arrows = axes.quiver(
        *pixels.T,
        *(residuals.T * enlargement),
        length,
        angles="xy",
        scale_units="xy",
        scale=1.0,
        width=0.0022,
        cmap="viridis",
        clim=(0.0, typical),
    )
    axes.plot(*pixels.T, ".", color="black", markersize=1.6)
    axes.plot(camera.cx, camera.cy, "+", color="black", markersize=12)
    axes.set_xlim(extent[:2])
    axes.set_ylim(extent[2:])
    axes.set_xlabel("x, px")
    axes.set_ylabel("y, px")
    axes.set_title(
        f"{len(pixels)} corners of {len(calibration.photos)} photos, rms {calibration.rms_px:.3f} px; "
        f"residuals × {enlargement:.0f}\norange: cells without a corner; +: principal point",
        fontsize=10,
    )
    figure.colorbar(arrows, ax=axes, label="residual, px", shrink=0.8)


def _draw_tilts(axes: Axes, calibration: Calibration) -> None:
    slope = calibration.coverage.slope_deg
    reach = max(50.0, 1.15 * float(np.abs(slope).max()))
    for radius in (15, 30, 45):
        angle = np.linspace(0.0, 2.0 * np.pi, 181)
        axes.plot(radius * np.cos(angle), radius * np.sin(angle), color="0.8", linewidth=0.8)
        axes.annotate(f"{radius}°", (0, -radius), color="0.5", fontsize=8, ha="center", va="bottom")
    axes.plot(*slope.T, "o", color="#0072B2", markersize=5)
    axes.set_xlim(-reach, reach)
    axes.set_ylim(reach, -reach)
    axes.set_aspect("equal")
    axes.set_xlabel("tilt about the vertical axis, °")
    axes.set_ylabel("tilt about the horizontal axis, °")
    axes.set_title("Tilt of the board in each photo", fontsize=10)
