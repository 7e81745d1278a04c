"""Help of the program and its commands, and lazy import of each command."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Sequence
from importlib import import_module
from pkgutil import iter_modules
from typing import Any, Final, TypeVar

import typer
from typer.core import TyperCommand, TyperGroup

from pindrive.cli.errors import stopping

Function = TypeVar("Function", bound=Callable[..., None])

COMMAND_GROUPS: Final = (
    "Device and study files",
    "One release",
    "Measurements",
    "The whole device",
    "Studies",
    "Designs",
    "Other simulators",
    "The paper behind the model",
)
"""The order in which the help lists them; a group that is not here comes after them."""

WRITTEN: Final = "Contents"
PAGE: Final = "Page"
ASKED: Final = "Analysis"
COMPUTED: Final = "Computation"
FILES: Final = "Files"
_PANELS: Final = ("Arguments", WRITTEN, PAGE, ASKED, COMPUTED, FILES, "Help")
"""The groups of options, in the order of a command's help; the program's own are in the last."""

_SHARED: Final = (
    "app",
    "design_tables",
    "errors",
    "fit_tables",
    "help",
    "interrupts",
    "options",
    "outputs",
    "progress",
    "scan_tables",
    "study_tables",
    "system_tables",
    "tables",
)
"""The files of this package that are no command."""
_UsageError: Any = typer.BadParameter.__base__
_marked: Final[list[tuple[Callable[..., None], dict[str, Any]]]] = []
"""The functions that are commands, and what each is registered with."""


def command(group: str, example: str) -> Callable[[Function], Function]:
    """Make a function the command of its file, whose name it has.

    Args:
        group: Group of commands under which the help lists the command.
        example: Example of the use, at the end of the help.
    """

    def mark(function: Function) -> Function:
        name = function.__module__.rpartition(".")[2]
        shown = {"name": name, "cls": HelpfulCommand, "epilog": example, "rich_help_panel": group}
        _marked.append((function, shown))
        return function

    return mark


def register(app: typer.Typer) -> None:
    """Give a program all commands, each the function of a file of this package."""
    package = __name__.rpartition(".")[0]
    for file in iter_modules(sys.modules[package].__path__):
        if file.name not in _SHARED:
            import_module(f"{package}.{file.name}")
    for function, shown in _marked:
        app.command(**shown)(function)


class HelpfulCommand(TyperCommand):
    """A command whose help groups its options and ends with an example."""

    def format_options(self, ctx: Any, formatter: Any) -> None:
        """Write its arguments, and its options group by group."""
        _write_options(self.get_params(ctx), ctx, formatter)

    def format_epilog(self, ctx: Any, formatter: Any) -> None:
        """Write the example unchanged, without a line break."""
        if self.epilog:
            with formatter.section("Example"):
                formatter.write(f"{'':>{formatter.current_indent}}{self.epilog}\n")


class Program(TyperGroup):
    """Commands that are listed group by group, and whose usage errors are one line."""

    def format_options(self, ctx: Any, formatter: Any) -> None:
        """Write the options, and the commands group by group, each with its whole sentence."""
        _write_options(self.get_params(ctx), ctx, formatter)
        groups: dict[str, list[tuple[str, str]]] = {}
        for name in self.list_commands(ctx):
            words = self.commands[name].get_short_help_str(limit=200)
            groups.setdefault(self._group(name), []).append((name, words))
        widest = max(len(name) for rows in groups.values() for name, _ in rows)
        for group, rows in groups.items():
            with formatter.section(group):
                formatter.write_dl([(name.ljust(widest), words) for name, words in rows])

    def list_commands(self, ctx: Any) -> list[str]:
        """The names in the order of the help: by group, then by name."""
        return sorted(self.commands, key=lambda name: (_place(self._group(name)), name))

    def _group(self, name: str) -> str:
        return str(vars(self.commands[name])["rich_help_panel"])

    def make_context(self, *given: Any, **more: Any) -> Any:
        """Read the arguments."""
        with stopping():
            return super().make_context(*given, **more)

    def invoke(self, ctx: Any) -> Any:
        """Run the command; Ctrl-C before and after its own work, too, is a line."""
        with stopping():
            return super().invoke(ctx)

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


def _place(group: str) -> tuple[int, str]:
    known = group in COMMAND_GROUPS
    return (COMMAND_GROUPS.index(group) if known else len(COMMAND_GROUPS), group)


def _write_options(parameters: Iterable[Any], ctx: Any, formatter: Any) -> None:
    groups: dict[str, list[tuple[str, str]]] = {panel: [] for panel in _PANELS}
    for parameter in parameters:
        record = parameter.get_help_record(ctx)
        if record is not None:
            argument = parameter.param_type_name == "argument"
            stated = getattr(parameter, "rich_help_panel", None) or "Help"
            groups["Arguments" if argument else stated].append(record)
    for group, records in groups.items():
        if records:
            with formatter.section(group):
                formatter.write_dl(records)
