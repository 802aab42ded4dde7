"""The fixed sparsity pattern of the tangent and the scatter that fills it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array

from .element_kernels import BLOCKS
from .elements import FloatArray, IntArray

IndexArray = NDArray[np.int32]

_FACE_BLOCKS = BLOCKS[3:]


@dataclass(frozen=True)
class TangentPattern:
    """Upper triangle, over the free displacement components, of the assembled tangent.

    Parameters
    ----------
    n_free : int
    row_starts, columns : array
        CSR structure.
    places : array
        For each entry of a flat buffer that holds all element blocks and, behind them, all cavity face
        blocks: the stored entry that it adds to, −1 for none.
    """

    n_free: int
    row_starts: IndexArray
    columns: IndexArray
    places: IndexArray

    def assemble(self, buffer: FloatArray) -> csr_array:
        """Add the buffer up into the upper triangle of the tangent."""
        data = np.zeros(len(self.columns))
        _scatter(self.places, buffer, data)
        return csr_array((data, self.columns, self.row_starts), shape=(self.n_free, self.n_free))


def tangent_pattern(elements: IntArray, faces: IntArray, free_number: IntArray) -> TangentPattern:
    """Work out the pattern of a mesh.

    Parameters
    ----------
    elements : array, shape (n_elements, n_element_nodes)
    faces : array, shape (n_faces, n_face_nodes)
        Cavity faces.
    free_number : array, shape (n_nodes, 3)
        Number of each free displacement component, −1 for the constrained ones.
    """
    rows, columns = zip(
        _block_entries(elements, BLOCKS, free_number),
        _block_entries(faces, _FACE_BLOCKS, free_number),
        strict=True,
    )
    row, column = np.concatenate(rows), np.concatenate(columns)
    n_free = int(free_number.max()) + 1
    used = row >= 0
    pattern = csr_array(
        coo_array((np.ones(np.count_nonzero(used)), (row[used], column[used])), shape=(n_free, n_free))
    )
    pattern.sort_indices()
    places = np.empty(len(row), dtype=np.int32)
    _find_places(row, column, pattern.indptr, pattern.indices, places)
    return TangentPattern(n_free, pattern.indptr, pattern.indices, places)


def _block_entries(cells: IntArray, blocks: IntArray, free_number: IntArray) -> tuple[IndexArray, IndexArray]:
    """Row and column of each entry of the cells' blocks, row −1 for those not assembled.

    Blocks of two different components stand for both triangles of the cell's tangent, blocks of equal
    components are symmetric themselves, so that one of each pair of entries is left out.
    """
    n_nodes = cells.shape[1]
    number = free_number[cells].astype(np.int32)
    lower_half = np.tril(np.ones((n_nodes, n_nodes), dtype=bool), k=-1)
    rows = np.empty((len(cells), len(blocks), n_nodes, n_nodes), dtype=np.int32)
    columns = np.empty_like(rows)
    for index, (i, j) in enumerate(blocks):
        first = number[:, :, None, i]
        second = number[:, None, :, j]
        np.minimum(first, second, out=rows[:, index])
        np.maximum(first, second, out=columns[:, index])
        if i == j:
            rows[:, index][:, lower_half] = -1
    return rows.ravel(), columns.ravel()


@njit(cache=True)
def _find_places(
    row: IndexArray, column: IndexArray, row_starts: IndexArray, columns: IndexArray, places: IndexArray
) -> None:
    """Find each entry in its row by bisection."""
    for entry in range(len(row)):
        if row[entry] < 0:
            places[entry] = -1
            continue
        low, high = row_starts[row[entry]], row_starts[row[entry] + 1]
        while high - low > 1:
            middle = (low + high) // 2
            if columns[middle] <= column[entry]:
                low = middle
            else:
                high = middle
        places[entry] = low


@njit(cache=True)
def _scatter(places: IndexArray, buffer: FloatArray, out: FloatArray) -> None:
    """Add up in one thread: it is bound by memory, and the order of summation stays."""
    for entry in range(len(places)):
        if places[entry] >= 0:
            out[places[entry]] += buffer[entry]
