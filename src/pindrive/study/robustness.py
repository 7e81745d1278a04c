"""Tolerance analysis of a design: spread, yield against a specification, worst case."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from pindrive.device.pin_scan import Progress
from pindrive.files.keys import NUMERIC_KEYS, variable
from pindrive.lazy import mpl_figure, optimize, xr
from pindrive.motion.motion import Motion
from pindrive.motion.simulate import motion_of
from pindrive.quantities import budgets
from pindrive.quantities.quantity import counted
from pindrive.quantities.status import Status
from pindrive.quantities.value import concise, equal_by_value
from pindrive.study.design import Ranges, ranges_of
from pindrive.study.distributions import Sample
from pindrive.study.evaluate import RefusedPoints, evaluate, evaluate_all, exist
from pindrive.study.outputs import NUMBERS, Constraint, Share, attributes
from pindrive.study.study import Study
from pindrive.views import NotebookHtml, figure

USUAL_COUNT: Final = 100_000
USUAL_COUNT_OF_SCANS: Final = 1000
"""A scan takes some ten thousand times as long as a release."""
WATCHED: Final = ("transient_settling_time", "transient_swing")
WATCHED_OF_SCANS: Final = ("lines_shown_part", "median_lag_on")
_POPULATION: Final = 15
"""Members for each key of the search for the worst case."""
_GENERATIONS: Final = 60
_POPULATION_OF_SCANS: Final = 5
_GENERATIONS_OF_SCANS: Final = 10


@equal_by_value
@concise
@dataclass(frozen=True, slots=True)
class WorstCase:
    """Point with the largest violation of a constraint, or with the smallest margin."""

    constraint: Constraint
    keys: Mapping[str, float]
    """SI."""
    value: float
    """The number there, NaN where it does not exist."""
    sampled: float
    """The worst among the draws, before the search."""
    motion: Motion | None
    """Motion at that point; None for a scan."""


@equal_by_value
@dataclass(frozen=True, slots=True, repr=False)
class Robustness(NotebookHtml):
    """Result of `robustness`."""

    ranges: Ranges
    draws: int
    seed: int
    own: Mapping[str, float]
    """Numbers of the design itself."""
    drawn: Mapping[str, NDArray[np.float64]]
    """Drawn values of the varied keys of every existing design, SI."""
    feasible: NDArray[np.bool_]
    """True for the existing designs that meet all constraints; all without a specification."""
    values: Mapping[str, NDArray[np.float64]]
    """Watched numbers of every design that exists; NaN where it has none."""
    refusals: tuple[RefusedPoints, ...]
    """Draws that cannot exist, as their values contradict each other: no designs."""
    stopped: int
    """Designs whose motion was stopped early, after too many events."""
    shares: tuple[tuple[Constraint, Share], ...]
    """For each constraint, how many designs meet it; without a number a design does not."""
    all_met: Share | None
    """Number of designs that meet all constraints: the yield."""
    worst: tuple[WorstCase, ...]
    name: str = ""
    """Name of the study."""

    def __repr__(self) -> str:
        """Return the counts of designs and of feasible designs in a line."""
        met = f"{self.all_met.text} meet the specification" if self.all_met else "no specification"
        return f"<Robustness of {counted(self.designs, 'design')}: {met}, {self.status.name}>"

    @property
    def status(self) -> Status:
        """`incomplete` where draws cannot exist and were left out; `refusals` says why."""
        return Status.incomplete if self.refusals else Status.ok

    def plot(self) -> mpl_figure.Figure:
        """Plot the distributions of the watched numbers with the limits."""
        return figure(self, "plot", self.name)

    def plot_designs(self) -> mpl_figure.Figure:
        """Plot the drawn values of the designs that meet and that violate the specification."""
        return figure(self, "plot_designs", self.name)

    def to_dataset(self) -> xr.Dataset:
        """Return the designs with their drawn values and numbers, and the yield.

        Returns:
            Over `design`: the drawn value of each varied key, SI, each watched number, SI (NaN for
            a design without the number), and `feasible`, true for a design that meets all
            constraints. Over `limit`: `met`, `met_low` and `met_high`, the fraction of the designs
            that meets each limit of the specification with its 95 % confidence interval, and
            `worst`, the worst value found.
        """
        data: dict[str, Any] = {
            variable(key): ("design", values, NUMERIC_KEYS[key].attributes)
            for key, values in self.drawn.items()
        }
        words = {"long_name": "true if the design meets all constraints"}
        data["feasible"] = ("design", self.feasible, words)
        data |= {name: ("design", values, attributes(name)) for name, values in self.values.items()}
        shares = [share for _, share in self.shares]
        for name, parts in (
            ("met", [share.met / share.of for share in shares]),
            ("met_low", [share.low for share in shares]),
            ("met_high", [share.high for share in shares]),
            ("worst", [case.value for case in self.worst]),
        ):
            data[name] = ("limit", np.array(parts, np.float64))
        coords = {"limit": [constraint.text() for constraint, _ in self.shares]}
        found: dict[str, Any] = {"status": self.status.name, "draws": self.draws, "seed": self.seed}
        if self.all_met:
            found["yield"] = self.all_met.met / self.all_met.of
        return xr.Dataset(data, coords=coords, attrs=found)

    @property
    def designs(self) -> int:
        """Draws that exist."""
        return self.draws - self.refused

    @property
    def refused(self) -> int:
        """Draws that cannot exist."""
        return sum(refusal.count for refusal in self.refusals)


def robustness(
    study: Study,
    *,
    count: int | None = None,
    seed: int = 1,
    threads: int | None = None,
    progress: Progress = lambda done, total: None,
) -> Robustness:
    """Draw designs within the tolerances of a study and compare them with its specification.

    A value that keeps its ratio to another value varies with that value, unless it has a tolerance
    (see `Quantity.follows`). A draw whose values contradict each other is not a design and is
    counted separately.

    Args:
        study: A study with tolerances.
        count: Number of independent random draws, >= 1, from which the confidence intervals follow.
            None: 100 000, of scans 1000.
        seed: Seed of the draws and of the search for the worst case.
        threads: Number of threads; None: all cores.
        progress: Function called with the points done and the points in all.

    Returns:
        The spread of the watched numbers, the yield against each limit and against all, and the
        worst case that a search found; `to_dataset` and `plot` give them as data and as a figure.

    Raises:
        ValueError: There are no tolerances, no draw can exist, or the draws exceed the memory.

    Examples:
        >>> import pindrive as pd
        >>> study = pd.Study(
        ...     pd.load_device("tactile-mouse.toml"),
        ...     tolerances={"mass": "5 %", "drive.stiffness": "10 %"},
        ...     specification={"settling_time": "<= 1 s"},
        ... )
        >>> pd.robustness(study, count=500)
        <Robustness of 500 designs: 100.000 % meet the specification, ok>
    """
    ranges = ranges_of(study, tolerances=True)
    if count is None:
        count = USUAL_COUNT_OF_SCANS if study.page else USUAL_COUNT
    usual = WATCHED_OF_SCANS if study.page else WATCHED
    watched = tuple(dict.fromkeys((*usual, *(constraint.name for constraint in study.constraints))))
    each = len(ranges.scatter) + len(watched) + 1
    of = f"{count} draws of {len(ranges.scatter)} keys and {len(watched) + 1} results"
    budgets.DESIGN_VALUES.check(count * each, of)
    sample = Sample(tuple(ranges.scatter), count, seed)

    def numbers(points: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
        columns = ranges.columns(study, points)
        return evaluate(study, columns, points.shape[1], (*watched, "status"), threads)

    parts = zip(sample.parts(np.arange(count)), ranges.scatter.values(), strict=True)
    points = np.array([scatter.ppf(part) for part, scatter in parts])
    table, refused = evaluate_all(study, ranges, points, watched, threads, progress)
    designs = exist(table["status"])
    if not designs.any():
        words, reason = counted(count, "draw"), refused[0].reason
        raise ValueError(f"{study.path}: of {words} none can exist: {reason}")
    points, table = points[:, designs], {name: values[designs] for name, values in table.items()}

    own = evaluate(study, {}, 1, watched)
    met = {constraint: constraint.met(table[constraint.name]) for constraint in study.constraints}
    every = np.logical_and.reduce([*met.values()]) if met else None
    size = points.shape[1]
    return Robustness(
        ranges,
        count,
        seed,
        {name: float(own[name][0]) for name in watched},
        dict(zip(ranges.scatter, points, strict=True)),
        np.ones(size, np.bool_) if every is None else every,
        {name: table[name] for name in watched},
        refused,
        int(np.count_nonzero(table["status"])),
        tuple(
            (d, Share.of_designs(int(m.sum()), size, int(np.isnan(table[d.name]).sum())))
            for d, m in met.items()
        ),
        None if every is None else Share.of_designs(int(every.sum()), size),
        tuple(_worst(study, ranges, d, points, table, numbers, seed) for d in study.constraints),
        study.name,
    )


def _worst(
    study: Study,
    ranges: Ranges,
    constraint: Constraint,
    points: NDArray[np.float64],
    table: Mapping[str, NDArray[np.float64]],
    numbers: Callable[[NDArray[np.float64]], Mapping[str, NDArray[np.float64]]],
    seed: int,
) -> WorstCase:
    """The worst of the draws, made worse by differential evolution within the ranges.

    A range ends where its distribution does, or three standard deviations off.
    """
    spans = np.array([scatter.span for scatter in ranges.scatter.values()])
    low, width = spans[:, :1], np.maximum(np.diff(spans, axis=1), 1e-300)

    def badness(excess: NDArray[np.float64], status: NDArray[np.float64]) -> NDArray[np.float64]:
        """Lower is worse. An infinite excess is the worst; a contradictory draw does not count."""
        far = 1e6 * abs(constraint.limit or 1.0)
        return np.where(exist(status), -np.minimum(excess, far), far)

    def at(parts: NDArray[np.float64]) -> NDArray[np.float64]:
        found = numbers(low + width * parts.reshape(len(spans), -1))
        return badness(constraint.excess(found[constraint.name]), found["status"])

    inside = ((points >= spans[:, :1]) & (points <= spans[:, 1:])).all(axis=0)
    first = badness(constraint.excess(table[constraint.name]), table["status"])
    order = np.argsort(np.where(inside, first, np.inf), kind="stable")
    population = _POPULATION_OF_SCANS if study.page else _POPULATION
    members = points[:, order[: max(5, population * len(spans))]]
    started = ((members - low) / width).T
    if len(started) < 5:
        rng = np.random.default_rng(seed)
        started = np.concatenate([started, rng.random((5 - len(started), len(spans)))])
    search = optimize.differential_evolution(
        at,
        [(0.0, 1.0)] * len(spans),
        init=np.clip(started, 0.0, 1.0),
        maxiter=_GENERATIONS_OF_SCANS if study.page else _GENERATIONS,
        vectorized=True,
        updating="deferred",
        polish=False,
        tol=1e-10,
        rng=np.random.default_rng(seed),
    )
    best = members[:, :1] if first[order[0]] <= search.fun else low + width * search.x[:, None]
    columns = {key: values.item() for key, values in ranges.columns(study, best).items()}
    sampled = float(table[constraint.name][order[0]])
    if study.page:
        return WorstCase(
            constraint, columns, float(numbers(best)[constraint.name][0]), sampled, None
        )
    motion = motion_of(study.device_at(columns))
    value = motion.numbers()[NUMBERS[constraint.name].name]
    return WorstCase(constraint, columns, value, sampled, motion)
