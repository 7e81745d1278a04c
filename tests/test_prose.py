"""Rules of the project's prose: documentation summaries stand alone and state their subject."""

from __future__ import annotations

import ast
import io
import re
import tokenize
from collections.abc import Callable, Iterator
from itertools import pairwise
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
QUESTION = re.compile(
    r"(what|how|whether|where|which|when|who|whose|why|of|by how|for how)\b", re.IGNORECASE
)
PRONOUN = re.compile(
    r"\b(the same|of it|of them|of these|of those|the others?|those|each of|as it is|as it has"
    r"|as many|so many|one of)\b",
    re.IGNORECASE,
)


def of_python(text: str) -> Iterator[str]:
    """Summaries of the docstrings and attribute docstrings of a Python text."""
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef):
            yield from filter(None, [(ast.get_docstring(node) or "").partition("\n\n")[0]])
        body = getattr(node, "body", None)
        for one, two in pairwise(body) if isinstance(body, list) else ():
            if isinstance(one, ast.Assign | ast.AnnAssign) and isinstance(two, ast.Expr):
                value = getattr(two.value, "value", None)
                if isinstance(value, str):
                    yield value


ENTRY = re.compile(
    r"^(what|how|whether|where|which|when|why|whose|of|by|as|to|with|that|likewise|it|its|they|their"
    r"|from|for|in|on|the same)\b",
    re.IGNORECASE,
)


def of_entries(docstring: str) -> Iterator[str]:
    """Descriptions in the sections of arguments, attributes and errors of a docstring."""
    for section in re.findall(r"^(?:Args|Attributes|Raises):\n((?: +.*\n?|\n)+)", docstring, re.M):
        yield from re.findall(r"^    [\w*`][\w*, `]*: (.*)$", section, re.M)


def of_cpp(text: str) -> Iterator[str]:
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


def of_typescript(text: str) -> Iterator[str]:
    """Documentation comments of a TypeScript text."""
    for comment in re.findall(r"/\*\*(.*?)\*/", text, re.DOTALL):
        yield " ".join(re.sub(r"\n\s*\*", " ", comment).split())


def test_summaries_of_typescript_are_read_from_comments() -> None:
    text = "/** A. */\nlet a;\n/**\n * B\n * c.\n */\nlet b; // no\n"
    assert [*of_typescript(text)] == ["A.", "B c."]


def test_summaries_of_cpp_are_read_from_blocks_and_from_the_ends_of_lines() -> None:
    text = "/// What it is,\n/// and one of them.\nint a;  ///< of it\n"
    assert [*of_cpp(text)] == ["What it is, and one of them.", "of it"]


def test_summaries_of_python_are_read_from_docstrings_and_attributes() -> None:
    text = '"""A.\n\nMore."""\nx = 1\n"""B."""\n\ndef f():\n    """C."""\n'
    assert [*of_python(text)] == ["A.", "B.", "C."]


PYTHON = sorted(
    path
    for folder in ("src", "tasks", "tests", "benchmarks", "wheels")
    for path in (ROOT / folder).rglob("*.py")
)
CPP = [
    path
    for folder in ("include", "engine", "bindings", "capi", "fmu", "src", "tests")
    for path in sorted((ROOT / folder).rglob("*.[ch]pp"))
]
SOURCES = {
    "src": {".py", ".cpp", ".hpp"},
    "include": {".hpp"},
    "bindings": {".cpp", ".hpp"},
    "capi": {".cpp", ".hpp"},
    "fmu": {".cpp", ".hpp"},
    "studio/src": {".ts"},
}
TYPESCRIPT = sorted((ROOT / "studio" / "src").rglob("*.ts"))


@pytest.mark.parametrize(
    ("paths", "read"),
    [(PYTHON, of_python), (CPP, of_cpp), (TYPESCRIPT, of_typescript)],
    ids=["Python", "C++", "TypeScript"],
)
def test_summaries_neither_begin_with_a_question_word_nor_lean_on_a_pronoun(
    paths: list[Path], read: Callable[[str], Iterator[str]]
) -> None:
    """At most 2 and 4 % of all, and 10 % of each file."""
    found = {path: [*read(path.read_text("utf-8"))] for path in paths}
    for pattern, share in ((QUESTION.match, 0.02), (PRONOUN.search, 0.04)):
        wrong = {path: [text for text in texts if pattern(text)] for path, texts in found.items()}
        count = sum(map(len, found.values()))
        assert sum(map(len, wrong.values())) <= share * count, wrong
        assert not {path: w for path, w in wrong.items() if len(w) > 0.1 * len(found[path])}


COMMENT = re.compile(
    r"^(what|how|whether|where|which|when|why|whose|of|by|as|to|that|likewise|it|its|they|their"
    r"|the same|those|these|else)\b",
    re.IGNORECASE,
)


def comments(path: Path) -> Iterator[str]:
    """First lines of the comments of a file, of Python, C++ or TypeScript."""
    text = path.read_text("utf-8")
    if path.suffix == ".py":
        for token in tokenize.generate_tokens(io.StringIO(text).readline):
            alone = token.line.lstrip().startswith("#")
            above = text.split("\n")[token.start[0] - 2].lstrip()[:1] if token.start[0] > 1 else ""
            if token.type == tokenize.COMMENT and not (alone and above == "#"):
                yield token.string.lstrip("# ")
        return
    above = ""
    for line in text.split("\n"):
        match = re.search(r"(?<![:/\"])//(?!/)\s*(.*)", line)
        alone = line.lstrip().startswith("//")
        if match and not (alone and above.startswith("//")):
            yield match[1]
        above = line.lstrip()


def test_comments_begin_with_their_subject() -> None:
    folders = [(ROOT / name, suffixes) for name, suffixes in SOURCES.items()]
    paths = [p for folder, suffixes in folders for p in folder.rglob("*") if p.suffix in suffixes]
    found = [(path, text) for path in paths for text in comments(path)]
    assert len(found) > 600
    assert [(path, text) for path, text in found if COMMENT.match(text)] == []


def test_descriptions_of_arguments_are_noun_phrases() -> None:
    assert [*of_entries("A.\n\nArgs:\n    a: of it.\n    b: Mass, kg.\n")] == [
        "of it.",
        "Mass, kg.",
    ]
    found, wrong = 0, []
    for path in (ROOT / "src").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef):
                entries = [*of_entries(ast.get_docstring(node) or "")]
                found += len(entries)
                wrong += [(path, entry) for entry in entries if ENTRY.match(entry)]
    assert found > 900
    assert wrong == []
