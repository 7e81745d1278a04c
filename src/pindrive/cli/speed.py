"""The command `pindrive speed`: how fast the hand may move before two lines run into one."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
from typing import Annotated

import typer

from pindrive.cli.errors import (
    DeviceArgument,
    OverridesOption,
    measure,
    measures,
    picture,
    picture_format,
    refusing,
)
from pindrive.cli.progress import bar

USUAL = "1 mm, 1.5 mm, 2 mm, 3 mm, 4 mm, 5 mm, 6 mm, 8 mm"


def speed(
    file: DeviceArgument,
    pitch: Annotated[
        list[str] | None,
        typer.Option(metavar="LENGTHS", help=f"From line to line; {USUAL} if none."),
    ] = None,
    width: Annotated[
        str | None, typer.Option(metavar="LENGTH", help="Of the lines; half the pitch if none.")
    ] = None,
    part: Annotated[
        float, typer.Option(help="Part of its way that the pin must be back in between.")
    ] = 0.5,
    slowest: Annotated[str, typer.Option(metavar="SPEED", help="Hand tried.")] = "5 mm/s",
    fastest: Annotated[str, typer.Option(metavar="SPEED", help="Hand tried.")] = "1000 mm/s",
    plot: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Draw it: .png, .svg or .pdf.")
    ] = None,
    overrides: OverridesOption = None,
) -> None:
    """Say how fast the hand may move before two lines run into one."""
    from pindrive.files.device import load_device

    with refusing(), ExitStack() as stack:
        device_file = load_device(file, overrides or (), whole=True)
        assert device_file.whole
        pitches = [
            step
            for text in pitch or [USUAL]
            for step in measures(text, "speed.pitch", "2 mm", "--pitch")
        ]
        line = None if width is None else measure(width, "speed.width", "1 mm", "--width")
        tried = (
            measure(slowest, "speed.slowest", "5 mm/s", "--slowest"),
            measure(fastest, "speed.fastest", "1000 mm/s", "--fastest"),
        )

        from pindrive.evaluation.resolution import largest_speeds
        from pindrive.files.output import naming, writing

        parts = stack.enter_context(writing([picture(plot)] if plot else [], [file]))
        device, criteria = device_file.whole.device(device_file.drive), device_file.whole.criteria()
        with bar("Pitches") as progress:
            limits = largest_speeds(
                device,
                pitches,
                width=line,
                part=part,
                slowest=tried[0],
                fastest=tried[1],
                criteria=criteria,
                progress=progress,
            )
        if plot:
            from pindrive.plot.resolution import plot_speeds
            from pindrive.plot.style import save

            with naming(plot):
                save(
                    plot_speeds(limits, part, criteria, device_file.name),
                    parts[plot],
                    picture_format(plot),
                )
    from pindrive.cli.evaluation_tables import speed_report
    from pindrive.cli.tables import show

    show(speed_report(limits, part, criteria))
    if plot:
        typer.echo(f"Wrote {plot}")
