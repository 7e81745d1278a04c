"""The command `pindrive sweep`: all points of a study, in one file."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from pindrive.cli.errors import refusing
from pindrive.cli.help import COMPUTED, command
from pindrive.cli.options import (
    ClusterOption,
    OverridesOption,
    StudyArgument,
    ThreadsOption,
    count_option,
    option,
)
from pindrive.cli.outputs import ForceOption, output_option
from pindrive.cli.progress import points_bar


@command("Studies", "pindrive sweep study.toml -o study.nc")
def sweep(
    study: StudyArgument,
    output: Annotated[
        Path | None, output_option("Points of the study: .nc; default STUDY.nc.")
    ] = None,
    force: ForceOption = False,
    resume: Annotated[bool, option(COMPUTED, "Resume an interrupted run.", "--resume")] = False,
    stop_after: Annotated[
        int | None,
        count_option(
            "--stop-after", "Points after which the run stops; --resume continues.", "POINTS"
        ),
    ] = None,
    threads: ThreadsOption = None,
    cluster: ClusterOption = None,
    overrides: OverridesOption = None,
) -> None:
    """Compute all points of a study and write them into one NetCDF file.

    Values with a ratio to a varied value change with it, as for `robustness`.
    """
    from pindrive.study.runner import on_cluster, on_threads
    from pindrive.study.runner import sweep as compute
    from pindrive.study.spec import load_study

    target = output or study.with_suffix(".nc")

    def stopped() -> str:
        kept = target.with_name(f"{target.name}.journal").exists()
        words = "finished chunks are kept, --resume continues with them"
        return f"stopped; {words if kept else 'no chunk was finished yet'}"

    with refusing(stopped):
        if resume and force:
            raise ValueError("give --resume or --force, not both")
        if threads and cluster:
            raise ValueError("give --threads or --cluster, not both: workers have their own")
        loaded = load_study(study, overrides or ())
        if not loaded.dimensions:
            raise ValueError(f"{study}: has no axes; write what to vary in [axes]")
        with points_bar() as progress:
            done = compute(
                loaded,
                target,
                resume=resume,
                force=force,
                stop_after=stop_after,
                work=on_cluster(cluster) if cluster else on_threads(threads),
                progress=progress,
            )
    from pindrive.cli.study_tables import say_coefficient, sweep_report

    for line in sweep_report(loaded, done):
        typer.echo(line)
    say_coefficient(loaded)
