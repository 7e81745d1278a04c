"""The command `pindrive map`: a study that was computed, drawn."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from pindrive.cli.errors import refusing
from pindrive.cli.help import ASKED, command
from pindrive.cli.options import file_option, option, picture, save_picture


@command("Studies", "pindrive map study.nc --number settling_time -o map.png")
def map_study(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="What a sweep wrote (NetCDF).")],
    output: Annotated[Path, file_option(".png, .svg or .pdf.", "--output", "-o", metavar="FIGURE")],
    x: Annotated[str | None, option(ASKED, "Along the abscissa.", "--x", metavar="KEY")] = None,
    y: Annotated[
        str | None, option(ASKED, "Along the ordinate; curves if none.", "--y", metavar="KEY")
    ] = None,
    number: Annotated[
        list[str] | None,
        option(ASKED, "What to draw; settling_time or shown_part if none.", metavar="NAME"),
    ] = None,
    at: Annotated[
        list[str] | None,
        option(ASKED, "A slice at the nearest value.", "--at", metavar="KEY=VALUE"),
    ] = None,
) -> None:
    """Draw a study: maps over two keys, curves over one, slices side by side."""
    from pindrive.files.output import check_outputs, naming, writing

    with refusing():
        target = picture(output, "--output")
        check_outputs([target], [file])

        from pindrive.study.slices import View

        with View(file) as view:
            over = [given and view.key(given, option) for given, option in ((x, "--x"), (y, "--y"))]
            held = view.held(at or ())
            names = [view.number(name) for name in number or view.usual_numbers()]
            chosen = view.axes(over[0], over[1], held)

            from pindrive.plot.slices import plot_study

            with writing([target], [file]) as parts, naming(output):
                figure = plot_study(view, names, *chosen, held)
                save_picture(figure, output, parts[output])
    from pindrive.cli.study_tables import compliance_words

    for line in compliance_words(file):
        typer.echo(line)
    typer.echo(f"Wrote {output}")
