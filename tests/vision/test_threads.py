"""Several photographs at a time."""

from __future__ import annotations

import threading
import time

import pytest

from spavision.vision.threads import in_threads


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
