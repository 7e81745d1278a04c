"""Words that the prose of the project does without: each has a literal term in their place."""

from __future__ import annotations

import re
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
