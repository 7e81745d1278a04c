"""Sentences of the report from `text.toml`, with numbers and words in their slots."""

from __future__ import annotations

import tomllib
from importlib.resources import files
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

TEXTS: Final[dict[str, Any]] = tomllib.loads(
    files("pindrive.paper").joinpath("text.toml").read_text("utf-8")
)


def worded(text: str, **slots: Any) -> str:
    """Return a text in one line with its slots filled.

    Args:
        text: Text with slots in braces, as of `str.format`.
        **slots: Numbers and words; truth values read "1990 of 2000", a list of words "a, b and c".
    """
    return text.format(**{name: _shown(of) for name, of in slots.items()})


def _shown(value: Any) -> Any:
    if isinstance(value, list):
        return listed(value)
    return share(value) if isinstance(value, np.ndarray) and value.dtype == bool else value


def listed(words: list[str]) -> str:
    """A, b and c."""
    *first, last = words
    return f"{', '.join(first)} and {last}" if first else last


def share(true: ArrayLike) -> str:
    """Return a share in words: "1990 of 2000"."""
    found = np.asarray(true)
    return f"{int(found.sum())} of {found.size}"
