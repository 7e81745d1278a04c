"""The command `pindrive scan`: a hand moves the whole device over a page."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from pindrive.refusing import DeviceArgument, OverridesOption, check_distinct, refusing

if TYPE_CHECKING:
    from pindrive.device.array import PinArray
    from pindrive.device.hand import HandPath
    from pindrive.device.reading import Reading
    from pindrive.device.scanning import Progress
    from pindrive.device.scene import Scene

STROKES = "strokes"


def scan(
    file: DeviceArgument,
    text: Annotated[
        str | None, typer.Option(metavar="TEXT", help=r"What is on the page; \n begins a line.")
    ] = None,
    image: Annotated[
        Path | None, typer.Option(metavar="FILE", help="A picture of the page instead.")
    ] = None,
    grating: Annotated[
        str | None, typer.Option(metavar="PITCHES", help='Lines instead, as in "4 mm, 2 mm".')
    ] = None,
    font: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Font of the text; DejaVu Sans if none.")
    ] = None,
    path: Annotated[
        str,
        typer.Option(metavar="strokes|FILE", help="How the hand moves: a CSV of t [s], x, y [mm]."),
    ] = STROKES,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", metavar="FILE", help="All of it, as NetCDF.")
    ] = None,
    overrides: OverridesOption = None,
) -> None:
    """Move the device over a page and say what its pins do."""
    from pindrive.config import load

    with refusing(), ExitStack() as stack:
        device_file = load(file, overrides or (), whole=True)
        assert device_file.whole
        device, reading = device_file.whole.device(device_file.drive), device_file.whole.reading()
        inputs = [file, *(given for given in (image, font) if given)]
        check_distinct([*inputs, *([output] if output else [])])

        from pindrive.device.scanning import scan as follow
        from pindrive.output import atomic_write, naming

        scene = _scene(text, image, grating, font, reading, device.array)
        hand = _path(path, reading, scene, device.array)
        part = stack.enter_context(atomic_write(output)) if output else None
        with _bar() as progress:
            done = follow(device, scene, hand, max_angle=reading.max_angle, progress=progress)
        if output and part:
            from pindrive.device.dataset import write_netcdf

            with naming(output):
                write_netcdf(done, part)
    from pindrive.device.report import scan_report
    from pindrive.report import show

    for warning in done.warnings:
        typer.echo(f"warning: {warning}", err=True)
    show(scan_report(done))
    if output:
        typer.echo(f"Wrote {output}")


def _scene(
    text: str | None,
    image: Path | None,
    grating: str | None,
    font: Path | None,
    reading: Reading,
    array: PinArray,
) -> Scene:
    """What is on the page."""
    given = [
        name
        for name, value in (("--text", text), ("--image", image), ("--grating", grating))
        if value is not None
    ]
    if len(given) != 1:
        found = " and ".join(given) or "none of them"
        raise ValueError(f"give exactly one of --text, --image and --grating, got {found}")
    if font and text is None:
        raise ValueError(f"--font {font}: goes with --text alone")
    if text is not None:
        return reading.text(text.replace("\\n", "\n"), array, font)
    if image is not None:
        return reading.image(image)
    return reading.grating(_lengths(grating or ""), array)


def _lengths(text: str) -> list[float]:
    from pindrive.units import UnitError, to_si

    lengths = []
    for part in text.split(","):
        try:
            lengths.append(to_si(part.strip(), "m", "4 mm"))
        except UnitError as error:
            raise ValueError(f"--grating {text}: must be {error}, got {part.strip()!r}") from None
    return lengths


def _path(path: str, reading: Reading, scene: Scene, array: PinArray) -> HandPath:
    """How the hand moves."""
    return reading.strokes(scene, array) if path == STROKES else reading.record(path)


@contextmanager
def _bar() -> Iterator[Progress | None]:
    """A progress bar where somebody looks on."""
    if not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import Progress as Bar

    with Bar(console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("Pins")
        yield lambda done, of: bar.update(task, completed=done, total=of)
