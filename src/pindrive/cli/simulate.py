"""The command `pindrive simulate`: one release of a device's pin."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from pindrive.cli.errors import refusing
from pindrive.cli.help import FILES, command
from pindrive.cli.options import (
    CsvOption,
    DeviceArgument,
    OverridesOption,
    PlotOption,
    count_option,
    csv_rate,
    file_option,
    picture,
    save_picture,
)

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from pindrive.motion.motion import Motion


@command("One release", 'pindrive simulate device.toml --set mass="1.2 g" --plot pin.png')
def simulate(
    file: DeviceArgument,
    overrides: OverridesOption = None,
    plot: PlotOption = None,
    csv: CsvOption = None,
    netcdf: Annotated[Path | None, file_option("Samples, events, numbers, with units.")] = None,
    json: Annotated[Path | None, file_option("Numbers, events and phases.")] = None,
    samples: Annotated[
        int, count_option("--samples", "Even times in CSV and NetCDF.", least=2, panel=FILES)
    ] = 1001,
    rate: Annotated[
        str | None, file_option('Of the CSV instead, as in "1 kHz".', metavar="FREQUENCY")
    ] = None,
) -> None:
    """Release the pin of a device file and say how it moves."""
    from pindrive.files import export
    from pindrive.files.device import load_device
    from pindrive.files.output import (
        EVENTS_CSV,
        MOTION_CSV,
        MOTION_JSON,
        MOTION_NETCDF,
        Output,
        naming,
        writing,
    )
    from pindrive.motion.simulate import motion_of
    from pindrive.quantities import budgets

    with refusing():
        device = load_device(file, overrides or ())
        wanted: list[tuple[Output, Callable[[Motion, Path], None]]] = []
        if plot:
            wanted.append((picture(plot), lambda m, part: save_picture(m.plot(), plot, part)))
        frequency = csv_rate(rate, csv)
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
