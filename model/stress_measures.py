"""Numba kernels between the spatial and the undeformed frame: stresses and their linear change."""

from __future__ import annotations

import numpy as np
from numba import njit, prange

from .elements import FloatArray, IntArray

_FAST = {"contract", "reassoc", "nsz", "arcp"}


@njit(cache=True, fastmath=_FAST)
def _congruence(A: FloatArray, symmetric: FloatArray, out: FloatArray) -> None:
    """Write A · symmetric · Aᵀ, six components each."""
    s = symmetric
    for i in range(3):
        j = (i + 1) % 3
        # row i of A · symmetric
        half0 = A[i, 0] * s[0] + A[i, 1] * s[3] + A[i, 2] * s[5]
        half1 = A[i, 0] * s[3] + A[i, 1] * s[1] + A[i, 2] * s[4]
        half2 = A[i, 0] * s[5] + A[i, 1] * s[4] + A[i, 2] * s[2]
        out[i] = half0 * A[i, 0] + half1 * A[i, 1] + half2 * A[i, 2]
        # 12, 23, 31 in turn: the places of 12, 23, 13
        out[3 + i] = half0 * A[j, 0] + half1 * A[j, 1] + half2 * A[j, 2]


@njit(cache=True, fastmath=_FAST)
def _invert(F: FloatArray, J: float, out: FloatArray) -> None:
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        for p in range(3):
            q, r = (p + 1) % 3, (p + 2) % 3
            out[p, i] = (F[j, q] * F[k, r] - F[j, r] * F[k, q]) / J


@njit(cache=True, parallel=True, fastmath=_FAST)
def push_forward(F: FloatArray, reference: FloatArray, spatial: FloatArray) -> None:
    """Turn second Piola-Kirchhoff stresses into Kirchhoff stresses, F·S·Fᵀ.

    Parameters
    ----------
    F : array, shape (n_elements, n_points, 3, 3)
    reference : array, shape (n_elements, n_points, 6)
    spatial : array, shape (n_elements, n_points, 6)
        Written.
    """
    for e in prange(len(F)):
        for q in range(F.shape[1]):
            _congruence(F[e, q], reference[e, q], spatial[e, q])


@njit(cache=True, parallel=True, fastmath=_FAST)
def pull_back(F: FloatArray, J: FloatArray, spatial: FloatArray, reference: FloatArray) -> None:
    """Turn Kirchhoff stresses into second Piola-Kirchhoff stresses, F⁻¹·τ·F⁻ᵀ.

    Parameters
    ----------
    F, J : array, shape (n_elements, n_points, 3, 3) and (n_elements, n_points)
    spatial : array, shape (n_elements, n_points, 6)
    reference : array, shape (n_elements, n_points, 6)
        Written.
    """
    for e in prange(len(F)):
        inverse = np.empty((3, 3))
        for q in range(F.shape[1]):
            _invert(F[e, q], J[e, q], inverse)
            _congruence(inverse, spatial[e, q], reference[e, q])


@njit(cache=True, parallel=True, fastmath=_FAST)
def linear_change(
    displacement: FloatArray,
    elements: IntArray,
    gradients: FloatArray,
    F: FloatArray,
    J: FloatArray,
    moduli: FloatArray,
    change_of_F: FloatArray,
    change_of_stress: FloatArray,
) -> None:
    """Compute the change of deformation gradient and second Piola-Kirchhoff stress, to first order.

    Parameters
    ----------
    displacement : array, shape (n_nodes, 3)
        Change of the displacement.
    elements : array, shape (n_elements, n_element_nodes)
    gradients : array, shape (n_elements, n_points, 3, n_element_nodes)
    F, J : array, shape (n_elements, n_points, 3, 3) and (n_elements, n_points)
        Where the change begins.
    moduli : array, shape (n_elements, n_points, 6, 6)
        Spatial moduli there.
    change_of_F : array, shape (n_elements, n_points, 3, 3)
        Written.
    change_of_stress : array, shape (n_elements, n_points, 6)
        Written.
    """
    n_elements, n_points, _, n_nodes = gradients.shape
    for e in prange(n_elements):
        local = np.empty((3, n_nodes))
        inverse = np.empty((3, 3))
        velocity = np.empty((3, 3))
        rate = np.empty(6)
        objective = np.empty(6)
        for a in range(n_nodes):
            for i in range(3):
                local[i, a] = displacement[elements[e, a], i]
        for q in range(n_points):
            for i in range(3):
                for j in range(3):
                    total = 0.0
                    for a in range(n_nodes):
                        total += local[i, a] * gradients[e, q, j, a]
                    change_of_F[e, q, i, j] = total
            _invert(F[e, q], J[e, q], inverse)
            for i in range(3):
                for j in range(3):
                    velocity[i, j] = (
                        change_of_F[e, q, i, 0] * inverse[0, j]
                        + change_of_F[e, q, i, 1] * inverse[1, j]
                        + change_of_F[e, q, i, 2] * inverse[2, j]
                    )
            for i in range(3):
                j = (i + 1) % 3
                rate[i] = velocity[i, i]
                rate[3 + i] = velocity[i, j] + velocity[j, i]
            for r in range(6):
                objective[r] = 0.0
                for s in range(6):
                    objective[r] += moduli[e, q, r, s] * rate[s]
            _congruence(inverse, objective, change_of_stress[e, q])
