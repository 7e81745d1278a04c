"""The command `pindrive robustness`: how designs within their tolerances meet a specification."""

from __future__ import annotations

from typing import Annotated

from pindrive.cli.errors import refusing
from pindrive.cli.help import command
from pindrive.cli.options import OverridesOption, StudyArgument, ThreadsOption, count_option
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


@command("Studies", "pindrive robustness study.toml --plot yield.png")
def robustness(
    study: StudyArgument,
    output: ResultOption = None,
    plot: PlotOption = None,
    force: ForceOption = False,
    draws: Annotated[
        int | None, count_option("--draws", "Number of draws; default 100 000, of scans 1000.")
    ] = None,
    seed: Annotated[int, count_option("--seed", "Seed of the draws and the search.", least=0)] = 1,
    threads: ThreadsOption = None,
    overrides: OverridesOption = None,
) -> None:
    """Analyse a design within its tolerances: spread, yield, worst case.

    Static friction and friction curves keep their ratio to kinetic friction, and the skin's stretch
    to its largest value, unless they have a tolerance of their own. Contradictory draws are counted
    separately, with the reason.
    """
    from pindrive.study.robustness import Robustness
    from pindrive.study.robustness import robustness as analyse
    from pindrive.study.spec import load_study

    with refusing():
        loaded = load_study(study, overrides or ())
        targets = pictures(plot, Robustness.plot)
        title = "Draws within the tolerances"
        targets += datasets(output, title, ("design",), Robustness.to_dataset)
        with results(targets, loaded.inputs, force=force) as write:
            with points_bar() as progress:
                found = analyse(loaded, count=draws, seed=seed, threads=threads, progress=progress)
            write(found)
    from pindrive.cli.study_tables import robustness_report, say_coefficient
    from pindrive.cli.tables import show

    show(robustness_report(loaded, found))
    say_coefficient(loaded, tolerances=True)
    say_written(targets)
