"""Rules of the project's prose: words to avoid, and summaries that stand alone."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
FILES = (
    *(ROOT / name for name in ("README.md", "CONTRIBUTING.md")),
    *sorted((ROOT / "docs").rglob("*.md")),
    *sorted((ROOT / "src").rglob("*.py")),
)
WORDS = {
    r"mend(s|ed|ing)?": "correct",
    r"work(s|ed|ing)? off": "run in chunks",
    r"work(s|ed|ing)? out": "compute",
    r"fares?": "perform; tolerance analysis",
    r"look(s|ed|ing)? on(?! (the|a)\b)": "say who sees it, or when",
    r"look(s|ed|ing)? after": "simulate",
    r"as good as": "say what it is",
    r"let(s|ting)? go": "release; break away",
    r"last digit": "to rounding",
    r"whoever|somebody": "say who",
    r"for ever|for good": "forever, permanently",
    r"came? to (?=\W)|(came|comes) to[.,:]": "result",
    r"but for (?!a second)": "except for",
    r"goes on|went on": "continue",
    r"asked for": "requested",
    r"as a person reads": "for display",
    r"in mind": "state",
    r"at a glance": "quickly",
}
"""What may not come back, and what is said instead."""


def found(text: str, pattern: str) -> list[str]:
    """The lines of a text in which a pattern occurs, even across their ends."""
    spread = pattern.replace(" ", r"[\s#]+")
    return [
        f"line {text.count(chr(10), 0, match.start()) + 1}: {match[0]!r}"
        for match in re.finditer(rf"\b(?:{spread})(?![\w-])", text, re.IGNORECASE)
    ]


@pytest.mark.parametrize("pattern", WORDS)
def test_prose_is_literal(pattern: str) -> None:
    places = [
        f"{path.relative_to(ROOT)}, {place}"
        for path in FILES
        for place in found(path.read_text(encoding="utf-8"), pattern)
    ]
    assert not places, f"say instead: {WORDS[pattern]}"


@pytest.mark.parametrize(
    ("text", "pattern"),
    [("is mended.", "mend(s|ed|ing)?"), ("it lets\n# go of", "let(s|ting)? go")],
)
def test_a_word_is_found(text: str, pattern: str) -> None:
    assert found(text, pattern)


# ---- summaries of the C++ core -------------------------------------------------------------------


HEADERS = sorted((ROOT / "include").rglob("*.hpp"))
QUESTION = re.compile(
    r"(what|how|whether|where|which|when|who|whose|why|of|by how|for how)\b", re.IGNORECASE
)
PRONOUN = re.compile(
    r"\b(the same|of it|of them|of these|of those|the others?|those|each of|as it is|as it has"
    r"|as many|so many|one of)\b",
    re.IGNORECASE,
)


def summaries(text: str) -> Iterator[str]:
    """Documentation comments of a C++ text."""
    block: list[str] = []
    for line in [*text.splitlines(), ""]:
        if match := re.match(r"\s*///\s?(?!<)(.*)", line):
            block.append(match[1])
            continue
        if block:
            yield " ".join(block)
        block = []
        if match := re.search(r"///<\s*(.*)", line):
            yield match[1]


def test_summaries_are_read_from_blocks_and_from_the_ends_of_lines() -> None:
    text = "/// What it is,\n/// and one of them.\nint a;  ///< of it\n"
    assert [*summaries(text)] == ["What it is, and one of them.", "of it"]


@pytest.mark.parametrize("path", [None, *HEADERS], ids=lambda path: path.stem if path else "all")
def test_summaries_of_the_core_neither_begin_with_a_question_word_nor_lean_on_a_pronoun(
    path: Path | None,
) -> None:
    """At most 2 and 4 % of all, and 10 % of each header."""
    paths, shares = ([path], (0.1, 0.1)) if path else (HEADERS, (0.02, 0.04))
    texts = [text for header in paths for text in summaries(header.read_text("utf-8"))]
    asking = [text for text in texts if QUESTION.match(text)]
    leaning = [text for text in texts if PRONOUN.search(text)]
    assert len(asking) <= shares[0] * len(texts), asking
    assert len(leaning) <= shares[1] * len(texts), leaning
