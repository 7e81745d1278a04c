"""The command `pindrive paper`: the paper reproduced, corrected and answered."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from pindrive.cli.errors import refusing
from pindrive.cli.help import command
from pindrive.cli.options import file_option
from pindrive.cli.outputs import ForceOption
from pindrive.cli.progress import steps


@command("The paper behind the model", "pindrive paper -o report")
def paper(
    output: Annotated[
        Path | None,
        file_option("Folder of the report: page, figures, data.", "--output", "-o", metavar="DIR"),
    ] = None,
    docs: Annotated[
        Path | None, file_option("Folder of the report in Markdown, with pictures.", metavar="DIR")
    ] = None,
    force: ForceOption = False,
) -> None:
    """Recompute the paper, correct its equations, and evaluate its statements."""
    from pindrive.files.output import REPORT, Output, check_folder, check_outputs, write_files
    from pindrive.quantities.quantity import counted

    with refusing():
        for folder in (output, docs):
            if folder is not None:
                check_folder(folder)
        from pindrive.paper import report

        pages = [(output, report.PAGE, "-o"), (docs, report.NAME, "--docs")]
        outputs = [Output(d / name, REPORT, option) for d, name, option in pages if d]
        check_outputs(outputs, force=force)
        written: dict[Path, dict[str, bytes]] = {}
        faces = (output is not None) + (docs is not None)
        with steps(report.STEPS + faces * report.FIGURES) as step:
            made = report.make(step)
            if output is not None:
                written[output / report.PAGE] = made.files(step)
            if docs is not None:
                written[docs / report.NAME] = report.files(made, step)
        for page, files in written.items():
            write_files(page.parent, files, force=force)
    typer.echo(made.summary)
    for page, files in written.items():
        typer.echo(f"Wrote {page} and {counted(len(files) - 1, 'file')} beside it")
