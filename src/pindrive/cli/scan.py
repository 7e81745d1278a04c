"""The command `pindrive scan`: a hand moves the whole device over a page."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
from typing import Annotated

import typer

from pindrive.cli.errors import refusing
from pindrive.cli.help import FILES, PAGE, command
from pindrive.cli.options import (
    CsvOption,
    DeviceArgument,
    OverridesOption,
    PlotOption,
    RateOption,
    csv_rate,
    file_option,
    measures,
    option,
    picture,
    save_picture,
)
from pindrive.cli.progress import bar

STROKES = "strokes"


@command("The whole device", 'pindrive scan device.toml --text "a" --plot scan.png')
def scan(
    file: DeviceArgument,
    text: Annotated[
        str | None, option(PAGE, r"What is on the page; \n begins a line.", metavar="TEXT")
    ] = None,
    image: Annotated[
        Path | None, option(PAGE, "A picture of the page instead.", metavar="FILE")
    ] = None,
    grating: Annotated[
        str | None, option(PAGE, 'Lines instead, as in "4 mm, 2 mm".', metavar="PITCHES")
    ] = None,
    font: Annotated[
        Path | None, option(PAGE, "Font of the text; DejaVu Sans if none.", metavar="FILE")
    ] = None,
    path: Annotated[
        str, option(PAGE, "How the hand moves: a CSV of time, x, y.", metavar="strokes|FILE")
    ] = STROKES,
    plot: PlotOption = None,
    pin: Annotated[
        int | None, file_option("The pin drawn in detail, from 0.", metavar="NUMBER")
    ] = None,
    film: Annotated[Path | None, file_option("Film it: .gif or .mp4.", "--animate")] = None,
    slow: Annotated[float, option(FILES, "How many times slower the film is.")] = 4.0,
    lines: Annotated[Path | None, file_option("Each line under each pin, as CSV.")] = None,
    csv: CsvOption = None,
    rate: RateOption = None,
    output: Annotated[Path | None, file_option("All of it, as NetCDF.", "--output", "-o")] = None,
    overrides: OverridesOption = None,
) -> None:
    """Move the device over a page and say what its pins do."""
    from pindrive.files.device import load_device

    with refusing(), ExitStack() as stack:
        device_file = load_device(file, overrides or (), whole=True)
        device, reading = device_file.device, device_file.reading
        from pindrive.files.output import FILMS, LINES_CSV, SCAN_NETCDF, Output, naming, writing

        outputs = [picture(plot)] if plot else []
        if film:
            from pindrive.plot.animation import animate, animation_format, frame_times

            film_kind = animation_format(film)
            outputs.append(Output(film, FILMS[film.suffix.lower()], "--animate"))
        if lines:
            outputs.append(Output(lines, LINES_CSV, "--lines"))
        if output:
            outputs.append(Output(output, SCAN_NETCDF, "--output"))
        frequency = csv_rate(rate, csv) or 1000.0
        if csv:
            from pindrive.files.export import events_path
            from pindrive.files.output import SCAN_CSV, SCAN_EVENTS_CSV

            outputs.append(Output(csv, SCAN_CSV, "--csv"))
            outputs.append(Output(events_path(csv), SCAN_EVENTS_CSV, "--csv"))
        if pin is not None and not (plot and 0 <= pin < len(device.array)):
            required = f"from 0 to {len(device.array) - 1}, beside --plot"
            raise ValueError(f"--pin must be {required}, got {pin}")

        from pindrive.device.page_description import Page
        from pindrive.device.scanning import scan as follow
        from pindrive.evaluation.perception import judge

        page = Page(
            text=None if text is None else text.replace("\\n", "\n"),
            image=image,
            grating=None
            if grating is None
            else tuple(measures(grating, "pitch", "4 mm", "--grating")),
            font=font,
            path=None if path == STROKES else Path(path),
        )
        page.check("--{}")
        parts = stack.enter_context(writing(outputs, [file, *page.files.values()]))
        scene = page.scene(reading, device.array)
        hand = page.hand(reading, scene, device.array)
        if output:
            from pindrive.device.dataset import check_samples, sample_count

            check_samples(len(device.array), sample_count(hand))
        if csv:
            from pindrive.files import export

            times = export.even_times(hand.begin, hand.end, frequency, len(device.array))
        if film:
            frame_times(hand, slow)
        with bar("Pins") as progress:
            done = follow(
                device,
                scene,
                hand,
                touch=device_file.touch,
                max_angle=reading.max_angle,
                progress=progress,
            )
        judgement = judge(done, device_file.criteria)
        if output:
            from pindrive.device.dataset import write_netcdf

            with naming(output):
                write_netcdf(done, parts[output])
        if csv:
            with naming(csv):
                export.write_scan_csv(done, parts[csv], times)
                export.write_scan_events(done, parts[export.events_path(csv)])
        if lines:
            from pindrive.files.export import write_lines

            with naming(lines):
                write_lines(judgement.columns(), parts[lines])
        if plot:
            from pindrive.plot.scan import plot_scan

            with naming(plot):
                save_picture(plot_scan(judgement, pin), plot, parts[plot])
        if film:
            with naming(film), bar("Frames") as progress:
                animate(judgement, parts[film], film_kind, slow=slow, progress=progress)
    from pindrive.cli.scan_tables import judgement_report, scan_report
    from pindrive.cli.tables import show

    for warning in done.warnings:
        typer.echo(f"warning: {warning}", err=True)
    show(scan_report(done))
    show(judgement_report(judgement))
    for target in outputs:
        typer.echo(f"Wrote {target.path}")
