"""docs/fitting.md: what its command and its programs print is what it says."""

from __future__ import annotations

import contextlib
import io
import re
import shlex
from pathlib import Path

import pytest

from command import run

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "fitting.md").read_text("utf-8")
BLOCKS = re.findall(r"^```(\w*)\n(.*?)^```$", PAGE, re.M | re.S)
RUN = [
    (text, BLOCKS[i + 1][1]) for i, (language, text) in enumerate(BLOCKS) if language == "python"
]


def stripped(text: str) -> list[str]:
    return [line.rstrip() for line in text.strip().splitlines()]


def test_the_command_prints_what_follows_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    i = next(i for i, (language, _) in enumerate(BLOCKS) if language == "sh")
    monkeypatch.chdir(tmp_path)
    words = [
        str(ROOT / word) if word.startswith("examples/") else word
        for word in shlex.split(BLOCKS[i][1])[1:]
    ]
    done = run(*words)
    assert done.exit_code == 0, done.output
    assert stripped(done.stdout) == stripped(BLOCKS[i + 1][1])
    assert (ROOT / "docs" / "images" / "fit.png").stat().st_size < 300_000


@pytest.mark.parametrize(("program", "printed"), RUN, ids=["fit", "fit_friction"])
def test_a_program_prints_what_follows_it(
    program: str, printed: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(ROOT)
    output = io.StringIO()
    with contextlib.redirect_stdout(output):
        exec(compile(program, "fitting.md", "exec"), {"__name__": "__main__"})
    assert output.getvalue() == printed
