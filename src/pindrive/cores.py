"""How many threads or processes share work."""

from __future__ import annotations

import os

from pindrive.quantities import check_whole


def usable_cores() -> int:
    """How many this process may use."""
    of_this_process = getattr(os, "sched_getaffinity", None)
    return len(of_this_process(0)) if of_this_process else os.cpu_count() or 1


def worker_count(threads: int | None) -> int:
    """As many as are asked for, or as there are cores to run on.

    Raises:
        ValueError: that is no count.
    """
    return usable_cores() if threads is None else check_whole(threads, "threads")
