"""`optimise`: the best design that meets a wish, by screening, a search, and checks of both."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from math import isfinite, nan
from os import PathLike
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from pindrive.device.scanning import Progress
from pindrive.files.device import DeviceFile
from pindrive.lazy import qmc
from pindrive.optimisation.around import alternatives, at_ends, maps
from pindrive.optimisation.effort import Count, Effort, usual_effort
from pindrive.optimisation.goals import PRICE, Goal, Wish
from pindrive.optimisation.line_speed import speeds
from pindrive.optimisation.problem import (
    Problem,
    first_cases,
    spread_cases,
    worst_cases,
)
from pindrive.optimisation.results import Demanded, Design, Front, Reached
from pindrive.optimisation.scan_search import search_scans
from pindrive.optimisation.search import Population, non_dominated, search
from pindrive.optimisation.tolerance import excess_as_built, reserves, share_of
from pindrive.optimisation.wish import read_wish, wish_of
from pindrive.quantities.refusal import check_whole
from pindrive.study.design import device_at
from pindrive.study.distributions import with_links
from pindrive.study.outputs import Demand
from pindrive.study.workers import Cluster, crew

__all__ = ["optimise"]

Array = NDArray[np.float64]
GAIN: Final = 0.05
"""Part by which the first goal gets better where a demand is relaxed."""
ROUNDS: Final = 6
"""Searches, each with the worst conditions of the design that the one before found."""
WORSE: Final = 1e-3
"""Of a goal or a limit, a part of it: a condition that is worse by less is no other."""


def optimise(
    device: DeviceFile | None,
    wish: Mapping[str, Any] | Wish | str | PathLike[str],
    *,
    seed: int = 1,
    effort: Effort | None = None,
    threads: int | None = None,
    cluster: str | None = None,
    progress: Progress = lambda done, total: None,
) -> Design:
    """Find the design that meets a wish best.

    Candidates are spread over what may vary by a Sobol' sequence and simulated as a batch; the best
    of them are improved by differential evolution, of one goal or of several. Every demand and
    every goal counts by its worst condition: conditions that are worse than those considered are
    looked for at the design that was found, and the search is repeated with them. The same seed
    gives the same design.

    Args:
        device: what varies; None where `wish` is a file that names one, which it stands for else.
        wish: the tables of a wish file, in which a number is SI and text has a unit, or the path of
            one: `axes` and `catalogues` (what may vary), `conditions`, `specification` (what is
            demanded), `tolerances`, `goals` and `page`.
        seed: of all draws, at least 0.
        effort: how much is tried; as the kind of the wish needs unless given.
        threads: how many work, at least 1; all cores unless given.
        cluster: the address of a Dask scheduler, whose workers do the work instead.
        progress: called with the parts of the work done and in all.

    Returns:
        The best design, or where none meets the demands the closest one: its device file, the front
        of several goals, what the demands cost, maps around it, the nearest catalogue parts, and
        the part of the designs built within the tolerances that meets the demands.

    Raises:
        ConfigError: the wish holds anything unknown, malformed, out of bounds or contradictory. It
            is a ValueError.

    Examples:
        >>> import pindrive as pd
        >>> device = pd.load_device("tactile-mouse.toml")
        >>> design = pd.optimise(device, {
        ...     "axes": {"drive.damping": {"uniform": ["0 N*s/m", "1 N*s/m"]}},
        ...     "specification": {"peak_displacement": ">= 2.01 mm"},
        ...     "goals": {"minimise": "settling_time"},
        ... })
        >>> design.feasible
        True
    """
    check_whole(seed, "seed", 0)
    if isinstance(wish, str | PathLike):
        wanted = read_wish(wish, device=device)
    elif isinstance(wish, Wish):
        wanted = wish
    else:
        if device is None:
            raise ValueError("device must be what load_device reads, got None")
        wanted = wish_of(device, wish)
    if threads is not None and cluster is not None:
        raise ValueError("give threads or cluster, not both: workers have their own")
    run = _Optimisation(wanted, seed, effort, threads, progress)
    with crew(cluster) as workers:
        run.problem.crew = workers if isinstance(workers, Cluster) else None
        return run.run()


class _Optimisation:
    """One run."""

    def __init__(
        self,
        wish: Wish,
        seed: int,
        effort: Effort | None,
        threads: int | None,
        progress: Callable[[int, int], None],
    ) -> None:
        self.wish, self.seed = wish, seed
        self.rng = np.random.default_rng(seed)
        self.problem = Problem(
            plan=wish.plan,
            variables=wish.variables,
            conditions=wish.conditions,
            cases=first_cases(wish.conditions),
            links=wish.plan.links,
            demands=wish.demands,
            goals=wish.goals,
            line_speeds=speeds,
            threads=threads,
            count=Count(),
        )
        self.effort = effort or usual_effort(scans=self.problem.scans, slow=self.problem.slow)
        self.done, self.total = 0, 8 + self.effort.generations
        self.progress = progress
        self.warnings: list[str] = []

    def step(self) -> None:
        """Tell that a part of the work is done."""
        self.done = min(self.done + 1, self.total)
        self.progress(self.done, self.total)

    def run(self) -> Design:
        """All of it."""
        found, chosen = self._with_worst_conditions(self._screened())
        point, device, excess = self._as_built(found, chosen)
        if self.wish.least_yield:
            found, chosen, excess = self._with_yield(found, chosen, excess, self.wish.least_yield)
        limits = [nan] * len(self.wish.demands)
        for _ in range(ROUNDS):
            if found.violation[chosen] > 0.0:
                break
            limits, better = self._relaxations(found, chosen)
            if better is None:
                break
            more = (found + self.problem.population(better[None])).best(len(found.points))
            more = self._again(more) if self.problem.scans else more
            found, chosen = self._with_worst_conditions(more)  # what is asked of less found more
        point, device, excess = self._as_built(found, chosen)
        self.problem = replace(self.problem, demands=self.wish.demands)  # as they were written
        goals, demanded = self._reached(point, limits)
        feasible = all(d.excess <= 0.0 for d in demanded) and all(isfinite(r.value) for r in goals)
        built = share_of(excess) if excess is not None else None
        if built and self.wish.least_yield:
            feasible &= built.met >= self.wish.least_yield * built.of
        self.step()
        drawn = maps(self.problem, point, self.effort.resolution)
        self.step()
        beside = alternatives(self.problem, point)
        self.progress(self.total, self.total)
        return Design(
            wish=self.wish,
            device=device,
            values=self._values(point),
            parts=self._parts(point),
            feasible=feasible,
            goals=goals,
            demands=demanded,
            front=self._front(found, chosen),
            maps=drawn,
            alternatives=beside,
            built=built,
            gain=GAIN,
            at_ends=at_ends(self.problem, point),
            count=self.problem.count,
            seed=self.seed,
            warnings=tuple(self.warnings),
        )

    def _as_built(self, found: Population, chosen: int) -> tuple[Array, DeviceFile, Array | None]:
        """The chosen design, its device file, and how far devices like it exceed the demands."""
        point = found.points[chosen]
        device = device_at(self.wish.plan, self._values(point))
        if not self.wish.tables.get("tolerances") or not self.wish.demands:
            return point, device, None
        problem = replace(self.problem, demands=self.wish.demands)
        draws = self.effort.draws
        return point, device, excess_as_built(self.wish, problem, device, point, draws, self.seed)

    def _with_yield(
        self, found: Population, chosen: int, excess: Array | None, least: float
    ) -> tuple[Population, int, Array | None]:
        """Repeat the search with tighter limits until enough of the devices built meet the demands.

        Each limit is tightened by how far devices within the tolerances scatter beyond the design,
        as in sequential optimisation and reliability assessment (Du and Chen 2004).
        """
        part = least
        for _ in range(ROUNDS):
            assert excess is not None
            share = share_of(excess)
            if share.met >= least * share.of:
                break
            original = replace(self.problem, demands=self.wish.demands)
            own = original.excess(original.numbers(found.points[[chosen]]))[:, 0].max(axis=1)
            room = reserves(excess, own, part)
            self.problem = replace(
                self.problem,
                demands=tuple(
                    replace(d, limit=d.limit - r if d.at_most else d.limit + r)
                    for d, r in zip(self.wish.demands, room.tolist(), strict=True)
                ),
            )
            found, chosen = self._with_worst_conditions(self._again(found))
            _, _, excess = self._as_built(found, chosen)
            part = 1.0 - 0.7 * (1.0 - part)
        return found, chosen, excess

    # ---- the search ------------------------------------------------------------------------------

    def _screened(self) -> Population:
        """The best of many candidates, improved."""
        first = self._candidates(self.problem, self.effort.motions)
        self.step()
        return self._searched(self.problem, first, self.effort.generations, self.step)

    def _searched(
        self,
        problem: Problem,
        first: Population,
        generations: int,
        progress: Callable[[], None] = lambda: None,
    ) -> Population:
        """The population improved, the best first."""
        patience = self.effort.patience
        if not problem.scans:
            return search(
                problem,
                first,
                generations=generations,
                patience=patience,
                rng=self.rng,
                progress=progress,
            )
        found = search_scans(
            problem,
            size=len(first.points),
            rounds=generations,
            patience=patience,
            rng=self.rng,
            progress=progress,
        )
        while not problem.confirm(found.points[[choose(found)]]):
            found = problem.known().best(len(first.points))
        return found

    def _candidates(self, problem: Problem, motions: int) -> Population:
        """The best of candidates that are spread over all that may vary."""
        size = max(self.effort.population, 8)
        count = max(size, motions // len(problem.cases))
        count = 1 << (count - 1).bit_length()  # a Sobol' sequence is even over powers of two
        sequence = qmc.Sobol(len(problem.variables), scramble=True, rng=self.seed)
        kept, rough = None, replace(problem, coarse=True)
        each = 1 << 16
        for begin in range(0, count, each):
            found = rough.population(sequence.random(min(each, count - begin)))
            kept = (found if kept is None else kept + found).best(4 * size)
        assert kept is not None
        return kept.best(size)

    def _with_worst_conditions(self, found: Population) -> tuple[Population, int]:
        """Repeat the search with conditions that are worse for the design, until there are none.

        A cutting-set method (Mutapcic and Boyd 2009).
        """
        for attempt in range(ROUNDS):
            chosen = choose(found)
            worst = self._worse_cases(found.points[chosen], attempt)
            if not len(worst):
                return found, chosen
            self.problem = replace(
                self.problem, cases=np.unique(np.concatenate([self.problem.cases, worst]), axis=0)
            )
            found = self._again(found)
        for i in np.argsort(found.goals[:, 0], kind="stable"):  # a little beside the best, then
            if found.violation[i] <= 0.0 and not len(self._worse_cases(found.points[i], ROUNDS)):
                return found, int(i)
        self.warnings.append(
            f"worse conditions were found in each of {ROUNDS} searches; there may be others yet"
        )
        return found, choose(found)

    def _again(self, found: Population) -> Population:
        """The search continued, after conditions or limits have changed."""
        again = self.problem.population(found.points)
        return self._searched(self.problem, again, max(1, self.effort.generations // 2))

    def _worse_cases(self, point: Array, attempt: int) -> Array:
        """Conditions at which the design is worse than at those of the problem, in what matters."""
        problem = self.problem
        if not problem.conditions:
            return np.empty((0, 0))
        worst = worst_cases(problem, point, self.effort.conditions, self.seed + attempt)
        before, now = problem.numbers(point[None]), problem.numbers(point[None], worst)
        over, excess = (problem.excess(n)[:, 0].max(axis=1) for n in (before, now))
        old, new = (problem.minimised(n)[:, 0].max(axis=1) for n in (before, now))
        with np.errstate(invalid="ignore"):
            misses = excess > np.maximum(over, 0.0) * (1.0 + WORSE)
            slower = new > old + WORSE * np.abs(old)
        found: Array = worst[np.concatenate([misses, slower])]
        return found

    # ---- what the demands cost -------------------------------------------------------------------

    def _relaxations(self, found: Population, chosen: int) -> tuple[list[float], Array | None]:
        """For each demand the limit with which the first goal is better by `GAIN`.

        And a better design than the chosen one that meets all demands, if one was met on the way.
        """
        problem, demands = self.problem, self.problem.demands
        limits: list[float] = []
        for i, demand in enumerate(demands):
            relaxed = replace(
                problem,
                demands=(*demands[:i], *demands[i + 1 :], *self._no_worse(found.goals[chosen])),
                goals=(Goal(demand.name, not demand.at_most),),
            )
            first = relaxed.population(found.points)
            if not problem.scans:  # all that has been scanned is known to that search
                size = len(first.points)
                first = (first + self._candidates(relaxed, self.effort.motions // 8)).best(size)
            result = self._searched(relaxed, first, max(1, self.effort.generations // 2))
            self.step()
            if result.violation[0] > 0.0:
                limits.append(nan)
                continue
            value = float(result.goals[0, 0]) * (1.0 if demand.at_most else -1.0)
            if demand.met(np.array([value])).all():
                return [nan] * len(demands), result.points[0]
            limits.append(value - demand.limit + self.wish.demands[i].limit)
        return limits, None

    def _no_worse(self, goals: Array) -> tuple[Demand, ...]:
        """The first goal better by `GAIN`, the others as they are."""
        wanted = [goals[0] - GAIN * abs(goals[0]), *goals[1:]]
        return tuple(
            Demand(goal.name, not goal.maximise, float(-value if goal.maximise else value))
            for goal, value in zip(self.problem.goals, wanted, strict=True)
        )

    # ---- what comes back -------------------------------------------------------------------------

    def _reached(
        self, point: Array, limits: list[float]
    ) -> tuple[tuple[Reached, ...], tuple[Demanded, ...]]:
        """Every goal and every demand of a design at its worst condition."""
        problem = self.problem
        worst = worst_cases(problem, point, self.effort.conditions, self.seed)
        cases = np.concatenate([problem.cases, worst]) if problem.conditions else problem.cases
        problem.confirm(point[None], cases)
        numbers = problem.numbers(point[None], cases)
        bad = np.concatenate([problem.excess(numbers), problem.minimised(numbers)])[:, 0]
        places = bad.argmax(axis=1)

        def value(name: str, place: int) -> float:
            return float(numbers[name][0, place])

        def case(name: str, place: int) -> dict[str, float]:
            return {} if name == PRICE else self._case(cases[place])

        split = len(problem.demands)
        demanded = tuple(
            Demanded(d, value(d.name, place), case(d.name, place), limit)
            for d, place, limit in zip(problem.demands, places[:split], limits, strict=True)
        )
        goals = tuple(
            Reached(goal, value(goal.name, place), case(goal.name, place))
            for goal, place in zip(problem.goals, places[split:], strict=True)
        )
        return goals, demanded

    def _values(self, point: Array) -> dict[str, float]:
        """The value of every key of a design, SI, and of those that follow them."""
        found: dict[str, Array] = {}
        for variable, part in zip(self.problem.variables, point, strict=True):
            found |= variable.columns(np.asarray(part))
        plan = self.wish.plan
        linked = with_links(plan.device, found, plan.links)
        return {key: float(value) for key, value in linked.items()}

    def _parts(self, point: Array) -> dict[str, str]:
        """The part of each catalogue."""
        pairs = zip(self.problem.variables, point, strict=True)
        return {
            v.catalogue.name: v.catalogue.parts[int(v.index(np.asarray(part)))]
            for v, part in pairs
            if v.catalogue
        }

    def _case(self, case: Array) -> dict[str, float]:
        """The value of each condition, SI."""
        found = {}
        for condition, part in zip(self.problem.conditions, case, strict=True):
            for key, value in condition.columns(np.asarray(part)).items():
                found[key] = float(value)
        return found

    def _front(self, found: Population, chosen: int) -> Front | None:
        """The designs of which none is better in all goals, at all conditions looked at."""
        if len(self.problem.goals) < 2 or found.violation[chosen] > 0.0:
            return None
        dense = spread_cases(self.problem.conditions, 4 * self.effort.conditions // 16, self.seed)
        problem = replace(self.problem, cases=np.concatenate([self.problem.cases, dense]))
        all_cases = problem.population(found.points)
        keep = np.flatnonzero(all_cases.violation <= WORSE)
        keep = np.union1d(keep, [chosen])
        keep = keep[non_dominated(all_cases.goals[keep]) | (keep == chosen)]
        members = all_cases[keep]
        order = np.argsort(members.goals[:, 0], kind="stable")
        signs = np.array([-1.0 if goal.maximise else 1.0 for goal in problem.goals])
        columns = problem.columns(members.points[order], self.problem.cases[:1])
        kept = {key: x for key, x in columns.items() if key not in self._condition_keys}
        place = int(np.flatnonzero(keep[order] == chosen)[0])
        return Front(kept, signs * members.goals[order], place)

    @property
    def _condition_keys(self) -> set[str]:
        return {key for condition in self.problem.conditions for key in condition.axes}


def choose(found: Population) -> int:
    """The best design; of a front the one nearest to the best of all goals at once.

    Each goal is measured by its range over the front. Where no design meets the demands, the one
    that misses them by the least.
    """
    meets = np.flatnonzero(found.violation <= 0.0)
    if not len(meets):
        return int(found.violation.argmin())
    goals = found.goals[meets]
    front = np.flatnonzero(non_dominated(goals))
    low, high = goals[front].min(axis=0), goals[front].max(axis=0)
    far = ((goals[front] - low) / np.where(high > low, high - low, 1.0)) ** 2
    return int(meets[front[far.sum(axis=1).argmin()]])
