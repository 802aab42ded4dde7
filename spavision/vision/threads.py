"""One function on many photographs, several at a time."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

from spavision.quiet_threads import quiet_blas

Item = TypeVar("Item")
Result = TypeVar("Result")


def in_threads(
    function: Callable[[Item], Result], items: Sequence[Item], *, workers: int | None = None
) -> Iterator[Result]:
    """Call a function on each item, and yield what it returns in the items' order.

    Nearly all the time on a photograph is spent in OpenCV, NumPy and compiled kernels, which let other
    threads run meanwhile.

    Parameters
    ----------
    function : callable
    items : sequence
    workers : int, optional
        How many at a time; as many as there are processors where nothing is said.
    """
    several = max(1, min(workers or os.cpu_count() or 1, len(items)))
    with quiet_blas(), ThreadPoolExecutor(max_workers=several) as pool:
        yield from pool.map(function, items)
