"""The command `pindrive init`: a device file, or study file, to start from."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from pindrive.cli.errors import refusing
from pindrive.cli.help import FILES, WRITTEN, command


@command("Device and study files", "pindrive init device.toml --device")
def init(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="Where to write it.")],
    force: Annotated[
        bool,
        typer.Option("--force", help="Replace such a file that is there.", rich_help_panel=FILES),
    ] = False,
    device: Annotated[
        bool,
        typer.Option(
            "--device",
            help="With magnet, control block, pin array and hand.",
            rich_help_panel=WRITTEN,
        ),
    ] = False,
    study: Annotated[
        bool,
        typer.Option(
            "--study",
            help="A study file: a device, and what to vary of it.",
            rich_help_panel=WRITTEN,
        ),
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
