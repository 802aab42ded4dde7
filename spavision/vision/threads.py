"""How many threads: several for photographs, one for the linear algebra."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import AbstractContextManager
from typing import TypeVar

from threadpoolctl import threadpool_limits

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
    with one_blas_thread(), ThreadPoolExecutor(max_workers=several) as pool:
        yield from pool.map(function, items)


def one_blas_thread() -> AbstractContextManager[object]:
    """Keep the linear algebra to the thread that calls it while a ``with`` block runs.

    On matrices as small as a camera's, threads of its own wait for each other longer than they compute: the
    adjustment of a series of photographs takes three times as long with two of them.
    """
    limits: AbstractContextManager[object] = threadpool_limits(1, user_api="blas")
    return limits
