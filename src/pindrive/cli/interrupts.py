"""Ctrl-C, raised where it cannot be lost.

An exception that is raised while a module is imported may be caught there, or renamed; raised while
a process is started, it leaves one that nobody knows. In such places Ctrl-C is raised a moment
later, so that no library can lose it. Only the standard library is imported, so that this holds
from the beginning of a command on.
"""

from __future__ import annotations

import signal
import sys
import threading
import time
from _thread import interrupt_main, start_new_thread
from types import FrameType

INTERRUPTED = 130
"""Exit status after Ctrl-C."""
STOPPED = "stopped; nothing was written"
"""Message after an interrupt, unless there is more to report."""

_UNINTERRUPTIBLE = (
    "importlib._bootstrap",
    "_frozen_importlib",  # name until importlib is imported
    "multiprocessing",
    "scipy.stats._qmc",  # calls Python from functions that cannot raise
)
"""Modules and packages whose functions run to their end before an interrupt is raised."""
_AGAIN = 0.02
"""Seconds after which it is looked again."""


def interruptible() -> None:
    """Raise KeyboardInterrupt on Ctrl-C from now on; where Ctrl-C is ignored, it stays ignored."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, _interrupt)
        sys.unraisablehook = _unraisable


def ignore_more() -> None:
    """Ignore Ctrl-C from now on, where it was heard before: the command is ending."""
    if signal.getsignal(signal.SIGINT) is _interrupt:
        signal.signal(signal.SIGINT, signal.SIG_IGN)


def _interrupt(_: int, frame: FrameType | None) -> None:
    while frame:
        if str(frame.f_globals.get("__name__")).startswith(_UNINTERRUPTIBLE):
            start_new_thread(_later, ())
            return
        frame = frame.f_back
    raise KeyboardInterrupt


def _later() -> None:
    time.sleep(_AGAIN)
    if sys.platform == "win32":
        interrupt_main()
    else:  # a signal that ends a wait of the main thread, too
        signal.pthread_kill(threading.main_thread().ident or 0, signal.SIGINT)


def _unraisable(lost: sys.UnraisableHookArgs) -> None:
    """An interrupt that was raised where nothing can catch it is raised again."""
    if isinstance(lost.exc_value, KeyboardInterrupt):
        start_new_thread(_later, ())
    else:
        sys.__unraisablehook__(lost)
