"""Options that several commands have, and how what they are given is read."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Annotated, Any

import typer

from pindrive.cli.help import ASKED, COMPUTED, FILES


def count_option(
    option: str,
    help: str,
    metavar: str = "COUNT",
    *,
    least: int = 1,
    most: int = 10**18,
    power_of_2: bool = False,
    panel: str = COMPUTED,
) -> Any:
    """An option that is a whole number from `least` to `most`, or such a power of 2."""
    required = f"{'a power of 2' if power_of_2 else 'a whole number'} of at least {least}"
    bounded = f"{required} and at most {most}"

    def count(text: str) -> int:
        number = int(text) if re.fullmatch(r"[0-9]{1,1000}", str(text)) else -1
        if least <= number <= most and not (power_of_2 and number & (number - 1)):
            return number
        stated = bounded if number > most or most < 10**18 else required
        typer.echo(f"{option} must be {stated}, got {text}", err=True)
        raise typer.Exit(2)

    return typer.Option(option, metavar=metavar, help=help, parser=count, rich_help_panel=panel)


def option(panel: str, help: str, *names: str, metavar: str | None = None) -> Any:
    """Define an option in a group of a command's help; a flag for names alone."""
    return typer.Option(*names, metavar=metavar, help=help, rich_help_panel=panel)


def file_option(help: str, *names: str, metavar: str = "FILE") -> Any:
    """An option that names a file to write."""
    return option(FILES, help, *names, metavar=metavar)


DeviceArgument = Annotated[Path, typer.Argument(metavar="FILE", help="Device file (TOML).")]
StudyArgument = Annotated[Path, typer.Argument(metavar="STUDY", help="Study file (TOML).")]
OverridesOption = Annotated[
    list[str] | None,
    option(
        ASKED,
        'Value of a key, for example mass="12 g"; static friction keeps its ratio to kinetic.',
        "--set",
        metavar="KEY=VALUE",
    ),
]
RateOption = Annotated[
    str | None,
    file_option(
        'Sampling rate of the CSV file, for example "1 kHz".', "--rate", metavar="FREQUENCY"
    ),
]
ClusterOption = Annotated[
    str | None,
    option(
        COMPUTED,
        "Dask scheduler whose workers compute: address or scheduler file.",
        metavar="ADDRESS",
    ),
]
ThreadsOption = Annotated[
    int | None, count_option("--threads", "Number of threads; default: all cores.")
]


def measures(text: str, name: str, example: str, option: str) -> list[float]:
    """Values of a quantity, apart by commas, as an option of the command line gives them, in SI."""
    return [measure(part.strip(), name, example, option) for part in text.split(",")]


def measure(text: str, name: str, example: str, option: str) -> float:
    """One value of the quantity called `name`, as an option gives it, in SI and within bounds."""
    from pindrive.quantities.refusal import quoted, refusal
    from pindrive.quantities.table import QUANTITIES, check
    from pindrive.quantities.units import UnitError, to_si

    label = name.rpartition(".")[2]
    try:
        value = to_si(text, QUANTITIES[name].unit, example)
    except UnitError as error:
        raise ValueError(refusal(label, str(error), quoted(text), option)) from None
    return check(name, value, where=option, label=label, given=quoted(text))
