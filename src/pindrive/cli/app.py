"""The command line. What a command needs is imported when it runs, so that help comes at once."""

from __future__ import annotations

import gc
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from pindrive.cli.errors import (
    INTERRUPTED,
    DeviceArgument,
    OneLine,
    OverridesOption,
    count_option,
    measure,
    picture,
    picture_format,
    refusing,
)
from pindrive.cli.help import shown
from pindrive.cli.interrupts import interruptible

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from pindrive.motion.motion import Motion

app = typer.Typer(
    name="pindrive",
    cls=OneLine,
    help="Exact dynamics of the pin drives of tactile devices.",
    no_args_is_help=True,
    rich_markup_mode=None,  # plain help is here in a third of the time
    pretty_exceptions_enable=False,
)


def main() -> None:
    """Run the command line."""
    interruptible()
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
    context: typer.Context,
    version: Annotated[
        bool,
        typer.Option("--version", callback=_print_version, is_eager=True, help="Show the version."),
    ] = False,
) -> None:
    context.with_resource(_brief_warnings())


@contextmanager
def _brief_warnings() -> Iterator[None]:
    """Warnings of implausible values are lines on the standard error, as refusals are."""
    import warnings

    from pindrive.quantities.table import ImplausibleValueWarning

    def show(message: Warning | str, category: type[Warning], *place: Any, **more: Any) -> None:
        if issubclass(category, ImplausibleValueWarning):
            typer.echo(f"warning: {message}", err=True)
        else:
            usual(message, category, *place, **more)

    with warnings.catch_warnings():
        usual = warnings.showwarning
        warnings.simplefilter("always", ImplausibleValueWarning)
        warnings.showwarning = show
        yield


@app.command(**shown("init"))
def init(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="Where to write it.")],
    force: Annotated[
        bool, typer.Option("--force", help="Replace such a file that is there.")
    ] = False,
    device: Annotated[
        bool, typer.Option("--device", help="With magnet, control block, pin array and hand.")
    ] = False,
    study: Annotated[
        bool, typer.Option("--study", help="A study file: a device, and what to vary of it.")
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
    command = f"sweep {file}" if study else release
    typer.echo(f"Wrote {file}; try: pindrive {command}")


@app.command(**shown("check"))
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


@app.command(**shown("simulate"))
def simulate(
    file: DeviceArgument,
    overrides: OverridesOption = None,
    plot: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Draw it: .png, .svg or .pdf.")
    ] = None,
    csv: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Even samples; events go beside it, to FILE-events.csv."),
    ] = None,
    netcdf: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Samples, events, numbers, with units.")
    ] = None,
    json: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Numbers, events and phases.")
    ] = None,
    samples: Annotated[
        int, count_option("--samples", "Even times in CSV and NetCDF.", least=2)
    ] = 1001,
    rate: Annotated[
        str | None, typer.Option(metavar="FREQUENCY", help='Of the CSV instead, as in "1 kHz".')
    ] = None,
) -> None:
    """Release the pin of a device file and say how it moves."""
    from pindrive.files import export
    from pindrive.files.device import load_device, motion_of
    from pindrive.files.output import (
        EVENTS_CSV,
        MOTION_CSV,
        MOTION_JSON,
        MOTION_NETCDF,
        Output,
        naming,
        writing,
    )
    from pindrive.quantities import budgets

    with refusing():
        device = load_device(file, overrides or ())
        wanted: list[tuple[Output, Callable[[Motion, Path], None]]] = []
        if plot:
            from pindrive.plot.motion import write_figure

            kind = picture_format(plot)
            wanted.append((picture(plot), lambda m, part: write_figure(m, part, kind)))
        if rate is not None and not csv:
            raise ValueError("--rate goes with --csv")
        frequency = None if rate is None else measure(rate, "rate", "1 kHz", "--rate")
        if csv:

            def times(m: Motion) -> NDArray[np.float64]:
                if frequency is None:
                    return m.even_times(samples)
                return export.even_times(0.0, m.duration, frequency)

            events = Output(export.events_path(csv), EVENTS_CSV, "--csv")
            wanted += [
                (
                    Output(csv, MOTION_CSV, "--csv"),
                    lambda m, part: export.write_csv(m, part, times(m)),
                ),
                (events, export.write_events),
            ]
        if netcdf:
            to_netcdf = Output(netcdf, MOTION_NETCDF, "--netcdf")
            wanted.append((to_netcdf, lambda m, part: export.write_netcdf(m, part, samples)))
        if json:
            to_json = Output(json, MOTION_JSON, "--json")
            wanted.append((to_json, lambda m, part: export.write_json(m, device, part)))
        budgets.MOTION_SAMPLES.check(samples, where="--samples")
        with writing([output for output, _ in wanted], device.inputs) as parts:
            motion = motion_of(device)
            for output, write in wanted:
                with naming(output.path):
                    write(motion, parts[output.path])
    from pindrive.cli.tables import motion_report, show

    show(motion_report(motion))
    if device.recording_words:
        typer.echo(device.recording_words)
    for output, _ in wanted:
        typer.echo(f"Wrote {output.path}")


def _register() -> None:
    """The commands that have a file of their own."""
    from pindrive.cli.fit import fit
    from pindrive.cli.paper import paper
    from pindrive.cli.scan import scan
    from pindrive.cli.speed import speed
    from pindrive.cli.study import map_study, robustness, sensitivity, sweep

    for command in (scan, speed, fit, sweep, sensitivity, robustness, paper):
        app.command(**shown(command.__name__))(command)
    app.command(**shown("map"))(map_study)


_register()
