"""Pictures of a simulation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PolyCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from .elements import FloatArray, IntArray, reference_face
from .fields import element_fields
from .observe import locate
from .simulation import Simulation

_RIM = {1: [0, 1, 2, 3], 2: [0, 4, 1, 5, 2, 6, 3, 7]}
"""Nodes once round a face, of those of `reference_face`: corners, then middles of edges, then the centre."""

_MARGIN_MM = 8.0
STRETCH_COLOURS = "viridis"


@dataclass(frozen=True)
class _Axes:
    """Axes in the x-y plane that a picture is drawn in: an origin, and the sense of each."""

    origin_mm: FloatArray
    sense: FloatArray

    def place(self, points_mm: FloatArray) -> FloatArray:
        """Return x and y of points, shape (..., 3), in these axes."""
        return np.asarray((points_mm[..., :2] - self.origin_mm) * self.sense)


_OWN_AXES = _Axes(np.zeros(2), np.ones(2))


def deformed_shapes(simulation: Simulation, *, panels: int = 6) -> Figure:
    """Draw the deformed side face at several pressures, coloured by the largest principal stretch.

    Each panel shows one pressure, in equal axes with y down, the tracked point as a red dot and its way
    up to that pressure as a red line.

    Parameters
    ----------
    simulation : Simulation
    panels : int
        Most pressures shown; they are spread over those reached.

    Returns
    -------
    matplotlib.figure.Figure
        Not registered with pyplot, so that nothing need be closed.

    Raises
    ------
    ValueError
        If no pressure was reached.
    """
    reached = np.flatnonzero(simulation.tip_path.has_reading)
    if len(reached) == 0:
        raise ValueError("no pressure was reached, so there is no shape to draw")
    rows = reached[np.unique(np.linspace(0, len(reached) - 1, panels).round().astype(int))]
    elements, faces = _side_faces(simulation)
    stretch = [element_fields(simulation, int(row)).largest_stretch[elements] for row in rows]
    norm = Normalize(1.0, max(float(values.max()) for values in stretch))
    x_range, y_range = _frame(simulation, rows)
    height = 5.5
    width = height * np.ptp(x_range) / np.ptp(y_range) * len(rows) + 1.8
    figure = Figure(figsize=(width, height), layout="constrained")
    axes = figure.subplots(1, len(rows), sharex=True, sharey=True, squeeze=False)[0]
    for axis, row, values in zip(axes, rows, stretch, strict=True):
        _draw_side(axis, simulation, int(row), faces, values, norm)
    axes[0].set(xlim=x_range, ylim=y_range[::-1], ylabel="y in mm (down)")
    figure.supxlabel("x in mm (first bend to the right)", fontsize="medium")
    figure.suptitle(f"Deformed side face, crimp ratio {simulation.crimp_ratio:g}", fontsize="medium")
    figure.colorbar(
        ScalarMappable(norm, STRETCH_COLOURS), ax=list(axes), label="largest principal stretch", shrink=0.8
    )
    return figure


def deformed_state(simulation: Simulation, row: int, norm: Normalize) -> Figure:
    """Draw the deformed side face at one pressure, in the frame that all pressures share.

    Parameters
    ----------
    simulation : Simulation
    row : int
        Which of the asked pressures; it must have been reached.
    norm : Normalize
        Colours, from `stretch_range`.
    """
    reached = np.flatnonzero(simulation.tip_path.has_reading)
    elements, faces = _side_faces(simulation)
    x_range, y_range = _frame(simulation, reached)
    figure = Figure(figsize=(5.0, 5.0), layout="constrained")
    axis = figure.add_subplot()
    _draw_side(axis, simulation, row, faces, element_fields(simulation, row).largest_stretch[elements], norm)
    axis.set(xlim=x_range, ylim=y_range[::-1], xlabel="x in mm", ylabel="y in mm (down)")
    figure.colorbar(
        ScalarMappable(norm, STRETCH_COLOURS), ax=axis, label="largest principal stretch", shrink=0.8
    )
    return figure


def draw_from_rest(
    axis: Axes, simulation: Simulation, row: int, norm: Normalize, *, mirrored: bool = False
) -> None:
    """Draw the deformed side face into axes whose origin is the tracked point at the lowest pressure.

    Parameters
    ----------
    axis : matplotlib Axes
        x to the right, y down, mm.
    simulation : Simulation
    row : int
        Which of the asked pressures; it must have been reached.
    norm : Normalize
        Colours, from `stretch_range`.
    mirrored : bool
        Whether the first bend goes to the left.
    """
    elements, faces = _side_faces(simulation)
    stretch = element_fields(simulation, row).largest_stretch[elements]
    axes_of_photo = _Axes(simulation.marker_at_rest_mm[:2], np.array([-1.0 if mirrored else 1.0, 1.0]))
    _draw_side(axis, simulation, row, faces, stretch, norm, axes_of_photo)


def stretch_range(simulation: Simulation) -> Normalize:
    """Return the colour range of the largest principal stretch that all pressures share."""
    elements, _ = _side_faces(simulation)
    last = int(np.flatnonzero(simulation.tip_path.has_reading)[-1])
    return Normalize(1.0, float(element_fields(simulation, last).largest_stretch[elements].max()))


def _draw_side(
    axis: Axes,
    simulation: Simulation,
    row: int,
    faces: IntArray,
    values: FloatArray,
    norm: Normalize,
    axes: _Axes = _OWN_AXES,
) -> None:
    position = simulation.mesh.nodes_mm + simulation.displacement_mm[row]
    outlines = axes.place(position[faces])
    axis.add_collection(
        PolyCollection(
            list(outlines), array=values, cmap=STRETCH_COLOURS, norm=norm, edgecolors="white", linewidths=0.15
        )
    )
    marker = np.array(simulation.geometry.marker_position_mm)
    way = marker + locate(simulation.mesh, marker).displacement(simulation.displacement_mm[: row + 1])
    way = axes.place(way)
    axis.plot(way[:, 0], way[:, 1], color="red", linewidth=0.8)
    axis.plot(*way[-1], "o", color="red", markersize=4.0)
    axis.set_aspect("equal")
    axis.set_title(f"{simulation.tip_path.pressure_kPa[row]:g} kPa", fontsize="small")
    axis.tick_params(labelsize="small")


def _side_faces(simulation: Simulation) -> tuple[IntArray, IntArray]:
    """Elements on the side face z = +width/2 and the nodes round each of their faces there."""
    mesh = simulation.mesh
    table = reference_face(mesh.order)
    faces = mesh.elements[:, table.nodes]
    on_side = np.all(np.isclose(mesh.nodes_mm[faces, 2], 0.5 * simulation.geometry.width_mm), axis=2)
    element, face = np.nonzero(on_side)
    return element, faces[element, face][:, _RIM[mesh.order]]


def _frame(simulation: Simulation, rows: IntArray) -> tuple[FloatArray, FloatArray]:
    """Ranges of x and y that hold every shape drawn."""
    position = simulation.mesh.nodes_mm + simulation.displacement_mm[rows]
    low = position.reshape(-1, 3).min(axis=0) - _MARGIN_MM
    high = position.reshape(-1, 3).max(axis=0) + _MARGIN_MM
    return np.array([low[0], high[0]]), np.array([low[1], high[1]])
