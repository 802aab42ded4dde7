"""Cases on a Dask cluster."""

from __future__ import annotations

import socket
import warnings
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING
from urllib.parse import urlsplit

from spavision.errors import InputError, InputWarning

from .execution import ATTEMPTS, Evaluate, Finished, lost

if TYPE_CHECKING:
    from distributed import Client

TIMEOUT_SECONDS = 10
_WAITING_PER_THREAD = 2
"""Cases handed to the scheduler for each thread of the cluster: those on a worker that dies are run again."""


def run_on_dask(evaluate: Evaluate, cases: Sequence[object], *, address: str) -> Iterator[Finished]:
    """Run cases on the workers of a Dask scheduler.

    Workers may come and go; a case whose worker dies is run again elsewhere. The scheduler gives a case up
    after some deaths (its ``allowed-failures``), also one that only waited on the workers that another case
    killed; so it is handed in `ATTEMPTS` times in all.

    Parameters
    ----------
    evaluate : callable
        Must be importable by name on the workers.
    cases : sequence
    address : str

    Yields
    ------
    Finished
        As they finish.

    Raises
    ------
    InputError
        If the address is none, Dask is not installed, or no scheduler answers within `TIMEOUT_SECONDS`.
    """
    client = _connected(address)
    try:
        yield from _run(client, evaluate, cases)
    finally:
        client.close()


def _run(client: Client, evaluate: Evaluate, cases: Sequence[object]) -> Iterator[Finished]:
    from distributed import as_completed
    from distributed.scheduler import KilledWorker

    remaining = iter(range(len(cases)))
    place: dict[object, tuple[int, int]] = {}
    finished = as_completed([], loop=client.loop, raise_errors=False)

    def submit(index: int, attempt: int) -> None:
        future = client.submit(evaluate, cases[index], pure=False)
        place[future.key] = index, attempt
        finished.add(future)

    def fill() -> None:
        threads = sum(client.nthreads().values())
        while len(place) < max(1, _WAITING_PER_THREAD * threads):
            index = next(remaining, None)
            if index is None:
                return
            submit(index, 1)

    fill()
    for future in finished:
        index, attempt = place.pop(future.key)
        error = future.exception() if future.status == "error" else None
        if future.status == "finished":
            yield Finished(index, future.result())
        elif (error is None or isinstance(error, KilledWorker)) and attempt < ATTEMPTS:
            submit(index, attempt + 1)
        elif error is None or isinstance(error, KilledWorker):
            yield lost(index)
        elif isinstance(error, InputError):
            raise error
        else:
            yield Finished(index, reason=f"on the cluster: {type(error).__name__}: {error}")
        fill()


def _refuse_no_address(address: str) -> None:
    """Refuse what cannot be an address, or names no host: Dask would try on and on."""
    try:
        parts = urlsplit(address)
        if not parts.scheme or not parts.hostname or not parts.port:
            raise ValueError(address)
    except ValueError as error:
        raise InputError(f"--scheduler {address}: expected an address such as tcp://host:8786") from error
    try:
        socket.getaddrinfo(parts.hostname, parts.port)
    except OSError as error:
        raise InputError(f"--scheduler {address}: the host is not known; correct the address") from error


def _connected(address: str) -> Client:
    _refuse_no_address(address)
    try:
        from distributed import Client
    except ImportError as error:
        raise InputError(
            '--scheduler needs Dask; install it with pip install "spavision[cluster]"'
        ) from error
    try:
        client = Client(address, timeout=TIMEOUT_SECONDS, set_as_default=False)
    except (OSError, TimeoutError, ValueError) as error:
        raise InputError(
            f"--scheduler {address}: no scheduler answered within {TIMEOUT_SECONDS} s; start one with "
            "'dask scheduler', or correct the address"
        ) from error
    if not client.nthreads():
        warnings.warn(InputWarning(f"{address} has no workers yet; waiting for them"), stacklevel=2)
    return client
