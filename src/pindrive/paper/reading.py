"""Words for numbers: how a curve goes, so that no sentence says what the data do not."""

from __future__ import annotations

from math import ceil, log10
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


def trend(values: ArrayLike) -> str:
    """How values go along their axis: throughout, on the whole (rank correlation), or neither."""
    y = np.asarray(values, dtype=np.float64)
    steps = np.diff(y)
    if (steps >= 0.0).all():
        return "rises throughout"
    if (steps <= 0.0).all():
        return "falls throughout"
    rank = rank_correlation(y)
    if abs(rank) < 0.5:
        return "goes up and down"
    return f"{'rises' if rank > 0 else 'falls'} on the whole (rank correlation {rank:.2f})".replace(
        "-", "−"
    )


def rank_correlation(values: ArrayLike) -> float:
    """Spearman's, of values against their order."""
    ranks = np.argsort(np.argsort(np.asarray(values)))
    return float(np.corrcoef(ranks, np.arange(len(ranks)))[0, 1])


def listed(words: list[str]) -> str:
    """A, b and c."""
    *first, last = words
    return f"{', '.join(first)} and {last}" if first else last


def by_case(found: dict[str, str]) -> str:
    """What is found in each case, the same said once: "rises at 1 and 2, falls at 3"."""
    cases: dict[str, list[str]] = {}
    for case, words in found.items():
        cases.setdefault(words, []).append(case)
    return ", ".join(f"{words} at {listed(names)}" for words, names in cases.items())


def at_most(value: float) -> str:
    """A bound on a rounding error: the next power of ten, as TeX; twice the value for safety."""
    return "0" if value == 0.0 else rf"< 10^{{{ceil(log10(2 * value))}}}"


def share(true: ArrayLike) -> str:
    """How many: "1990 of 2000"."""
    found = np.asarray(true)
    return f"{int(found.sum())} of {found.size}"
