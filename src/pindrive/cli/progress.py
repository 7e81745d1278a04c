"""Progress bars, shown where standard error is a terminal."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from typing import TYPE_CHECKING

from pindrive.lazy import rich_console, rich_progress

if TYPE_CHECKING:
    from pindrive.device.pin_scan import Progress


@contextmanager
def bar(what: str) -> Iterator[Progress | None]:
    """Return a function of the counts done and in all; None if standard error is no terminal."""
    if not sys.stderr.isatty():
        yield None
        return
    with rich_progress.Progress(console=rich_console.Console(stderr=True), transient=True) as shown:
        task = shown.add_task(what)
        yield lambda done, of: shown.update(task, completed=done, total=of)


@contextmanager
def simulated_time(duration: float | None) -> Iterator[Callable[[float], None] | None]:
    """Return a function that shows the simulated time, s, from its first call on.

    Args:
        duration: End of the simulation, s. None: its ending.

    Yields:
        The function; None if standard error is no terminal.
    """
    if not sys.stderr.isatty():
        yield None
        return
    columns = (
        rich_progress.SpinnerColumn(),
        rich_progress.TextColumn("{task.description}"),
        rich_progress.TimeElapsedColumn(),
    )
    of = "" if duration is None else f" of {duration:.6g} s"
    with ExitStack() as stack:
        shown: list[rich_progress.Progress] = []

        def show(time: float) -> None:
            text = f"Simulated {time:.6g} s{of}"
            if shown:
                shown[0].update(shown[0].task_ids[0], description=text)
                return
            screen = rich_console.Console(stderr=True)
            bar = rich_progress.Progress(*columns, console=screen, transient=True)
            bar.add_task(text)
            shown.append(stack.enter_context(bar))

        yield show


@contextmanager
def steps(count: int) -> Iterator[Callable[[str], None]]:
    """Return a function that reports the name of each step as it begins."""
    columns = (
        rich_progress.BarColumn(),
        rich_progress.TextColumn("{task.description}"),
        rich_progress.TimeElapsedColumn(),
    )
    screen, looked_at = rich_console.Console(stderr=True), sys.stderr.isatty()
    with rich_progress.Progress(
        *columns, console=screen, transient=True, disable=not looked_at
    ) as shown:
        task = shown.add_task("", total=count)
        begun = 0

        def step(what: str) -> None:
            nonlocal begun
            shown.update(task, description=what, completed=begun)
            begun += 1

        yield step


@contextmanager
def points_bar() -> Iterator[Progress]:
    """A progress bar with points per second and time left, shown in a terminal."""
    if not sys.stderr.isatty():
        yield lambda done, total: None
        return
    columns = (
        rich_progress.TextColumn("{task.percentage:>3.0f} %"),
        rich_progress.BarColumn(),
        rich_progress.TextColumn("{task.fields[speed]}"),
        rich_progress.TimeRemainingColumn(),
    )
    with rich_progress.Progress(
        *columns, console=rich_console.Console(stderr=True), transient=True
    ) as bar:
        task = bar.add_task("", total=None, speed="")

        def tell(done: int, total: int) -> None:
            speed = bar.tasks[task].speed
            digits = 0 if speed and speed >= 10.0 else 1
            shown = f"{speed:,.{digits}f} points/s".replace(",", " ") if speed else ""
            bar.update(task, completed=done, total=total, speed=shown)

        yield tell
