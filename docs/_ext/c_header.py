"""The C header as a reference page: each declaration under a heading, with its comment as text."""

from __future__ import annotations

import re
from pathlib import Path

HEADER = Path(__file__).parents[2] / "capi" / "pindrive.h"
_EXPORT = "PINDRIVE_API "


def reference() -> str:
    """The page in Markdown: its introduction, then the sections of the header in their order."""
    text = HEADER.read_text("utf-8")
    head, _, rest = text.partition("*/\n#ifndef")
    body = rest.partition('extern "C" {\n#endif\n')[2].partition("#ifdef __cplusplus")[0]
    parts = ["## Use", _prose(head.removeprefix("/*")), "## Version"]
    for paragraph in re.split(r"\n\s*\n", body.strip()):
        if title := re.fullmatch(r"/\* -+ (.*?) -+ \*/", paragraph):
            parts.append(f"## {title[1].capitalize()}")
            continue
        comment, declared = "", paragraph
        if found := re.match(r"/\*(.*?)\*/\n?", paragraph, re.DOTALL):
            comment, declared = found[1], paragraph[found.end() :]
        if names := list(dict.fromkeys(_declared(declared))):
            parts.append("### " + ", ".join(f"`{name}`" for name in names))
        parts.append(_prose(comment))
        if declared:
            parts.append(f"```c\n{_without_export(declared)}\n```")
    return "\n\n".join(filter(None, parts))


def _without_export(text: str) -> str:
    """The declarations without what exports them, and their further lines moved by as much."""
    moved = []
    exported = False
    for line in text.splitlines():
        exported = line.startswith(_EXPORT) or (exported and line.startswith(" "))
        further = " " * len(_EXPORT)
        moved.append(line.removeprefix(_EXPORT).removeprefix(further) if exported else line)
    return "\n".join(moved)


def _declared(text: str) -> list[str]:
    """The functions, types and constants that it declares."""
    functions = re.findall(r"^PINDRIVE_API [^(;]*?\b(pindrive_\w+)\(", text, re.MULTILINE)
    types = re.findall(
        r"^typedef (?:(?!struct \w+ \{)[^(;]*?\b|.*?\(\*)(pindrive_\w+)\)?[;(]", text, re.M
    )
    structures = re.findall(r"^\} (pindrive_\w+);", text, re.MULTILINE)
    defined = re.findall(r"^#define (PINDRIVE_\w+)", text, re.MULTILINE)
    return [*defined, *types, *structures, *functions]


def _prose(comment: str) -> str:
    """The text of a comment; lines that are indented in it, tables and code, as they are."""
    lines = [re.sub(r"^ \* ?", "", line) for line in comment.strip().splitlines()]
    lines = [line.rstrip() for line in lines]
    parts: list[str] = []
    for fixed, group in _grouped(lines):
        if fixed:
            language = "c" if any(line.endswith(";") for line in group) else "text"
            shift = min(len(line) - len(line.lstrip()) for line in group if line)
            inside = "\n".join(line[shift:] for line in group)
            parts.append(f"```{language}\n{inside.rstrip()}\n```")
        else:
            text = re.sub(r"([*\[])", r"\\\1", "\n".join(group).strip())
            parts.append(re.sub(r"(\w*_\w+(?:\(\))?)", r"`\1`", text))
    return "\n\n".join(filter(None, parts))


def _grouped(lines: list[str]) -> list[tuple[bool, list[str]]]:
    """Neighbouring lines, apart by whether they are indented."""
    groups: list[tuple[bool, list[str]]] = []
    for line in lines:
        fixed = line.startswith("  ") or (not line and bool(groups) and groups[-1][0])
        if not groups or groups[-1][0] != fixed:
            groups.append((fixed, []))
        groups[-1][1].append(line)
    return groups
