"""Sensitivity near the device's values and over the ranges of a study."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from pindrive.device.pin_scan import Progress
from pindrive.lazy import mpl_figure, qmc, xr
from pindrive.quantities import budgets
from pindrive.quantities.quantity import counted
from pindrive.quantities.refusal import refusal
from pindrive.quantities.status import Status
from pindrive.quantities.value import concise, equal_by_value
from pindrive.study.design import Ranges, ranges_of
from pindrive.study.distributions import Distribution
from pindrive.study.evaluate import RefusedPoints, evaluate_all, exist
from pindrive.study.local_sensitivity import Elasticities, elasticities
from pindrive.study.outputs import LEDGER, MEASURED, SCAN_MEASURED, known_output
from pindrive.study.study import Study
from pindrive.views import NotebookHtml, figure

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


@equal_by_value
@concise
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
        function: Function of columns of points (keys, n).
        ranges: Distribution of each key, independent of the others.
        rows: Rows of the design, a power of 2, at least 128; (keys + 2) points each.
        seed: Seed of the Sobol' sequence and the bootstrap.

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
        """Compute the indices from the values at A, B and each mixture, shape (keys + 2, count)."""
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


_SETTLED: Final = "transient_settled"
USUAL_ROWS: Final = 8192
USUAL_ROWS_OF_SCANS: Final = 256
"""A scan takes some ten thousand times as long as a release."""


@equal_by_value
@dataclass(frozen=True, slots=True, repr=False)
class SobolIndices(NotebookHtml):
    """Sobol' indices of each key for each number, optionally with elasticities."""

    keys: tuple[str, ...]
    ranges: Ranges
    near: Elasticities | None
    """None where they were not requested, and of scans, which have no exact derivatives."""
    over: Mapping[str, Indices]
    rows: int
    points: int
    refusals: tuple[RefusedPoints, ...]
    """Points that cannot exist, as their values contradict each other; left out."""
    name: str = ""
    """Name of the study."""

    def __repr__(self) -> str:
        """Return the counts of numbers, keys and points in a line."""
        numbers, keys = counted(len(self.over), "number"), counted(len(self.keys), "key")
        points = counted(self.points, "point")
        return f"<Sobol' indices of {numbers} over {keys}, {points}, {self.status.name}>"

    @property
    def status(self) -> Status:
        """`incomplete` where points cannot exist and were left out; `refusals` says why."""
        return Status.incomplete if self.refusals else Status.ok

    def plot(self) -> mpl_figure.Figure:
        """The indices as bars, numbers down and keys across, as a figure that a notebook shows."""
        return figure(self, "plot", self.name)

    def to_dataset(self) -> xr.Dataset:
        """The indices with their 95 % confidence intervals.

        Returns:
            Variables over (number, key): `first_order` and `total`, and the ends of their intervals
            as `first_order_low`, `first_order_high`, `total_low` and `total_high`; NaN where a
            number is constant or exists too rarely. Over `number`: `spread`, its standard deviation
            in SI, and `kept`, the part of the rows in which it exists.
        """
        numbers = [*self.over]
        data: dict[str, Any] = {}
        for part, order in (("first", "first_order"), ("total", "total")):
            for field, end in (("value", ""), ("low", "_low"), ("high", "_high")):
                rows = [getattr(getattr(self.over[n], part), field) for n in numbers]
                data[f"{order}{end}"] = (("number", "key"), np.array(rows), {"units": "1"})
        data["spread"] = ("number", np.array([self.over[n].spread for n in numbers]))
        data["kept"] = ("number", np.array([self.over[n].kept for n in numbers]), {"units": "1"})
        coords = {"number": numbers, "key": [*self.keys]}
        title = {"title": f"Sobol' indices of {self.name}"} if self.name else {}
        return xr.Dataset(data, coords=coords, attrs={**title, "status": self.status.name})


def askable(study: Study) -> tuple[str, ...]:
    """The variables whose sensitivity can be computed."""
    return SCAN_MEASURED if study.page else (*MEASURED, _SETTLED)


def sobol(
    study: Study,
    *,
    tolerances: bool = False,
    numbers: Sequence[str] = (),
    rows: int | None = None,
    seed: int = 1,
    threads: int | None = None,
    progress: Progress = lambda done, total: None,
    near: bool = False,
) -> SobolIndices:
    """Compute Sobol' indices, first order and total, over the ranges of a study.

    The estimators are those of Saltelli et al. 2010, 10.1016/j.cpc.2009.09.018, the intervals a
    bootstrap over the rows.

    Args:
        study: Study whose axes are the ranges; each key is drawn independently of the others.
        tolerances: True for the tolerances of the study in place of its axes.
        numbers: The numbers to analyse, as "settling_time"; all that exist unless given, of
            the energy ledger those that the study names in its outputs.
        rows: Rows of the design, a power of 2, at least 128, of (keys + 2) points each; None: 8192,
            of scans 256.
        seed: Seed of the sequence and the bootstrap.
        threads: Number of workers; None: all cores.
        progress: Function called with the points done and the points in all.
        near: Find the elasticities at the device's own values too, unless it is one of scans.

    Returns:
        The indices; `to_dataset` and `plot` give them as data and as a figure.

    Raises:
        ValueError: Nothing varies, a number is unknown, or `rows` is no power of 2 or too large.

    Examples:
        >>> import pindrive as pd
        >>> study = pd.Study(
        ...     pd.load_device("tactile-mouse.toml"),
        ...     tolerances={"mass": "5 %", "drive.stiffness": "10 %"},
        ... )
        >>> found = pd.sobol(study, numbers=["settling_time"], rows=128)
        >>> found
        <Sobol' indices of 1 number over 2 keys, 512 points, ok>
        >>> found.to_dataset().total.dims
        ('number', 'key')
    """
    among = askable(study)
    numbers = [known_output(name, "numbers", among) for name in numbers]
    ranges = ranges_of(study, tolerances)
    keys = tuple(ranges.scatter)
    usual = (name for name in askable(study) if name not in LEDGER or name in study.outputs)
    requested = tuple(dict.fromkeys(numbers)) or tuple(usual)
    if rows is None:
        rows = USUAL_ROWS_OF_SCANS if study.page else USUAL_ROWS
    varied = len(keys)
    results = len(requested) + 2  # status and reason
    each = (varied + 2) * (varied + results) + 3 * (varied + 1) * results
    of = f"{rows} rows of {each}, for {varied} keys and {results} results"
    budgets.DESIGN_VALUES.check(rows * each, of)
    refused: tuple[RefusedPoints, ...] = ()

    def function(points: NDArray[np.float64]) -> dict[str, Any]:
        nonlocal refused
        found, refused = evaluate_all(study, ranges, points, requested, threads, progress)
        designs = exist(found.pop("status"))
        if _SETTLED in found:
            found[_SETTLED] = np.where(designs, found[_SETTLED].astype(float), np.nan)
        return found

    over = sobol_indices(function, [*ranges.scatter.values()], rows, seed)
    points = rows * (len(keys) + 2)
    local = elasticities(study, keys, ranges.links) if near and not study.page else None
    return SobolIndices(keys, ranges, local, over, rows, points, refused, study.name)
