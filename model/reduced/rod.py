"""A hanging row of cells under its own weight, in the plane."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from spavision.model.elements import FloatArray
from spavision.model.equilibrium import GRAVITY_MM_PER_S2

from .cell import CellResponse

_LARGEST_CHANGE = 1e-9
_MAX_ITERATIONS = 200
_DAMPING = 0.5


@dataclass(frozen=True)
class RodShape:
    """A row of cells in equilibrium.

    Parameters
    ----------
    points_mm : array, shape (n_cells + 1, 2)
        Axis points at the cells' ends, x and y, from the clamp.
    angles : array, shape (n_cells + 1,)
        By which the faces there are turned towards +x, in rad.
    moments_Nmm, tensions_N : array, shape (n_cells,)
        In the middle of each cell.
    """

    points_mm: FloatArray
    angles: FloatArray
    moments_Nmm: FloatArray
    tensions_N: FloatArray


def hang(
    cell: CellResponse, *, n_cells: int, mass_tonne: float, start: RodShape | None, tilt: float = 0.0
) -> RodShape:
    """Find the shape in which the weight and each cell's response, taken as linear, agree.

    Parameters
    ----------
    cell : CellResponse
        Response and compliance that all cells share.
    n_cells : int
    mass_tonne : float
        Of one cell; 0 leaves gravity out.
    start : RodShape or None
        A guess.
    tilt : float
        By which the vertical leans from the axis at the clamp towards +x, in rad.

    Raises
    ------
    ArithmeticError
        If the iteration does not settle.
    """
    loads = (
        np.zeros((n_cells, 2)) if start is None else np.column_stack([start.moments_Nmm, start.tensions_N])
    )
    weight = mass_tonne * GRAVITY_MM_PER_S2 * np.array([np.sin(tilt), np.cos(tilt)])
    for _ in range(_MAX_ITERATIONS):
        shape = _shape(cell, loads)
        wanted = _section_loads(shape, weight)
        change = wanted - loads
        loads = loads + _DAMPING * change
        if np.abs(change).max() < _LARGEST_CHANGE * (1.0 + np.abs(wanted).max()):
            return RodShape(shape[0], shape[1], loads[:, 0], loads[:, 1])
    raise ArithmeticError("the hanging row of cells did not settle")


def _shape(cell: CellResponse, loads: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Axis points and face angles of the row, each cell's chord halfway between its faces' normals."""
    excess = loads - np.array([cell.load.moment_Nmm, cell.load.tension_N])
    turn = cell.angle + excess @ cell.compliance[0]
    chord = cell.chord_mm + excess @ cell.compliance[1]
    angles = np.concatenate([[0.0], np.cumsum(turn)])
    middle = 0.5 * (angles[:-1] + angles[1:])
    steps = chord[:, None] * np.column_stack([np.sin(middle), np.cos(middle)])
    return np.vstack([np.zeros(2), np.cumsum(steps, axis=0)]), angles


def _section_loads(shape: tuple[FloatArray, FloatArray], cell_weight_N: FloatArray) -> FloatArray:
    """Moment and tension in the middle of each cell from the weight (x and y components) below it."""
    points, angles = shape
    middle = 0.5 * (points[:-1] + points[1:])
    direction = 0.5 * (angles[:-1] + angles[1:])
    count = len(middle)
    below = np.arange(count)[None, :] > np.arange(count)[:, None]
    share = below + 0.5 * np.eye(count)
    lever = middle[None, :, :] - middle[:, None, :]
    # A weight below at larger x turns the row back, against the bend towards +x.
    moment = np.sum(share * (cell_weight_N[0] * lever[..., 1] - cell_weight_N[1] * lever[..., 0]), axis=1)
    along = cell_weight_N[0] * np.sin(direction) + cell_weight_N[1] * np.cos(direction)
    return np.column_stack([moment, share.sum(axis=1) * along])
