"""The shape of the bent actuator: a centre line that carries the dot to a given displacement."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.optimize import fsolve

from .settings import ActuatorSettings, MarkerSettings

FloatArray = NDArray[np.float64]

STATIONS = 161
FIELD_STEP_MM = 0.5
FIELD_MARGIN_MM = 45.0


@dataclass(frozen=True)
class CentreLine:
    """Centre line of the bent actuator, in the plane of its side face.

    Parameters
    ----------
    points_mm : array, shape (n, 2)
        x and y in board axes, from the clamped end to the tip, evenly spaced in material length.
    heading_deg : array, shape (n,)
        Direction of the line against straight down, positive when it turns to the right.
    stretch : float
        Length over length at rest.
    rest_mm : array, shape (n,)
        Material coordinate: distance from the clamped end at rest.
    """

    points_mm: FloatArray
    heading_deg: FloatArray
    stretch: float
    rest_mm: FloatArray

    @property
    def tip_angle_deg(self) -> float:
        """Bend angle of the tip, positive to the right."""
        return float(self.heading_deg[-1])

    def point_on_face(self, rest_mm: float, off_centre_mm: float) -> FloatArray:
        """Return the place of a material point of the side face, shape (2,)."""
        x = np.interp(rest_mm, self.rest_mm, self.points_mm[:, 0])
        y = np.interp(rest_mm, self.rest_mm, self.points_mm[:, 1])
        heading = np.radians(np.interp(rest_mm, self.rest_mm, self.heading_deg))
        return np.array([x + off_centre_mm * np.cos(heading), y - off_centre_mm * np.sin(heading)])


def bend_to(
    actuator: ActuatorSettings,
    marker: MarkerSettings,
    base_mm: tuple[float, float],
    move_mm: tuple[float, float],
) -> CentreLine:
    """Return the centre line whose dot has moved by ``move_mm`` from its place on the straight actuator.

    Bend angle and stretch are the two unknowns; the curvature falls linearly from clamp to tip by
    ``curvature_taper``.
    """
    dot = actuator.length_mm - marker.from_tip_mm
    start = _shape(actuator, base_mm, 0.0, 1.0).point_on_face(dot, marker.off_centre_mm)
    target = start + np.asarray(move_mm)
    chord = target - np.asarray(base_mm)

    def miss(unknowns: FloatArray) -> FloatArray:
        line = _shape(actuator, base_mm, unknowns[0], unknowns[1])
        return line.point_on_face(dot, marker.off_centre_mm) - target

    first_guess = np.array([2.0 * np.arctan2(chord[0], chord[1]), np.hypot(*chord) / dot])
    angle, stretch = fsolve(miss, first_guess, xtol=1e-13)
    return _shape(actuator, base_mm, float(angle), float(stretch))


def _shape(
    actuator: ActuatorSettings, base_mm: tuple[float, float], angle_rad: float, stretch: float
) -> CentreLine:
    """Return the centre line of a given bend angle (at the tip) and stretch."""
    share = np.linspace(0.0, 1.0, STATIONS)
    heading = angle_rad * (share + actuator.curvature_taper * (share - share**2))
    step = actuator.length_mm * stretch / (STATIONS - 1)
    x = base_mm[0] + _running_integral(np.sin(heading), step)
    y = base_mm[1] + _running_integral(np.cos(heading), step)
    return CentreLine(np.column_stack([x, y]), np.degrees(heading), stretch, share * actuator.length_mm)


def _running_integral(values: FloatArray, step: float) -> FloatArray:
    """Integrate by the trapezium rule, starting from zero."""
    return np.concatenate([[0.0], np.cumsum(0.5 * step * (values[1:] + values[:-1]))])


@dataclass(frozen=True)
class BodyField:
    """Coordinates along and across the body, tabulated on a square grid of the face plane.

    Parameters
    ----------
    x0_mm, y0_mm : float
        Grid point [0, 0]; the grid's step is `FIELD_STEP_MM`.
    along_mm, across_mm : array, shape (rows, columns)
        Distance along the stretched centre line, and to its right looking down it.
    """

    x0_mm: float
    y0_mm: float
    along_mm: FloatArray
    across_mm: FloatArray


def tabulate(line: CentreLine) -> BodyField:
    """Tabulate the body's own coordinates around a centre line."""
    low = line.points_mm.min(axis=0) - FIELD_MARGIN_MM
    high = line.points_mm.max(axis=0) + FIELD_MARGIN_MM
    columns, rows = (np.ceil((high - low) / FIELD_STEP_MM).astype(int) + 1).tolist()
    along, across = np.empty((rows, columns)), np.empty((rows, columns))
    _nearest(line.points_mm, low[0], low[1], FIELD_STEP_MM, along, across)
    return BodyField(float(low[0]), float(low[1]), along, across)


@njit(cache=True)
def _nearest(points, x0, y0, step, along, across):  # type: ignore[no-untyped-def]
    """Fill the two tables from the nearest point of the polyline; its end segments go on for ever."""
    last = points.shape[0] - 2
    length = np.hypot(points[1, 0] - points[0, 0], points[1, 1] - points[0, 1])
    for row in range(along.shape[0]):
        for column in range(along.shape[1]):
            x, y = x0 + column * step, y0 + row * step
            best = np.inf
            for k in range(last + 1):
                tx = (points[k + 1, 0] - points[k, 0]) / length
                ty = (points[k + 1, 1] - points[k, 1]) / length
                px, py = x - points[k, 0], y - points[k, 1]
                u = px * tx + py * ty
                low = -np.inf if k == 0 else 0.0
                high = np.inf if k == last else length
                clipped = min(max(u, low), high)
                gap = (u - clipped) ** 2 + (px * ty - py * tx) ** 2
                if gap < best:
                    best = gap
                    along[row, column] = k * length + clipped
                    side = 1.0 if px * ty - py * tx >= 0 else -1.0
                    across[row, column] = side * np.sqrt(gap)
