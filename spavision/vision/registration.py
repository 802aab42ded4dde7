"""Which corner is which: one index origin for all photographs, and which of them share a camera position."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from .arrays import FloatImage, IntArray
from .board import BoardView
from .camera import to_plane
from .grid import common_rows
from .observe import BoardMap, Observation

WIDEST_SHIFT_SQUARES = 20
SMALLEST_CERTAINTY = 3.0
"""Lead of the best shift, over the disagreement that it leaves, from which its index is trusted. Wrong shifts
stay below 1.6 on renders; with the clamp in view, right ones reach 4 to 7."""

BLOCK_SQUARES = 6

LARGEST_DIFFERENCE = 0.15
"""Difference of brightness, relative to the board's, at which two places simply count as different."""

MOVED_SHARE = 0.3
"""Share of that difference above which, under either shift, something else has come or gone."""

STILL_PX = 0.04
"""Lattice motion up to which the camera counts as unmoved."""

MAP_ERROR = 0.002
"""Difference of two maps, relative to the board's brightness, that noise and uneven light alone make."""

CONTRADICTION = 1.3
"""Disagreement that an unmoved camera leaves, over that of the best shift, above which it may have moved."""


@dataclass(frozen=True)
class Registration:
    """Index shift of one photograph to the reference photograph.

    Parameters
    ----------
    shift : int array, shape (2,)
        Add to the photograph's indices.
    certainty : float
        Least lead of this shift over the next best ones (see `SMALLEST_CERTAINTY`); infinite for an unmoved
        camera.
    """

    shift: IntArray
    certainty: float


def register(reference: Observation, other: Observation) -> Registration:
    """Find the index shift between two photographs of the same board.

    An unmoved camera shows the lattice at the same pixels. A bump of just a whole number of squares does so
    too, so the low-passed maps are correlated in either case; the lattice decides unless the maps contradict.
    """
    assert reference.board is not None
    assert other.board is not None
    assert reference.map is not None
    assert other.map is not None
    nearest, is_near = _nearest_shift(reference.board, other.board)
    unmoved = (int(nearest[0]), int(nearest[1]))
    is_same = same_position(reference.board, other.board, nearest)
    one_map, other_map = levelled(reference.map), levelled(other.map)
    costs = disagreements(one_map, other_map, about=nearest)
    best = min(costs, key=lambda shift: costs[shift])
    if (is_near or is_same) and costs.get(unmoved, np.inf) < CONTRADICTION * costs[best] + MAP_ERROR:
        return Registration(nearest, np.inf)
    # A bump by whole squares and without any turn hardly happens: it takes clear evidence to believe in it.
    if is_same and _certainty(one_map, other_map, best, unmoved) < SMALLEST_CERTAINTY:
        return Registration(nearest, np.inf)
    rivals = sorted((shift for shift in costs if shift != best), key=lambda shift: costs[shift])
    certainty = min((_certainty(one_map, other_map, best, rival) for rival in rivals[:5]), default=0.0)
    return Registration(np.array(best, dtype=np.intp), certainty)


def _nearest_shift(first: BoardView, second: BoardView) -> tuple[IntArray, bool]:
    """Return the shift that an unmoved camera would have, and whether the lattice lies near where it says."""
    offset = to_plane(first.camera, first.pose, second.pixels) - second.indices
    middle = np.median(offset, axis=0)
    spread = float(np.median(np.linalg.norm(offset - middle, axis=1)))
    nearest = np.rint(middle).astype(np.intp)
    is_near = spread < 0.08 and float(np.abs(middle - nearest).max()) < 0.12 and nearest.sum() % 2 == 0
    return nearest, is_near


