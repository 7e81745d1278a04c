"""The command `pindrive init`: a device file, study file, or wish file, to start from."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from pindrive.cli.errors import refusing
from pindrive.cli.help import WRITTEN, command
from pindrive.cli.options import option
from pindrive.cli.outputs import ForceOption

if TYPE_CHECKING:
    from collections.abc import Callable


@command("Device and study files", "pindrive init device.toml --device")
def init(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="Where to write it.")],
    force: ForceOption = False,
    device: Annotated[
        bool, option(WRITTEN, "With magnet, control block, pin array and hand.", "--device")
    ] = False,
    study: Annotated[
        bool, option(WRITTEN, "A study file: a device, and what to vary of it.", "--study")
    ] = False,
    wish: Annotated[
        bool, option(WRITTEN, "A wish file: a device, and what is wanted of it.", "--wish")
    ] = False,
) -> None:
    """Write a commented device file, study file, or wish file, to start from."""
    from pindrive.files.keys import template
    from pindrive.files.output import DEVICE_FILE, STUDY_FILE, WISH_FILE, Output, naming, writing
    from pindrive.optimisation.template import wish_template
    from pindrive.study.template import study_template

    made: Callable[..., str]
    made, kind, next_ = template, DEVICE_FILE, f"simulate {file}"
    if study:
        made, kind, next_ = study_template, STUDY_FILE, f"sweep {file}"
    elif wish:
        made, kind, next_ = wish_template, WISH_FILE, f"design {file} --plot {file.stem}.png"
    elif device:
        next_ = f"scan {file} --text A"
    with refusing():
        if study and wish:
            raise ValueError("give --study or --wish, not both")
        with writing([Output(file, kind)], force=force) as parts, naming(file):
            parts[file].write_text(made(whole=device), encoding="utf-8")
    typer.echo(f"Wrote {file}; try: pindrive {next_}")
