"""Designs beside brute force: `run.py bench design`.

    python3 run.py bench design [paper|parts|reader ...]

- `paper`: examples/tactile-mouse-problem.toml, without its tolerances, beside a grid of 60 values
  of each variable at nine hand speeds, and beside SciPy's vectorised differential evolution with
  the constraints as a penalty;
- `parts`: examples/catalogue-problem.toml without the yield, beside a grid of all parts;
- `reader`: examples/tactile-reader-problem.toml beside grids of `LEVELS` values of each variable.
  All devices of a grid are scanned. The hand speed is computed of those that meet the constraints.
  The number of scans is that of the devices plus the trials of hand speeds, whose mean is estimated
  from `SAMPLE` devices.
"""

from __future__ import annotations

import sys
import time
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import optimize

import pindrive as pd
from pindrive.optimisation import Design, DesignProblem, line_speed, read_problem
from pindrive.optimisation.design_space import DesignSpace, worst_cases
from pindrive.optimisation.effort import Count
from pindrive.optimisation.goals import Goal
from pindrive.optimisation.line_speed import speeds
from pindrive.optimisation.problem import problem_of
from pindrive.optimisation.search import Population, non_dominated

Array = NDArray[np.float64]
EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
LEVELS = (4, 6, 8)
SAMPLE = 24


def tables_of(name: str) -> tuple[pd.files.DeviceFile, dict[str, Any]]:  # type: ignore[name-defined]
    """The device of an example design problem, and its tables; catalogues by their whole path."""
    path = EXAMPLES / name
    tables = tomllib.loads(path.read_text("utf-8"))
    problem = read_problem(path)
    for kind, file in tables.get("catalogues", {}).items():
        tables["catalogues"][kind] = str(EXAMPLES / file)
    tables.get("specification", {}).pop("yield", None)
    for key in ("tolerances", "base", "set"):
        tables.pop(key, None)
    return problem.study.device, tables


def timed(device: Any, tables: dict[str, Any]) -> Design:
    """A design, and what it took, printed."""
    begun = time.perf_counter()
    found = pd.optimise(device, tables)
    seconds = time.perf_counter() - begun
    print(f"  found      {found}")
    count = found.count
    print(f"             {seconds:.1f} s, {count.motions} motions, {count.scans} scans")
    return found


def space_of(problem: DesignProblem, cases: Array) -> DesignSpace:
    """Goals and violations of designs at these conditions."""
    return DesignSpace(
        study=problem.study,
        variables=problem.variables,
        conditions=problem.conditions,
        cases=cases,
        links=problem.study.links,
        constraints=problem.constraints,
        goals=problem.goals,
        line_speeds=speeds,
        count=Count(),
    )


def grid_of(problem: DesignProblem, levels: int, cases: Array) -> tuple[Population, DesignSpace]:
    """All designs of a grid."""
    space = space_of(problem, cases)
    axes = [
        (np.arange(v.choices) + 0.5) / v.choices if v.choices else np.linspace(0.0, 1.0, levels)
        for v in problem.variables
    ]
    points = np.stack([x.ravel() for x in np.meshgrid(*axes)], axis=1)
    return space.population(points), space


def paper() -> None:
    """One goal over three ranges."""
    device, tables = tables_of("tactile-mouse-problem.toml")
    found = timed(device, tables)
    problem = problem_of(device, tables)
    cases = np.linspace(0.0, 1.0, 9)[:, None]
    begun = time.perf_counter()
    grid, space = grid_of(problem, 60, cases)
    best = grid.goals[grid.violation <= 0.0].min()
    seconds = time.perf_counter() - begun
    print(f"  grid       {1e3 * best:.3f} ms, {seconds:.1f} s, {space.count.motions} motions")
    space = space_of(problem, np.array([[0.0], [0.5], [1.0]]))

    def penalised(parts: Array) -> Array:
        goals, violation = space(np.atleast_2d(parts.T))
        return np.where(violation > 0.0, 1.0 + violation, np.minimum(goals[:, 0], 1.0))

    begun = time.perf_counter()
    result = optimize.differential_evolution(
        penalised,
        [(0.0, 1.0)] * len(problem.variables),
        popsize=43,
        maxiter=400,
        tol=1e-8,
        polish=False,
        vectorized=True,
        updating="deferred",
        rng=np.random.default_rng(1),
    )
    seconds = time.perf_counter() - begun
    worst = worst_cases(space, np.asarray(result.x), 1024, 1)
    _, missed = space.worth(space.numbers(result.x[None], worst))
    print(
        f"  SciPy      {1e3 * result.fun:.3f} ms, {seconds:.1f} s, {space.count.motions} "
        f"motions; between its conditions it misses by {missed[0]:.2g}"
    )
    print(
        f"  the design is {'no worse' if found.goals[0].value <= best else 'WORSE'} than the grid"
    )


