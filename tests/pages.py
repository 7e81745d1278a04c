"""Pages of the site with their blocks of code, which tests run.

How a page is written for that stands in tests/README.md, "Pages".
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from markdown_it import MarkdownIt

ROOT = Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs"

FILES = ("c", "cmake", "cpp", "csv", "sbatch", "toml")
"""Languages of files: such a block begins with a comment that names the file."""


@dataclass(frozen=True)
class Block:
    """A fenced block of a page."""

    page: str
    line: int
    language: str
    text: str
    reason: str
    """Return the reason for which a block is not run, from a comment before the block; else ""."""

    def __str__(self) -> str:
        return f"{self.page}, line {self.line}:\n{self.text}"


def pages() -> list[Path]:
    """README and every page of the site that a person wrote."""
    return [ROOT / "README.md", *sorted(DOCS.rglob("*.md"))]


def blocks(page: Path) -> list[Block]:
    """The blocks that a person wrote, in their order; directives, such as lists of pages, apart."""
    found = []
    before = ""
    made = r"<!-- made of pindrive: .*?<!-- end -->"
    text = re.sub(made, lambda m: "\n" * m[0].count("\n"), page.read_text("utf-8"), flags=re.DOTALL)
    for token in MarkdownIt("commonmark").parse(text):
        if token.type == "fence" and not token.info.startswith("{"):
            assert token.map
            name = page.relative_to(ROOT).as_posix()
            reason = re.fullmatch(r"<!-- not run: (.*?) -->\s*", before, re.DOTALL)
            found.append(
                Block(
                    name, token.map[0] + 1, token.info, token.content, reason[1] if reason else ""
                )
            )
        if token.type in ("html_block", "fence", "inline"):
            before = token.content if token.type == "html_block" else ""
    return found


def file_of(block: Block) -> str:
    """The text of a file, with its name, which stands in a comment, as the first line."""
    comment = re.match(r"(?://|#|/\*) (\S+?)(?: \*/)?\n", block.text)
    assert comment, f"{block}must begin with a comment that names the file"
    return f"{comment[1]}\n{block.text[comment.end() :]}"
