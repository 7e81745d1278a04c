"""The command `pindrive init`: a device file, study file, or problem file, to start from."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from pindrive.cli.errors import refusing
from pindrive.cli.help import WRITTEN, command
from pindrive.cli.options import option
from pindrive.cli.outputs import ForceOption

if TYPE_CHECKING:
    from collections.abc import Callable


@command("Device and study files", "pindrive init device.toml --device")
def init(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="File to write.")],
    force: ForceOption = False,
    device: Annotated[
        bool,
        option(WRITTEN, "Whole device: magnet, control block, pin array and hand.", "--device"),
    ] = False,
    study: Annotated[
        bool, option(WRITTEN, "Study file: a device with varied keys.", "--study")
    ] = False,
    problem: Annotated[
        bool,
        option(
            WRITTEN, "Problem file: a device with variables, constraints and goals.", "--problem"
        ),
    ] = False,
) -> None:
    """Write a commented device file, study file, or problem file, to start from."""
    from pindrive.files.keys import template
    from pindrive.files.output import DEVICE_FILE, PROBLEM_FILE, STUDY_FILE, Output, naming, writing
    from pindrive.optimisation.template import problem_template
    from pindrive.study.template import study_template

    made: Callable[..., str]
    made, kind, next_ = template, DEVICE_FILE, f"simulate {file}"
    if study:
        made, kind, next_ = study_template, STUDY_FILE, f"sweep {file}"
    elif problem:
        made, kind, next_ = problem_template, PROBLEM_FILE, f"design {file} --plot {file.stem}.png"
    elif device:
        next_ = f"scan {file} --text A"
    with refusing():
        if study and problem:
            raise ValueError("give --study or --problem, not both")
        with writing([Output(file, kind)], force=force) as parts, naming(file):
            parts[file].write_text(made(whole=device), encoding="utf-8")
    typer.echo(f"Wrote {file}; try: pindrive {next_}")
    if device and not (study or problem):
        typer.echo(_page_that_fits(file))


def _page_that_fits(file: Path) -> str:
    """Return the size of the pages on which the spots of a device find room."""
    from pindrive.files.device import load_device

    device = load_device(file, whole=True)
    array = device.device.array
    spots = array.on_page(array.spots)
    across, down = 1e3 * (spots.max(axis=0) - spots.min(axis=0))
    return (
        f"Its {len(array)} pins look at spots {across:.3g} mm across and {down:.3g} mm down: it "
        f"fits pages larger than that; letters are {1e3 * device.reading.text_height:.3g} mm high."
    )
