"""Design space: numbers of designs under all conditions, and the worst values."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import product
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from pindrive.lazy import qmc
from pindrive.optimisation.effort import Count
from pindrive.optimisation.goals import PRICE, SPEED, Goal, SpeedRequest, Variable
from pindrive.optimisation.scanned import Scanned
from pindrive.optimisation.search import Population
from pindrive.quantities.budgets import worker_count
from pindrive.study.distributions import Linked, with_links
from pindrive.study.evaluate import evaluate, exist, is_slow
from pindrive.study.outputs import DESIGN_OUTPUTS, NUMBERS, Constraint
from pindrive.study.workers import Cluster, spread

if TYPE_CHECKING:
    from pindrive.study.study import Study

Array = NDArray[np.float64]
POINTS: Final = 1 << 18
"""Motions that are simulated together."""
PORTION: Final = 4
"""Scans, or devices whose speeds are found, that a process takes at a time."""
SENT: Final = 1 << 14
"""Motions that a worker elsewhere takes at a time."""
GUESSED: Final = 2
"""Number of scanned devices per variable from which on a speed is first estimated by the model."""
SHORTER: Final = 0.02
"""Relative shortfall of a confirmed speed below its estimate that is accepted."""
FAR: Final = 1e3
"""The most that a constraint counts in a violation, and what a missing number adds to it."""
ALIKE: Final = 10
"""Digits of a goal after the first that count."""
MOST_CONDITIONS: Final = 32
"""With which a search begins."""


@dataclass(kw_only=True)
class DesignSpace:
    """Designs as points of the unit cube, and what they are worth under conditions.

    Attributes:
        study: The device and its page.
        variables: Variables of a design; a point has a part from 0 to 1 for each.
        conditions: Conditions of a design, in the same notation.
        cases: The conditions at which designs are compared, shape (c, conditions).
        links: Keys that follow others.
        constraints: Limits on numbers.
        goals: At least one goal.
        line_speeds: The largest hand speeds of some devices, with the trials that they took, as
            `pindrive.optimisation.line_speed.speeds` finds them.
        threads: Number of workers.
        count: Counter of the simulations.
        scanned: Scanned devices.
        progress: Function called after each part of the work.
    """

    study: Study
    variables: tuple[Variable, ...]
    conditions: tuple[Variable, ...]
    cases: Array
    links: Mapping[str, Linked]
    constraints: tuple[Constraint, ...]
    goals: tuple[Goal, ...]
    line_speeds: Callable[[Study, Sequence[SpeedRequest]], list[tuple[float, int]]]
    threads: int | None = None
    crew: Cluster | None = None
    """Workers elsewhere, which take scans, and motions by the ten thousand; None: none are."""
    price: float = 0.0
    """Price of the fixed parts."""
    count: Count = field(default_factory=Count)
    scanned: Scanned = field(default_factory=Scanned)
    coarse: bool = False
    """True if hand speeds are computed roughly, as for a map."""
    progress: Callable[[], None] = lambda: None

    @cached_property
    def names(self) -> tuple[str, ...]:
        """The numbers that it needs."""
        names = (
            *(goal.name for goal in self.goals),
            *(constraint.name for constraint in self.constraints),
        )
        return tuple(dict.fromkeys(names))

    @cached_property
    def scales(self) -> Array:
        """Scale of each violation: the limit, or a display unit."""
        sizes = [abs(d.limit) or 1.0 / NUMBERS[d.name].display_scale for d in self.constraints]
        return np.array(sizes, np.float64)

    @property
    def slow(self) -> bool:
        """True if motions are simulated one by one."""
        swept = {key: 0 for v in (*self.variables, *self.conditions) for key in v.axes}
        return self.study.page is None and is_slow(self.study.device, swept)

    @property
    def scans(self) -> bool:
        """True if a page is scanned."""
        return self.study.page is not None

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
        linked = with_links(self.study.device, found, self.links)
        return {key: np.broadcast_to(values, (n * c,)) for key, values in linked.items()}

    def prices(self, points: Array) -> Array:
        """The price of the parts of each point, shape (n,)."""
        total = np.full(len(points), self.price)
        for variable, parts in zip(self.variables, points.T, strict=True):
            if variable.catalogue and variable.catalogue.priced:
                total = total + np.array(variable.catalogue.prices)[variable.index(parts)]
        return total

    # ---- numbers ---------------------------------------------------------------------------------

    def numbers(self, points: Array, cases: Array | None = None) -> dict[str, Array]:
        """Return the numbers of points at cases, SI, all of shape (n, c); NaN if missing.

        Args:
            points: Shape (n, variables).
            cases: Shape (c, conditions); the own ones unless given.
        """
        at = self.cases if cases is None else cases
        each = max(1, POINTS // len(at))
        parts = []
        for begin in range(0, len(points), each):
            parts.append(self._numbers(points[begin : begin + each], at))
            self.progress()
        return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}

    def _numbers(self, points: Array, cases: Array) -> dict[str, Array]:
        shape = len(points), len(cases)
        if self.scans:
            self._scan(points, cases)
            known = self.scanned.look_up(self.inputs(points, cases))
            found = {name: column.reshape(shape) for name, column in known.items()}
        else:
            simulated = self.simulated(self.columns(points, cases), shape[0] * shape[1])
            found = {name: column.reshape(shape) for name, column in simulated.items()}
        return found | self.priced(points, shape)

    def priced(self, points: Array, shape: tuple[int, ...]) -> dict[str, Array]:
        """Return the price of points, shape (n, ...), by its name; nothing if it is not needed."""
        if PRICE not in self.names:
            return {}
        prices = self.prices(points).reshape(-1, *(1 for _ in shape[1:]))
        return {PRICE: np.broadcast_to(prices, shape)}

    def simulated(self, columns: dict[str, Array], size: int) -> dict[str, Array]:
        """Return the numbers of devices, SI, each of shape (size,), without prices.

        Args:
            columns: Values of keys, SI, each of shape (size,).
            size: Number of devices.
        """
        found = self._simulated(columns, size)
        if self.scans and SPEED in self.names:
            found[SPEED] = self._speeds(columns, np.full(size, np.nan), self._beat(), False)
        return found

    def _simulated(self, columns: dict[str, Array], size: int) -> dict[str, Array]:
        """The numbers of motions or of scans, each (size,), without speeds."""
        requested = [name for name in self.names if name not in DESIGN_OUTPUTS]
        if not requested:
            return {}
        if self.scans:
            self.count.scans += size
        else:
            self.count.motions += size
        table = self._evaluated(columns, size, (*requested, "status"))
        exists = exist(table["status"])
        return {name: np.where(exists, table[name], np.nan) for name in requested}

    # ---- scans -----------------------------------------------------------------------------------

    def snapped(self, points: Array) -> Array:
        """Points with each choice in the middle of the parts that stand for it."""
        found = points.copy()
        for variable, parts in zip(self.variables, found.T, strict=True):
            if variable.choices:
                parts[:] = (variable.index(parts) + 0.5) / variable.choices
        return found

    def inputs(self, points: Array, cases: Array) -> Array:
        """Every point at every case as `scanned` has it, shape (n * c, variables + conditions)."""
        n, c = len(points), len(cases)
        return np.hstack([np.repeat(self.snapped(points), c, axis=0), np.tile(cases, (n, 1))])

    def _scan(self, points: Array, cases: Array) -> None:
        """Scan what has not been."""
        inputs = self.inputs(points, cases)
        new = self.scanned.missing(inputs)
        if not len(new):
            return
        columns = {key: x[new] for key, x in self.columns(points, cases).items()}
        found = self._simulated(columns, len(new))
        if SPEED in self.names:
            found[SPEED] = self._speeds(columns, self._guessed(inputs[new]), self._beat(), False)
        self.scanned.keep(inputs[new], found)

    def confirm(self, points: Array, cases: Array | None = None) -> bool:
        """Find the speeds of points over the whole grid; whether they are what they were taken for.

        Args:
            points: Shape (n, variables).
            cases: Cases, as for `numbers`.
        """
        at = self.cases if cases is None else cases
        if SPEED not in self.names:
            return True
        before = self.numbers(points, at)[SPEED].ravel()
        inputs = self.inputs(points, at)
        new = self.scanned.unconfirmed(inputs)
        columns = {key: x[new] for key, x in self.columns(points, at).items()}
        found = self._speeds(columns, np.full(len(new), np.nan), np.nan, True)
        self.scanned.keep(inputs[new], {SPEED: found}, confirmed=True)
        return bool((found >= (1.0 - SHORTER) * before[new]).all())

    def known(self) -> Population:
        """All that has been scanned at all cases."""
        keys = len(self.variables)
        every = self.scanned.inputs.reshape(self.scanned.count, -1)[:, :keys]
        if not len(every):
            return Population(np.empty((0, keys)), np.empty((0, len(self.goals))), np.empty(0))
        points = every[np.sort(np.unique(every, axis=0, return_index=True)[1])]
        each = [not len(self.scanned.missing(self.inputs(p[None], self.cases))) for p in points]
        return self.population(points[np.array(each, np.bool_)])

    def expected(self, points: Array, trust: float) -> tuple[Array, Array]:
        """Goals and violations of points, better than is expected by standard deviations."""
        shape, inputs = (len(points), len(self.cases)), self.inputs(points, self.cases)
        least, most = {}, {}
        for name in self.names:
            if name == PRICE:
                low = high = np.repeat(self.prices(points)[:, None], shape[1], axis=1)
            else:
                low, high = self.scanned.expected(
                    name, inputs, trust, large_is_bad=self._large_is_bad(name)
                )
            least[name], most[name] = low.reshape(shape), high.reshape(shape)
        return self.worth(least, most)

    def _large_is_bad(self, name: str) -> bool:
        if any(goal.name == name for goal in self.goals):
            return Goal(name, False) in self.goals
        return any(
            constraint.name == name and constraint.at_most for constraint in self.constraints
        )

    def _guessed(self, inputs: Array) -> Array:
        if self.scanned.count < GUESSED * inputs.shape[1]:
            return np.full(len(inputs), np.nan)
        return self.scanned.expected(SPEED, inputs, 0.0, large_is_bad=False)[0]

    def _beat(self) -> float:
        """The speed below which that of a device matters little, m/s; NaN: there is none."""
        if self.coarse:
            return np.inf
        limits = [d.limit for d in self.constraints if d.name == SPEED and not d.at_most]
        if self.goals == (Goal(SPEED, True),):
            known = self.known()
            limits += [-float(goal) for goal in known.goals[known.violation <= 0.0, 0]]
        elif any(goal.name == SPEED for goal in self.goals):
            return np.nan
        return max(limits, default=np.nan)

    def _evaluated(
        self, columns: dict[str, Array], size: int, outputs: tuple[str, ...]
    ) -> dict[str, Any]:
        """The outputs at points, by the workers elsewhere where there are any."""
        each = PORTION if self.scans or self.slow else SENT
        if self.crew is None or size <= each:
            return evaluate(self.study, columns, size, outputs, self.threads)
        portions = []
        for begin in range(0, size, each):
            end = min(begin + each, size)
            part = {key: values[begin:end] for key, values in columns.items()}
            portions.append((part, end - begin, outputs))
        done = [*self.crew.spread(_evaluate, self.study, portions)]
        return {name: np.concatenate([table[name] for table in done]) for name in outputs}

    def _speeds(
        self, columns: dict[str, Array], near: Array, beat: float, confirmed: bool
    ) -> Array:
        """The largest speeds of devices, m/s, shape (n,)."""
        requested = [
            SpeedRequest(
                {key: float(x[i]) for key, x in columns.items()}, float(guess), beat, confirmed
            )
            for i, guess in enumerate(near)
        ]
        threads = worker_count(self.threads)
        each = min(PORTION, -(-len(requested) // threads)) or 1
        portions = [requested[i : i + each] for i in range(0, len(requested), each)]
        if self.crew is not None:
            rows = [*self.crew.spread(self.line_speeds, self.study, portions)]
        else:
            rows = spread(self.line_speeds, self.study, portions, threads)
        every = [row for portion in rows for row in portion]
        self.count.scans += sum(trials for _, trials in every)
        return np.array([speed for speed, _ in every])

    # ---- what they are worth ---------------------------------------------------------------------

    def excess(
        self, numbers: Mapping[str, Array], most: Mapping[str, Array] | None = None
    ) -> Array:
        """Return the excess over each constraint at each case, SI, (constraints, n, c), at best.

        Args:
            numbers: Numbers, each of shape (n, c).
            most: Upper bounds of the numbers, of which `numbers` are the lower bounds.
        """
        shape = next(iter(numbers.values())).shape
        high = numbers if most is None else most
        each = [d.excess((numbers if d.at_most else high)[d.name]) for d in self.constraints]
        return np.array(each).reshape(len(self.constraints), *shape)

    def minimised(
        self, numbers: Mapping[str, Array], most: Mapping[str, Array] | None = None
    ) -> Array:
        """The goals at each case, least is best, shape (goals, n, c); arguments as for `excess`."""
        high = numbers if most is None else most
        return np.array(
            [g.minimised((high if g.maximise else numbers)[g.name]) for g in self.goals]
        )

    def worth(
        self, numbers: Mapping[str, Array], most: Mapping[str, Array] | None = None
    ) -> tuple[Array, Array]:
        """Goals (n, g) and violations (n,), by the worst case of each, as for `excess`."""
        goals = _alike(self.minimised(numbers, most).max(axis=2).T)
        over = self.excess(numbers, most).max(axis=2).T / self.scales
        violation = np.clip(over, 0.0, FAR).sum(axis=1)
        violation += FAR * np.isinf(goals).sum(axis=1)
        return goals, violation

    def __call__(self, points: Array) -> tuple[Array, Array]:
        """Goals and violations of points, as `search` takes them."""
        return self.worth(self.numbers(points))

    def population(self, points: Array) -> Population:
        """Points with what they are worth."""
        return Population(points, *self(points))


def _alike(goals: Array) -> Array:
    """Goals without their last digits, so that equal ones are equal whatever their rounding."""
    with np.errstate(divide="ignore", invalid="ignore"):
        unit = 10.0 ** (np.floor(np.log10(np.abs(goals))) - ALIKE)
        shorter = unit * np.round(goals / unit)
    return np.where(np.isfinite(shorter), shorter, goals)


def _evaluate(
    study: Study, portion: tuple[dict[str, Array], int, tuple[str, ...]]
) -> dict[str, Any]:
    """The outputs at a portion of points, with one thread."""
    columns, size, outputs = portion
    return evaluate(study, columns, size, outputs, 1)


def first_cases(conditions: tuple[Variable, ...]) -> Array:
    """Return the first conditions of a search: ends and middles, up to the budget."""
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
    """Return conditions spread over all ranges, a power of two; one without conditions."""
    if not conditions:
        return np.zeros((1, 0))
    unit: Array = qmc.Sobol(len(conditions), scramble=True, rng=seed).random(count)
    return unit


def worst_cases(space: DesignSpace, point: Array, count: int, seed: int) -> Array:
    """The worst case found of each constraint and each goal of one design.

    Conditions are spread evenly, and again, ever closer, about the worst so far.

    Args:
        space: Space with constraints and goals; its own cases are evaluated, too.
        point: The design, shape (variables,).
        count: Conditions of the first spread, a power of two.
        seed: Seed of the spreads.

    Returns:
        Of each constraint, then of each goal, a case; shape (constraints + goals, conditions).
    """
    if not space.conditions:
        return np.zeros((len(space.constraints) + len(space.goals), 0))
    rng = np.random.default_rng(seed)
    cases = np.concatenate([space.cases, spread_cases(space.conditions, count, seed)])
    width = 0.25

    def badness(at: Array) -> Array:
        found = space.numbers(point[None], at)
        return np.concatenate([space.excess(found), space.minimised(found)])[:, 0]

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
