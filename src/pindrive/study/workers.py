"""Who works on a study: threads where the core does the work, processes where Python does."""

from __future__ import annotations

import os
import signal
import sys
import threading
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from functools import cache
from multiprocessing import active_children, parent_process
from multiprocessing.context import SpawnContext, SpawnProcess
from threading import Thread
from typing import TYPE_CHECKING, NoReturn, TypeVar

from pindrive.files.output import OutputError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

Shared = TypeVar("Shared")
Given = TypeVar("Given")
Done = TypeVar("Done")
DIED = "a process that worked on the study died"


def workers(count: int, *, processes: bool) -> Executor:
    """So many workers. One alone is a thread of this process in any case."""
    return _processes(count) if processes and count > 1 else ThreadPoolExecutor(count)


class Standing:
    """Processes that stand by for one batch of points after the other."""

    def __init__(self, count: int) -> None:
        """Begin them at the first batch."""
        self._pool = _processes(count)

    def spread(
        self, work: Callable[[Shared, Given], Done], shared: Shared, portions: Sequence[Given]
    ) -> list[Done]:
        """The work of each portion, in their order; `shared` is the same for all."""
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
    # Of pools that miss their processes, while they work and as this process ends.
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
