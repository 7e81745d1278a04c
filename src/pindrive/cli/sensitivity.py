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
    from pindrive.study.sensitivity import SobolIndices, askable, sobol
    from pindrive.study.spec import load_study

    with refusing():
        loaded = load_study(study, overrides or ())
        targets = pictures(plot, SobolIndices.plot)
        title = "Sobol' indices"
        targets += datasets(output, title, ("number", "key"), SobolIndices.to_dataset)
        with results(targets, loaded.inputs, force=force) as write:
            among = askable(loaded)
            with points_bar() as tell:
                found = sobol(
                    loaded,
                    tolerances=tolerances,
                    numbers=[known_output(name, "--number", among) for name in number or ()],
                    rows=rows,
                    seed=seed,
                    threads=threads,
                    progress=tell,
                    near=True,
                )
            write(found)
    from pindrive.cli.study_tables import say_coefficient, sobol_report
    from pindrive.cli.tables import show

    show(sobol_report(found))
    say_coefficient(loaded, tolerances=tolerances)
    say_written(targets)
