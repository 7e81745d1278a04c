"""The command `pindrive speed`: how fast the hand may move before two lines run into one."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Protocol

from pindrive.cli.errors import refusing
from pindrive.cli.help import ASKED, PAGE, command
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
    Target,
    datasets,
    pictures,
    results,
    say_written,
)
from pindrive.cli.progress import bar

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure
    from rich.console import RenderableType

    from pindrive.files.device import DeviceFile

USUAL = "1 mm, 1.5 mm, 2 mm, 3 mm, 4 mm, 5 mm, 6 mm, 8 mm"


@command("The whole device", 'pindrive speed device.toml --pitch "4 mm" --plot speed.png')
def speed(
    file: DeviceArgument,
    pitch: Annotated[
        list[str] | None, option(PAGE, f"Pitches of the lines; default {USUAL}.", metavar="LENGTHS")
    ] = None,
    width: Annotated[
        str | None, option(PAGE, "Width of the lines; default half the pitch.", metavar="LENGTH")
    ] = None,
    text: Annotated[
        str | None, option(PAGE, r"Text instead of two lines; \n begins a line.", metavar="TEXT")
    ] = None,
    slowest: Annotated[
        str, option(ASKED, "Lowest hand speed of the search.", metavar="SPEED")
    ] = "5 mm/s",
    fastest: Annotated[
        str | None,
        option(
            ASKED,
            "Highest hand speed of the search; default 1000 mm/s, and up to 10 m/s over two lines "
            "without a limit below.",
            metavar="SPEED",
        ),
    ] = None,
    overrides: OverridesOption = None,
    output: ResultOption = None,
    plot: PlotOption = None,
    force: ForceOption = False,
) -> None:
    """Compute the largest hand speed at which two lines are distinct.

    For a text: the largest peak speed of the strokes at which all lines of the letters are shown.
    """
    from pindrive.cli.tables import show
    from pindrive.files.device import load_device

    with refusing():
        device = load_device(file, overrides or (), whole=True)
        least = measure(slowest, "speed.slowest", "5 mm/s", "--slowest")
        most = fastest and measure(fastest, "speed.fastest", "1000 mm/s", "--fastest")
        tried = least, most or None
        files = partial(_files, output, plot, device.name)
        if text is not None:
            if pitch or width:
                raise ValueError("give --text or --pitch and --width, not both")
            report, targets = _over_text(device, text, tried, files, force)
        else:
            pitches = [
                step
                for lengths in pitch or [USUAL]
                for step in measures(lengths, "speed.pitch", "2 mm", "--pitch")
            ]
            line = None if width is None else measure(width, "speed.width", "1 mm", "--width")
            report, targets = _over_lines(device, pitches, line, tried, files, force)
    show(report)
    say_written(targets)


class _Speeds(Protocol):
    """Common interface of both kinds of speeds."""

    def plot(self, device: str = "") -> Figure: ...
    def to_dataset(self) -> xr.Dataset: ...


def _files(
    output: list[Path] | None, plot: Path | None, name: str, column: str
) -> list[Target[_Speeds]]:
    """The files to write, of a device with this name; the first column of the CSV is `column`."""
    targets: list[Target[_Speeds]] = pictures(plot, lambda found: found.plot(name))
    title = "Largest speeds of a hand"
    return targets + datasets(output, title, (column,), lambda found: found.to_dataset())


def _over_lines(
    device: DeviceFile,
    pitches: list[float],
    width: float | None,
    tried: tuple[float, float | None],
    files: Callable[[str], list[Target[_Speeds]]],
    force: bool,
) -> tuple[RenderableType, list[Target[_Speeds]]]:
    from pindrive.cli.scan_tables import speed_report
    from pindrive.evaluation.hand_speed import largest_hand_speeds
    from pindrive.evaluation.resolution import largest_speeds
    from pindrive.quantities.refusal import refusal

    gives_way = device.device.hand is not None
    if gives_way and width is not None:
        required = "left out for a hand that gives way: lines are half as wide as their pitch"
        raise ValueError(refusal("--width", required, f"{width!r} m"))
    targets = files("speed_pitch [m]")
    with results(targets, [device.path], force=force) as write:
        with bar("Trials") as progress:
            search = partial(largest_speeds, device.device, pitches, width=width)
            if gives_way:
                reading, touch = device.reading, device.touch
                search = partial(largest_hand_speeds, device.device, reading, pitches, touch=touch)
            found = search(
                slowest=tried[0],
                fastest=tried[1],
                criteria=device.criteria,
                progress=progress,
            )
        write(found)
    return speed_report(found, device.criteria, gives_way=gives_way), targets


def _over_text(
    device: DeviceFile,
    text: str,
    tried: tuple[float, float | None],
    files: Callable[[str], list[Target[_Speeds]]],
    force: bool,
) -> tuple[RenderableType, list[Target[_Speeds]]]:
    from pindrive.cli.scan_tables import page_speed_report
    from pindrive.device.page_description import Page
    from pindrive.evaluation.page_speed import speeds_over_page
    from pindrive.quantities.table import default

    page = Page(text=text.replace("\\n", "\n"))
    page.check("--{}")
    targets = files("hand_speed [m/s]")
    with results(targets, [device.path], force=force) as write:
        with bar("Scans") as progress:
            found = speeds_over_page(
                device.device,
                device.reading,
                page,
                touch=device.touch,
                criteria=device.criteria,
                slowest=tried[0],
                fastest=tried[1] or default("speed.fastest"),
                progress=progress,
            )
        write(found)
    return page_speed_report(found), targets
