"""What the help of each command shows beside its options: their groups, and an example."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Final

from typer.core import TyperCommand, TyperGroup

COMMANDS: Final[dict[str, tuple[str, str]]] = {
    "init": ("Device and study files", "pindrive init device.toml --device"),
    "check": ("Device and study files", "pindrive check device.toml"),
    "simulate": ("One release", 'pindrive simulate device.toml --set mass="1.2 g" --plot pin.png'),
    "scan": ("The whole device", 'pindrive scan device.toml --text "a" --plot scan.png'),
    "speed": ("The whole device", 'pindrive speed device.toml --pitch "4 mm" --plot speed.png'),
    "fit": ("Measurements", 'pindrive fit device.toml pin.csv --free "stiffness, damping"'),
    "sweep": ("Studies", "pindrive sweep study.toml -o study.nc"),
    "map": ("Studies", "pindrive map study.nc --number settling_time -o map.png"),
    "sensitivity": ("Studies", "pindrive sensitivity study.toml --tolerances --plot matters.png"),
    "robustness": ("Studies", "pindrive robustness study.toml --plot yield.png"),
    "paper": ("The paper behind the model", "pindrive paper --out report"),
}
"""By name, in the order of the help: the group it is listed in, and an example of its use."""

OPTIONS: Final[dict[str, tuple[str, ...]]] = {
    "What is written": ("device", "study"),
    "What is on the page": ("text", "image", "grating", "font", "path"),
    "What is asked": (
        *("pitch", "width", "part", "slowest", "fastest", "tolerances", "number"),
        *("free", "mouse_velocity", "window", "noise", "compare"),
        *("x", "y", "at", "overrides"),
    ),
    "How it is computed": (
        *("rows", "draws", "seed", "threads", "cluster", "resume", "restart", "stop_after"),
    ),
    "Files": (
        *("output", "plot", "pin", "film", "slow", "lines", "csv", "netcdf", "json", "samples"),
        "rate",
        *("out", "docs", "force"),
    ),
    "Help": ("version", "install_completion", "show_completion", "help"),
}
"""The groups of options in their order, each with the names of its parameters."""
_GROUP_OF: Final = {name: group for group, names in OPTIONS.items() for name in names}


class HelpfulCommand(TyperCommand):
    """A command whose help groups its options and ends with an example."""

    def format_options(self, ctx: Any, formatter: Any) -> None:
        """Write its arguments, and its options group by group."""
        _write_options(self.get_params(ctx), ctx, formatter)

    def format_epilog(self, ctx: Any, formatter: Any) -> None:
        """Write the example as it is, without a break."""
        if self.epilog:
            with formatter.section("Example"):
                formatter.write(f"{'':>{formatter.current_indent}}{self.epilog}\n")


class HelpfulGroup(TyperGroup):
    """Commands that are listed group by group, each with its whole sentence."""

    def format_options(self, ctx: Any, formatter: Any) -> None:
        """Write the options, and the commands group by group."""
        _write_options(self.get_params(ctx), ctx, formatter)
        groups: dict[str, list[tuple[str, str]]] = {}
        for name in self.list_commands(ctx):
            command: Any = self.get_command(ctx, name)
            words = command.get_short_help_str(limit=200)
            groups.setdefault(command.rich_help_panel, []).append((name, words))
        widest = max(len(name) for rows in groups.values() for name, _ in rows)
        for group, rows in groups.items():
            with formatter.section(group):
                formatter.write_dl([(name.ljust(widest), words) for name, words in rows])

    def list_commands(self, ctx: Any) -> list[str]:
        """The names in the order of the help."""
        return sorted(super().list_commands(ctx), key=list(COMMANDS).index)


def shown(name: str) -> dict[str, Any]:
    """What a command called `name` is registered with, beside the function that it runs."""
    group, example = COMMANDS[name]
    return {"name": name, "cls": HelpfulCommand, "epilog": example, "rich_help_panel": group}


def _write_options(parameters: Iterable[Any], ctx: Any, formatter: Any) -> None:
    groups: dict[str, list[tuple[str, str]]] = {"Arguments": []}
    groups |= {group: [] for group in OPTIONS}
    for parameter in parameters:
        record = parameter.get_help_record(ctx)
        if record is not None:
            argument = parameter.param_type_name == "argument"
            groups["Arguments" if argument else _GROUP_OF[parameter.name]].append(record)
    for group, records in groups.items():
        if records:
            with formatter.section(group):
                formatter.write_dl(records)
