"""What designs are worth: their numbers under all conditions, and the worst of these."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from itertools import product
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from pindrive.lazy import qmc
from pindrive.optimisation.effort import Count
from pindrive.optimisation.goals import PRICE, SPEED, Goal, Variable
from pindrive.optimisation.search import Population
from pindrive.quantities.budgets import worker_count
from pindrive.study.distributions import Linked, with_links
from pindrive.study.evaluate import evaluate, exist, is_slow
from pindrive.study.outputs import DESIGN_OUTPUTS, NUMBERS, Demand
from pindrive.study.workers import standing

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from pindrive.study.cluster import Cluster
    from pindrive.study.design import Plan

Array = NDArray[np.float64]
Asked = tuple["Mapping[str, float]", float]
"""The values of keys, SI, and the speed to beat; NaN: there is none."""
POINTS: Final = 1 << 18
"""Motions that are simulated together."""
PORTION: Final = 4
"""Scans, or devices whose speeds are found, that a process takes at a time."""
SENT: Final = 1 << 14
"""Motions that a worker elsewhere takes at a time."""
BEATEN: Final = 0.6
"""Part of a population that a device must be faster than to be followed further."""
FAR: Final = 1e3
"""The most that a demand counts in a violation, and what a missing number adds to it."""
MOST_CONDITIONS: Final = 32
"""With which a search begins."""


@dataclass(kw_only=True)
class Problem:
    """Designs as points of the unit cube, and what they are worth under conditions.

    Attributes:
        plan: the device and its page.
        variables: of a design; a point has a part from 0 to 1 for each.
        conditions: under which it is followed, likewise.
        cases: the conditions at which designs are compared, shape (c, conditions).
        links: keys that follow others.
        demands: limits on numbers.
        goals: at least one.
        line_speeds: the largest hand speeds of some devices, with the trials that they took, as
            `pindrive.optimisation.line_speed.speeds` finds them.
        threads: how many work.
        count: of what was simulated.
        tell: called after each part of the work.
    """

    plan: Plan
    variables: tuple[Variable, ...]
    conditions: tuple[Variable, ...]
    cases: Array
    links: Mapping[str, Linked]
    demands: tuple[Demand, ...]
    goals: tuple[Goal, ...]
    line_speeds: Callable[[Plan, Sequence[Asked]], list[tuple[float, int]]]
    threads: int | None = None
    crew: Cluster | None = None
    """Workers elsewhere, which take scans, and motions by the ten thousand; None: none are."""
    price: float = 0.0
    """Of parts that are no variables."""
    count: Count = field(default_factory=Count)
    tell: Callable[[], None] = lambda: None

    @cached_property
    def names(self) -> tuple[str, ...]:
        """The numbers that it needs."""
        names = (*(goal.name for goal in self.goals), *(demand.name for demand in self.demands))
        return tuple(dict.fromkeys(names))

    @cached_property
    def scales(self) -> Array:
        """What an excess over each demand is measured in: its limit, or a unit for display."""
        sizes = [abs(d.limit) or 1.0 / NUMBERS[d.name].display_scale for d in self.demands]
        return np.array(sizes, np.float64)

    @property
    def slow(self) -> bool:
        """Whether its motions are followed one by one."""
        swept = {key: 0 for v in (*self.variables, *self.conditions) for key in v.axes}
        return self.plan.page is None and is_slow(self.plan.device, swept)

    @property
    def scans(self) -> bool:
        """Whether it scans a page."""
        return self.plan.page is not None

    # ---- points ----------------------------------------------------------------------------------

    def columns(self, points: Array, cases: Array) -> dict[str, Array]:
        """The keys of every point at every case, SI, shape (n * c,)."""
        n, c = len(points), len(cases)
        found: dict[str, Array] = {}
        for variable, parts in zip(self.variables, points.T, strict=True):
            for key, values in variable.columns(parts).items():
                found[key] = np.repeat(values, c)
        for condition, parts in zip(self.conditions, cases.T, strict=True):
            for key, values in condition.columns(parts).items():
                found[key] = np.tile(values, n)
        linked = with_links(self.plan.device, found, self.links)
        return {key: np.broadcast_to(values, (n * c,)) for key, values in linked.items()}

    def prices(self, points: Array) -> Array:
        """The price of the parts of each point, shape (n,)."""
        total = np.full(len(points), self.price)
        for variable, parts in zip(self.variables, points.T, strict=True):
            if variable.catalogue and variable.catalogue.priced:
                total = total + np.array(variable.catalogue.prices)[variable.index(parts)]
        return total

    # ---- numbers ---------------------------------------------------------------------------------

    def numbers(
        self, points: Array, cases: Array | None = None, beat: Array | None = None
    ) -> dict[str, Array]:
        """The numbers of points at cases, SI, each of shape (n, c); NaN where there is none.

        Args:
            points: shape (n, variables).
            cases: shape (c, conditions); the own ones unless given.
            beat: of each point a speed (m/s): of a device with a lower `distinct_speed` that number
                may be any lower one. NaN: there is none.
        """
        at = self.cases if cases is None else cases
        each = max(1, POINTS // len(at))
        parts = []
        for begin in range(0, len(points), each):
            here = slice(begin, begin + each)
            parts.append(self._numbers(points[here], at, None if beat is None else beat[here]))
            self.tell()
        return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}

    def _numbers(self, points: Array, cases: Array, beat: Array | None) -> dict[str, Array]:
        shape = len(points), len(cases)
        columns = self.columns(points, cases)
        found: dict[str, Array] = {}
        asked = [name for name in self.names if name not in DESIGN_OUTPUTS]
        if asked:
            size = shape[0] * shape[1]
            table = self._evaluated(columns, size, (*asked, "status"))
            exists = exist(table["status"])
            for name in asked:
                found[name] = np.where(exists, table[name], np.nan).reshape(shape)
            if self.scans:
                self.count.scans += size
            else:
                self.count.motions += size
        if PRICE in self.names:
            found[PRICE] = np.repeat(self.prices(points)[:, None], shape[1], axis=1)
        if SPEED in self.names:
            found[SPEED] = self._speeds(columns, shape, beat)
        return found

    def _evaluated(
        self, columns: dict[str, Array], size: int, outputs: tuple[str, ...]
    ) -> dict[str, Any]:
        """The outputs at points, by the workers elsewhere where there are any."""
        each = PORTION if self.scans or self.slow else SENT
        if self.crew is None or size <= each:
            return evaluate(self.plan, columns, size, outputs, self.threads)
        portions = []
        for begin in range(0, size, each):
            end = min(begin + each, size)
            part = {key: values[begin:end] for key, values in columns.items()}
            portions.append((part, end - begin, outputs))
        done = [*self.crew.spread(_evaluate, self.plan, portions)]
        return {name: np.concatenate([table[name] for table in done]) for name in outputs}

    def _speeds(
        self, columns: dict[str, Array], shape: tuple[int, int], beat: Array | None
    ) -> Array:
        wanted = np.repeat(np.full(shape[0], np.nan) if beat is None else beat, shape[1])
        asked = [
            ({key: float(values[i]) for key, values in columns.items()}, float(wanted[i]))
            for i in range(len(wanted))
        ]
        portions = [asked[i : i + PORTION] for i in range(0, len(asked), PORTION)]
        processes = worker_count(self.threads)
        if self.crew is not None:
            rows = [*self.crew.spread(self.line_speeds, self.plan, portions)]
        elif processes == 1 or len(portions) == 1:
            rows = [self.line_speeds(self.plan, portion) for portion in portions]
        else:
            rows = standing(processes).spread(self.line_speeds, self.plan, portions)
        every = [row for portion in rows for row in portion]
        self.count.scans += sum(trials for _, trials in every)
        return np.array([speed for speed, _ in every]).reshape(shape)

    # ---- what they are worth ---------------------------------------------------------------------

    def excess(self, numbers: Mapping[str, Array]) -> Array:
        """How far each demand is exceeded at each case, SI, shape (demands, n, c)."""
        shape = next(iter(numbers.values())).shape
        each = [demand.excess(numbers[demand.name]) for demand in self.demands]
        return np.array(each).reshape(len(self.demands), *shape)

    def minimised(self, numbers: Mapping[str, Array]) -> Array:
        """The goals at each case, least is best, shape (goals, n, c)."""
        return np.array([goal.minimised(numbers[goal.name]) for goal in self.goals])

    def worth(self, numbers: Mapping[str, Array]) -> tuple[Array, Array]:
        """Goals (n, g) and violations (n,), by the worst case of each."""
        goals = self.minimised(numbers).max(axis=2).T
        over = self.excess(numbers).max(axis=2).T / self.scales
        violation = np.clip(over, 0.0, FAR).sum(axis=1)
        violation += FAR * np.isinf(goals).sum(axis=1)
        return goals, violation

    def __call__(self, points: Array, rivals: Array | None = None) -> tuple[Array, Array]:
        """Goals and violations of points, as `search` takes them."""
        alone = len(self.goals) == 1 and self.goals[0] == Goal(SPEED, True)
        demanded = any(demand.name == SPEED for demand in self.demands)
        beat = None
        if alone and not demanded and rivals is not None:
            known = -rivals[:, 0]  # what is slower than most is not worth its trials
            beat = np.fmax(known, np.nanquantile(known, BEATEN)) if (known > 0.0).any() else known
        return self.worth(self.numbers(points, beat=beat))

    def population(self, points: Array) -> Population:
        """Points with what they are worth."""
        return Population(points, *self(points))


def _evaluate(plan: Plan, portion: tuple[dict[str, Array], int, tuple[str, ...]]) -> dict[str, Any]:
    """The outputs at a portion of points, with one thread."""
    columns, size, outputs = portion
    return evaluate(plan, columns, size, outputs, 1)


def first_cases(conditions: tuple[Variable, ...]) -> Array:
    """The conditions with which a search begins: ends and middles of all, or as many as fit."""
    if not conditions:
        return np.zeros((1, 0))
    nodes = []
    for condition in conditions:
        if condition.choices:
            rows = {0, condition.choices // 2, condition.choices - 1}
            nodes.append([condition.part(row) for row in sorted(rows)])
        else:
            nodes.append([0.0, 0.5, 1.0])
    size = np.prod([len(node) for node in nodes])
    if size <= MOST_CONDITIONS:
        return np.array([*product(*nodes)], np.float64).reshape(-1, len(nodes))
    unit = qmc.Sobol(len(nodes), scramble=False).random(MOST_CONDITIONS)
    return np.where(unit < 0.25, 0.0, np.where(unit > 0.75, 1.0, 0.5))


def spread_cases(conditions: tuple[Variable, ...], count: int, seed: int) -> Array:
    """Conditions spread over all, a power of two of them; one where there are none."""
    if not conditions:
        return np.zeros((1, 0))
    unit: Array = qmc.Sobol(len(conditions), scramble=True, rng=seed).random(count)
    return unit


def worst_cases(problem: Problem, point: Array, count: int, seed: int) -> Array:
    """The worst case found of each demand and each goal of one design.

    Conditions are spread evenly, and again, ever closer, about the worst so far.

    Args:
        problem: whose demands and goals; its own cases are looked at too.
        point: the design, shape (variables,).
        count: conditions of the first spread, a power of two.
        seed: of the spreads.

    Returns:
        Of each demand, then of each goal, a case; shape (demands + goals, conditions).
    """
    if not problem.conditions:
        return np.zeros((len(problem.demands) + len(problem.goals), 0))
    rng = np.random.default_rng(seed)
    cases = np.concatenate([problem.cases, spread_cases(problem.conditions, count, seed)])
    width = 0.25

    def badness(at: Array) -> Array:
        found = problem.numbers(point[None], at)
        return np.concatenate([problem.excess(found), problem.minimised(found)])[:, 0]

    bad = badness(cases)
    best, level = cases[bad.argmax(axis=1)], bad.max(axis=1)
    for _ in range(4 if count > 64 else 1):
        each = max(4, count // 8)
        near = best[:, None] + width * rng.uniform(-1.0, 1.0, (len(best), each, best.shape[1]))
        near = np.clip(near, 0.0, 1.0).reshape(-1, best.shape[1])
        found = badness(near)
        for row in range(len(best)):
            i = int(found[row].argmax())
            if found[row, i] > level[row]:
                best[row], level[row] = near[i], found[row, i]
        width *= 0.25
    return np.asarray(best)
