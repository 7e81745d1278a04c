"""The command `pindrive sensitivity`: which parameter matters."""

from __future__ import annotations

from typing import Annotated

import typer

from pindrive.cli.errors import refusing
from pindrive.cli.help import ASKED, command
from pindrive.cli.options import (
    OverridesOption,
    PlotOption,
    StudyArgument,
    ThreadsOption,
    count_option,
    option,
    picturing,
)
from pindrive.cli.progress import points_bar


@command("Studies", "pindrive sensitivity study.toml --tolerances --plot matters.png")
def sensitivity(
    study: StudyArgument,
    plot: PlotOption = None,
    tolerances: Annotated[
        bool, option(ASKED, "Over [tolerances] instead of [axes].", "--tolerances")
    ] = False,
    number: Annotated[
        list[str] | None,
        option(ASKED, "A number to analyse; all unless given.", metavar="NAME"),
    ] = None,
    rows: Annotated[
        int | None,
        count_option(
            "--rows",
            "Rows of the design, a power of 2 from 128 on; 8192 unless given, of scans 256.",
            least=128,
            power_of_2=True,
        ),
    ] = None,
    seed: Annotated[int, count_option("--seed", "Of the design and the bootstrap.", least=0)] = 1,
    threads: ThreadsOption = None,
    overrides: OverridesOption = None,
) -> None:
    """Say which parameter matters: elasticities at the device, Sobol' indices over the ranges.

    What keeps its ratio to a varied value changes with it, as for `robustness`.
    """
    from pindrive.study.outputs import known_output
    from pindrive.study.sensitivity import askable, sobol
    from pindrive.study.study import load_study

    with refusing():
        plan = load_study(study, overrides or ())
        with picturing(plot, plan.inputs) as draw:
            among = askable(plan)
            with points_bar() as tell:
                found = sobol(
                    plan,
                    tolerances=tolerances,
                    numbers=[known_output(name, "--number", among) for name in number or ()],
                    rows=rows,
                    seed=seed,
                    threads=threads,
                    progress=tell,
                    near=True,
                )
            draw(found.plot)
    from pindrive.cli.study_tables import influence_report, say_coefficient
    from pindrive.cli.tables import show

    show(influence_report(found))
    say_coefficient(plan, tolerances=tolerances)
    if plot:
        typer.echo(f"Wrote {plot}")
