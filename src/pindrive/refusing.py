"""What the commands share: how they take a device file, and how they refuse."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import typer

DeviceArgument = Annotated[Path, typer.Argument(metavar="FILE", help="Device file (TOML).")]
OverridesOption = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help='Another value, as in --set mass="12 g".'),
]


@contextmanager
def refusing() -> Iterator[None]:
    """Bad input ends the command with a line for each problem and exit status 2."""
    try:
        yield
    except ValueError as error:
        typer.echo(str(error), err=True)
        raise typer.Exit(2) from None


def check_distinct(paths: Iterable[Path]) -> None:
    """Refuse to write one file over another of the same command."""
    seen: set[str] = set()
    for path in paths:
        real = os.path.realpath(path)
        if real in seen:
            raise ValueError(f"{path}: is named twice; give each file a name of its own")
        seen.add(real)
