"""The command `pindrive init`: a device file, or study file, to start from."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from pindrive.cli.errors import refusing
from pindrive.cli.help import WRITTEN, command
from pindrive.cli.options import ForceOption, option


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
) -> None:
    """Write a commented device file, or study file, to start from."""
    from pindrive.files.output import DEVICE_FILE, STUDY_FILE, Output, naming, writing
    from pindrive.files.template import template
    from pindrive.study.template import study_template

    kind = STUDY_FILE if study else DEVICE_FILE
    with refusing(), writing([Output(file, kind)], consent=force) as parts, naming(file):
        text = study_template(whole=device) if study else template(whole=device)
        parts[file].write_text(text, encoding="utf-8")
    release = f"scan {file} --text A" if device else f"simulate {file}"
    typer.echo(f"Wrote {file}; try: pindrive {f'sweep {file}' if study else release}")
