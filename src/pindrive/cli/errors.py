"""Early ends of a command: bad input, a line for each error, and Ctrl-C."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import typer

from pindrive.cli.interrupts import INTERRUPTED, STOPPED, ignore_more


@contextmanager
def refusing(stopped: Callable[[], str] = lambda: STOPPED) -> Iterator[None]:
    """Bad input ends the command with a line for each problem and exit status 2.

    Args:
        stopped: what is said after Ctrl-C.
    """
    with stopping(stopped):
        try:
            yield
        except ValueError as error:
            typer.echo(str(error), err=True)
            raise typer.Exit(2) from None


@contextmanager
def stopping(stopped: Callable[[], str] = lambda: STOPPED) -> Iterator[None]:
    """Ctrl-C ends the command with a line; `stopped` gives it."""
    try:
        yield
    except KeyboardInterrupt:
        ignore_more()
        typer.echo(stopped(), err=True)
        raise typer.Exit(INTERRUPTED) from None
