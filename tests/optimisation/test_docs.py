"""docs/design.md: what its command and its program print is what it says."""

from __future__ import annotations

import contextlib
import io
import re
import shlex
from pathlib import Path

import pytest

from command import run

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "design.md").read_text("utf-8")
BLOCKS = re.findall(r"^```(\w*)\n(.*?)^```$", PAGE, re.M | re.S)


def after(language: str) -> tuple[str, str]:
    """The first block of a language, and the one that follows it."""
    i = next(i for i, (name, _) in enumerate(BLOCKS) if name == language)
    return BLOCKS[i][1], BLOCKS[i + 1][1]


def stripped(text: str) -> list[str]:
    return [line.rstrip() for line in text.strip().splitlines()]


def test_the_command_prints_what_follows_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    command, printed = after("sh")
    monkeypatch.chdir(tmp_path)
    words = [
        str(ROOT / word) if word.startswith("examples/") else word
        for word in shlex.split(command)[1:]
    ]
    done = run(*words)
    assert done.exit_code == 0, done.output
    assert stripped(done.stdout) == stripped(printed)
    assert (ROOT / "docs" / "images" / "design.png").stat().st_size < 300_000


def test_the_program_prints_what_follows_it(monkeypatch: pytest.MonkeyPatch) -> None:
    program, printed = after("python")
    monkeypatch.chdir(ROOT)
    output = io.StringIO()
    with contextlib.redirect_stdout(output):
        exec(compile(program, "design.md", "exec"), {"__name__": "__main__"})
    assert output.getvalue() == printed


def test_the_wish_that_is_shown_is_the_example() -> None:
    """Its lines are lines of the file, in their order."""
    shown = [line for line in after("toml")[0].splitlines() if line]
    file = iter((ROOT / "examples" / "catalogue-wish.toml").read_text("utf-8").splitlines())
    assert all(line in file for line in shown)
