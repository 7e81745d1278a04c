"""Twelve design problems beside brute force, SciPy and pymoo.

    python3 run.py bench twelve_designs [PROBLEM ...]

Every problem is solved by `optimise`, by brute force, by SciPy's differential evolution with the
limits as a penalty, and by pymoo's differential evolution (of two goals NSGA2) with constraints.
These three share with `optimise` the model alone, `simulate_batch` or a scan: limits, worst
conditions, draws and yields are computed here. Brute force tries `TRIED` designs spread evenly, the
best by their goal first, until one has the yield, and then searches around it.

Each result is judged alike: at `JUDGED` values of each condition, and by a yield of 100 000 draws
of its own seed, designs of a front by `FRONT`. Printed are the goal, the yield, the seconds and the
motions that each took. `apart` is the part by which the goal of `optimise` is behind the best
result that keeps the limits; of two goals the part by which its front dominates less.
"""

from __future__ import annotations

import csv
import sys
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from itertools import product
from math import inf, nan
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pymoo.algorithms.moo.nsga2 import NSGA2
from pymoo.algorithms.soo.nonconvex.de import DE
from pymoo.core.problem import Problem as PymooProblem
from pymoo.optimize import minimize
from scipy import optimize
from scipy.stats import qmc

import pindrive as pd
from pindrive.optimisation import read_problem
from pindrive.study.evaluate import scan_numbers
from pindrive.study.outputs import NUMBERS

Array = NDArray[np.float64]
Columns = dict[str, Array]
EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
TRIED, NEAR, JUDGED, DRAWS = 1 << 15, 1 << 12, 33, 20_000
STEPS = (200, 2000, DRAWS)
"""Draws after which brute force drops a design that fails too often."""
FEW = 500
"""Draws of each design of SciPy and pymoo."""
FRONT = 10_000
"""Draws by which each design of a front is judged."""
SLACK = 1e-9
"""Part of a limit by which rounding may exceed it."""


@dataclass(frozen=True)
class Problem:
    """Design problem in SI, written once for all solvers."""

    ranges: Mapping[str, tuple[float, float]]
    limits: tuple[tuple[str, str, float], ...]
    goals: tuple[tuple[str, str], ...]
    parts: tuple[str, ...] = ()
    conditions: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    tolerances: Mapping[str, float] = field(default_factory=dict)
    least: float = 0.0
    fixed: Mapping[str, float] = field(default_factory=dict)
    scans: bool = False

    @property
    def tables(self) -> dict[str, Any]:
        """The tables of a problem file."""
        specification: dict[str, Any] = {
            name.replace(".", "_"): f"{sign} {limit!r} {NUMBERS[name.replace('.', '_')].unit}"
            for name, sign, limit in self.limits
        }
        if self.least:
            specification["yield"] = f">= {100.0 * self.least:g} %"
        found: dict[str, Any] = {
            "axes": {key: {"uniform": [*ends]} for key, ends in self.ranges.items()},
            "catalogues": {name: str(EXAMPLES / f"{name}s.csv") for name in self.parts},
            "conditions": {key: {"uniform": [*ends]} for key, ends in self.conditions.items()},
            "tolerances": {key: f"{100.0 * part:g} %" for key, part in self.tolerances.items()},
            "specification": specification,
            "goals": {
                which: [
                    name.replace(".", "_") for direction, name in self.goals if direction == which
                ]
                for which in dict(self.goals)
            },
        }
        if self.scans:
            found["page"] = {"grating": ["3 mm"]}
        return {name: table for name, table in found.items() if table}

    @property
    def device(self) -> Any:
        """The device file with what is fixed."""
        if self.scans:
            return read_problem(EXAMPLES / "tactile-reader-problem.toml").study.device
        return pd.load_device(EXAMPLES / "tactile-mouse.toml", dict(self.fixed))


