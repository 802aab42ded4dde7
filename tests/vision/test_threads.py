"""Several photographs at a time, one thread for the linear algebra."""

from __future__ import annotations

import threading
import time

import pytest
from threadpoolctl import threadpool_info

from spavision.vision.threads import in_threads, one_blas_thread


def blas_threads() -> set[int]:
    """Threads that the linear algebra libraries loaded may use."""
    return {library["num_threads"] for library in threadpool_info() if library["user_api"] == "blas"}


def test_results_come_in_the_order_of_the_items_whoever_ends_first() -> None:
    def late(seconds: float) -> float:
        time.sleep(seconds)
        return seconds

    assert list(in_threads(late, [0.1, 0.0, 0.05], workers=3)) == [0.1, 0.0, 0.05]


def test_items_are_worked_on_at_the_same_time() -> None:
    meeting = threading.Barrier(2, timeout=5.0)
    assert sorted(in_threads(lambda _: meeting.wait(), [0, 1], workers=2)) == [0, 1]


def test_an_error_reaches_the_caller() -> None:
    with pytest.raises(ZeroDivisionError):
        list(in_threads(lambda item: 1 // item, [1, 0, 2]))


def test_nothing_to_do_gives_nothing() -> None:
    assert list(in_threads(str, [])) == []


def test_linear_algebra_keeps_to_one_thread_and_gets_its_others_back() -> None:
    before = blas_threads()
    assert list(in_threads(lambda _: blas_threads(), [0, 1])) == [{1}, {1}]
    with one_blas_thread():
        assert blas_threads() == {1}
    assert blas_threads() == before
