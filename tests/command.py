"""The command line, called as a user calls it."""

from __future__ import annotations

import signal
from pathlib import Path

from typer.testing import CliRunner, Result

from pindrive.cli.app import app

EXAMPLES = Path(__file__).parents[1] / "examples"
EXAMPLE, SKIN = EXAMPLES / "tactile-mouse.toml", EXAMPLES / "stribeck-skin.toml"
GOOD = Path(__file__).with_name("minimal.toml").read_text(encoding="utf-8")


def run(*arguments: str | Path) -> Result:
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def refused(*arguments: str | Path) -> str:
    """The one line on the standard error of a command that refuses and leaves the folder as is."""
    assert not Path("pyproject.toml").exists(), "in_empty_folder: others write to the checkout"
    before = {path: path.stat().st_mtime_ns for path in Path().rglob("*")}
    result = run(*arguments)
    assert result.exit_code == 2, result.output
    assert result.stdout == ""
    assert isinstance(result.exception, SystemExit), "no traceback"
    assert {path: path.stat().st_mtime_ns for path in Path().rglob("*")} == before
    (line,) = result.stderr.splitlines()
    return line


def taking_ctrl_c() -> None:
    """In a process that begins: Ctrl-C is not ignored, whatever this one was told by its shell."""
    signal.signal(signal.SIGINT, signal.default_int_handler)
