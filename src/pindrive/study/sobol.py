"""Which parameter matters over whole ranges: Sobol' indices with bootstrap confidence intervals.

First order: the part of a number's variance that one key explains by itself. Total: with all its
interactions. The estimators are those of Saltelli et al. 2010, 10.1016/j.cpc.2009.09.018.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from pindrive.lazy import qmc
from pindrive.quantities.table import refusal

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.typing import NDArray

    from pindrive.study.distributions import Distribution

    Function = Callable[[NDArray[np.float64]], Mapping[str, NDArray[np.float64]]]
    """Numbers at points given by columns (keys, n): arrays of shape (n,)."""

RESAMPLES: Final = 500
FEWEST_ROWS: Final = 128
FEWEST: Final = 64
"""Rows that must be left where a number does not exist everywhere."""
_CONFIDENCE: Final = 0.95
_AT_A_TIME: Final = 50


@dataclass(frozen=True, slots=True)
class Interval:
    """A number for each key, with its 95 % confidence interval."""

    value: NDArray[np.float64]
    low: NDArray[np.float64]
    high: NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Indices:
    """Sobol' indices of one number; NaN where it is constant or exists too rarely."""

    first: Interval
    total: Interval
    kept: float
    """The part of the rows in which it exists at every point; the rest is left out."""
    spread: float
    """Its standard deviation, SI."""


def sobol_indices(
    function: Function, ranges: Sequence[Distribution], rows: int, seed: int = 1
) -> dict[str, Indices]:
    """The indices of every number that a function gives.

    Args:
        function: called with columns of points (keys, n).
        ranges: how each key is distributed, independently of the others.
        rows: of the design, a power of 2, at least 128; (keys + 2) points each.
        seed: of the Sobol' sequence and the bootstrap.

    Raises:
        ValueError: `rows` is no power of 2, or below 128.
    """
    if rows < FEWEST_ROWS or rows & (rows - 1):
        required = f"a power of 2 of at least {FEWEST_ROWS}"
        raise ValueError(refusal("rows", required, repr(rows)))
    keys = len(ranges)
    rng = np.random.default_rng(seed)
    parts = qmc.Sobol(2 * keys, scramble=True, rng=rng, bits=64).random(rows).T
    drawn = np.array([ranges[i % keys].ppf(part) for i, part in enumerate(parts)])
    a, b = drawn[:keys], drawn[keys:]
    # B's column i in A, for each i, one after the other.
    mixed = np.concatenate([np.where(np.arange(keys)[:, None] == i, b, a) for i in range(keys)], 1)
    found = function(np.concatenate([a, b, mixed], axis=1))
    designs = {name: values.reshape(keys + 2, rows) for name, values in found.items()}
    return _estimate(designs, rng)


def _estimate(
    designs: Mapping[str, NDArray[np.float64]], rng: np.random.Generator
) -> dict[str, Indices]:
    """From the values at A, B and each mixture: everything is a sum over rows, reweighted."""
    sums = {name: _Sums.of(values) for name, values in designs.items()}
    count = next(iter(designs.values())).shape[1]
    one = {name: s.indices(np.ones((1, count))) for name, s in sums.items()}
    draws: dict[str, list[tuple[NDArray[np.float64], NDArray[np.float64]]]] = {
        name: [] for name in sums
    }
    for _ in range(0, RESAMPLES, _AT_A_TIME):
        weights = rng.multinomial(count, np.full(count, 1.0 / count), _AT_A_TIME).astype(float)
        for name, s in sums.items():
            draws[name].append(s.indices(weights))
    found = {}
    for name, s in sums.items():
        intervals = []
        for part in (0, 1):
            resampled = np.concatenate([draw[part] for draw in draws[name]])
            low, high = np.quantile(
                resampled, (0.5 - _CONFIDENCE / 2, 0.5 + _CONFIDENCE / 2), axis=0
            )
            intervals.append(Interval(one[name][part][0], low, high))
        first, total = intervals
        found[name] = Indices(first, total, s.kept, s.spread)
    return found


@dataclass(frozen=True, slots=True)
class _Sums:
    """The terms of the estimators of one number, a row for each row of the design."""

    terms: NDArray[np.float64]
    """Columns: 1, a + b, a² + b², and for each key b (ab - a), ab - a, (ab - a)²."""
    kept: float
    spread: float
    keys: int

    @classmethod
    def of(cls, design: NDArray[np.float64]) -> _Sums:
        """Of values at A, B and each mixture, shape (keys + 2, count)."""
        exists = np.isfinite(design).all(axis=0)
        keys = len(design) - 2
        kept = float(exists.mean())
        if exists.sum() < FEWEST:
            return cls(np.full((design.shape[1], 3 + 3 * keys), np.nan), kept, np.nan, keys)
        known = np.where(exists, design, 0.0)
        middle = known[:2].sum() / (2.0 * exists.sum())
        a, b, *mixed = np.where(exists, known - middle, 0.0)
        spread = float(np.sqrt((a**2 + b**2).sum() / (2.0 * exists.sum())))
        rounding = 1e-9 * max(float(np.abs(known).max()), 1e-300)
        if spread <= rounding:  # constant
            return cls(np.full((len(a), 3 + 3 * keys), np.nan), kept, 0.0, keys)
        a, b, mixed = a / spread, b / spread, [ab / spread for ab in mixed]
        columns: list[Any] = [exists.astype(float), a + b, a**2 + b**2]
        for ab in mixed:
            columns += [b * (ab - a), ab - a, (ab - a) ** 2]
        return cls(np.array(columns).T, kept, spread, keys)

    def indices(
        self, weights: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """First order and total, shape (n, keys) each, for weights of the rows (n, count)."""
        rows, both, squares, *each = (weights @ self.terms).T
        with np.errstate(invalid="ignore", divide="ignore"):
            mean = both / (2.0 * rows)
            variance = squares / (2.0 * rows) - mean**2
            first = [
                (each[3 * i] - mean * each[3 * i + 1]) / (rows * variance) for i in range(self.keys)
            ]
            total = [each[3 * i + 2] / (2.0 * rows * variance) for i in range(self.keys)]
        return np.array(first).T, np.array(total).T
