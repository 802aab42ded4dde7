"""Numba kernels for element forces and tangents, with the pressure condensed in each element."""

from __future__ import annotations

import numpy as np
from numba import njit, prange

from .elements import FloatArray, IndexArray, IntArray

BLOCKS = np.array([[0, 0], [1, 1], [2, 2], [0, 1], [1, 2], [0, 2]])
"""Component pairs of the six stored blocks of an element's symmetric tangent."""

_VOIGT = np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2]])
_FAST = {"contract", "reassoc", "nsz", "arcp"}


@njit(cache=True)
def _aligned(count: int, rows: int, columns: int) -> FloatArray:
    """Zeros, shape (count, rows, columns), that begin with a cache line: vectors then lie within one each."""
    size = count * rows * columns
    memory = np.zeros(size + 8)
    begin = -(memory.ctypes.data // 8) % 8
    return memory[begin : begin + size].reshape((count, rows, columns))


@njit(cache=True, fastmath=_FAST)
def _spatial_gradients(F: FloatArray, J: float, gradients: FloatArray, out: FloatArray) -> None:
    """Turn gradients in undeformed coordinates, (3, n_nodes), into spatial ones, (3, n_nodes or more)."""
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        # column i of the inverse of F
        inverse0 = (F[j, 1] * F[k, 2] - F[j, 2] * F[k, 1]) / J
        inverse1 = (F[j, 2] * F[k, 0] - F[j, 0] * F[k, 2]) / J
        inverse2 = (F[j, 0] * F[k, 1] - F[j, 1] * F[k, 0]) / J
        for a in range(gradients.shape[1]):
            out[i, a] = inverse0 * gradients[0, a] + inverse1 * gradients[1, a] + inverse2 * gradients[2, a]


@njit(cache=True, parallel=True, fastmath=_FAST)
def element_forces(
    gradients: FloatArray,
    volumes: FloatArray,
    modes: FloatArray,
    F: FloatArray,
    J: FloatArray,
    stress: FloatArray,
    forces: FloatArray,
    dilatation: FloatArray,
    pressure_operator: FloatArray,
) -> None:
    """Integrate isochoric forces, dilatation and the operator from pressure to force.

    Parameters
    ----------
    gradients, volumes, modes : array
        Tables of `ElementGeometry`.
    F, J : array, shape (n_elements, n_points, 3, 3) and (n_elements, n_points)
    stress : array, shape (n_elements, n_points, 6)
        Kirchhoff stress without the volumetric part.
    forces : array, shape (n_elements, 3, n_nodes)
        Written: ∫ τ·∇N dV.
    dilatation : array, shape (n_elements, n_modes)
        Written: ∫ ψ (J − 1) dV.
    pressure_operator : array, shape (n_elements, n_modes, 3, n_nodes)
        Written: its derivative with respect to the displacements.
    """
    n_elements, n_points, _, n_nodes = gradients.shape
    n_modes = modes.shape[2]
    for e in prange(n_elements):
        g = np.empty((3, n_nodes))
        forces[e] = 0.0
        dilatation[e] = 0.0
        pressure_operator[e] = 0.0
        for q in range(n_points):
            _spatial_gradients(F[e, q], J[e, q], gradients[e, q], g)
            w = volumes[e, q]
            for i in range(3):
                t0 = w * stress[e, q, _VOIGT[i, 0]]
                t1 = w * stress[e, q, _VOIGT[i, 1]]
                t2 = w * stress[e, q, _VOIGT[i, 2]]
                for a in range(n_nodes):
                    forces[e, i, a] += t0 * g[0, a] + t1 * g[1, a] + t2 * g[2, a]
            for m in range(n_modes):
                weight = w * modes[e, q, m]
                dilatation[e, m] += weight * (J[e, q] - 1.0)
                weight *= J[e, q]
                for i in range(3):
                    for a in range(n_nodes):
                        pressure_operator[e, m, i, a] += weight * g[i, a]


@njit(cache=True, fastmath=_FAST)
def _product_with_moduli(
    i: int,
    j: int,
    moduli: FloatArray,
    stress: FloatArray,
    p: float,
    volume: float,
    g: FloatArray,
    out: FloatArray,
) -> None:
    """Write A·g for the components i and j, with A = c_irjs + δ_ij τ_rs + p (δ_ir δ_js − δ_is δ_jr)."""
    for r in range(3):
        a0 = moduli[_VOIGT[i, r], _VOIGT[j, 0]]
        a1 = moduli[_VOIGT[i, r], _VOIGT[j, 1]]
        a2 = moduli[_VOIGT[i, r], _VOIGT[j, 2]]
        if i == j:
            a0 += stress[_VOIGT[r, 0]]
            a1 += stress[_VOIGT[r, 1]]
            a2 += stress[_VOIGT[r, 2]]
        elif r == i:
            # d(J F⁻ᵀ)·p; the two terms cancel where i = j
            a0 += p if j == 0 else 0.0
            a1 += p if j == 1 else 0.0
            a2 += p if j == 2 else 0.0
        elif r == j:
            a0 -= p if i == 0 else 0.0
            a1 -= p if i == 1 else 0.0
            a2 -= p if i == 2 else 0.0
        for b in range(out.shape[1]):
            out[r, b] = volume * (a0 * g[0, b] + a1 * g[1, b] + a2 * g[2, b])


@njit(cache=True, fastmath=_FAST)
def _element_tangent(
    gradients: FloatArray,
    volumes: FloatArray,
    modes: FloatArray,
    F: FloatArray,
    J: FloatArray,
    stress: FloatArray,
    moduli: FloatArray,
    pressure: FloatArray,
    bulk_modulus: float,
    pressure_operator: FloatArray,
    g: FloatArray,
    tiles: FloatArray,
) -> None:
    """Integrate one element's tangent; see `element_tangents`.

    `g`, (n_points + 1, 3, n_padded), is scratch; both it and `tiles`, (6, n_nodes, n_padded), come from
    `_aligned` and have rows filled up to whole vectors of the processor, so that no loop has a remainder.
    """
    n_points, _, n_nodes = gradients.shape
    n_padded = tiles.shape[2]
    t = g[n_points]
    p = np.zeros(n_points)
    for q in range(n_points):
        _spatial_gradients(F[q], J[q], gradients[q], g[q])
        for m in range(len(pressure)):
            p[q] += J[q] * modes[q, m] * pressure[m]
    for block in range(6):
        i, j = BLOCKS[block]
        tile = tiles[block]
        tile[:] = 0.0
        for q in range(n_points):
            _product_with_moduli(i, j, moduli[q], stress[q], p[q], volumes[q], g[q], t)
            for a in range(n_nodes):
                g0, g1, g2 = g[q, 0, a], g[q, 1, a], g[q, 2, a]
                for b in range(n_padded):
                    tile[a, b] += g0 * t[0, b] + g1 * t[1, b] + g2 * t[2, b]
        for m in range(len(pressure)):
            t[0, :n_nodes] = pressure_operator[m, j]
            for a in range(n_nodes):
                factor = bulk_modulus * pressure_operator[m, i, a]
                for b in range(n_padded):
                    tile[a, b] += factor * t[0, b]


@njit(cache=True, parallel=True, fastmath=_FAST)
def element_tangents(
    gradients: FloatArray,
    volumes: FloatArray,
    modes: FloatArray,
    F: FloatArray,
    J: FloatArray,
    stress: FloatArray,
    moduli: FloatArray,
    pressure: FloatArray,
    bulk_modulus: FloatArray,
    pressure_operator: FloatArray,
    tangents: FloatArray,
) -> None:
    """Integrate the element tangents, pressure condensed.

    Parameters
    ----------
    gradients, volumes, modes, F, J, stress, pressure_operator : array
        As in `element_forces`.
    moduli : array, shape (n_elements, n_points, 6, 6)
        Spatial moduli without the volumetric part.
    pressure : array, shape (n_elements, n_modes)
    bulk_modulus : array, shape (n_elements,)
    tangents : array, shape (n_elements, 6, n_nodes, n_nodes)
        Written: the blocks ``BLOCKS`` of the symmetric tangent, rows by the first component's nodes.
    """
    n_elements, n_points, _, n_nodes = gradients.shape
    n_padded = (n_nodes + 7) // 8 * 8
    for e in prange(n_elements):
        g = _aligned(n_points + 1, 3, n_padded)
        tiles = _aligned(6, n_nodes, n_padded)
        _element_tangent(
            gradients[e],
            volumes[e],
            modes[e],
            F[e],
            J[e],
            stress[e],
            moduli[e],
            pressure[e],
            bulk_modulus[e],
            pressure_operator[e],
            g,
            tiles,
        )
        tangents[e] = tiles[:, :, :n_nodes]


@njit(cache=True, parallel=True, fastmath=_FAST)
def add_element_tangents(
    gradients: FloatArray,
    volumes: FloatArray,
    modes: FloatArray,
    F: FloatArray,
    J: FloatArray,
    stress: FloatArray,
    moduli: FloatArray,
    pressure: FloatArray,
    bulk_modulus: FloatArray,
    pressure_operator: FloatArray,
    slab_order: IntArray,
    slab_starts: IntArray,
    places: IndexArray,
    data: FloatArray,
) -> None:
    """Integrate the element tangents and add them to the entries of the assembled one.

    Threads take whole slabs, first those of even number, then the others: slabs two apart share no entry,
    and the order of summation does not depend on the number of threads.

    Parameters
    ----------
    gradients, volumes, modes, F, J, stress, moduli, pressure, bulk_modulus, pressure_operator : array
        As in `element_tangents`.
    slab_order : array, shape (n_elements,)
        The elements, slab by slab.
    slab_starts : array, shape (n_slabs + 1,)
        Where in it each slab begins.
    places : array, shape (n_elements, 6, n_nodes, n_nodes)
        The entry that each of the elements' adds to, −1 for none.
    data : array, shape (n_entries,)
        Added to.
    """
    _, n_points, _, n_nodes = gradients.shape
    n_padded = (n_nodes + 7) // 8 * 8
    n_slabs = len(slab_starts) - 1
    for parity in range(2):
        for half in prange((n_slabs + 1 - parity) // 2):
            slab = 2 * half + parity
            g = _aligned(n_points + 1, 3, n_padded)
            tiles = _aligned(6, n_nodes, n_padded)
            for position in range(slab_starts[slab], slab_starts[slab + 1]):
                e = slab_order[position]
                _element_tangent(
                    gradients[e],
                    volumes[e],
                    modes[e],
                    F[e],
                    J[e],
                    stress[e],
                    moduli[e],
                    pressure[e],
                    bulk_modulus[e],
                    pressure_operator[e],
                    g,
                    tiles,
                )
                for block in range(6):
                    for a in range(n_nodes):
                        for b in range(n_nodes):
                            place = places[e, block, a, b]
                            if place >= 0:
                                data[place] += tiles[block, a, b]
