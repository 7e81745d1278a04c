"""The site: what its pages run prints what they say, and what it is made of is there."""

from __future__ import annotations

import re
import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import pytest

from page_run import NOT_RUN, Run, agrees, is_excerpt
from pages import DOCS, FILES, ROOT, blocks, file_of, pages

BLOCKS = {page.relative_to(ROOT).as_posix(): blocks(page) for page in pages()}
EXCEPTIONS = {
    ("docs/cluster.md", "sbatch"),
    ("docs/julia.md", "julia"),
    ("docs/matlab.md", "matlab"),
}
"""Pages with blocks that cannot be run here, and their language; the page says why."""
LONGER = {
    ".venv/bin/pindrive speed examples/tactile-reader.toml --plot speed.png": (
        '--pitch "4 mm" --slowest "0.05 m/s" --fastest "0.2 m/s"'
    )
}
"""What a command that takes long gets here, to be quick; it changes nothing in what it takes."""
WARNED = {
    "docs/studies.md": "the plate's friction coefficient",
    "docs/scanning.md": "the spot of pin 0 is beyond the page",
}
"""Pages whose commands warn, and of what."""
LIBRARY = [block.text.splitlines() for block in BLOCKS["docs/c.md"]][0]
"""The commands that install the C interface, which a fixture runs."""


def test_what_is_left_out_is_no_more_than_that() -> None:
    assert agrees("a  \nb\nc\n", "a\nb\nc\n")
    assert agrees("a\nb\nc\n", "a\n...\n")
    assert not agrees("a\nb\nc\n", "a\nc\n")
    assert not agrees("a\nb\nc\n", "b\n...\n")
    assert is_excerpt("a\n\nc\n", "a\nb\nc\n")
    assert not is_excerpt("c\na\n", "a\nb\nc\n")


@pytest.mark.parametrize("page", [page for page, found in BLOCKS.items() if found])
def test_a_page_prints_what_it_says(
    page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest
) -> None:
    """Its blocks, one after the other, in one folder, each with the block of text after it."""
    text = "".join(block.text for block in BLOCKS[page])
    if sys.platform == "win32" and re.search(r"^(cmake|cc|dask) ", text, re.M):
        pytest.skip("its commands are those of other systems")
    if "~/.local/lib" in text or LIBRARY[0] in text:
        (tmp_path / ".local").symlink_to(request.getfixturevalue("c_library"))
    (tmp_path / "page").mkdir()
    monkeypatch.chdir(tmp_path / "page")
    done = Run(tmp_path, LONGER, frozenset(LIBRARY))
    done.page(BLOCKS[page])
    expected = f"warning: {WARNED[page]}" if page in WARNED else None
    assert [line for line in done.warnings if not expected or not line.startswith(expected)] == []
    assert bool(done.warnings) == bool(expected)


def test_every_block_is_of_a_language_that_is_run_or_says_why_not() -> None:
    found = [block for page in BLOCKS.values() for block in page]
    assert {block.language for block in found if not block.reason} <= {
        *FILES,
        "python",
        "sh",
        "text",
    }
    excused = [block for block in found if block.reason]
    assert {(block.page, block.language) for block in excused} == EXCEPTIONS
    assert all(len(block.reason.split()) > 4 for block in excused)


def test_every_text_was_printed_by_the_block_before_it() -> None:
    for page in BLOCKS.values():
        for before, block in pairwise([None, *page]):
            if block and block.language == "text":
                assert before and before.language in ("python", "sh") and not before.reason, block


def test_every_file_that_a_page_writes_is_used_on_it() -> None:
    for page in BLOCKS.values():
        for i, block in enumerate(page):
            if block.language in FILES and not block.reason:
                name = Path(file_of(block).partition("\n")[0])
                places = {str(name), name.name, name.parts[0]}
                others = "".join(other.text for other in [*page[:i], *page[i + 1 :]])
                assert any(place in others for place in places), block


def test_commands_that_no_page_runs_are_there() -> None:
    """Those of run.py are listed by its help."""
    said = subprocess.run(
        [sys.executable, ROOT / "run.py", "--help"], capture_output=True, text=True, check=True
    ).stdout
    listed = {*re.findall(r"^    python3 run\.py *(\S*)", said, re.M)}
    for page in BLOCKS.values():
        for block in page:
            for line in block.text.splitlines() if block.language == "sh" else ():
                if match := re.match(r"python3 run\.py ?(\S*)", line):
                    assert match[1] in listed or (not match[1] and "simulate" in listed), line
    assert all(len(reason.split()) > 3 for reason in NOT_RUN.values())


def test_pictures_are_small() -> None:
    pictures = {
        (page.parent / name).resolve()
        for page in pages()
        for name in re.findall(r"!\[[^]]*\]\(([^)]+\.png)\)", page.read_text("utf-8"))
    }
    assert len(pictures) > 20
    assert [path.name for path in pictures if path.stat().st_size > 600_000] == []


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
