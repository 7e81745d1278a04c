"""Margins of a design: how far each variable may move before a number of the design jumps."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from pindrive.optimisation.goals import Goal, Limit, Margin, Variable
from pindrive.study.outputs import Constraint

if TYPE_CHECKING:
    from pindrive.optimisation.design_space import DesignSpace

Array = NDArray[np.float64]
WORSE: Final = 0.05
"""Relative worsening of a goal at which a variable has moved too far."""
JUMP: Final = 0.01
"""Relative change of a number, over next to no way, that is a jump."""
PLACES: Final = 48
"""Places of a variable to either side of a design."""
FEW_PLACES: Final = 8
"""Places of a variable where motions are simulated one by one."""
NEAREST: Final = 1e-7
"""Part of a range between a design and the first place beside it."""
NARROW: Final = 1e-10
"""Part of a range to which the end of a way is found."""


def margins(space: DesignSpace, point: Array) -> tuple[Margin, ...]:
    """Return how far each variable with a range may move from a design.

    Args:
        space: Space of the designs, under whose conditions numbers are compared.
        point: The design.
    """
    found = []
    for i, variable in enumerate(space.variables):
        if variable.choices:
            continue
        value = _first(variable, point[i])
        found.append(
            Margin(variable, value, _limit(space, point, i, 0.0), _limit(space, point, i, 1.0))
        )
    return tuple(found)


def _first(variable: Variable, part: float) -> float:
    """The value of the first key of a variable, SI."""
    return float(next(iter(variable.columns(np.array([part])).values()))[0])


def _limit(space: DesignSpace, point: Array, which: int, end: float) -> Limit:
    """The end of the way of one variable towards an end of its range."""
    variable, start = space.variables[which], float(point[which])
    count = FEW_PLACES if space.slow else PLACES
    way = end - start
    if abs(way) <= NEAREST:
        return Limit(_first(variable, end), None, np.nan, False)
    steps = np.sign(way) * np.geomspace(NEAREST, abs(way), count)
    good, bad = start, np.nan
    places = start + steps
    while True:
        wrong = _wrong(space, point, which, places)
        if not wrong.any():
            if np.isnan(bad):
                return Limit(_first(variable, end), None, np.nan, False)
            good = float(places[-1])
        else:
            at = int(wrong.argmax())
            good, bad = (float(places[at - 1]) if at else good), float(places[at])
        if abs(bad - good) <= NARROW:
            break
        places = good + (bad - good) * np.arange(1, count) / count
    return _cause(space, point, which, good, bad)


def _moved(point: Array, which: int, places: Array) -> Array:
    """The design with other values of one variable."""
    points = np.tile(point, (len(places), 1))
    points[:, which] = places
    return points


def _wrong(space: DesignSpace, point: Array, which: int, places: Array) -> NDArray[np.bool_]:
    """Places of a variable at which a goal is worse, or a constraint violated that was met."""
    goals, violation = space(np.concatenate([point[None], _moved(point, which, places)]))
    worse = goals[1:] > goals[0] + WORSE * np.abs(goals[0])
    found: NDArray[np.bool_] = worse.any(axis=1) | (violation[1:] > max(violation[0], 0.0))
    return found


def _cause(space: DesignSpace, point: Array, which: int, good: float, bad: float) -> Limit:
    """The number that ends a way between two places next to each other."""
    three = np.concatenate([point[None], _moved(point, which, np.array([good, bad]))])
    numbers = space.numbers(three)
    excess, goals = space.excess(numbers).max(axis=2), space.minimised(numbers).max(axis=2)
    signs = np.array([-1.0 if goal.maximise else 1.0 for goal in space.goals])
    over = (excess[:, 2] - np.maximum(excess[:, 0], 0.0)) / space.scales
    lost = (goals[:, 2] - goals[:, 0]) / np.maximum(np.abs(goals[:, 0]), 1e-300)
    number: Goal | Constraint
    if len(over) and over.max() > 0.0:
        i = int(over.argmax())
        number, size = space.constraints[i], space.scales[i]
        change, beyond = excess[i, 2] - excess[i, 1], excess[i, 2]
        reached = number.limit + beyond if number.at_most else number.limit - beyond
    else:
        i = int(lost.argmax())
        number, size = space.goals[i], abs(goals[i, 0])
        change, reached = goals[i, 2] - goals[i, 1], signs[i] * goals[i, 2]
    reached = float(reached) if np.isfinite(reached) else np.nan
    return Limit(_first(space.variables[which], good), number, reached, not change <= JUMP * size)
