"""What the commands share: how they take a device file, and how they refuse."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from pindrive.cli.help import HelpfulGroup

if TYPE_CHECKING:
    from pindrive.files.output import Output

_UsageError: Any = typer.BadParameter.__base__
DeviceArgument = Annotated[Path, typer.Argument(metavar="FILE", help="Device file (TOML).")]
OverridesOption = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="KEY=VALUE",
        help='Another value, as in --set mass="12 g"; static friction keeps its ratio to kinetic.',
    ),
]


INTERRUPTED = 130
"""Exit status after Ctrl-C."""


def count_option(
    option: str,
    help: str,
    metavar: str = "COUNT",
    *,
    least: int = 1,
    most: int = 10**18,
    power_of_2: bool = False,
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

    return typer.Option(option, metavar=metavar, help=help, parser=count)


class OneLine(HelpfulGroup):
    """Commands whose usage errors are one line too."""

    def main(
        self,
        args: Sequence[str] | None = None,
        prog_name: str | None = None,
        complete_var: str | None = None,
        standalone_mode: bool = True,
        *more: Any,
        **extra: Any,
    ) -> Any:
        """Run the command that the arguments name."""
        try:
            status = super().main(args, prog_name, complete_var, False, *more, **extra)
        except _UsageError as error:
            if not standalone_mode:
                raise
            typer.echo(error.format_message(), err=True)
            sys.exit(error.exit_code)
        if standalone_mode:
            sys.exit(status or 0)
        return status


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


def picture(path: Path, option: str = "--plot") -> Output:
    """A picture that is to be written, in the format that its name asks for.

    Raises:
        ValueError: it asks for none.
    """
    from pindrive.files.output import PICTURES, Output

    suffix = path.suffix.lower()
    if suffix not in PICTURES:
        raise ValueError(f"{option} {path}: must end in {', '.join(PICTURES)}")
    return Output(path, PICTURES[suffix], option)


def picture_format(path: Path) -> str:
    """The format of a picture, as Matplotlib calls it."""
    return path.suffix.lower().removeprefix(".")


def measures(text: str, name: str, example: str, option: str) -> list[float]:
    """Values of a quantity, apart by commas, as an option of the command line gives them, in SI."""
    return [measure(part.strip(), name, example, option) for part in text.split(",")]


def measure(text: str, name: str, example: str, option: str) -> float:
    """One value of the quantity called `name`, as an option gives it, in SI and within bounds."""
    from pindrive.quantities.table import QUANTITIES, check, refusal
    from pindrive.quantities.units import UnitError, quoted, to_si

    label = name.rpartition(".")[2]
    try:
        value = to_si(text, QUANTITIES[name].unit, example)
    except UnitError as error:
        raise ValueError(refusal(label, str(error), quoted(text), option)) from None
    return check(name, value, where=option, label=label, given=quoted(text))
