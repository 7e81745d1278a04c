"""One notation, two faces: text with x_d, `code`, TeX between dollars and line breaks."""

from __future__ import annotations

import re
from html import escape
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Callable

_TEX: Final = re.compile(r"\$([^$]+)\$")
_CODE: Final = re.compile(r"`([^`]+)`")
_INDEX: Final = re.compile(r"(?<![A-Za-z])([A-Za-zα-ωΑ-Ω]′?)_([a-z0-9]+(?:,[a-z0-9])?)")
"""A letter with an index: x_d, φ′_0, X_m,0."""


def html(text: str) -> str:
    """As HTML: MathML, code, and indices as such."""
    from latex2mathml.converter import convert

    def math(tex: str) -> str:
        return convert(tex.replace(r"\mathrm", r"\text"), display="inline")

    found = _each(text, math, lambda code: f"<code>{escape(code)}</code>", escape)
    return found.replace("\n", "<br>")


def markdown(text: str) -> str:
    """As GitHub's Markdown: thin spaces, which it takes for escapes, left out."""

    def math(tex: str) -> str:
        return f"${tex.replace(chr(92) + ',', ' ')}$"

    return _each(text, math, lambda code: f"`{code}`", str).replace("\n", "<br>")


def _each(
    text: str,
    math: Callable[[str], str],
    code: Callable[[str], str],
    plain: Callable[[str], str],
) -> str:
    pieces = []
    for i, piece in enumerate(_TEX.split(text)):
        if i % 2:
            pieces.append(math(piece))
            continue
        for j, words in enumerate(_CODE.split(piece)):
            pieces.append(code(words) if j % 2 else _INDEX.sub(_index, plain(words)))
    return "".join(pieces)


def _index(found: re.Match[str]) -> str:
    return f"{found[1]}<sub>{found[2]}</sub>"
