"""Photograph and model at one pressure, drawn to the same scale from the same origin."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from numpy.typing import NDArray

from spavision.model.figures import STRETCH_COLOURS, draw_from_rest
from spavision.model.simulation import Simulation
from spavision.tip_path import TipPath

MARGIN_MM = 12.0
"""Room left round the body and the tip's path."""

HEIGHT_INCHES = 5.6
LEFT_INCHES, RIGHT_INCHES, TOP_INCHES, BOTTOM_INCHES = 0.65, 0.15, 0.35, 1.15
"""Room round the axes, the same in both pictures, so that a millimetre is as long in one as in the other."""

BAR_INCHES = (0.5, 0.12)
"""Place of the colour bar above the lower rim, and its height."""


@dataclass(frozen=True)
class Window:
    """Part of the plane of motion that both pictures show, from the tip at rest.

    Parameters
    ----------
    x_mm, y_mm : tuple of float
        From and to; x to the right in the photographs, y down.
    mirrored : bool
        Whether the first bend goes to the left in the photographs.
    """

    x_mm: tuple[float, float]
    y_mm: tuple[float, float]
    mirrored: bool = False

    @property
    def size_mm(self) -> tuple[float, float]:
        """Width and height."""
        return self.x_mm[1] - self.x_mm[0], self.y_mm[1] - self.y_mm[0]


def window_of(measured: TipPath, simulation: Simulation, *, mirrored: bool) -> Window:
    """Return the window that holds every shape of the model and the whole measured path.

    Parameters
    ----------
    measured : TipPath
        In the photographs' axes.
    simulation : Simulation
    mirrored : bool
        Whether the first bend goes to the left in the photographs.

    Raises
    ------
    ValueError
        If the model reached no pressure.
    """
    reached = np.flatnonzero(simulation.tip_path.has_reading)
    body = simulation.mesh.nodes_mm + simulation.displacement_mm[reached] - simulation.marker_at_rest_mm
    sense = -1.0 if mirrored else 1.0
    readings = measured.readings()
    path = np.column_stack([readings.ux_mm, readings.uy_mm])
    points = np.concatenate([body.reshape(-1, 3)[:, :2] * [sense, 1.0], path])
    low, high = points.min(axis=0) - MARGIN_MM, points.max(axis=0) + MARGIN_MM
    return Window((float(low[0]), float(high[0])), (float(low[1]), float(high[1])), mirrored)


def photo_figure(photo_rgb: NDArray[np.uint8], window: Window, *, title: str) -> Figure:
    """Draw a straightened photograph that fills the window.

    Parameters
    ----------
    photo_rgb : uint8 array, shape (rows, columns, 3)
        The window's part of the photograph, in the plane of the marker.
    window : Window
    title : str
    """
    figure, axes = _framed(window, title)
    left, right = window.x_mm
    top, bottom = window.y_mm
    axes.imshow(photo_rgb, extent=(left, right, bottom, top), aspect="auto", interpolation="antialiased")
    return figure


def model_figure(simulation: Simulation, row: int, window: Window, norm: Normalize) -> Figure:
    """Draw the deformed model at one of its pressures in the window.

    Parameters
    ----------
    simulation : Simulation
    row : int
        Which of the asked pressures; it must have been reached.
    window : Window
    norm : Normalize
        Colours of the largest principal stretch, the same for all pressures.
    """
    figure, axes = _framed(window, "")
    draw_from_rest(axes, simulation, row, norm, mirrored=window.mirrored)
    axes.set_title(f"model, {simulation.tip_path.pressure_kPa[row]:g} kPa", fontsize="small")
    axes.set_aspect("auto")
    place = (0.25, BAR_INCHES[0] / HEIGHT_INCHES, 0.6, BAR_INCHES[1] / HEIGHT_INCHES)
    bar = figure.add_axes(place, label="largest principal stretch")
    colours = ScalarMappable(norm, STRETCH_COLOURS)
    figure.colorbar(colours, cax=bar, orientation="horizontal")
    bar.set_xlabel("largest principal stretch", fontsize="small")
    bar.tick_params(labelsize="small")
    return figure


def _framed(window: Window, title: str) -> tuple[Figure, Axes]:
    """Axes of the window in millimetres, one scale in x and y."""
    width_mm, height_mm = window.size_mm
    inner_height = HEIGHT_INCHES - TOP_INCHES - BOTTOM_INCHES
    inner_width = inner_height * width_mm / height_mm
    width = inner_width + LEFT_INCHES + RIGHT_INCHES
    figure = Figure(figsize=(width, HEIGHT_INCHES))
    axes = figure.add_axes(
        (
            LEFT_INCHES / width,
            BOTTOM_INCHES / HEIGHT_INCHES,
            inner_width / width,
            inner_height / HEIGHT_INCHES,
        )
    )
    axes.set(xlim=window.x_mm, ylim=window.y_mm[::-1])
    axes.set_xlabel("x from the tip at rest, mm", fontsize="small")
    axes.set_ylabel("y from the tip at rest, mm (down)", fontsize="small")
    axes.set_title(title, fontsize="small")
    axes.tick_params(labelsize="small")
    return figure, axes
