"""The command `pindrive fmu`: a drive as a block of other simulators."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from pindrive.cli.errors import refusing
from pindrive.cli.help import WRITTEN, command
from pindrive.cli.options import DeviceArgument, OverridesOption, count_option, option
from pindrive.cli.outputs import ForceOption, output_option


@command("Other simulators", "pindrive fmu device.toml -o drive.fmu")
def fmu(
    file: DeviceArgument,
    output: Annotated[Path | None, output_option("Unit: .fmu; default FILE.fmu.")] = None,
    force: ForceOption = False,
    fmi: Annotated[
        int,
        count_option("--fmi", "Version of FMI: 2 or 3.", "2|3", least=2, most=3, panel=WRITTEN),
    ] = 3,
    control: Annotated[
        bool,
        option(
            WRITTEN,
            "With the control block, whose input luminance replaces magnet_on.",
            "--control",
        ),
    ] = False,
    overrides: OverridesOption = None,
) -> None:
    """Write the drive of a device file as a functional mock-up unit (FMU) for co-simulation.

    Inputs, each with its rate, are mouse velocity, plate load, force, transverse velocity and
    finger load. For a file of a whole device, the unit is one pin with its magnet: the input
    magnet_on, a command of the control block, replaces the plate load. With --control the unit has
    the control block, too, whose input is the luminance under the pin. All further values on which
    the motion depends are parameters. The simulation is exact for all step sizes of the importer.

    Input tables of the file are not part of the unit: the importer sets the inputs.
    """
    from pindrive.files.device import load_device
    from pindrive.files.fmu import COMMAND, LUMINANCE, inputs_of, variables_of, write_fmu
    from pindrive.files.output import FMU, Output, naming, writing

    with refusing():
        device = load_device(file, overrides or ())
        target = output or file.with_suffix(".fmu")
        outputs = [Output(target, FMU, "-o")]
        with writing(outputs, device.inputs, force=force) as parts, naming(target):
            write_fmu(device, parts[target], fmi, control=control)
    for name in inputs_of(device):
        given = getattr(device.release, name)
        if not isinstance(given, float) and given.changes:
            typer.echo(
                f"warning: {name} is an input and starts at {given(0.0):g}; its rows are left out",
                err=True,
            )
    if device.whole and device.release.plate_load != 1.0:
        place = LUMINANCE if control else COMMAND
        typer.echo(f"warning: plate_load is left out; the input {place} takes its place", err=True)
    kinds = [variable.causality for variable in variables_of(device, control)]
    counts = (f"{kinds.count(kind)} {kind}s" for kind in ("parameter", "input", "output"))
    typer.echo(f"Wrote {target}, FMI {fmi}.0 for co-simulation: {', '.join(counts)}")
