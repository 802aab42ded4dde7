"""Lattice growth: corner candidates become an indexed grid, neighbour by mutual neighbour."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import breadth_first_order, connected_components, minimum_spanning_tree
from scipy.spatial import cKDTree

from .arrays import FloatArray, IntArray
from .saddles import Candidates
from .spectra import LatticeField

STEPS = np.array([[1, 0], [0, 1]])
REACH_SQUARES = 0.3
"""How far from its expected place a neighbour may lie, in squares."""


def grow_lattice(candidates: Candidates, field: LatticeField) -> tuple[IntArray, IntArray]:
    """Index the largest connected part of the lattice.

    Two candidates are neighbours when each is the other's nearest at one lattice step, and their colour
    parities alternate. Indices spread along the tree of the closest-fitting links; candidates whose other
    links contradict their index are left out.

    Returns
    -------
    rows : int array, shape (n,)
        Rows of ``candidates`` that received an index.
    indices : int array, shape (n, 2)
        Their column and row in the lattice, from an arbitrary origin.
    """
    links = [_mutual_links(candidates, field, axis) for axis in (0, 1)]
    first = np.concatenate([link[0] for link in links])
    second = np.concatenate([link[1] for link in links])
    misfit = np.concatenate([link[2] for link in links])
    step = np.repeat(STEPS, [len(link[0]) for link in links], axis=0)
    n = len(candidates.pixels)
    if len(first) == 0:
        return np.zeros(0, dtype=np.intp), np.zeros((0, 2), dtype=np.intp)
    graph = coo_matrix((misfit + 1e-3, (first, second)), shape=(n, n)).tocsr()
    _, label = connected_components(graph, directed=False)
    largest = np.bincount(label).argmax()
    indices = _spread(graph, first, second, step, root=int(np.flatnonzero(label == largest)[0]))
    member = label == largest
    inside = member[first]
    agrees = (indices[second] - indices[first] == step).all(axis=1)
    links_of = np.bincount(first[inside], minlength=n) + np.bincount(second[inside], minlength=n)
    clashes = inside & ~agrees
    contradictions = np.bincount(first[clashes], minlength=n) + np.bincount(second[clashes], minlength=n)
    keep = np.flatnonzero(member & (contradictions * 3 < links_of) & (links_of >= 2))
    return _without_twins(keep, indices, candidates.quality)


def _mutual_links(
    candidates: Candidates, field: LatticeField, axis: int
) -> tuple[IntArray, IntArray, FloatArray]:
    """Pairs one step apart along ``axis`` that choose each other; with their misfit in squares."""
    pixels = candidates.pixels
    vector = field.vectors(pixels)[axis]
    tree = cKDTree(pixels)
    reach = REACH_SQUARES * field.pitch_px
    distance_on, onward = tree.query(pixels + vector, distance_upper_bound=reach)
    _, backward = tree.query(pixels - vector, distance_upper_bound=reach)
    n = len(pixels)
    has = onward < n
    start = np.flatnonzero(has)
    end = onward[has]
    mutual = (backward[end] == start) & (candidates.parity[end] != candidates.parity[start])
    return start[mutual], end[mutual], distance_on[has][mutual] / field.pitch_px


def _spread(graph: coo_matrix, first: IntArray, second: IntArray, step: IntArray, *, root: int) -> IntArray:
    """Return the indices of every node reached from ``root`` along the minimum spanning tree."""
    n = graph.shape[0]
    order, parent = breadth_first_order(minimum_spanning_tree(graph), root, directed=False)
    keys = np.concatenate([first * n + second, second * n + first])
    steps = np.concatenate([step, -step])
    sorting = np.argsort(keys, kind="stable")
    child = order[1:].astype(np.intp)
    link = sorting[np.searchsorted(keys[sorting], parent[child] * n + child)]
    indices = np.zeros((n, 2), dtype=np.intp)
    indices[child] = steps[link]
    # Each node's index is the sum of the steps on its way to the root: double the way until all are there.
    towards = np.full(n, root, dtype=np.intp)
    towards[child] = parent[child]
    while (towards[order] != root).any():
        indices += indices[towards]
        towards = towards[towards]
    return indices


def _without_twins(rows: IntArray, indices: IntArray, quality: FloatArray) -> tuple[IntArray, IntArray]:
    """Keep the better of any candidates that share an index."""
    best_first = rows[np.argsort(-quality[rows], kind="stable")]
    _, unique = np.unique(indices[best_first], axis=0, return_index=True)
    kept = np.sort(best_first[unique])
    return kept, indices[kept]
