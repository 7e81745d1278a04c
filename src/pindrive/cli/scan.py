"""The command `pindrive scan`: a hand moves the whole device over a page."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from pindrive.cli.errors import refusing
from pindrive.cli.help import FILES, PAGE, command
from pindrive.cli.options import (
    DeviceArgument,
    OverridesOption,
    RateOption,
    file_option,
    option,
)
from pindrive.cli.outputs import (
    ForceOption,
    PlotOption,
    Target,
    Writer,
    by_suffix,
    csv_rate,
    output_option,
    pictures,
    results,
    say_written,
    with_events,
)
from pindrive.cli.progress import bar

if TYPE_CHECKING:
    from pindrive.device.hand import HandPath
    from pindrive.evaluation.perception import Evaluation

STROKES = "strokes"


@command("The whole device", 'pindrive scan device.toml --text "a" --plot scan.png')
def scan(
    file: DeviceArgument,
    text: Annotated[
        str | None, option(PAGE, r"Text of the page; \n begins a line.", metavar="TEXT")
    ] = None,
    image: Annotated[Path | None, option(PAGE, "Picture of the page.", metavar="FILE")] = None,
    grating: Annotated[
        str | None,
        option(
            PAGE,
            'Pitches of groups of four lines, "4 mm, 2 mm"; of twelve, "12 x 4 mm"; or of as many '
            'as a length holds, "4 mm over 60 mm".',
            metavar="PITCHES",
        ),
    ] = None,
    font: Annotated[
        Path | None, option(PAGE, "Font of the text; default DejaVu Sans.", metavar="FILE")
    ] = None,
    path: Annotated[
        str,
        option(PAGE, "Path of the hand: strokes, or a CSV of time, x, y.", metavar="strokes|FILE"),
    ] = STROKES,
    smooth: Annotated[
        bool | None,
        option(
            PAGE,
            "Smooth the recorded path or not; default as its data require.",
            "--smooth/--no-smooth",
        ),
    ] = None,
    overrides: OverridesOption = None,
    output: Annotated[
        list[Path] | None,
        output_option(
            "Scan: .csv at even times, with its events in FILE-events.csv; .nc with units; "
            ".json of the lines, without samples."
        ),
    ] = None,
    plot: PlotOption = None,
    force: ForceOption = False,
    rate: RateOption = None,
    lines: Annotated[Path | None, file_option("Lines under the pins: .csv.")] = None,
    pin: Annotated[
        int | None, file_option("Pin drawn in detail, from 0.", metavar="NUMBER")
    ] = None,
    film: Annotated[Path | None, file_option("Animation: .gif or .mp4.", "--animate")] = None,
    slow: Annotated[float, option(FILES, "Slow-motion factor of the animation.")] = 4.0,
) -> None:
    """Simulate the device moving over a page, and evaluate the lines."""
    from pindrive.files.device import load_device

    with refusing():
        saved = None
        if file.suffix.lower() == ".json":
            from pindrive.files.reading import load_reading

            saved = load_reading(file)
            _check_alone(overrides, text, image, grating, font, path, smooth)
        device_file = saved.device if saved else load_device(file, overrides or (), whole=True)
        device, reading = device_file.device, device_file.reading
        wanted = output or []
        frequency = csv_rate(rate, wanted) or 1000.0
        if pin is not None and not (plot and 0 <= pin < len(device.array)):
            required = f"from 0 to {len(device.array) - 1}, beside --plot"
            raise ValueError(f"--pin must be {required}, got {pin}")

        from pindrive.device.gratings import line_group
        from pindrive.device.page_description import Page
        from pindrive.device.scanning import scan as follow
        from pindrive.evaluation.perception import Evaluation, evaluate
        from pindrive.files.output import LINES_CSV, SCAN_EVENTS_CSV

        page = None
        if saved is None:
            page = Page(
                text=None if text is None else text.replace("\\n", "\n"),
                image=image,
                grating=None
                if grating is None
                else [
                    line_group(part.strip(), "pitch", "--grating") for part in grating.split(",")
                ],
                font=font,
                path=None if path == STROKES else Path(path),
                smooth=smooth,
            )
            page.check("--{}")
        targets = pictures(plot, partial(Evaluation.plot, pin=pin))
        targets += _films(film, slow) + by_suffix(wanted, _writers(frequency))
        targets = with_events(targets, SCAN_EVENTS_CSV, _write_events)
        line_writers = {".csv": (LINES_CSV, _write_lines)}
        targets += by_suffix([lines] if lines else [], line_writers, "--lines")
        sources = [] if page is None else page.files.values()
        with results(targets, [file, *sources], force=force) as write:
            if saved:
                scene, hand = saved.page, saved.hand
            else:
                assert page
                scene = page.scene(reading, device.array)
                hand = page.hand(reading, scene, device.array)
            suffixes = {path.suffix.lower() for path in wanted}
            _check_sizes(hand, len(device.array), suffixes, frequency)
            if film:
                from pindrive.plot.animation import frame_times

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
            evaluation = evaluate(done, device_file.criteria)
            write(evaluation)
    from pindrive.cli.scan_tables import evaluation_report, scan_report
    from pindrive.cli.tables import show

    for warning in done.warnings:
        typer.echo(f"warning: {warning}", err=True)
    show(scan_report(done))
    show(evaluation_report(evaluation))
    say_written(targets)


def _check_alone(overrides: list[str] | None, *page: object) -> None:
    """Reject a page, a hand or values beside a saved reading, which has them."""
    if overrides or any(part not in (None, STROKES) for part in page):
        raise ValueError(
            "a saved reading has its device, page and hand; leave out --set, --text, --image, "
            "--grating, --font, --path and --smooth"
        )


def _writers(frequency: float) -> dict[str, Writer[Evaluation]]:
    """Return the writers of a scan by the suffix of a file, with the sampling rate of a CSV."""
    from pindrive.device.dataset import write_netcdf
    from pindrive.files import dataset, export
    from pindrive.files.output import SCAN_CSV, SCAN_NETCDF

    def write_csv(evaluation: Evaluation, part: Path) -> None:
        scan = evaluation.scan
        times = export.even_times(scan.path.begin, scan.path.end, frequency, len(scan.pins))
        export.write_scan_csv(scan, part, times)

    def write_json(evaluation: Evaluation, part: Path) -> None:
        dataset.write_json(evaluation.to_dataset(), part, f"Scan of {evaluation.scan.scene.title}")

    return {
        ".csv": (SCAN_CSV, write_csv),
        ".nc": (SCAN_NETCDF, lambda evaluation, part: write_netcdf(evaluation.scan, part)),
        ".json": (dataset.DATASET_JSON, write_json),
    }


def _write_events(evaluation: Evaluation, part: Path) -> None:
    from pindrive.files.export import write_scan_events

    write_scan_events(evaluation.scan, part)


def _write_lines(evaluation: Evaluation, part: Path) -> None:
    from pindrive.files.export import write_lines

    write_lines(evaluation.columns(), part)


def _films(film: Path | None, slow: float) -> list[Target[Evaluation]]:
    """The film, if one is wanted and can be made here."""
    if not film:
        return []
    from pindrive.files.output import FILMS
    from pindrive.plot.animation import animate, animation_format

    suffix = animation_format(film)

    def write(evaluation: Evaluation, part: Path) -> None:
        with bar("Frames") as progress:
            animate(evaluation, part, suffix, slow=slow, progress=progress)

    return by_suffix([film], {s: (kind, write) for s, kind in FILMS.items()}, "--animate")


def _check_sizes(hand: HandPath, pins: int, suffixes: set[str], frequency: float) -> None:
    """Refuse files that would be too large before anything is computed."""
    from pindrive.device.dataset import check_samples, sample_count
    from pindrive.files.export import even_times

    if ".nc" in suffixes:
        check_samples(pins, sample_count(hand))
    if ".csv" in suffixes:
        even_times(hand.begin, hand.end, frequency, pins)
