"""The command `pindrive map`: a study that was computed, drawn."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from pindrive.cli.errors import refusing
from pindrive.cli.help import ASKED, command
from pindrive.cli.options import option
from pindrive.cli.outputs import ForceOption, PlotOption, pictures, results, say_written

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@command("Studies", "pindrive map study.nc --number settling_time --plot map.png")
def map_study(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="Results of a sweep (NetCDF).")],
    x: Annotated[str | None, option(ASKED, "Key of the abscissa.", "--x", metavar="KEY")] = None,
    y: Annotated[
        str | None, option(ASKED, "Key of the ordinate; curves if none.", "--y", metavar="KEY")
    ] = None,
    number: Annotated[
        list[str] | None,
        option(ASKED, "Number to draw; default settling_time or shown_part.", metavar="NAME"),
    ] = None,
    at: Annotated[
        list[str] | None,
        option(ASKED, "Slice at the nearest value of a key.", "--at", metavar="KEY=VALUE"),
    ] = None,
    plot: PlotOption = None,
    force: ForceOption = False,
) -> None:
    """Draw a study: maps over two keys, curves over one, slices side by side.

    The smallest and the largest value of each slice are printed.
    """
    from pindrive.study.slices import Slice

    def draw(view: Slice) -> Figure:
        from pindrive.plot.slices import plot_study

        return plot_study(view, names, *chosen, held)

    with refusing():
        targets = pictures(plot, draw)
        with results(targets, [file], force=force) as write, Slice(file) as view:
            over = [given and view.key(given, axis) for given, axis in ((x, "x"), (y, "y"))]
            held = view.held(at or ())
            names = [view.number(name) for name in number or view.usual_numbers()]
            chosen = view.axes(over[0], over[1], held)
            panels = [panel for name in names for panel in view.panels(name, *chosen, held)]
            write(view)
    from pindrive.cli.study_tables import compliance_words, slice_words

    for line in (*map(slice_words, panels), *compliance_words(file)):
        typer.echo(line)
    say_written(targets)
