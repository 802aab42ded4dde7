"""The fixed sparsity pattern of the tangent, and where in it the elements' entries go."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit, prange
from scipy.sparse import csr_array

from .element_kernels import BLOCKS
from .elements import FloatArray, IndexArray, IntArray

_FACE_BLOCKS = BLOCKS[3:]

_SLAB_COUNTS = (16, 8, 4, 2)
"""Slabs tried; enough for eight threads. Of two no pair is two apart."""


@dataclass(frozen=True)
class TangentPattern:
    """Upper triangle, over the free displacement components, of the assembled tangent.

    Parameters
    ----------
    n_free : int
    row_starts, columns : array
        CSR structure.
    element_places : array, shape (n_elements, 6, n_nodes, n_nodes)
        The stored entry that each entry of the elements' blocks adds to, −1 for none.
    face_places : array, shape (n_faces, 3, n_face_nodes, n_face_nodes)
        The same for the cavity faces.
    """

    n_free: int
    row_starts: IndexArray
    columns: IndexArray
    element_places: IndexArray
    face_places: IndexArray

    def matrix(self, data: FloatArray) -> csr_array:
        """Return the upper triangle with the given entries."""
        return csr_array((data, self.columns, self.row_starts), shape=(self.n_free, self.n_free))


def tangent_pattern(elements: IntArray, faces: IntArray, free_number: IntArray) -> TangentPattern:
    """Work out the pattern of a mesh.

    Parameters
    ----------
    elements : array, shape (n_elements, n_element_nodes)
    faces : array, shape (n_faces, n_face_nodes)
        Cavity faces, each a face of an element.
    free_number : array, shape (n_nodes, 3)
        Number of each free displacement component, increasing with node and component; −1 for the
        constrained ones.
    """
    n_free = int(free_number.max()) + 1
    row_starts, columns = _structure(elements, free_number, n_free)
    places = []
    for cells, blocks in ((elements, BLOCKS), (faces, _FACE_BLOCKS)):
        n_nodes = cells.shape[1]
        found = np.empty((len(cells), len(blocks), n_nodes, n_nodes), dtype=np.int32)
        _find_places(free_number[cells], blocks, row_starts, columns, found)
        places.append(found)
    return TangentPattern(n_free, row_starts, columns, *places)


def slabs(elements: IntArray, centres: FloatArray) -> tuple[IntArray, IntArray]:
    """Cut a body across its length into slabs of elements, of which those two apart share no node.

    Parameters
    ----------
    elements : array, shape (n_elements, n_element_nodes)
    centres : array, shape (n_elements, 3)

    Returns
    -------
    order : array, shape (n_elements,)
        The elements, slab by slab.
    starts : array, shape (n_slabs + 1,)
        Where in it each slab begins.
    """
    order = np.argsort(centres[:, np.ptp(centres, axis=0).argmax()], kind="stable")
    for n_slabs in _SLAB_COUNTS:
        starts = np.linspace(0, len(order), n_slabs + 1).astype(np.int64)
        slab = np.empty(len(order), dtype=np.int64)
        slab[order] = np.repeat(np.arange(n_slabs), np.diff(starts))
        first = np.full(elements.max() + 1, n_slabs)
        last = np.zeros(elements.max() + 1, dtype=np.int64)
        np.minimum.at(first, elements, slab[:, None])
        np.maximum.at(last, elements, slab[:, None])
        if np.all(last - first <= 1):
            break
    return order, starts


def _structure(elements: IntArray, free_number: IntArray, n_free: int) -> tuple[IndexArray, IndexArray]:
    """CSR structure of the upper triangle: row starts and sorted columns."""
    n_cells, n_cell_nodes = elements.shape
    belongs = csr_array(
        (
            np.ones(elements.size, dtype=np.int32),
            elements.ravel(),
            np.arange(0, elements.size + 1, n_cell_nodes),
        ),
        shape=(n_cells, len(free_number)),
    )
    neighbours = csr_array(belongs.T @ belongs)
    neighbours.sort_indices()
    row_starts = np.zeros(n_free + 1, dtype=np.int32)
    _count_columns(neighbours.indptr, neighbours.indices, free_number, row_starts)
    np.cumsum(row_starts, out=row_starts)
    columns = np.empty(row_starts[-1], dtype=np.int32)
    _list_columns(neighbours.indptr, neighbours.indices, free_number, row_starts, columns)
    return row_starts, columns


@njit(cache=True)
def _count_columns(
    starts: IndexArray, neighbours: IndexArray, free_number: IntArray, counts: IndexArray
) -> None:
    """Count the stored entries of each row, one place further on in `counts`."""
    for node in range(len(free_number)):
        for row in free_number[node]:
            if row >= 0:
                for neighbour in neighbours[starts[node] : starts[node + 1]]:
                    for column in free_number[neighbour]:
                        if column >= row:
                            counts[row + 1] += 1


@njit(cache=True)
def _list_columns(
    starts: IndexArray,
    neighbours: IndexArray,
    free_number: IntArray,
    row_starts: IndexArray,
    columns: IndexArray,
) -> None:
    """List the columns of each row; they come sorted, for the numbers increase with the nodes."""
    for node in range(len(free_number)):
        for row in free_number[node]:
            if row >= 0:
                entry = row_starts[row]
                for neighbour in neighbours[starts[node] : starts[node + 1]]:
                    for column in free_number[neighbour]:
                        if column >= row:
                            columns[entry] = column
                            entry += 1


@njit(cache=True, parallel=True)
def _find_places(
    number: IntArray, blocks: IntArray, row_starts: IndexArray, columns: IndexArray, places: IndexArray
) -> None:
    """Find each entry of the cells' blocks in its row, by bisection; −1 for those not assembled.

    Blocks of two different components stand for both triangles of the cell's tangent, blocks of equal
    components are symmetric themselves, so that one of each pair of entries is left out.
    """
    for cell in prange(len(number)):
        for block in range(len(blocks)):
            i, j = blocks[block]
            for a in range(number.shape[1]):
                for b in range(number.shape[1]):
                    row = min(number[cell, a, i], number[cell, b, j])
                    column = max(number[cell, a, i], number[cell, b, j])
                    if row < 0 or (i == j and b < a):
                        places[cell, block, a, b] = -1
                        continue
                    low, high = row_starts[row], row_starts[row + 1]
                    while high - low > 1:
                        middle = (low + high) // 2
                        if columns[middle] <= column:
                            low = middle
                        else:
                            high = middle
                    places[cell, block, a, b] = low


@njit(cache=True)
def add_up(places: IndexArray, entries: FloatArray, data: FloatArray) -> None:
    """Add entries to the stored ones at the given places, both flat; −1 for none."""
    for entry in range(len(places)):
        if places[entry] >= 0:
            data[places[entry]] += entries[entry]