def same_position(first: BoardView, second: BoardView, shift: IntArray) -> bool:
    """Tell whether two photographs show the lattice at the same pixels.

    ``shift`` takes the second's indices to the first's. An affine motion is fitted to the common corners, so
    that noise averages out and the slightest turn shows at the board's rim.
    """
    rows_first, rows_second = common_rows(first.indices, second.indices + shift)
    if len(rows_first) < 30:
        return False
    pixels = first.pixels[rows_first]
    motion = second.pixels[rows_second] - pixels
    local = (pixels - pixels.mean(axis=0)) / max(float(np.ptp(pixels, axis=0).max()), 1.0)
    design = np.column_stack([np.ones(len(local)), local])
    keep = np.linalg.norm(motion - np.median(motion, axis=0), axis=1) < 1.0
    if keep.sum() < 30:
        return False
    coefficients, *_ = np.linalg.lstsq(design[keep], motion[keep], rcond=None)
    rest = motion[keep] - design[keep] @ coefficients
    error = 4.0 * float(rest.std()) / np.sqrt(keep.sum())
    return bool(np.abs(design @ coefficients).max() < STILL_PX + error)


def disagreements(reference: BoardMap, other: BoardMap, *, about: IntArray) -> dict[tuple[int, int], float]:
    """Return the mean disagreement of two maps for every shift that keeps the colour of squares.

    Each photograph's indices have an origin of their own, however far off: ``about`` (2,) is the shift that
    an unmoved camera would have, and those within `WIDEST_SHIFT_SQUARES` of it are tried.
    """
    column, row = about.tolist()
    reach = range(-WIDEST_SHIFT_SQUARES, WIDEST_SHIFT_SQUARES + 1)
    costs = {}
    for shift in (
        (column + dx, row + dy) for dy in reach for dx in reach if (column + row + dx + dy) % 2 == 0
    ):
        _, difference = _difference(reference, other, shift)
        defined = np.isfinite(difference)
        if defined.sum() > 60:
            costs[shift] = float(difference[defined].mean())
    return costs


def _difference(
    reference: BoardMap, other: BoardMap, shift: tuple[int, int]
) -> tuple[tuple[slice, slice], FloatImage]:
    """Return where in the reference map the other one lies, and their capped difference there."""
    rows, columns = reference.values.shape
    left, top = np.array(other.origin) - np.array(reference.origin) + shift
    x0, y0 = max(0, left), max(0, top)
    x1, y1 = max(x0, min(columns, left + other.values.shape[1])), max(y0, min(rows, top + len(other.values)))
    difference = reference.values[y0:y1, x0:x1] - other.values[y0 - top : y1 - top, x0 - left : x1 - left]
    # The actuator moves: where it was and where it is count for no more than the cap.
    return (slice(y0, y1), slice(x0, x1)), np.minimum(np.abs(difference), LARGEST_DIFFERENCE)


def _certainty(reference: BoardMap, other: BoardMap, best: tuple[int, int], rival: tuple[int, int]) -> float:
    """Lead of one shift over another, over the disagreement that it leaves itself.

    Both are summed over blocks of the board: neighbouring nodes share shadows and occluders, blocks hardly
    do. Nodes where both shifts disagree show something that moved, and speak for neither.
    """
    own, others = np.full_like(reference.values, np.nan), np.full_like(reference.values, np.nan)
    for field, shift in ((own, best), (others, rival)):
        place, difference = _difference(reference, other, shift)
        field[place] = difference
    with np.errstate(invalid="ignore"):
        moved = ~(np.minimum(own, others) < MOVED_SHARE * LARGEST_DIFFERENCE)
    lead, rest = (_block_sums(np.where(moved, 0.0, field)) for field in (others - own, own))
    error = np.maximum(rest, BLOCK_SQUARES**2 * MAP_ERROR)
    return float(lead.sum() / np.sqrt((error**2).sum()))


def _block_sums(values: FloatImage) -> FloatImage:
    rows, columns = (size // BLOCK_SQUARES for size in values.shape)
    whole = values[: rows * BLOCK_SQUARES, : columns * BLOCK_SQUARES]
    return np.asarray(whole.reshape(rows, BLOCK_SQUARES, columns, BLOCK_SQUARES).sum(axis=(1, 3)))


def levelled(board_map: BoardMap) -> BoardMap:
    """Return a map of brightness over the board's typical brightness: exposure drops out."""
    return replace(board_map, values=board_map.values / max(float(np.nanmedian(board_map.values)), 1.0))
