"""The command `pindrive bifurcation`: which steady motions there are over a parameter."""

from __future__ import annotations

from typing import Annotated

from pindrive.cli.errors import refusing
from pindrive.cli.help import ASKED, command
from pindrive.cli.options import OverridesOption, StudyArgument, option
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


@command("Studies", "pindrive bifurcation study.toml --axis mouse_velocity --plot motions.png")
def bifurcation(
    study: StudyArgument,
    output: ResultOption = None,
    plot: PlotOption = None,
    force: ForceOption = False,
    axis: Annotated[
        str | None,
        option(ASKED, "Axis to follow; default: the only one.", "--axis", metavar="KEY"),
    ] = None,
    overrides: OverridesOption = None,
) -> None:
    """Follow the steady motions over one axis of a study, up and down.

    Each motion begins where the one at the value before has ended, so that the two directions find
    one each where two motions exist.
    """
    from pindrive.study.bifurcation import Bifurcation
    from pindrive.study.bifurcation import bifurcation as followed
    from pindrive.study.spec import load_study

    with refusing():
        loaded = load_study(study, overrides or ())
        targets = pictures(plot, Bifurcation.plot)
        title = "Steady motions"
        targets += datasets(output, title, ("direction",), Bifurcation.to_dataset)
        with results(targets, loaded.inputs, force=force) as write:
            with points_bar() as progress:
                found = followed(loaded, axis, progress=progress)
            write(found)
    from pindrive.cli.study_tables import bifurcation_report
    from pindrive.cli.tables import show

    show(bifurcation_report(found))
    say_written(targets)
