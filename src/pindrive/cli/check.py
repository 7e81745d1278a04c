"""The command `pindrive check`: what a device file describes, or a CSV that it names."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from pindrive.cli.errors import refusing
from pindrive.cli.help import command
from pindrive.cli.options import OverridesOption


@command("Device and study files", "pindrive check device.toml")
def check(
    file: Annotated[
        Path, typer.Argument(metavar="FILE", help="Device file (TOML), or an input file (CSV).")
    ],
    overrides: OverridesOption = None,
) -> None:
    """Check a device file and its CSV files; report errors, or the device.

    For a CSV of an input, such as mouse_velocity or touch, the number of rows and the time range
    are reported; for a recording of the hand its rate, its resolution, and its peak speed before
    and after smoothing.
    """
    if file.suffix.lower() == ".csv":
        from pindrive.cli.tables import path_words
        from pindrive.device.recording import read_csv
        from pindrive.files.recording import profile_words

        with refusing():
            said = [profile_words(file)]
            if not said[0]:
                path = read_csv(file)
                said = [path.about, path_words(path, 0.0)]
        for line in said:
            typer.echo(line)
        return
    from pindrive.files.device import load_device

    with refusing():
        device = load_device(file, overrides or ())
    from pindrive.cli.tables import device_report, show, warn_of

    warn_of(device)
    show(device_report(device))
