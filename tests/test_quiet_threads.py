"""One thread for the linear algebra, for a while."""

from collections.abc import Iterator

import numpy as np
import pytest
from threadpoolctl import ThreadpoolController

from spavision.quiet_threads import quiet_blas
from spavision.vision.threads import in_threads


def openblas_threads() -> set[int]:
    """Threads that the OpenBLAS libraries loaded may use."""
    return {
        library["num_threads"] for library in ThreadpoolController().select(internal_api="openblas").info()
    }


@pytest.fixture(autouse=True)
def _two_threads() -> Iterator[None]:
    np.linalg.inv(np.eye(2))
    with ThreadpoolController().select(internal_api="openblas").limit(limits=2):
        yield


def test_linear_algebra_keeps_to_one_thread_and_gets_its_others_back():
    with quiet_blas():
        assert openblas_threads() == {1}
    assert openblas_threads() == {2}


def test_photographs_that_are_measured_together_share_the_processors_with_nothing():
    assert list(in_threads(lambda _: openblas_threads(), [0, 1])) == [{1}, {1}]
