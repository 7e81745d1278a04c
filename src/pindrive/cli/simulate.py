"""The command `pindrive simulate`: one release of a device's pin."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from pindrive.cli.errors import refusing
from pindrive.cli.help import FILES, command
from pindrive.cli.options import DeviceArgument, OverridesOption, RateOption, count_option
from pindrive.cli.outputs import (
    ForceOption,
    PlotOption,
    Target,
    by_suffix,
    csv_rate,
    output_option,
    pictures,
    results,
    say_written,
    with_events,
)
from pindrive.cli.progress import simulated_time

if TYPE_CHECKING:
    from pindrive.bodies.system_motion import SystemMotion
    from pindrive.motion.motion import Motion


@command("One release", "pindrive simulate device.toml --set damping_ratio=0.3 --plot pin.png")
def simulate(
    file: DeviceArgument,
    overrides: OverridesOption = None,
    output: Annotated[
        list[Path] | None,
        output_option(
            "Motion: .csv at even times, with its events in FILE-events.csv; .nc with units; "
            ".json without samples."
        ),
    ] = None,
    plot: PlotOption = None,
    force: ForceOption = False,
    samples: Annotated[
        int,
        count_option("--samples", "Number of even times in CSV and NetCDF.", least=2, panel=FILES),
    ] = 1001,
    rate: RateOption = None,
) -> None:
    """Simulate the release of the pin of a device file, or the bodies of a system file."""
    from pindrive.files.system import is_system_file

    if is_system_file(file):
        simulate_system(
            file, overrides or (), output or [], plot, force=force, samples=samples, rate=rate
        )
        return
    from pindrive.files import export
    from pindrive.files.device import load_device
    from pindrive.files.output import EVENTS_CSV, JSON, MOTION_CSV, MOTION_NETCDF
    from pindrive.motion.simulate import motion_of
    from pindrive.quantities import budgets

    with refusing():
        device = load_device(file, overrides or ())
        wanted = output or []
        frequency = csv_rate(rate, wanted)
        budgets.MOTION_SAMPLES.check(samples, where="--samples")

        def write_csv(motion: Motion, part: Path) -> None:
            if frequency is None:
                times = motion.even_times(samples)
            else:
                times = export.even_times(0.0, motion.duration, frequency)
            export.write_csv(motion, part, times)

        targets: list[Target[Motion]] = pictures(plot, lambda motion: motion.plot())
        targets += by_suffix(
            wanted,
            {
                ".csv": (MOTION_CSV, write_csv),
                ".nc": (MOTION_NETCDF, lambda m, part: export.write_netcdf(m, part, samples)),
                ".json": (JSON, lambda m, part: export.write_json(m, device, part)),
            },
        )
        targets = with_events(targets, EVENTS_CSV, export.write_events)
        with results(targets, device.inputs, force=force) as write:
            with simulated_time(device.duration) as progress:
                motion = motion_of(device, progress)
            write(motion)
    from pindrive.cli.tables import motion_report, release_words, show, warn_of

    warn_of(device)
    show(motion_report(motion, release_words(device)))
    say_written(targets)


def simulate_system(
    file: Path,
    overrides: Sequence[str],
    wanted: list[Path],
    plot: Path | None,
    *,
    force: bool,
    samples: int,
    rate: str | None,
) -> None:
    """Simulate the bodies of a system file; arguments as for `simulate`."""
    import numpy as np

    from pindrive.files import system_export as export
    from pindrive.files.export import even_times
    from pindrive.files.output import JSON
    from pindrive.files.system import load_system
    from pindrive.quantities import budgets

    with refusing():
        given = load_system(file, overrides)
        frequency = csv_rate(rate, wanted)
        budgets.MOTION_SAMPLES.check(samples, where="--samples")

        def write_csv(motion: SystemMotion, part: Path) -> None:
            end = motion.core.end
            times = np.linspace(0.0, end, samples)
            if frequency is not None:
                times = even_times(0.0, end, frequency, len(motion.system.bodies))
            export.write_csv(motion, part, times)

        targets: list[Target[SystemMotion]] = pictures(plot, lambda motion: motion.plot())
        targets += by_suffix(
            wanted,
            {
                ".csv": (export.SYSTEM_CSV, write_csv),
                ".nc": (
                    export.SYSTEM_NETCDF,
                    lambda m, part: export.write_netcdf(m, part, samples),
                ),
                ".json": (JSON, lambda m, part: export.write_json(m, file, part)),
            },
        )
        targets = with_events(targets, export.SYSTEM_EVENTS_CSV, export.write_events)
        with results(targets, given.inputs, force=force) as write:
            motion = given.system.simulate(given.duration)
            write(motion)
    from pindrive.cli.system_tables import system_report
    from pindrive.cli.tables import show

    show(system_report(motion, given.name))
    say_written(targets)