SPEEDS = {"motion.mouse_velocity": (0.05, 0.15)}
USUAL = {"drive.stiffness": 0.05, "drive.damping_ratio": 0.1, "finger.kinetic": 0.2}
SPRING = {
    "drive.stiffness": (30.0, 600.0),
    "drive.damping_ratio": (0.02, 0.6),
    "finger.kinetic": (0.002, 0.03),
}
STROKE = {"drive.damping_ratio": (0.05, 0.5), "motion.displacement": (1e-3, 8e-3)}
SETTLED, PEAK, TROUGH, SWING = (
    f"transient.{name}"
    for name in ("settling_time", "peak_displacement", "trough_displacement", "swing")
)
FAST = (("minimise", SETTLED),)
FAR = (("maximise", PEAK),)
BOUGHT = {
    "parts": ("spring", "damper"),
    "fixed": {"drive.damping": 0.3},
    "tolerances": {"drive.stiffness": 0.1},
}
PROBLEMS = {
    "settling, conditions": Problem(
        SPRING, ((PEAK, ">=", 2.1e-3), (TROUGH, ">=", -1.5e-3)), FAST, conditions=SPEEDS
    ),
    "stroke, 99 %, jump at 58 ms": Problem(
        STROKE, ((SETTLED, "<=", 0.058),), FAR, tolerances=USUAL, least=0.99
    ),
    "stroke, 99 %, three ranges": Problem(
        SPRING, ((SETTLED, "<=", 0.06),), FAR, tolerances=USUAL, least=0.99
    ),
    "stroke, 90 %, conditions": Problem(
        STROKE, ((SETTLED, "<=", 0.06),), FAR, conditions=SPEEDS, tolerances=USUAL, least=0.9
    ),
    "settling, 95 %, conditions": Problem(
        SPRING,
        ((PEAK, ">=", 2.05e-3), (TROUGH, ">=", -1.5e-3)),
        FAST,
        conditions=SPEEDS,
        tolerances=USUAL,
        least=0.95,
    ),
    "settling, 99.9 %": Problem(
        {"drive.stiffness": (30.0, 600.0), "drive.damping_ratio": (0.02, 0.6)},
        ((PEAK, ">=", 2.1e-3),),
        FAST,
        tolerances=USUAL,
        least=0.999,
    ),
    "swing, 99.5 %": Problem(
        SPRING, ((SETTLED, "<=", 0.08),), (("minimise", SWING),), tolerances=USUAL, least=0.995
    ),
    "price, 95 %, conditions": Problem(
        {"drive.mass": (0.005, 0.02), "finger.kinetic": (0.003, 0.02)},
        ((SETTLED, "<=", 0.1), (PEAK, ">=", 2.05e-3)),
        (("minimise", "price"),),
        conditions=SPEEDS,
        least=0.95,
        **BOUGHT,  # type: ignore[arg-type]
    ),
    "price and settling, 90 %": Problem(
        {"drive.mass": (0.005, 0.02)},
        ((PEAK, ">=", 2.05e-3),),
        (("minimise", SETTLED), ("minimise", "price")),
        least=0.9,
        **BOUGHT,  # type: ignore[arg-type]
    ),
    "stroke and settling, 95 %": Problem(
        STROKE,
        ((SETTLED, "<=", 0.09),),
        (("maximise", PEAK), ("minimise", SETTLED)),
        tolerances=USUAL,
        least=0.95,
    ),
    "none feasible": Problem(
        SPRING, ((PEAK, ">=", 3e-3), (SETTLED, "<=", 0.1)), FAST, conditions=SPEEDS
    ),
    "lines": Problem(
        {"drive.stiffness": (100.0, 1000.0), "drive.damping_ratio": (0.1, 1.0)},
        (("worst.overshoot", "<=", 0.02), ("worst.stroke", ">=", 7e-4)),
        (("minimise", "worst.smear_time"),),
        scans=True,
    ),
}


# ---- the model -----------------------------------------------------------------------------------


