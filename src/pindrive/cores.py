"""How many threads or processes share work."""

from __future__ import annotations

import os

from pindrive.quantities import refusal


def usable_cores() -> int:
    """How many this process may use."""
    of_this_process = getattr(os, "sched_getaffinity", None)
    return len(of_this_process(0)) if of_this_process else os.cpu_count() or 1


def worker_count(threads: int | None) -> int:
    """As many as are asked for, or as there are cores to run on.

    Raises:
        ValueError: that is no count.
    """
    if threads is None:
        return usable_cores()
    if type(threads) is not int or threads < 1:
        raise ValueError(refusal("threads", "a whole number of at least 1", repr(threads)))
    return threads
