"""The command `pindrive studio`: the page that simulates in a browser, with a device loaded."""

from __future__ import annotations

import json
import tempfile
import webbrowser
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from pindrive.cli.errors import refusing
from pindrive.cli.help import WRITTEN, command

if TYPE_CHECKING:
    from pindrive.files.device import DeviceFile

PAGE = Path(__file__).resolve().parents[1] / "studio.html"
PLACE = '<script type="application/json" id="device"></script>'


@command("One release", "pindrive studio device.toml")
def studio(
    file: Annotated[
        Path | None,
        typer.Argument(metavar="[FILE]", help="Initial device file (TOML)."),
    ] = None,
    no_browser: Annotated[
        bool,
        typer.Option("--no-browser", help="Only say where the page is.", rich_help_panel=WRITTEN),
    ] = False,
) -> None:
    """Open the studio in a browser, offline: read with a device, or follow one release."""
    if not PAGE.is_file():
        typer.echo("the studio is not built; `python3 run.py studio` builds it", err=True)
        raise typer.Exit(2)
    page = PAGE
    if file is not None:
        from pindrive.files.device import load_device

        with refusing():
            page = page_of(load_device(file))
    typer.echo(page)
    if not no_browser and not webbrowser.open(page.as_uri()):
        typer.echo("no browser could be opened; open that file in one", err=True)


def page_of(device: DeviceFile) -> Path:
    """A copy of the page, in a folder for temporary files, that begins with a device."""
    from pindrive.files.recording import files_named

    values = device.values()
    named = files_named(device.tables, device.path.parent)
    given = {
        "file": str(device.path),
        "text": device.path.read_text("utf-8-sig"),
        "rows": {key: values[key] for key in named},
    }
    text = json.dumps(given, ensure_ascii=False).replace("<", "\\u003c")
    page = PAGE.read_text("utf-8").replace(PLACE, f"{PLACE.partition('</')[0]}{text}</script>", 1)
    folder = Path(tempfile.mkdtemp(prefix="pindrive-"))
    made = folder / f"{device.path.stem}.html"
    made.write_text(page, "utf-8")
    return made