class Model:
    """Numbers, limits and yields of the designs of a problem, points of the unit cube."""

    def __init__(self, problem: Problem, conditions: int, draws: int, seed: int) -> None:
        self.problem, self.file, self.motions = problem, problem.device, 0
        if problem.scans:
            self.study = read_problem(EXAMPLES / "tactile-reader-problem.toml").study
        self.catalogues = [_rows(EXAMPLES / f"{name}s.csv") for name in problem.parts]
        axes = [np.linspace(*ends, conditions) for ends in problem.conditions.values()]
        grid = np.array([*product(*axes)], np.float64)
        self.cases = dict(zip(problem.conditions, grid.T, strict=True))
        rng = np.random.default_rng(seed)
        self.factors = {
            key: 1.0 + part * rng.uniform(-1.0, 1.0, draws)
            for key, part in problem.tolerances.items()
        }

    @property
    def size(self) -> int:
        """Number of variables."""
        return len(self.problem.ranges) + len(self.catalogues)

    def columns(self, points: Array) -> Columns:
        """The values of keys, and the price of the parts."""
        found = {}
        for (key, (low, high)), part in zip(self.problem.ranges.items(), points.T, strict=False):
            found[key] = low + (high - low) * part
        prices = np.zeros(len(points))
        for rows, part in zip(self.catalogues, points.T[len(found) :], strict=True):
            row = np.clip((part * len(rows)).astype(int), 0, len(rows) - 1)
            for key in rows[0]:
                values = np.array([each[key] for each in rows])[row]
                if key == "price":
                    prices = prices + values
                else:
                    found[key] = values
        return {**found, "price": prices}

    def numbers(self, points: Array, draws: slice | None = None) -> Columns:
        """All numbers, shape (designs, cases, draws); without draws one, the design itself."""
        problem, columns = self.problem, self.columns(points)
        names = {name for name, *_ in problem.limits} | {name for _, name in problem.goals}
        if problem.scans:
            rows = [
                scan_numbers(self.study, {key: float(columns[key][i]) for key in problem.ranges})
                for i in range(len(points))
            ]
            self.motions += len(rows)
            return {n: np.array([row[n] for row in rows])[:, None, None] for n in names}
        keys = {key: values[:, None, None] for key, values in columns.items() if key != "price"}
        keys |= {key: values[None, :, None] for key, values in self.cases.items()}
        if draws is not None:
            for key, factors in self.factors.items():
                own = keys.get(key, self.file.values()[key])
                keys[key] = own * factors[draws]
        keys = self._followed(keys)
        done = pd.simulate_batch(
            self.file.drive,
            self.file.release,
            outputs=[name for name in names if name != "price"] or [PEAK],
            **keys,  # type: ignore[arg-type]
        )
        self.motions += int(np.prod(done.status.shape))
        cases = len(next(iter(self.cases.values()), [0]))
        shape = (len(points), cases, 1 if draws is None else draws.stop - draws.start)
        found = {
            name: np.broadcast_to(_whole(done[name.replace(".", "_")].values, shape), shape)
            for name in names
            if name != "price"
        }
        if "price" in names:
            found["price"] = np.broadcast_to(columns["price"][:, None, None], shape)
        return found

    def _followed(self, keys: Columns) -> Columns:
        """Keys that follow: a damping by its ratio, static friction by kinetic friction."""
        drive = self.file.drive
        if "drive.damping_ratio" in keys:
            stiffness = keys.get("drive.stiffness", np.array(drive.stiffness))
            mass = keys.get("drive.mass", np.array(drive.mass))
            ratio = keys.pop("drive.damping_ratio")
            keys["drive.damping"] = 2.0 * ratio * np.sqrt(mass * stiffness)
        if "finger.kinetic" in keys:
            part = drive.finger.static_friction / drive.finger.kinetic
            keys["finger.static"] = part * keys["finger.kinetic"]
        return keys

    def excess(self, numbers: Columns) -> Array:
        """Sum of what is beyond each limit, parts of it; shape (designs, cases, draws)."""
        total = np.zeros(())
        for name, sign, limit in self.problem.limits:
            value = numbers[name]
            over = (value - limit if sign == "<=" else limit - value) / abs(limit)
            total = total + np.where(np.isnan(over), 1e3, np.maximum(over - SLACK, 0.0))
        return np.asarray(total)

    def goals(self, numbers: Columns) -> Array:
        """Worst goals over all cases, the least is best, shape (designs, goals)."""
        found = []
        for which, name in self.problem.goals:
            value = -numbers[name] if which == "maximise" else numbers[name]
            found.append(np.where(np.isnan(value), inf, value)[:, :, 0].max(axis=1))
        return np.stack(found, axis=1)

    def nominal(self, points: Array) -> tuple[Array, Array]:
        """Goals (n, g) and violations (n,) of designs as they are."""
        goals, violation = [], []
        for begin in range(0, len(points), 1 << 14):
            numbers = self.numbers(points[begin : begin + (1 << 14)])
            goals.append(self.goals(numbers))
            worst = np.zeros(len(goals[-1]))
            for name, sign, limit in self.problem.limits:
                value = numbers[name][:, :, 0]
                over = (value - limit if sign == "<=" else limit - value) / abs(limit)
                worst += np.where(np.isnan(over), 1e3, np.maximum(over - SLACK, 0.0)).max(axis=1)
            violation.append(worst)
        return np.concatenate(goals), np.concatenate(violation)

    def share(self, point: Array, draws: slice) -> float:
        """Part of the devices built that meets all limits at all cases."""
        return float((self.excess(self.numbers(point[None], draws)) <= 0.0).all(axis=1).mean())

    def yields(self, point: Array) -> bool:
        """Whether a design has the yield, by few draws first."""
        least = self.problem.least
        if not least:
            return True
        return all(
            self.share(point, slice(0, draws)) >= least - (0.0 if draws == DRAWS else 2e-2)
            for draws in STEPS
        )

    def penalised(self, points: Array) -> tuple[Array, Array]:
        """Goals and violations, with what the yield lacks."""
        goals, violation = self.nominal(points)
        for i in np.flatnonzero(violation <= 0.0) if self.problem.least else ():
            lacks = self.problem.least - self.share(points[i], slice(0, FEW))
            violation[i] = max(0.0, lacks)
        return goals, violation


