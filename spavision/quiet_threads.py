"""NumPy's linear algebra in one thread beside other threads that compute."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from threadpoolctl import ThreadpoolController


@contextmanager
def quiet_blas() -> Iterator[None]:
    """Keep OpenBLAS, NumPy's and SciPy's linear algebra, to one thread while the block runs.

    All that it has to do here is short, a norm or a product of small matrices, but after each its threads go
    on spinning for tens of milliseconds, on processors that others wait for. A ramp takes a third less time
    without them, the adjustment of a series of photographs two thirds. MKL's solver keeps its threads.
    """
    with ThreadpoolController().select(internal_api="openblas").limit(limits=1):
        yield
