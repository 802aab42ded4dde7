"""The fixed sparsity pattern of the tangent and the gather that fills it without races."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit, prange
from scipy.sparse import csr_array

from .element_kernels import BLOCKS
from .elements import FloatArray, IntArray

_FACE_BLOCKS = BLOCKS[3:]


@dataclass(frozen=True)
class TangentPattern:
    """Upper triangle, over the free displacement components, of the assembled tangent.

    Each stored entry is the sum of a fixed list of entries of a flat buffer that holds all element
    blocks and, behind them, all cavity face blocks.

    Parameters
    ----------
    n_free : int
    row_starts, columns : array
        CSR structure.
    list_starts : array, shape (n_entries + 1,)
    sources : array
        Positions in the buffer.
    buffer_size : int
    """

    n_free: int
    row_starts: IntArray
    columns: IntArray
    list_starts: IntArray
    sources: IntArray
    buffer_size: int

    def gather(self, buffer: FloatArray) -> csr_array:
        """Sum the buffer into the upper triangle of the tangent."""
        data = np.empty(len(self.columns))
        _sum_lists(self.list_starts, self.sources, buffer, data)
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
    used = np.flatnonzero(row >= 0)
    n_free = int(free_number.max()) + 1
    key = row[used] * n_free + column[used]
    order = np.argsort(key, kind="stable")
    key = key[order]
    is_first = np.ones(len(key), dtype=bool)
    is_first[1:] = key[1:] != key[:-1]
    starts = np.flatnonzero(is_first)
    entry_row = key[starts] // n_free
    return TangentPattern(
        n_free=n_free,
        row_starts=np.searchsorted(entry_row, np.arange(n_free + 1)).astype(np.int32),
        columns=(key[starts] % n_free).astype(np.int32),
        list_starts=np.append(starts, len(key)).astype(np.int32),
        sources=used[order].astype(np.int32),
        buffer_size=len(row),
    )


def _block_entries(cells: IntArray, blocks: IntArray, free_number: IntArray) -> tuple[IntArray, IntArray]:
    """Row and column of each entry of the cells' blocks, −1 for those not assembled.

    Blocks of two different components stand for both triangles of the cell's tangent, blocks of equal
    components are symmetric themselves, so that one of each pair of entries is left out.
    """
    n_nodes = cells.shape[1]
    number = free_number[cells]
    lower_half = np.tril(np.ones((n_nodes, n_nodes), dtype=bool), k=-1)
    rows = np.empty((len(cells), len(blocks), n_nodes, n_nodes), dtype=np.int64)
    columns = np.empty_like(rows)
    for index, (i, j) in enumerate(blocks):
        first = np.broadcast_to(number[:, :, None, i], (len(cells), n_nodes, n_nodes))
        second = np.broadcast_to(number[:, None, :, j], (len(cells), n_nodes, n_nodes))
        rows[:, index] = np.minimum(first, second)
        columns[:, index] = np.maximum(first, second)
        if i == j:
            rows[:, index][:, lower_half] = -1
    return rows.ravel(), columns.ravel()


@njit(cache=True, parallel=True)
def _sum_lists(starts: IntArray, sources: IntArray, buffer: FloatArray, out: FloatArray) -> None:
    for entry in prange(len(out)):
        total = 0.0
        for place in range(starts[entry], starts[entry + 1]):
            total += buffer[sources[place]]
        out[entry] = total