def _whole(values: Array, shape: tuple[int, int, int]) -> Array:
    """Values as (designs, cases, draws), of a batch in which some do not vary."""
    return values.reshape((1,) * (3 - values.ndim) + values.shape) if values.ndim < 3 else values


def _rows(path: Path) -> list[dict[str, float]]:
    """Parts of a catalogue: keys without units, and the price."""
    with path.open(encoding="utf-8") as file:
        return [
            {k.split(" [")[0]: float(v) for k, v in row.items() if k != "part"}
            for row in csv.DictReader(line for line in file if not line.startswith("#"))
        ]


# ---- solvers -------------------------------------------------------------------------------------


def brute(model: Model) -> Array:
    """Best designs of many, and of many around them; of two goals the front."""
    points = qmc.Sobol(model.size, rng=5).random(TRIED if not model.problem.scans else 1 << 9)
    found = _first_with_yield(model, points)
    for width in (0.05, 0.01, 0.002) if len(found) else ():
        rng = np.random.default_rng(int(1e4 * width))
        each = max(1, (NEAR if not model.problem.scans else 64) // len(found))
        near = np.repeat(found, each, axis=0)
        ranges = len(model.problem.ranges)
        near[:, :ranges] += width * rng.uniform(-1.0, 1.0, (len(near), ranges))
        near = np.clip(near, 0.0, 1.0)
        found = _first_with_yield(model, np.concatenate([found, near]), found)
    return found


def _first_with_yield(model: Model, points: Array, sure: Array | None = None) -> Array:
    """Best designs, by their goals, that keep the limits and the yield."""
    goals, violation = model.nominal(points)
    order = [i for i in np.lexsort(goals.T[::-1]) if violation[i] <= 0.0]
    known = set() if sure is None else {point.tobytes() for point in sure}
    if not order:
        return points[[int(violation.argmin())]] if sure is None else sure
    kept: list[int] = []
    least = inf
    for i in order:
        if goals.shape[1] > 1 and goals[i, 1] >= least:
            continue
        if points[i].tobytes() in known or model.yields(points[i]):
            kept.append(i)
            if goals.shape[1] == 1:
                break
            least = goals[i, 1] - 1e-3 * abs(goals[i, 1])
    return points[kept]


def by_scipy(model: Model) -> Array:
    """Best design of SciPy's differential evolution, the limits as a penalty."""

    def cost(parts: Array) -> Array:
        goals, violation = model.penalised(np.atleast_2d(parts.T))
        scale = np.abs(goals[np.isfinite(goals)]).max(initial=1e-9)
        return np.where(violation > 0.0, 10.0 * scale * (1.0 + violation), goals[:, 0])

    found = optimize.differential_evolution(
        cost,
        [(0.0, 1.0)] * model.size,
        popsize=15,
        maxiter=60 if not model.problem.scans else 20,
        tol=1e-8,
        polish=False,
        vectorized=True,
        updating="deferred",
        rng=np.random.default_rng(1),
    )
    return np.asarray(found.x)[None]


def by_pymoo(model: Model) -> Array:
    """Best design, or the front, of pymoo."""

    class Asked(PymooProblem):  # type: ignore[misc]
        def __init__(self) -> None:
            count = len(model.problem.goals)
            super().__init__(n_var=model.size, n_obj=count, n_ieq_constr=1, xl=0.0, xu=1.0)

        def _evaluate(self, x: Array, out: dict[str, Array], *_: Any, **__: Any) -> None:
            goals, violation = model.penalised(x)
            out["F"], out["G"] = np.minimum(goals, 1e9), violation[:, None]

    size = 15 * model.size
    kind = NSGA2(pop_size=3 * size) if len(model.problem.goals) > 1 else DE(pop_size=size)
    rounds = ("n_gen", 60 if not model.problem.scans else 20)
    found = minimize(Asked(), kind, rounds, seed=1)
    if found.X is None:
        population = found.pop.get("X")
        return np.asarray(population[[found.pop.get("CV").ravel().argmin()]], np.float64)
    return np.atleast_2d(np.asarray(found.X, np.float64))


def by_pindrive(problem: Problem) -> tuple[pd.optimisation.Design, float]:
    """Design of `optimise`, and the seconds that it took."""
    began = time.perf_counter()
    found = pd.optimise(problem.device, problem.tables)
    return found, time.perf_counter() - began


def point_of(model: Model, values: Mapping[str, float], parts: Mapping[str, str]) -> Array:
    """Point of a design of `optimise`."""
    found = [
        (values[key] - low) / (high - low) for key, (low, high) in model.problem.ranges.items()
    ]
    for name, rows in zip(model.problem.parts, model.catalogues, strict=True):
        with (EXAMPLES / f"{name}s.csv").open(encoding="utf-8") as file:
            names = [row["part"] for row in csv.DictReader(x for x in file if x[0] != "#")]
        found.append((names.index(parts[name]) + 0.5) / len(rows))
    point: Array = np.clip(np.array(found), 0.0, 1.0)
    return point


# ---- the table -----------------------------------------------------------------------------------


def judged(judge: Model, points: Array) -> tuple[Array, Array, Array]:
    """Goals, violations and yields at many conditions, with many draws of their own."""
    goals, violation = judge.nominal(points)
    shares = np.full(len(points), nan)
    if judge.problem.least:
        every = range(0, 5 * DRAWS if len(points) == 1 else FRONT, 2000)
        for i, point in enumerate(points):
            shares[i] = np.mean([judge.share(point, slice(b, b + 2000)) for b in every])
    return goals, violation, shares


def row_of(name: str, problem: Problem) -> float:
    """Solve one problem by all, print a row of each, and return how far `optimise` is behind."""
    # conditions between those of the search, fewer where each has many draws
    judge = Model(problem, 9 if problem.least else JUDGED, 5 * DRAWS, seed=99)
    design, seconds = by_pindrive(problem)
    runs: dict[str, tuple[Array, float, int]] = {}
    chosen = point_of(judge, design.values, design.parts)[None]
    if design.front is not None:
        columns = design.front.columns
        chosen = np.stack([_at(judge, columns, i) for i in range(len(design.front.goals))])
    runs["pindrive"] = chosen, seconds, design.count.motions + design.count.scans
    solvers: dict[str, Callable[[Model], Array]] = {"brute force": brute, "pymoo": by_pymoo}
    if len(problem.goals) == 1:
        solvers["SciPy"] = by_scipy
    for solver, solve in solvers.items():
        model = Model(problem, 5, DRAWS, seed=7)
        began = time.perf_counter()
        points = solve(model)
        runs[solver] = points, time.perf_counter() - began, model.motions
    print(name)
    best = {}
    for solver, (points, took, motions) in runs.items():
        goals, violation, shares = judged(judge, points)
        noise = 3.0 * np.sqrt(problem.least * (1.0 - problem.least) / DRAWS)  # of its own draws
        keeps = (violation <= 1e-3) & ~(shares < problem.least - noise)
        best[solver] = goals[keeps]
        first = int(goals[:, 0].argmin())
        words = (
            f"    {solver:12}{len(points):3}  goal {goals[first]}  violation {violation.max():.2g}"
            f"  yield {100 * np.nanmin(shares) if problem.least else nan:.2f} %"
            f"  keeps {keeps.sum()}  {took:.1f} s  {motions} motions"
        )
        print(words, flush=True)
    behind = behindhand(best, problem)
    if not any(len(goals) for goals in best.values()):
        own, other = (judge.nominal(runs[s][0])[1].min() for s in ("pindrive", "brute force"))
        behind = own / other - 1.0
        print(f"    none feasible: {design.closest}; violation {own:.5f}, brute force {other:.5f}")
    print(f"    apart {100 * behind:.2f} %; {design!r}", flush=True)
    return behind


def _at(model: Model, columns: Mapping[str, Array], i: int) -> Array:
    """Point of a design of a front."""
    problem = model.problem
    found = [(columns[k][i] - low) / (high - low) for k, (low, high) in problem.ranges.items()]
    for rows in model.catalogues:
        keys = [key for key in rows[0] if key != "price"]
        row = int(np.argmin([abs(each[keys[0]] - columns[keys[0]][i]) for each in rows]))
        found.append((row + 0.5) / len(rows))
    point: Array = np.clip(np.array(found), 0.0, 1.0)
    return point


def behindhand(best: Mapping[str, Array], problem: Problem) -> float:
    """Part by which `optimise` is behind the best of the others; negative: ahead."""
    own, others = best["pindrive"], [goals for s, goals in best.items() if s != "pindrive"]
    every = np.concatenate([*others, np.empty((0, len(problem.goals)))])
    if not len(every) or not len(own):
        return nan if not len(own) and not len(every) else (inf if not len(own) else -inf)
    if len(problem.goals) == 1:
        return float((own.min() - every.min()) / abs(every.min()))
    reference = np.concatenate([own, every]).max(axis=0)
    best_other = max(dominated(goals, reference) for goals in others if len(goals))
    return 1.0 - dominated(own, reference) / best_other


def dominated(front: Array, reference: Array) -> float:
    """Area of goals that a front is better than, up to a reference (the hypervolume)."""
    area, least = 0.0, reference[1]
    for first, second in front[np.lexsort(front.T[::-1])]:
        if second < least:
            area += (reference[0] - first) * (least - second)
            least = second
    return float(area)


def main() -> None:
    """All problems, or those whose name has one of the given words."""
    asked = [n for n in PROBLEMS if not sys.argv[1:] or any(word in n for word in sys.argv[1:])]
    behind = {name: row_of(name, PROBLEMS[name]) for name in asked}
    print("\n".join(f"{name:32}{100 * part:8.2f} %" for name, part in behind.items()))


if __name__ == "__main__":
    main()
