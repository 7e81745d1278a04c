"""`optimise`: solution of a design problem by screening, search and checks."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from itertools import product
from math import isfinite, nan, prod
from os import PathLike
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from pindrive.device.pin_scan import Progress
from pindrive.files.device import DeviceFile
from pindrive.lazy import qmc
from pindrive.optimisation.design_space import (
    DesignSpace,
    first_cases,
    spread_cases,
    worst_cases,
)
from pindrive.optimisation.effort import Count, Effort, usual_effort
from pindrive.optimisation.goals import PRICE, DesignProblem, Goal, Margin
from pindrive.optimisation.line_speed import speeds
from pindrive.optimisation.margins import margins
from pindrive.optimisation.problem import problem_of, read_problem
from pindrive.optimisation.results import (
    ConstraintResult,
    Design,
    Front,
    Reached,
    SteadyDesign,
    alternatives,
    at_ends,
    maps,
)
from pindrive.optimisation.rounding import rounded
from pindrive.optimisation.scan_search import search_scans
from pindrive.optimisation.search import Population, non_dominated, search
from pindrive.optimisation.steady import Steady
from pindrive.optimisation.tolerance import Built, reserves, share_of
from pindrive.quantities.refusal import check_whole
from pindrive.study.distributions import with_links
from pindrive.study.outputs import Constraint
from pindrive.study.workers import Cluster, crew

__all__ = ["optimise"]

Array = NDArray[np.float64]
GAIN: Final = 0.05
"""Relative improvement of the first goal for which a constraint is relaxed."""
ROUNDS: Final = 6
"""Largest number of searches, each with the worst conditions of the design found before."""
DRAWS: Final = 2000
"""Devices of each design in a search with a counted yield."""
YIELDED: Final = 32
"""Designs of its population."""
GENERATIONS: Final = 60
"""Largest number of its generations."""
PATIENCE: Final = 12
"""Generations without progress after which it ends."""
SPREAD: Final = 2048
"""Designs over the whole ranges, of which some that meet the limits are among its first ones."""
TRIALS: Final = 3
"""Largest number of its repetitions, each with a larger yield of few draws."""
FEW: Final = 4
"""Designs with the yield of few draws and not of many, of which the lack is counted."""
FAR: Final = 16
"""Designs for each variable, over the whole ranges, of a search before."""
NEAR: Final = 0.05
"""Scatter of its first designs about the one with tighter limits, a part of the ranges."""
ENUMERATED: Final = 4096
"""Largest number of combinations of catalogue parts of which each is evaluated."""
BESIDE: Final = 12
"""Designs beside the best that are tried where searches found worse conditions to the last."""
MARGIN: Final = 0.01
"""Margin of the design that is offered where the best one has less, a part of each value."""
WORSE: Final = 1e-3
"""Smallest relative change of a goal or a limit that makes a condition worse."""


def optimise(
    device: DeviceFile | None,
    problem: Mapping[str, Any] | DesignProblem | str | PathLike[str],
    *,
    seed: int = 1,
    effort: Effort | None = None,
    threads: int | None = None,
    cluster: str | None = None,
    progress: Progress = lambda done, total: None,
) -> Design:
    """Find the best design for a design problem.

    A Sobol' sequence of candidates over the variables is simulated as a batch. Differential
    evolution then improves the best candidates, for one goal or several. Each constraint and each
    goal is evaluated at its worst condition: the optimiser searches for conditions under which the
    design performs worse than under those considered, and repeats the search with these. The same
    seed gives the same design.

    Args:
        device: Device to be varied. None if `problem` is a file that names its device; otherwise
            `device` replaces the device of the file.
        problem: Tables of a problem file, in which numbers are SI and texts have a unit, or the
            path of a problem file: `axes` and `catalogues` (variables), `conditions`,
            `specification` (constraints), `tolerances`, `goals` and `page`.
        seed: Seed of all random numbers, >= 0.
        effort: Size of the search. None: by the kind of the design problem.
        threads: Number of threads, >= 1. None: all cores.
        cluster: Address of a Dask scheduler whose workers simulate. None: this machine.
        progress: Function of the finished and of the total parts of the work.

    Returns:
        The best design, or the closest one if no design meets the constraints: its device file, the
        front of several goals, the cost of each constraint, maps around the design, the nearest
        catalogue parts, and the yield within the tolerances.

    Raises:
        ConfigError: An entry of the design problem is unknown, malformed, out of bounds or
            contradictory. The error is a ValueError.

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
    if isinstance(problem, str | PathLike):
        wanted = read_problem(problem, device=device)
    elif isinstance(problem, DesignProblem):
        wanted = problem
    else:
        if device is None:
            raise ValueError("device must be a DeviceFile, got None")
        wanted = problem_of(device, problem)
    if threads is not None and cluster is not None:
        raise ValueError("give threads or cluster, not both: workers have their own")
    run = _Optimisation(wanted, seed, effort, threads, progress)
    with crew(cluster) as workers:
        run.space.crew = workers if isinstance(workers, Cluster) else None
        return run.run()


