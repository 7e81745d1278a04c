"""Early ends of a command: bad input, a line for each error, and Ctrl-C."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Final

import typer

from pindrive.cli.interrupts import INTERRUPTED, STOPPED, ignore_more

_ARGUMENTS: Final = (
    "at",
    "cluster",
    "font",
    "force",
    "image",
    "number",
    "resume",
    "slow",
    "x",
    "y",
)
_OPTIONS: Final = {name: f"--{name}" for name in _ARGUMENTS} | {"overrides": "--set"}
"""Options of the commands, by the arguments of Python that messages name."""


@contextmanager
def refusing(stopped: Callable[[], str] = lambda: STOPPED) -> Iterator[None]:
    """Bad input ends the command with a line for each problem and exit status 2.

    Args:
        stopped: Message after Ctrl-C.
    """
    with stopping(stopped):
        try:
            yield
        except ValueError as error:
            typer.echo(in_options(str(error)), err=True)
            raise typer.Exit(2) from None


@contextmanager
def stopping(stopped: Callable[[], str] = lambda: STOPPED) -> Iterator[None]:
    """Ctrl-C ends the command with a line; `stopped` gives it."""
    try:
        yield
    except KeyboardInterrupt:
        ignore_more()
        typer.echo(in_options(stopped()), err=True)
        raise typer.Exit(INTERRUPTED) from None


def in_options(text: str) -> str:
    """Return a message of the library with options in place of the arguments of Python.

    The library writes `force=True` where a command has the option --force.
    """
    return re.sub(r"`([a-z]+)(?:=True)?`", lambda found: _OPTIONS.get(found[1], found[0]), text)
