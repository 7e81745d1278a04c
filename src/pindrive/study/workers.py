"""Workers of a study: threads for the core, processes for Python, or a Dask cluster."""

from __future__ import annotations

import json
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from functools import cache
from multiprocessing import active_children, parent_process
from multiprocessing.context import SpawnContext, SpawnProcess
from pathlib import Path
from threading import Thread
from time import monotonic, sleep
from typing import Any, Final, NoReturn, TypeVar

from pindrive.files.output import OutputError
from pindrive.quantities.refusal import refusal

Shared = TypeVar("Shared")
Given = TypeVar("Given")
Done = TypeVar("Done")
DIED = "a process that worked on the study died"


def workers(count: int, *, processes: bool) -> Executor:
    """Return the given number of workers. A single worker is a thread of this process."""
    return _processes(count) if processes and count > 1 else ThreadPoolExecutor(count)


class Standing:
    """Processes that wait for batches of points."""

    def __init__(self, count: int) -> None:
        """Begin them at the first batch."""
        self._pool = _processes(count)

    def spread(
        self, work: Callable[[Shared, Given], Done], shared: Shared, portions: Sequence[Given]
    ) -> list[Done]:
        """Compute each portion, in order; `shared` is passed to all portions."""
        try:
            return list(self._pool.map(work, [shared] * len(portions), portions))
        except BrokenProcessPool:
            standing.cache_clear()
            raise OutputError(DIED) from None


@cache
def standing(count: int) -> Standing:
    """The processes of this process, as long as it lives."""
    return Standing(count)


def stop_at_once(status: int) -> NoReturn:
    """End this process without waiting for what is under way."""
    if "multiprocessing.synchronize" not in sys.modules:  # nothing is shared with processes
        os._exit(status)
    # Errors of pools without their processes, during work and at the end of this process.
    threading.excepthook = lambda _: None
    sys.unraisablehook = lambda _: None
    for process in active_children():
        process.kill()
    sys.exit(status)  # so that what they shared is given back


@contextmanager
def _held_back() -> Iterator[None]:
    """Ctrl-C comes after this, and never to a process that is started meanwhile."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, (signal.SIGINT,))
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


class _Worker(SpawnProcess):
    """A process that takes no Ctrl-C from its first instruction on: its asker ends it."""

    def start(self) -> None:
        with _held_back():
            super().start()


class _Context(SpawnContext):
    """Processes begun anew, not forked: a process with threads cannot be forked safely."""

    Process = _Worker


def _processes(count: int) -> ProcessPoolExecutor:
    return ProcessPoolExecutor(count, _Context(), initializer=_attend)


def _attend() -> None:
    """End with the process that asked, however that ends; leave Ctrl-C to it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    asker = parent_process()
    if asker:

        def end() -> None:
            asker.join()
            os._exit(1)

        Thread(target=end, daemon=True).start()


# ---- a Dask scheduler ----------------------------------------------------------------------------


_PATIENCE: Final = 20.0
"""Longest wait for a scheduler to write its file, and to respond, s."""


class Here:
    """Worker that computes parts in sequence, in this thread."""

    def spread(
        self,
        work: Callable[[Shared, Given], Done],
        shared: Shared,
        portions: Sequence[Given],
    ) -> Iterator[Done]:
        """The work of each portion, in their order."""
        return (work(shared, portion) for portion in portions)


class Cluster:
    """Parts on the workers of a Dask scheduler."""

    def __init__(self, executor: Executor) -> None:
        self._executor = executor

    def spread(
        self,
        work: Callable[[Shared, Given], Done],
        shared: Shared,
        portions: Sequence[Given],
    ) -> Iterator[Done]:
        """The work of each portion, in their order."""
        begun = [self._executor.submit(work, shared, portion) for portion in portions]
        return (future.result() for future in begun)


@contextmanager
def crew(address: str | None) -> Iterator[Here | Cluster]:
    """Return the workers of independent parts: a scheduler, else this thread.

    Raises:
        ValueError: The address is invalid, as for `cluster_executor`.
    """
    if address is None:
        yield Here()
        return
    check_installed()
    with cluster_executor(address, "nothing was written") as (executor, _):
        yield Cluster(executor)


def check_installed() -> None:
    """Refuse where Dask's distributed is not installed."""
    try:
        import distributed  # noqa: F401
    except ImportError:
        raise ValueError(
            "`cluster` needs Dask's distributed; pip install 'pindrive[cluster]'"
        ) from None


@contextmanager
def cluster_executor(address: str, kept: str) -> Iterator[tuple[Executor, int]]:
    """An executor on the workers of a scheduler, and how many threads they have, at least 1.

    Args:
        address: Address such as tcp://10.0.0.1:8786, or the file of the scheduler, which ends in
            .json.
        kept: Content that is kept if workers die one after the other, for the message.

    Raises:
        ValueError: No scheduler answers at the address, or a worker has another version.
    """
    from distributed import Client, KilledWorker

    try:
        place = _written(Path(address)) if address.endswith(".json") else address
        client = Client(place, timeout=_PATIENCE, set_as_default=False)
    except (OSError, ValueError) as error:
        required = "the address of a Dask scheduler, like tcp://10.0.0.1:8786, or its .json file"
        given = f"{address}: {str(error) or type(error).__name__}"
        raise ValueError(refusal("`cluster`", required, given)) from None
    with client, client.get_executor(pure=False) as executor:
        _check_versions(client.run(_version))
        try:
            yield executor, max(1, sum(client.nthreads().values()))
        except KilledWorker as error:
            raise OutputError(
                f"`cluster` {address}: workers died one after the other: {error}; {kept}"
            ) from None


def _written(file: Path) -> str:
    """The address in the file of a scheduler, which may have just begun.

    Raises:
        ValueError: The file does not exist, or holds no address, after `_PATIENCE`.
    """
    end = monotonic() + _PATIENCE
    while True:
        try:
            return str(json.loads(file.read_text("utf-8"))["address"])
        except (OSError, ValueError, KeyError, TypeError) as error:
            if monotonic() > end:
                missing = isinstance(error, OSError)
                raise ValueError("cannot be read" if missing else "holds no address") from None
        sleep(0.05)


def _version() -> str:
    """The version that a worker has."""
    from pindrive import __version__

    return __version__


def _check_versions(of_workers: Mapping[str, Any]) -> None:
    """Refuse workers that would compute with another version."""
    for worker, version in of_workers.items():
        if version != _version():
            given = f"{version} on {worker}"
            raise ValueError(refusal("the workers' pindrive", f"version {_version()}", given))
