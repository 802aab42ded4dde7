"""Cases on the processors of this machine, each worker a process of its own that may die alone."""

from __future__ import annotations

import multiprocessing
import os
import signal
from collections import deque
from collections.abc import Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool

from .execution import ATTEMPTS, Evaluate, Finished, lost

_THREAD_VARIABLES = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")


def run_in_processes(evaluate: Evaluate, cases: Sequence[object], *, workers: int) -> Iterator[Finished]:
    """Run cases in worker processes.

    Each worker is a pool of one, so that a worker that is killed takes only its own case with it; that
    case is run again, `ATTEMPTS` times in all.

    Parameters
    ----------
    evaluate : callable
        Must be importable by name.
    cases : sequence
    workers : int

    Yields
    ------
    Finished
        As they finish.
    """
    before = set(multiprocessing.active_children())
    waiting = deque((index, 1) for index in range(len(cases)))
    idle = [_worker() for _ in range(min(workers, len(cases)))]
    busy: dict[Future, tuple[ProcessPoolExecutor, int, int]] = {}
    try:
        while waiting or busy:
            while waiting and idle:
                index, attempt = waiting.popleft()
                worker = idle.pop()
                busy[worker.submit(evaluate, cases[index])] = worker, index, attempt
            for future in wait(busy, return_when=FIRST_COMPLETED).done:
                worker, index, attempt = busy.pop(future)
                try:
                    result = future.result()
                except BrokenProcessPool:
                    worker.shutdown(wait=False)
                    idle.append(_worker())
                    if attempt < ATTEMPTS:
                        waiting.append((index, attempt + 1))
                    else:
                        yield lost(index)
                    continue
                idle.append(worker)
                yield Finished(index, result)
    finally:
        for worker in [*idle, *(each for each, _, _ in busy.values())]:
            worker.shutdown(wait=not busy, cancel_futures=True)
        for process in set(multiprocessing.active_children()) - before:
            process.terminate()


def _worker() -> ProcessPoolExecutor:
    # A fork would copy the locks of this process's threads in whatever state they are.
    context = multiprocessing.get_context("spawn")
    return ProcessPoolExecutor(1, mp_context=context, initializer=_prepare)


def _prepare() -> None:
    """Keep numerical libraries, not yet loaded here, to one thread; leave Ctrl-C to the parent."""
    os.environ.update(dict.fromkeys(_THREAD_VARIABLES, "1"))
    signal.signal(signal.SIGINT, signal.SIG_IGN)
