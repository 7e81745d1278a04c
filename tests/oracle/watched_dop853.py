"""SciPy's DOP853 with watches: functions that are positive until something happens."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import DOP853
from scipy.optimize import brentq, minimize_scalar

RTOL = 1e-12
CLEAR = 1e-9  # of its scale: what a watch left at its zero must reach to be looked at again
GRID = np.array([0.0, 1e-4, 1e-3, 1e-2, 0.05, 0.2, 0.4, 0.6, 0.8, 1.0])  # of a step

State = NDArray[np.float64]  # x, v and stretch of the skin
Function = Callable[[float, State], Any]


@dataclass
class Watch:
    """A function that is positive until (contact, kind) happens; `left`: 0 at the start."""

    contact: str
    kind: str
    value: Function
    scale: float
    left: bool = False


# (rhs, watches, t, y, end, longest step, tolerances, sample times) -> t, y, what stops it, samples
Answer = tuple[float, State, Watch | None, list[State]]
Integrator = Callable[
    [Function, list[Watch], float, State, float, float, State, list[float]], Answer
]


def dop853(
    rhs: Function,
    watches: list[Watch],
    t: float,
    y: State,
    end: float,
    longest: float,
    atol: State,
    samples: list[float],
) -> Answer:
    """Steps of DOP853; the watches are looked at in and between them through its dense output."""
    solver = DOP853(rhs, t, y, end, rtol=RTOL, atol=atol, max_step=longest)
    asleep = {id(w) for w in watches if w.left}
    rows: list[State] = []
    while True:
        solver.step()
        assert solver.status != "failed"
        begin, dense = float(solver.t_old), solver.dense_output()
        grid = begin + GRID * (solver.t - begin)
        states = [dense(u) for u in grid]
        first: tuple[float, Watch] | None = None
        for watch in watches:
            values = [watch.value(u, s) for u, s in zip(grid, states, strict=True)]
            zero = _first_zero(watch, dense, grid, values, asleep)
            if zero is not None and (first is None or zero < first[0]):
                first = (zero, watch)
        stop = first[0] if first else float(solver.t)
        rows += [dense(s) for s in samples if begin <= s < stop]
        if first:
            return stop, dense(stop), first[1], rows
        if solver.status == "finished":
            return end, solver.y, None, rows


def _first_zero(
    watch: Watch,
    dense: Callable[[float], State],
    grid: State,
    values: list[float],
    asleep: set[int],
) -> float | None:
    def value(u: float) -> float:
        return float(watch.value(u, dense(u)))

    for i in range(len(grid)):
        if id(watch) in asleep:
            if values[i] > CLEAR * watch.scale:
                asleep.remove(id(watch))
        elif values[i] < 0 and i > 0:
            assert values[i - 1] >= 0
            return float(brentq(value, grid[i - 1], grid[i], xtol=1e-17))
        elif 0 < i < len(grid) - 1 and values[i - 1] > values[i] < values[i + 1]:
            dip = minimize_scalar(value, bounds=(grid[i - 1], grid[i + 1]), method="bounded")
            if dip.fun < 0:
                return float(brentq(value, grid[i - 1], dip.x, xtol=1e-17))
    return None
