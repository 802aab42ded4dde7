"""The composite's slack fibres as nonlinear springs along element edges, for decks of other programs."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from .elements import FloatArray, IntArray
from .hex_mesh import HexMesh
from .materials.slack_fibre import SlackFibre

_SIMPSON = {0: 1.0 / 6.0, 1: 4.0 / 6.0, 2: 1.0 / 6.0}
_LARGEST_STRETCH = 3.0
_POINTS_OF_TRANSITION = 13
_ROUNDING = 9
"""Decimals to which lengths and areas are compared."""


@dataclass(frozen=True)
class SpringGroup:
    """Springs of one length and one area of fibres behind them.

    Parameters
    ----------
    pairs : array, shape (n, 2)
        Nodes joined.
    force_N, elongation_mm : array, shape (n_points,)
        The springs' characteristic.
    """

    pairs: IntArray
    force_N: FloatArray
    elongation_mm: FloatArray


def fibre_springs(mesh: HexMesh, vtk_elements: IntArray, fibre: SlackFibre) -> list[SpringGroup]:
    """Lump fibres along y or z of box elements on lines of nodes.

    In each element the section across the fibres is integrated by Simpson's rule over x (through the
    thickness, on which bending depends) and by the trapezoidal rule over the third axis. Springs along one
    pair of nodes are merged.

    Parameters
    ----------
    mesh : HexMesh
        Quadratic.
    vtk_elements : array, shape (n, 20 or more)
        Elements that hold the fibres, nodes in VTK's order.
    fibre : SlackFibre
        Along y or z.
    """
    along = int(np.argmax(np.abs(fibre.direction)))
    area: dict[tuple[int, int], float] = {}
    for nodes in vtk_elements:
        for first, second, share in _lines(mesh.nodes_mm, nodes[:20], along):
            pair = (min(first, second), max(first, second))
            area[pair] = area.get(pair, 0.0) + share
    grouped: dict[tuple[float, float], list[tuple[int, int]]] = {}
    for (first, second), total in sorted(area.items()):
        length = float(mesh.nodes_mm[second, along] - mesh.nodes_mm[first, along])
        grouped.setdefault((round(abs(length), _ROUNDING), round(total, _ROUNDING)), []).append(
            (first, second)
        )
    return [
        SpringGroup(np.array(pairs), *_characteristic(fibre, length_mm=length, area_mm2=total))
        for (length, total), pairs in grouped.items()
    ]


def _lines(nodes_mm: FloatArray, nodes: IntArray, along: int) -> list[tuple[int, int, float]]:
    """Neighbouring nodes along one axis of a box, and the area of the fibres that act between them."""
    corner = nodes_mm[nodes]
    low, high = corner.min(axis=0), corner.max(axis=0)
    place = np.rint(2.0 * (corner - low) / (high - low)).astype(int)
    across = 3 - along
    area = (high - low)[0] * (high - low)[across]
    found = []
    for x, weight in _SIMPSON.items():
        for side in (0, 2):
            line = np.flatnonzero((place[:, 0] == x) & (place[:, across] == side))
            line = line[np.argsort(place[line, along])]
            found += [(int(nodes[a]), int(nodes[b]), 0.5 * weight * area) for a, b in pairwise(line)]
    return found


def _characteristic(fibre: SlackFibre, *, length_mm: float, area_mm2: float) -> tuple[FloatArray, FloatArray]:
    """Force against elongation, by straight lines: zero when slack, exact when taut."""
    taut = 1.0 + fibre.slack_strain
    half = fibre.transition_half_width
    bend = np.linspace(taut - half, taut + half, _POINTS_OF_TRANSITION)
    stretch = np.concatenate([[0.1, 0.5 * (0.1 + bend[0])], bend, [_LARGEST_STRETCH]])
    return area_mm2 * fibre.tension(stretch), length_mm * (stretch - 1.0)
