"""A point in the space of solutions, its combinations, and the load."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from .elements import FloatArray


@dataclass(frozen=True)
class State:
    """A point in the space of solutions, or the rate at which it moves.

    Displacement and pressure determine it. Stress and tension are what the last Newton correction predicted
    to first order; the next tangent is formed with them (None: with those that the displacement gives).

    Parameters
    ----------
    displacement : array, shape (n_nodes, 3)
        In mm.
    pressure : array, shape (n_elements, n_modes)
        Coefficients of the solid's own pressure, κ(J − 1) when converged.
    stress : array, shape (n_elements, n_points, 6), or None
        Second Piola-Kirchhoff stress in MPa without the volumetric part.
    tension : array, shape (n_fibre_rows, n_points), or None
        Fibre tensions in MPa.
    """

    displacement: FloatArray
    pressure: FloatArray
    stress: FloatArray | None = None
    tension: FloatArray | None = None


@dataclass(frozen=True)
class Load:
    """What acts on the body.

    Parameters
    ----------
    gas_pressure_MPa : float
        Gauge pressure in the cavity.
    gravity : float
        Fraction of its own weight that the body bears.
    """

    gas_pressure_MPa: float
    gravity: float


def combine(weights: Sequence[float], states: Sequence[State]) -> State:
    """Return the weighted sum of states; a part that one of them lacks is left out."""
    return State(
        displacement=_sum(weights, [state.displacement for state in states]),
        pressure=_sum(weights, [state.pressure for state in states]),
        stress=_sum_if_all(weights, [state.stress for state in states]),
        tension=_sum_if_all(weights, [state.tension for state in states]),
    )


def _sum(weights: Sequence[float], parts: list[FloatArray]) -> FloatArray:
    total = weights[0] * parts[0]
    for weight, part in zip(weights[1:], parts[1:], strict=True):
        total += weight * part
    return total


def _sum_if_all(weights: Sequence[float], parts: Sequence[FloatArray | None]) -> FloatArray | None:
    present = [part for part in parts if part is not None]
    return _sum(weights, present) if len(present) == len(parts) else None
