"""The command `pindrive sensitivity`: which parameter matters."""

from __future__ import annotations

from typing import Annotated

from pindrive.cli.errors import refusing
from pindrive.cli.help import ASKED, command
from pindrive.cli.options import (
    OverridesOption,
    StudyArgument,
    ThreadsOption,
    count_option,
    option,
)
from pindrive.cli.outputs import (
    ForceOption,
    PlotOption,
    ResultOption,
    datasets,
    pictures,
    results,
    say_written,
)
from pindrive.cli.progress import points_bar


@command("Studies", "pindrive sensitivity study.toml --tolerances --plot matters.png")
def sensitivity(
    study: StudyArgument,
    output: ResultOption = None,
    plot: PlotOption = None,
    force: ForceOption = False,
    tolerances: Annotated[
        bool, option(ASKED, "Ranges of [tolerances] instead of [axes].", "--tolerances")
    ] = False,
    number: Annotated[
        list[str] | None,
        option(ASKED, "Number to analyse; default: all.", metavar="NAME"),
    ] = None,
    rows: Annotated[
        int | None,
        count_option(
            "--rows",
            "Rows of the design, a power of 2, >= 128; default 8192, of scans 256.",
            least=128,
            power_of_2=True,
        ),
    ] = None,
    seed: Annotated[
        int, count_option("--seed", "Seed of the design and the bootstrap.", least=0)
    ] = 1,
    threads: ThreadsOption = None,
    overrides: OverridesOption = None,
) -> None:
    """Compute elasticities at the device, and Sobol' indices over the ranges.

    Values with a ratio to a varied value change with it, as for `robustness`.
    """
    from pindrive.study.outputs import known_output
    from pindrive.study.sensitivity import SobolIndices, askable, sobol
    from pindrive.study.spec import load_study

    with refusing():
        loaded = load_study(study, overrides or ())
        targets = pictures(plot, SobolIndices.plot)
        title = "Sobol' indices"
        targets += datasets(output, title, ("number", "key"), SobolIndices.to_dataset)
        with results(targets, loaded.inputs, force=force) as write:
            among = askable(loaded)
            with points_bar() as progress:
                found = sobol(
                    loaded,
                    tolerances=tolerances,
                    numbers=[known_output(name, "--number", among) for name in number or ()],
                    rows=rows,
                    seed=seed,
                    threads=threads,
                    progress=progress,
                    near=True,
                )
            write(found)
    from pindrive.cli.study_tables import say_coefficient, sobol_report
    from pindrive.cli.tables import show

    show(sobol_report(found))
    say_coefficient(loaded, tolerances=tolerances)
    say_written(targets)
