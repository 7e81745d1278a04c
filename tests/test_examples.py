"""The examples of docs/devices.md: each runs by its command, its picture is there."""

from __future__ import annotations

import re
import runpy
import shlex
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from pindrive.cli.app import app

ROOT = Path(__file__).resolve().parent.parent
COMMANDS = re.findall(
    r"^\.venv/bin/(.*examples/(?:letter_a|tactile-reader\.toml).*)$",
    (ROOT / "docs" / "devices.md").read_text("utf-8"),
    re.M,
)
SHORTER = {
    "--text": ["--set", "array.columns=2", "--set", "array.rows=2"],
    "speed": ["--pitch", "4 mm", "--slowest", "0.05 m/s", "--fastest", "0.2 m/s"],
}
"""What a command with this word adds here, to be quick; it takes what it took before."""


def test_there_are_four() -> None:
    kinds = [shlex.split(command)[:2] for command in COMMANDS]
    assert [words[1] for words in kinds] == ["examples/letter_a.py", "scan", "scan", "speed"]


@pytest.mark.parametrize("command", COMMANDS, ids=lambda command: " ".join(command.split()[:4]))
def test_an_example_draws_its_picture(
    command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    program, *words = shlex.split(command)
    picture = words[words.index("--plot") + 1] if "--plot" in words else "letter-a.png"
    assert (ROOT / "docs" / "images" / picture).stat().st_size < 300_000
    monkeypatch.chdir(tmp_path)
    words = [str(ROOT / word) if word.startswith("examples/") else word for word in words]
    if program == "python":
        monkeypatch.setattr(sys, "argv", words)
        runpy.run_path(words[0], run_name="__main__")
    else:
        more = [part for word, parts in SHORTER.items() if word in words for part in parts]
        done = CliRunner().invoke(app, [*words, *more])
        assert done.exit_code == 0, done.output
        assert "warning" not in done.output
    assert [path.name for path in tmp_path.iterdir()] == [picture]
    assert (tmp_path / picture).read_bytes()[:4] == b"\x89PNG"
