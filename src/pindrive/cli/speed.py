"""The command `pindrive speed`: how fast the hand may move before two lines run into one."""

from __future__ import annotations

from functools import partial
from typing import Annotated

from pindrive.cli.errors import refusing
from pindrive.cli.help import ASKED, command
from pindrive.cli.options import (
    DeviceArgument,
    OverridesOption,
    measure,
    measures,
    option,
)
from pindrive.cli.outputs import (
    ForceOption,
    PlotOption,
    ResultOption,
    datasets,
    pictures,
    results,
    say_written,
)
from pindrive.cli.progress import bar

USUAL = "1 mm, 1.5 mm, 2 mm, 3 mm, 4 mm, 5 mm, 6 mm, 8 mm"


@command("The whole device", 'pindrive speed device.toml --pitch "4 mm" --plot speed.png')
def speed(
    file: DeviceArgument,
    pitch: Annotated[
        list[str] | None, option(ASKED, f"From line to line; {USUAL} if none.", metavar="LENGTHS")
    ] = None,
    width: Annotated[
        str | None, option(ASKED, "Of the lines; half the pitch if none.", metavar="LENGTH")
    ] = None,
    part: Annotated[
        float, option(ASKED, "Part of its way that the pin must be back in between.")
    ] = 0.5,
    slowest: Annotated[str, option(ASKED, "Hand tried.", metavar="SPEED")] = "5 mm/s",
    fastest: Annotated[str, option(ASKED, "Hand tried.", metavar="SPEED")] = "1000 mm/s",
    output: ResultOption = None,
    plot: PlotOption = None,
    force: ForceOption = False,
    overrides: OverridesOption = None,
) -> None:
    """Say how fast the hand may move before two lines run into one."""
    from pindrive.files.device import load_device

    with refusing():
        device_file = load_device(file, overrides or (), whole=True)
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

        from pindrive.evaluation.resolution import SpeedLimits, largest_speeds

        targets = pictures(plot, partial(SpeedLimits.plot, device=device_file.name))
        title = "Largest speeds of a hand"
        targets += datasets(output, title, ("speed_pitch [m]",), SpeedLimits.to_dataset)
        with results(targets, [file], force=force) as write:
            device = device_file.device
            criteria = device_file.criteria
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
            write(limits)
    from pindrive.cli.scan_tables import speed_report
    from pindrive.cli.tables import show

    show(speed_report(limits, part, criteria))
    say_written(targets)