def parts() -> None:
    """Two goals over two catalogues and two ranges."""
    device, tables = tables_of("catalogue-problem.toml")
    device = pd.load_device(EXAMPLES / "tactile-mouse.toml", {"drive.damping": 0.3})
    found = timed(device, tables)
    problem = problem_of(device, tables)
    grid, space = grid_of(problem, 40, np.linspace(0.0, 1.0, 5)[:, None])
    goals = grid.goals[grid.violation <= 0.0]
    goals = goals[np.unique(goals, axis=0, return_index=True)[1]]
    cheapest = [goals[goals[:, 1] == price].min(axis=0) for price in np.unique(goals[:, 1])]
    front = np.array(cheapest)
    front = front[non_dominated(front)]
    print(f"  grid       a front of {len(front)} designs, {space.count.motions} motions")
    assert found.front is not None
    worse = 0.0
    for time_, price in front:
        own = found.front.goals[found.front.goals[:, 1] <= price + 1e-9, 0]
        worse = max(worse, own.min() / time_ - 1.0 if len(own) else np.inf)
    print(f"  no design of the grid's front is better than the design's by more than {worse:.2%}")


def reader() -> None:
    """A whole device, by scans."""
    device, tables = tables_of("tactile-reader-problem.toml")
    found = timed(device, tables)
    reached = found.goals[0].value
    problem = problem_of(device, tables)
    ((pitch, _),) = problem.study.page.page.grating  # type: ignore[union-attr, misc]
    for levels in LEVELS:
        meets, points = grid_that_meets(problem, levels)
        best = 0.0
        for point in points:
            climb = climb_of(problem, point, pitch)
            if climb.distinct(max(best, line_speed.SLOWEST)):
                best = max(best, climb.first_interval())
        chosen = np.random.default_rng(1).choice(len(points), SAMPLE)
        climbs = [climb_of(problem, points[i], pitch) for i in chosen]
        for climb in climbs:
            climb.first_interval()
        each = float(np.mean([len(climb.trials) for climb in climbs]))
        scans = levels**4 + meets * each
        print(
            f"  grid of {levels}  {levels**4} devices, {meets} feasible: {1e3 * best:.1f} "
            f"mm/s, {scans:.0f} scans, {scans / found.count.scans:.1f} times as many; the design "
            f"has {reached / best:.3f} times its speed",
            flush=True,
        )


def grid_that_meets(problem: DesignProblem, levels: int) -> tuple[int, list[dict[str, float]]]:
    """The devices of a grid that meet the constraints, as the values of keys."""
    cases = np.zeros((1, 0))
    space = replace(space_of(problem, cases), goals=(Goal(problem.constraints[0].name, False),))
    axes = [np.linspace(0.0, 1.0, levels)] * len(problem.variables)
    points = np.stack([x.ravel() for x in np.meshgrid(*axes)], axis=1)
    _, violation = space(points)
    kept = points[violation <= 0.0]
    columns = space.columns(kept, cases)
    rows = [{key: float(x[i]) for key, x in columns.items()} for i in range(len(kept))]
    return len(kept), rows


def climb_of(problem: DesignProblem, at: dict[str, float], pitch: float) -> line_speed.Climb:
    """The way to the hand speed of a device."""
    file = problem.study.device_at(at)
    return line_speed.Climb(file, pitch)


def main() -> None:
    """All benchmarks, or the named ones."""
    kinds = {"paper": paper, "parts": parts, "reader": reader}
    for name in sys.argv[1:] or kinds:
        print(name)
        kinds[name]()


if __name__ == "__main__":
    main()
