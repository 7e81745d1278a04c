"""The site: what its pages run prints what they say, and what it is made of is there."""

from __future__ import annotations

import contextlib
import io
import re
import shlex
from pathlib import Path

import pytest

from command import run

DOCS = Path(__file__).resolve().parents[1] / "docs"


def blocks(page: str) -> list[tuple[str, str]]:
    """The fenced blocks of a page as (language, content)."""
    text = (DOCS / page).read_text("utf-8")
    return re.findall(r"^```(\w*)\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


def agrees(printed: str, shown: str) -> bool:
    """Whether it was printed, spaces at line ends apart; `...` stands for what is left out."""

    def lines(text: str) -> str:
        return "\n".join(line.rstrip() for line in text.strip().splitlines())

    parts = [re.escape(part) for part in re.split(r"^\.\.\.$", lines(shown), flags=re.MULTILINE)]
    return re.fullmatch(".*".join(parts), lines(printed), re.DOTALL) is not None


def test_what_is_left_out_is_no_more_than_that() -> None:
    assert agrees("a  \nb\nc\n", "a\nb\nc\n")
    assert agrees("a\nb\nc\n", "a\n...\n")
    assert not agrees("a\nb\nc\n", "a\nc\n")
    assert not agrees("a\nb\nc\n", "b\n...\n")


@pytest.mark.usefixtures("in_empty_folder")
@pytest.mark.parametrize("page", ["tutorial.md", "simulink.md"])
def test_a_page_prints_what_it_says(page: str) -> None:
    """Its commands and programs, one after the other, each with the block of text after it."""
    found = blocks(page)
    names = {"__name__": "__main__"}
    for i, (language, block) in enumerate(found):
        if language == "python":
            output = io.StringIO()
            with contextlib.redirect_stdout(output):
                exec(compile(block, page, "exec"), names)
            printed = output.getvalue()
        elif language == "sh":
            result = run(*shlex.split(block.removeprefix(".venv/bin/pindrive ")))
            assert (result.exit_code, result.stderr) == (0, ""), block
            printed = result.stdout
        else:
            assert language == "text" and found[i - 1][0] in ("python", "sh")
            continue
        follows, shown = found[i + 1] if i + 1 < len(found) else ("", "")
        assert agrees(printed, shown if follows == "text" else ""), (block, printed)


def test_every_page_is_on_the_site() -> None:
    """Those that the first page names are there; it takes all others of its folder by itself."""
    index = (DOCS / "index.md").read_text("utf-8")
    trees = re.findall(r"^```\{toctree\}\n(?::[^\n]*\n)+\n(.*?)^```$", index, re.M | re.S)
    named = [line for tree in trees for line in tree.split("\n") if line and line[0] != "%"]
    assert [name for name in named if not (DOCS / f"{name}.md").exists()] == []
    assert len(named) == len({*named})
    assert {f"reference/{path.stem}" for path in DOCS.glob("reference/*.md")} <= {*named}
    assert "% other pages" in index


def test_the_public_names_are_in_the_reference() -> None:
    import pindrive

    page = (DOCS / "reference" / "python.md").read_text("utf-8")
    documented = re.findall(r"^\.\. auto\w+:: (\w+)$", page, re.MULTILINE)
    assert sorted(documented) == sorted(n for n in pindrive.__all__ if not n.startswith("__"))
