"""The command `pindrive design`: the best design for a design problem."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from pindrive.cli.errors import refusing
from pindrive.cli.help import command
from pindrive.cli.options import ClusterOption, OverridesOption, ThreadsOption, count_option
from pindrive.cli.outputs import (
    ForceOption,
    PlotOption,
    by_suffix,
    dataset_writers,
    output_option,
    pictures,
    results,
    say_written,
)
from pindrive.cli.progress import bar

if TYPE_CHECKING:
    from pindrive.cli.outputs import Writer
    from pindrive.optimisation.results import Design

NONE_MEETS = 1
"""Exit status where no design meets the constraints."""


@command("Designs", "pindrive design problem.toml --plot design.png -o design.toml")
def design(
    problem: Annotated[Path, typer.Argument(metavar="PROBLEM", help="Problem file (TOML).")],
    output: Annotated[
        list[Path] | None, output_option("Device file of the design: .toml; numbers: .nc or .json.")
    ] = None,
    plot: PlotOption = None,
    force: ForceOption = False,
    seed: Annotated[int, count_option("--seed", "Seed of the random numbers.", least=0)] = 1,
    threads: ThreadsOption = None,
    cluster: ClusterOption = None,
    overrides: OverridesOption = None,
) -> None:
    """Find the best design for a design problem.

    A design problem names a device, its variables (ranges and catalogues), constraints on numbers,
    operating conditions, tolerances and one to three goals. Exit status 1: no design meets the
    constraints, and the closest design is printed and written.
    """
    from pindrive.optimisation.designing import optimise
    from pindrive.optimisation.problem import read_problem
    from pindrive.optimisation.results import Design

    with refusing():
        if threads and cluster:
            raise ValueError("give --threads or --cluster, not both: workers have their own")
        wanted = read_problem(problem, overrides or ())
        targets = by_suffix(output or [], _writers()) + pictures(plot, Design.plot)
        with results(targets, wanted.inputs, force=force) as write:
            with bar("Designs") as progress:
                tell = progress or (lambda done, total: None)
                found = optimise(
                    None, wanted, seed=seed, threads=threads, cluster=cluster, progress=tell
                )
            write(found)
    from pindrive.cli.design_tables import design_report
    from pindrive.cli.tables import show

    show(design_report(found))
    say_written(targets)
    if not found.feasible:
        raise typer.Exit(NONE_MEETS)


def _writers() -> dict[str, Writer[Design]]:
    """Return the writers of a design by file suffix; a design has no main table for a CSV."""
    from pindrive.files.output import DEVICE_FILE
    from pindrive.optimisation.results import Design, designed_file

    def write_device(found: Design, part: Path) -> None:
        part.write_text(designed_file(found, part), encoding="utf-8")

    numbers = dataset_writers("A design", (), Design.to_dataset)
    del numbers[".csv"]
    return {".toml": (DEVICE_FILE, write_device), **numbers}
