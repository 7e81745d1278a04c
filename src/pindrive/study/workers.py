"""Who works on a study: threads where the core does the work, processes where Python does."""

from __future__ import annotations

import os
import signal
import sys
import threading
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from functools import cache
from multiprocessing import active_children, get_context, parent_process
from threading import Thread
from typing import TYPE_CHECKING, NoReturn, TypeVar

from pindrive.files.output import OutputError

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

Given = TypeVar("Given")
Done = TypeVar("Done")
DIED = "a process that worked on the study died"


def workers(count: int, *, processes: bool) -> Executor:
    """So many workers. One alone is a thread of this process in any case."""
    return _processes(count) if processes and count > 1 else ThreadPoolExecutor(count)


def spread(count: int, work: Callable[[Given], Done], portions: Sequence[Given]) -> list[Done]:
    """The work of each portion, in their order, done by so many processes.

    They begin at the first call and stand by for the next, as long as this process lives.
    """
    try:
        return list(_standing(count).map(work, portions))
    except BrokenProcessPool:
        _standing.cache_clear()
        raise OutputError(DIED) from None


def stop_at_once(status: int) -> NoReturn:
    """End this process without waiting for what is under way."""
    if not active_children():
        os._exit(status)
    threading.excepthook = lambda _: None  # of pools that miss their processes
    for process in active_children():
        process.kill()
    sys.exit(status)  # so that what they shared is given back


@cache
def _standing(count: int) -> ProcessPoolExecutor:
    return _processes(count)


def _processes(count: int) -> ProcessPoolExecutor:
    """Begun anew, not forked: a process with threads cannot be forked safely."""
    return ProcessPoolExecutor(count, get_context("spawn"), initializer=_attend)


def _attend() -> None:
    """End with the process that asked, however that ends; leave Ctrl-C to it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    asker = parent_process()
    if asker:

        def end() -> None:
            asker.join()
            os._exit(1)

        Thread(target=end, daemon=True).start()
