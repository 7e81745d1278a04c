"""The command line. What a command needs is imported when it runs, so that help comes at once."""

from __future__ import annotations

import gc
import os
import sys
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from pindrive.refusing import (
    INTERRUPTED,
    DeviceArgument,
    OverridesOption,
    check_distinct,
    figure_format,
    refusing,
)

if TYPE_CHECKING:
    from pindrive.motion import Motion

app = typer.Typer(
    name="pindrive",
    help="Exact dynamics of the pin drives of tactile devices.",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,  # plain help is here in a third of the time
    pretty_exceptions_enable=False,
)


def main() -> None:
    """Run the command line."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")  # a terminal without µ shows ? instead
    status: int | str | None = None
    try:
        app()
    except KeyboardInterrupt:
        status = INTERRUPTED
    except SystemExit as end:
        status = end.code
    except OSError as error:  # other files have been named already
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # nothing to flush at exit
        print(f"standard output: cannot be written: {error.strerror}", file=sys.stderr)
        sys.exit(2)
    if status == INTERRUPTED:
        from pindrive.study.workers import stop_at_once

        gc.collect()  # what an exception held is closed: no file is left half written
        stop_at_once(INTERRUPTED)  # threads and processes at work would be waited for
    sys.exit(status)


def _print_version(wanted: bool) -> None:
    if wanted:
        from pindrive import __version__

        typer.echo(f"pindrive {__version__}")
        raise typer.Exit


@app.callback()
def _program(
    version: Annotated[
        bool,
        typer.Option("--version", callback=_print_version, is_eager=True, help="Show the version."),
    ] = False,
) -> None:
    pass


@app.command()
def init(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="Where to write it.")],
    force: Annotated[bool, typer.Option("--force", help="Replace an existing file.")] = False,
    device: Annotated[
        bool, typer.Option("--device", help="With magnet, control block, pin array and hand.")
    ] = False,
) -> None:
    """Write a commented device file to start from."""
    from pindrive.output import OutputError, atomic_write
    from pindrive.template import template

    with refusing():
        if file.is_file() and not force:
            raise OutputError(f"{file}: exists already; --force replaces it")
        with atomic_write(file) as part:
            part.write_text(template(whole=device), encoding="utf-8")
    command = f"scan {file} --text A" if device else f"simulate {file}"
    typer.echo(f"Wrote {file}; try: pindrive {command}")


@app.command()
def check(file: DeviceArgument) -> None:
    """Say what is wrong with a device file, or what it describes."""
    from pindrive.config import load

    with refusing():
        device = load(file)
    from pindrive.report import device_report, show

    show(device_report(device))


@app.command()
def simulate(
    file: DeviceArgument,
    overrides: OverridesOption = None,
    plot: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Draw it: .png, .svg or .pdf.")
    ] = None,
    csv: Annotated[Path | None, typer.Option(metavar="FILE", help="Samples over time.")] = None,
    netcdf: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Samples, events, numbers, with units.")
    ] = None,
    json: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Numbers, events and phases.")
    ] = None,
    samples: Annotated[int, typer.Option(min=2, help="Even times in CSV and NetCDF.")] = 1001,
) -> None:
    """Release the pin of a device file and say how it moves."""
    from pindrive import budgets, export
    from pindrive.config import load, motion_of
    from pindrive.output import atomic_write, naming

    with refusing():
        device = load(file, overrides or ())
        outputs: dict[Path, Callable[[Motion, Path], None]] = {}
        if plot:
            suffix = figure_format(plot)
            outputs[plot] = lambda motion, part: export.write_figure(motion, part, suffix)
        if csv:
            outputs[csv] = lambda motion, part: export.write_csv(motion, part, samples)
        if netcdf:
            outputs[netcdf] = lambda motion, part: export.write_netcdf(motion, part, samples)
        if json:
            outputs[json] = lambda motion, part: export.write_json(motion, device, part)
        check_distinct([file, *(path for path in (plot, csv, netcdf, json) if path)])
        budgets.MOTION_SAMPLES.check(samples, where="--samples")
        with ExitStack() as stack:
            parts = {path: stack.enter_context(atomic_write(path)) for path in outputs}
            motion = motion_of(device)
            for path, write in outputs.items():
                with naming(path):
                    write(motion, parts[path])
    from pindrive.report import motion_report, show

    show(motion_report(motion))
    for path in outputs:
        typer.echo(f"Wrote {path}")


def _register() -> None:
    """The commands that have a file of their own."""
    from pindrive.cli_paper import paper
    from pindrive.cli_scan import scan
    from pindrive.cli_speed import speed
    from pindrive.cli_study import map_study, robustness, sensitivity, sweep

    for command in (scan, speed, sweep, sensitivity, robustness, paper):
        app.command()(command)
    app.command("map")(map_study)


_register()
