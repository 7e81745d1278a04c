"""The command `pindrive check`: what a device file describes, or a recording of the hand."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from pindrive.cli.errors import refusing
from pindrive.cli.help import command


@command("Device and study files", "pindrive check device.toml")
def check(
    file: Annotated[
        Path, typer.Argument(metavar="FILE", help="Device file (TOML), or a recorded hand (CSV).")
    ],
) -> None:
    """Say what is wrong with a device file, or what it describes; or what a recording (CSV) is.

    Of a recording of the hand: its rate and resolution, and its peak speed before and after
    smoothing.
    """
    if file.suffix.lower() == ".csv":
        from pindrive.cli.tables import path_words
        from pindrive.device.recording import read_csv

        with refusing():
            path = read_csv(file)
        for line in (path.about, path_words(path, 0.0)):
            typer.echo(line)
        return
    from pindrive.files.device import load_device

    with refusing():
        device = load_device(file)
        pressing = device.whole.magnet().pressing if device.whole else None
    from pindrive.cli.tables import device_report, show
    from pindrive.motion.friction import Coefficients

    doubt = Coefficients.of(device.drive.plate, device.drive.mass, pressing).doubt
    if doubt:
        typer.echo(f"warning: {doubt}", err=True)
    show(device_report(device))
