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


INTERRUPTED = 130
"""Exit status after Ctrl-C."""
FIGURE_FORMATS = (".png", ".svg", ".pdf")


@contextmanager
def refusing() -> Iterator[None]:
    """Bad input ends the command with a line for each problem and exit status 2."""
    try:
        yield
    except ValueError as error:
        typer.echo(str(error), err=True)
        raise typer.Exit(2) from None
    except KeyboardInterrupt:
        typer.echo("stopped", err=True)
        raise typer.Exit(INTERRUPTED) from None


def check_distinct(paths: Iterable[Path]) -> None:
    """Refuse to write one file over another of the same command."""
    seen: set[str] = set()
    for path in paths:
        real = os.path.realpath(path)
        if real in seen:
            raise ValueError(f"{path}: is named twice; give each file a name of its own")
        seen.add(real)


def figure_format(path: Path, option: str = "--plot") -> str:
    """The format that the name of a figure asks for."""
    suffix = path.suffix.lower()
    if suffix not in FIGURE_FORMATS:
        raise ValueError(f"{option} {path}: must end in {', '.join(FIGURE_FORMATS)}")
    return suffix.removeprefix(".")


def measures(text: str, name: str, example: str, option: str) -> list[float]:
    """Values of a quantity, apart by commas, as an option of the command line gives them, in SI."""
    return [measure(part.strip(), name, example, option) for part in text.split(",")]


def measure(text: str, name: str, example: str, option: str) -> float:
    """One value of the quantity called `name`, as an option gives it, in SI and within bounds."""
    from pindrive.quantities import QUANTITIES, check, refusal
    from pindrive.units import UnitError, quoted, to_si

    label = name.rpartition(".")[2]
    try:
        value = to_si(text, QUANTITIES[name].unit, example)
    except UnitError as error:
        raise ValueError(refusal(label, str(error), quoted(text), option)) from None
    return check(name, value, where=option, label=label, given=quoted(text))
