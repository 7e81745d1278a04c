"""The README's example prints what the README says, and its commands exist."""

from __future__ import annotations

import contextlib
import io
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
README = (ROOT / "README.md").read_text("utf-8")


def blocks(text: str) -> list[tuple[str, str]]:
    """The fenced blocks as (language, content)."""
    return re.findall(r"^```(\w*)\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


def test_the_example_prints_what_follows_it() -> None:
    found = blocks(README)
    example = next(i for i, (language, _) in enumerate(found) if language == "python")
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(found[example][1], "README.md", "exec"), {"__name__": "__main__"})
    assert printed.getvalue() == found[example + 1][1]


def test_run_and_test_each_start_with_their_one_command() -> None:
    sections = dict(re.findall(r"^## (\w+)\n+(```.*?^```)", README, re.MULTILINE | re.DOTALL))
    assert blocks(sections["Run"])[0][1] == "python3 run.py\n"
    assert blocks(sections["Test"])[0][1] == "python3 run.py test\n"


def test_what_it_links_to_is_there() -> None:
    links = re.findall(r"\]\(([^)#:]+)\)", README)
    assert links
    assert [link for link in links if not (ROOT / link).exists()] == []
