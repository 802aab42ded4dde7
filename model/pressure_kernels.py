"""Numba kernels for the solid's own pressure: the forces that it adds, its change with the displacement."""

from __future__ import annotations

from numba import njit, prange

from .elements import FloatArray, IntArray

_FAST = {"contract", "reassoc", "nsz", "arcp"}


@njit(cache=True, parallel=True, fastmath=_FAST)
def add_pressure_forces(
    forces: FloatArray, pressure: FloatArray, pressure_operator: FloatArray, total: FloatArray
) -> None:
    """Add the forces of the solid's own pressure to others.

    Parameters
    ----------
    forces, total : array, shape (n_elements, 3, n_nodes)
        The sum is written to the second, which may be the first.
    pressure : array, shape (n_elements, n_modes)
    pressure_operator : array, shape (n_elements, n_modes, 3, n_nodes)
    """
    for e in prange(len(forces)):
        for i in range(3):
            for a in range(forces.shape[2]):
                total[e, i, a] = forces[e, i, a]
                for m in range(pressure.shape[1]):
                    total[e, i, a] += pressure[e, m] * pressure_operator[e, m, i, a]


@njit(cache=True, parallel=True, fastmath=_FAST)
def pressure_changes(
    displacement: FloatArray,
    elements: IntArray,
    pressure_operator: FloatArray,
    bulk_modulus: FloatArray,
    changes: FloatArray,
) -> None:
    """Find how the solid's own pressure changes with the displacement.

    Parameters
    ----------
    displacement : array, shape (n_nodes, 3)
        Its change.
    elements : array, shape (n_elements, n_nodes)
    pressure_operator : array, shape (n_elements, n_modes, 3, n_nodes)
    bulk_modulus : array, shape (n_elements,)
    changes : array, shape (n_elements, n_modes)
        Written.
    """
    for e in prange(len(elements)):
        for m in range(changes.shape[1]):
            dilatation = 0.0
            for i in range(3):
                for a in range(elements.shape[1]):
                    dilatation += pressure_operator[e, m, i, a] * displacement[elements[e, a], i]
            changes[e, m] = bulk_modulus[e] * dilatation