class _Optimisation:
    """One run."""

    def __init__(
        self,
        problem: DesignProblem,
        seed: int,
        effort: Effort | None,
        threads: int | None,
        progress: Callable[[int, int], None],
    ) -> None:
        self.problem, self.seed = problem, seed
        self.rng = np.random.default_rng(seed)
        self.space = DesignSpace(
            study=problem.study,
            variables=problem.variables,
            conditions=problem.conditions,
            cases=first_cases(problem.conditions),
            links=problem.study.links,
            constraints=problem.constraints,
            goals=problem.goals,
            line_speeds=speeds,
            threads=threads,
            count=Count(),
        )
        self.effort = effort or usual_effort(scans=self.space.scans, slow=self.space.slow)
        self.done, self.total = 0, 8 + self.effort.generations
        self.progress = progress
        self.warnings: list[str] = []

    def step(self) -> None:
        """Report that a part of the work is done."""
        self.done = min(self.done + 1, self.total)
        self.progress(self.done, self.total)

    def run(self) -> Design:
        """Return the whole result."""
        found, chosen = self._with_worst_conditions(self._screened())
        least = self.problem.least_yield
        if least:
            found, chosen = self._with_tighter_limits(found, chosen, least)
        limits = [nan] * len(self.problem.constraints)
        for _ in range(ROUNDS):
            if found.violation[chosen] > 0.0:
                break
            limits, better = self._relaxations(found, chosen)
            if better is None:
                break
            more = (found + self.space.population(better[None])).best(len(found.points))
            more = self._again(more) if self.space.scans else more
            # The smaller search found a better design.
            found, chosen = self._with_worst_conditions(more)
        if least and not (self.space.scans or self.space.slow):
            found, chosen = self._with_counted_yield(found, chosen, least)
        self.space = replace(self.space, constraints=self.problem.constraints)  # original limits
        point = found.points[chosen]
        holds = self._holds(point, least)
        point = rounded(self.space, self._confirmed, self._cheaper(point, holds), holds)
        others = np.delete(np.arange(len(found.points)), chosen)
        found, chosen = self.space.population(point[None]) + found[others], 0
        built = self._built(self.effort.draws).share(point) if self._toleranced else None
        goals, required = self._reached(point, limits)
        feasible = all(d.excess <= 0.0 for d in required) and all(isfinite(r.value) for r in goals)
        if built and least:
            feasible &= built.met >= least * built.of
        if len(self._worse_cases(point, 0)):
            self.warnings.append(
                f"worse conditions were found in each of {ROUNDS} searches; there may be others yet"
            )
        beside = margins(self.space, point) if feasible and not self.space.scans else ()
        self.step()
        drawn = maps(self.space, point, self.effort.resolution)
        self.step()
        parts = alternatives(self.space, point)
        self.progress(self.total, self.total)
        return Design(
            problem=self.problem,
            device=self.problem.study.device_at(self._values(point)),
            values=self._values(point),
            parts=self._parts(point),
            feasible=feasible,
            goals=goals,
            constraints=required,
            front=self._front(found, chosen),
            maps=drawn,
            alternatives=parts,
            margins=beside,
            steady=self._steady(found, beside, least),
            built=built,
            gain=GAIN,
            at_ends=at_ends(self.space, point),
            count=self.space.count,
            seed=self.seed,
            warnings=tuple(self.warnings),
        )

    @property
    def _toleranced(self) -> bool:
        """True if devices are built within tolerances."""
        return bool(self.problem.tables.get("tolerances") and self.problem.constraints)

    def _built(self, draws: int) -> Built:
        """Return devices at random, under the original limits and the present conditions."""
        space = replace(self.space, constraints=self.problem.constraints, goals=())
        return Built.drawn(space, self.problem.tables["tolerances"], draws, self.seed)

    def _with_tighter_limits(
        self, found: Population, chosen: int, least: float
    ) -> tuple[Population, int]:
        """Repeat the search with tighter limits until the yield is reached.

        Each limit is tightened by the scatter of toleranced devices beyond the design, as in
        sequential optimisation and reliability assessment (Du and Chen 2004). Limits that gave the
        yield are relaxed again, halfway to those that did not, where no counted search follows.
        """
        tight = np.zeros(len(self.problem.constraints))
        too_little, part = tight, least
        reached: tuple[Population, int] | None = None
        enough = tight
        for _ in range(ROUNDS):
            point = found.points[[chosen]]
            built = self._built(self.effort.draws)
            excess = built.excess(point)[:, 0]
            if share_of(excess).met >= least * excess.shape[1]:
                reached, enough = (found, chosen), tight
                if not (tight.any() and (self.space.scans or self.space.slow)):
                    break
            else:
                too_little = tight
            if reached:
                tight = 0.5 * (too_little + enough)
            else:
                own = built.space.excess(built.space.numbers(point))[:, 0].max(axis=1)
                tight = reserves(excess, own, part)
                part = 1.0 - 0.7 * (1.0 - part)
            self.space = replace(
                self.space,
                constraints=tuple(
                    replace(d, limit=d.limit - r if d.at_most else d.limit + r)
                    for d, r in zip(self.problem.constraints, tight.tolist(), strict=True)
                ),
            )
            found, chosen = self._with_worst_conditions(self._again(found))
        return reached or (found, chosen)

    def _with_counted_yield(
        self, found: Population, chosen: int, least: float
    ) -> tuple[Population, int]:
        """Search with the yield of each design counted, at conditions that are worst for it."""
        self.space = replace(self.space, constraints=self.problem.constraints)
        self.space = replace(self.space, cases=self._decisive(found.points))
        for attempt in range(TRIALS):
            found, chosen = self._counted(found, chosen, least, wide=not attempt)
            worst = self._worse_cases(found.points[chosen], attempt)
            if not len(worst):
                break
            cases = np.unique(np.concatenate([self.space.cases, worst]), axis=0)
            self.space = replace(self.space, cases=cases)
        return found, chosen

    def _decisive(self, points: Array) -> Array:
        """Return the conditions that are worst for a number of some designs."""
        sequence = qmc.Sobol(points.shape[1], scramble=True, rng=self.seed)
        numbers = self.space.numbers(np.concatenate([points, sequence.random(SPREAD)]))
        bad = np.concatenate([self.space.excess(numbers), self.space.minimised(numbers)])
        found: Array = self.space.cases[np.unique(bad.argmax(axis=2))]
        return found

    def _counted(
        self, found: Population, chosen: int, least: float, *, wide: bool
    ) -> tuple[Population, int]:
        """Search on from a design, with the yield of each design counted.

        Tighter limits give away what a jump of a number allows: devices on its near side need no
        margin. Limits are the original ones here, and all designs are built with the same draws.
        """
        start = found.points[[chosen]]
        near = np.clip(start + NEAR * self.rng.normal(size=(YIELDED, start.shape[1])), 0.0, 1.0)
        sequence = qmc.Sobol(start.shape[1], scramble=True, rng=self.seed)
        points = np.concatenate([start, near, found.points])
        if wide:
            free = self._again(self.space.population(found.points))
            points = np.concatenate([points, free.points[:YIELDED], sequence.random(SPREAD)])
        few, many = self._built(DRAWS), self._built(self.effort.draws)
        required = least

        def counted(points: Array) -> tuple[Array, Array]:
            goals, violation = self.space(points)
            return goals, few.with_yield(points, violation, required)

        def searched(first: Population) -> Population:
            return search(counted, first, generations=GENERATIONS, patience=PATIENCE, rng=self.rng)

        size = YIELDED * len(self.space.goals)
        ends = Population(points, *counted(points))
        if wide:
            far = sequence.random(FAR * start.shape[1])  # not the best ones, which may be alike
            ends = searched(Population(far, *counted(far))) + ends
        proven = ends[:0]
        for _ in range(TRIALS):
            ends = searched(ends.best(size))
            meets = ends[ends.violation <= 0.0]
            front = meets[non_dominated(meets.goals)]
            reached = many.shortfall(front.points, least) <= 0.0
            proven = proven + front[reached]
            lucky = [many.share(point) for point in front.points[~reached][:FEW]]
            if not lucky:
                break
            required += max(least - share.met / share.of for share in lucky)
            ends = Population(ends.points, *counted(ends.points))
        if len(proven.points):
            return proven, self._choose(proven)
        return self.space.population(np.concatenate([start, ends.points])), 0

    # ---- the search ------------------------------------------------------------------------------

    def _screened(self) -> Population:
        """The best of many candidates, improved."""
        first = self._candidates(self.space, self.effort.motions)
        self.step()
        return self._searched(self.space, first, self.effort.generations, self.step)

    def _searched(
        self,
        space: DesignSpace,
        first: Population,
        generations: int,
        progress: Callable[[], None] = lambda: None,
    ) -> Population:
        """The population improved, the best first."""
        patience = self.effort.patience
        if not space.scans:
            return search(
                space,
                first,
                generations=generations,
                patience=patience,
                rng=self.rng,
                progress=progress,
            )
        found = search_scans(
            space,
            size=len(first.points),
            rounds=generations,
            patience=patience,
            rng=self.rng,
            progress=progress,
        )
        while not space.confirm(found.points[[self._choose(found)]]):
            found = space.known().best(len(first.points))
        return found

    def _candidates(self, space: DesignSpace, motions: int) -> Population:
        """The best of candidates that are spread over all that may vary; of few parts each."""
        size = max(self.effort.population, 8)
        count = max(size, motions // len(space.cases))
        combinations = _combinations(space, min(count, ENUMERATED))
        if combinations is not None:
            return space.population(combinations)
        count = 1 << (count - 1).bit_length()  # a Sobol' sequence is even over powers of two
        sequence = qmc.Sobol(len(space.variables), scramble=True, rng=self.seed)
        kept, rough = None, replace(space, coarse=True)
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
            chosen = self._choose(found)
            worst = self._worse_cases(found.points[chosen], attempt)
            if not len(worst):
                return found, chosen
            self.space = replace(
                self.space, cases=np.unique(np.concatenate([self.space.cases, worst]), axis=0)
            )
            found = self._again(found)
        for i in np.argsort(found.goals[:, 0], kind="stable")[:BESIDE]:
            if found.violation[i] <= 0.0 and not len(self._worse_cases(found.points[i], ROUNDS)):
                return found, int(i)
        return found, self._choose(found)

    def _choose(self, found: Population) -> int:
        """The place of the best design."""
        return choose(found, self.space.prices(found.points))

    def _again(self, found: Population) -> Population:
        """The search continued, after conditions or limits have changed."""
        again = self.space.population(found.points)
        return self._searched(self.space, again, max(1, self.effort.generations // 2))

    def _worse_cases(self, point: Array, attempt: int) -> Array:
        """Return conditions that are worse for the design than the present ones."""
        space = self.space
        if not space.conditions:
            return np.empty((0, 0))
        worst = worst_cases(space, point, self.effort.conditions, self.seed + attempt)
        before, now = space.numbers(point[None]), space.numbers(point[None], worst)
        over, excess = (space.excess(n)[:, 0].max(axis=1) for n in (before, now))
        old, new = (space.minimised(n)[:, 0].max(axis=1) for n in (before, now))
        with np.errstate(invalid="ignore"):
            misses = excess > np.maximum(over, 0.0) * (1.0 + WORSE)
            slower = new > old + WORSE * np.abs(old)
        found: Array = worst[np.concatenate([misses, slower])]
        return found

    # ---- cost of the constraints -----------------------------------------------------------------

    def _relaxations(self, found: Population, chosen: int) -> tuple[list[float], Array | None]:
        """Return for each constraint the limit with which the first goal is better by `GAIN`.

        The second value is a better design than the chosen one that meets all constraints, if the
        search came across one.
        """
        space, constraints = self.space, self.space.constraints
        limits: list[float] = []
        for i, constraint in enumerate(constraints):
            relaxed = replace(
                space,
                constraints=(
                    *constraints[:i],
                    *constraints[i + 1 :],
                    *self._no_worse(found.goals[chosen]),
                ),
                goals=(Goal(constraint.name, not constraint.at_most),),
            )
            first = relaxed.population(found.points)
            if not space.scans:  # all that has been scanned is known to that search
                size = len(first.points)
                first = (first + self._candidates(relaxed, self.effort.motions // 8)).best(size)
            result = self._searched(relaxed, first, max(1, self.effort.generations // 2))
            self.step()
            if result.violation[0] > 0.0:
                limits.append(nan)
                continue
            value = float(result.goals[0, 0]) * (1.0 if constraint.at_most else -1.0)
            if constraint.met(np.array([value])).all():
                return [nan] * len(constraints), result.points[0]
            limits.append(value - constraint.limit + self.problem.constraints[i].limit)
        return limits, None

    def _no_worse(self, goals: Array) -> tuple[Constraint, ...]:
        """Return the constraints of a first goal better by `GAIN`, all other goals unchanged."""
        wanted = [goals[0] - GAIN * abs(goals[0]), *goals[1:]]
        return tuple(
            Constraint(goal.name, not goal.maximise, float(-value if goal.maximise else value))
            for goal, value in zip(self.space.goals, wanted, strict=True)
        )

    # ---- digits and margins ----------------------------------------------------------------------

    def _holds(self, point: Array, least: float | None) -> Callable[[Array], bool]:
        """Return a function that verifies a design near another by conditions and yield."""
        meets = self.space(point[None])[1][0] <= 0.0
        sure = meets and not len(self._worse_cases(point, ROUNDS))

        def holds(near: Array) -> bool:
            if sure and len(self._worse_cases(near, ROUNDS)):
                return False
            return (
                not (least and meets)
                or not self._built(self.effort.draws).shortfall(near[None], least)[0]
            )

        return holds

    def _confirmed(self, points: Array) -> tuple[Array, Array]:
        """Goals and violations of designs, with hand speeds over the whole grid."""
        self.space.confirm(points)
        return self.space(points)

    def _cheaper(self, point: Array, holds: Callable[[Array], bool]) -> Array:
        """Return the design with the cheapest parts that change neither goals nor feasibility."""
        space = self.space
        if space.scans or any(goal.name == PRICE for goal in space.goals):
            return point
        for i, variable in enumerate(space.variables):
            if not (variable.catalogue and variable.catalogue.priced):
                continue
            others = np.tile(point, (variable.choices, 1))
            others[:, i] = [variable.part(row) for row in range(variable.choices)]
            goals, violation = space(np.concatenate([point[None], others]))
            alike = (violation[1:] <= 0.0) & (goals[1:] == goals[0]).all(axis=1)
            prices = space.prices(others)
            for row in np.argsort(prices, kind="stable"):
                if prices[row] >= space.prices(point[None])[0]:
                    break
                if alike[row] and holds(others[row]):
                    point = others[row]
        return point

    def _steady(
        self, found: Population, beside: tuple[Margin, ...], least: float | None
    ) -> SteadyDesign | None:
        """Return the best design with a margin, where the chosen one has less."""
        if self.space.slow or all(margin.part >= MARGIN for margin in beside):
            return None
        built = self._built(DRAWS // 4) if least else None
        within = Steady(self.space, MARGIN, built, least)
        point = within.best(found.points, self.rng, self.seed)
        if point is None:
            return None
        goals = within(point[None])[0][0]
        values = self._values(point)
        signs = [-1.0 if goal.maximise else 1.0 for goal in self.space.goals]
        return SteadyDesign(
            MARGIN,
            values,
            self._parts(point),
            self.problem.study.device_at(values),
            tuple(float(sign * goal) for sign, goal in zip(signs, goals, strict=True)),
        )

    # ---- what comes back -------------------------------------------------------------------------

    def _reached(
        self, point: Array, limits: list[float]
    ) -> tuple[tuple[Reached, ...], tuple[ConstraintResult, ...]]:
        """Every goal and every constraint of a design at its worst condition."""
        space = self.space
        worst = worst_cases(space, point, self.effort.conditions, self.seed)
        cases = np.concatenate([space.cases, worst]) if space.conditions else space.cases
        space.confirm(point[None], cases)
        numbers = space.numbers(point[None], cases)
        bad = np.concatenate([space.excess(numbers), space.minimised(numbers)])[:, 0]
        places = bad.argmax(axis=1)

        def value(name: str, place: int) -> float:
            return float(numbers[name][0, place])

        def case(name: str, place: int) -> dict[str, float]:
            return {} if name == PRICE else self._case(cases[place])

        split = len(space.constraints)
        required = tuple(
            ConstraintResult(d, value(d.name, place), case(d.name, place), limit)
            for d, place, limit in zip(space.constraints, places[:split], limits, strict=True)
        )
        goals = tuple(
            Reached(goal, value(goal.name, place), case(goal.name, place))
            for goal, place in zip(space.goals, places[split:], strict=True)
        )
        return goals, required

    def _values(self, point: Array) -> dict[str, float]:
        """Return the value of every key of a design, SI, with the linked keys."""
        found: dict[str, Array] = {}
        for variable, part in zip(self.space.variables, point, strict=True):
            for key, value in variable.columns(np.asarray(part)).items():
                digits = 17 if variable.choices else 15  # the last ones are those of its place
                found[key] = np.asarray(float(f"{float(value):.{digits}g}"))
        study = self.problem.study
        linked = with_links(study.device, found, study.links)
        return {key: float(value) for key, value in linked.items()}

    def _parts(self, point: Array) -> dict[str, str]:
        """The part of each catalogue."""
        pairs = zip(self.space.variables, point, strict=True)
        return {
            v.catalogue.name: v.catalogue.parts[int(v.index(np.asarray(part)))]
            for v, part in pairs
            if v.catalogue
        }

    def _case(self, case: Array) -> dict[str, float]:
        """The value of each condition, SI."""
        found = {}
        for condition, part in zip(self.space.conditions, case, strict=True):
            for key, value in condition.columns(np.asarray(part)).items():
                found[key] = float(value)
        return found

    def _front(self, found: Population, chosen: int) -> Front | None:
        """The designs of which none is better in all goals, at all conditions looked at."""
        if len(self.space.goals) < 2 or found.violation[chosen] > 0.0:
            return None
        dense = spread_cases(self.space.conditions, 4 * self.effort.conditions // 16, self.seed)
        space = replace(self.space, cases=np.concatenate([self.space.cases, dense]))
        all_cases = space.population(found.points)
        keep = np.flatnonzero(all_cases.violation <= WORSE)
        keep = np.union1d(keep, [chosen])
        keep = keep[non_dominated(all_cases.goals[keep]) | (keep == chosen)]
        keep = keep[_distinct(all_cases.goals[keep], int(np.flatnonzero(keep == chosen)[0]))]
        members = all_cases[keep]
        order = np.argsort(members.goals[:, 0], kind="stable")
        signs = np.array([-1.0 if goal.maximise else 1.0 for goal in space.goals])
        columns = space.columns(members.points[order], self.space.cases[:1])
        kept = {key: x for key, x in columns.items() if key not in self._condition_keys}
        place = int(np.flatnonzero(keep[order] == chosen)[0])
        return Front(kept, signs * members.goals[order], place)

    @property
    def _condition_keys(self) -> set[str]:
        return {key for condition in self.space.conditions for key in condition.axes}


def _combinations(space: DesignSpace, most: int) -> Array | None:
    """Return all designs of a space of parts alone, shape (n, k); None of other spaces, or larger.

    The rows are completed to four, which a search needs.
    """
    choices = [variable.choices for variable in space.variables]
    if not choices or not all(choices) or prod(choices) > most:
        return None
    parts = [[v.part(row) for row in range(v.choices)] for v in space.variables]
    found = np.array([*product(*parts)])
    return np.resize(found, (max(4, len(found)), len(choices)))


def _distinct(goals: Array, chosen: int) -> NDArray[np.int64]:
    """Return the designs of a front whose goals differ by more than a thousandth from others.

    The chosen one comes first, and others follow in their order.
    """
    kept = [chosen]
    for i in range(len(goals)):
        near = np.abs(goals[kept] - goals[i]) <= WORSE * np.abs(goals[i])
        if not near.all(axis=1).any():
            kept.append(i)
    return np.array(sorted(kept), np.int64)


def choose(found: Population, prices: Array) -> int:
    """Return the best design; of a front the one nearest to the best of all goals at once.

    Each goal is measured by its range over the front; of equal designs the cheapest is taken. If no
    design meets the constraints, return the design with the smallest violation.
    """
    meets = np.flatnonzero(found.violation <= 0.0)
    if not len(meets):
        return int(found.violation.argmin())
    goals = found.goals[meets]
    front = np.flatnonzero(non_dominated(goals))
    low, high = goals[front].min(axis=0), goals[front].max(axis=0)
    far = ((goals[front] - low) / np.where(high > low, high - low, 1.0)) ** 2
    return int(meets[front[np.lexsort((prices[meets[front]], far.sum(axis=1)))[0]]])
