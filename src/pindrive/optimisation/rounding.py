"""Designs with few digits: what is printed of a design has the goals that are printed."""

from __future__ import annotations

from collections.abc import Callable
from itertools import product
from math import ceil, floor, log10
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from pindrive.files.keys import NUMERIC_KEYS

if TYPE_CHECKING:
    from pindrive.optimisation.design_space import DesignSpace
    from pindrive.optimisation.goals import Variable
    from pindrive.optimisation.search import Function

Array = NDArray[np.float64]
DIGITS: Final = (3, 4, 5, 6, 8, 10, 12)
"""Significant digits that are tried, in display units."""
KEPT: Final = 1e-3
"""Relative worsening of a goal that rounding may cost."""
COMBINATIONS: Final = 64
"""Largest number of designs, each value rounded up or down, of a number of digits."""
TRIED: Final = 4
"""Designs that are verified, of a number of digits."""


def rounded(
    space: DesignSpace, worth: Function, point: Array, holds: Callable[[Array], bool]
) -> Array:
    """Return the design near another whose values have the fewest digits.

    No goal is worse by more than a thousandth, nor the violation, which is 0 where the constraints
    are met. The other itself is returned where there is none.

    Args:
        space: Space of the designs.
        worth: Function of designs that gives their goals and violations.
        point: Design to be rounded.
        holds: Function of a design that verifies it further.
    """
    alone = space.scans or space.slow
    goals, least = worth(point[None])
    for digits in DIGITS:
        near = _near(space, point, digits, 1 if alone else COMBINATIONS)
        found, violation = worth(near)
        kept = violation <= (1.0 + KEPT) * least
        if not least[0]:
            kept &= (found <= goals + KEPT * np.abs(goals)).all(axis=1)
        best = np.flatnonzero(kept)[np.argsort(found[kept, 0], kind="stable")]
        for i in best[:TRIED]:
            if holds(near[i]):
                return np.asarray(near[i])
    return point


def _near(space: DesignSpace, point: Array, digits: int, most: int) -> Array:
    """Designs with values rounded up or down; each to the nearest where these are too many."""
    choices = [
        [float(part)] if variable.choices else _places(variable, float(part), digits)
        for variable, part in zip(space.variables, point, strict=True)
    ]
    if 2 ** sum(len(each) > 1 for each in choices) > most:
        choices = [
            [min(each, key=lambda at, part=part: abs(at - part))]  # type: ignore[misc]
            for each, part in zip(choices, point, strict=True)
        ]
    return np.array([*product(*choices)], np.float64)


def _places(variable: Variable, part: float, digits: int) -> list[float]:
    """Return the places of the nearest values of a number of digits, within the range."""
    ((key, at),) = variable.columns(np.asarray(part)).items()
    scale = NUMERIC_KEYS[key].display_scale
    value = scale * float(at)
    if value == 0.0 or part in (0.0, 1.0):
        return [part]
    step = digits - 1 - floor(log10(abs(value)))
    sides = (round(side(value * 10.0**step) * 10.0**-step, max(step, 0)) for side in (floor, ceil))
    parts = (variable.place(side / scale) for side in sides)
    return sorted({min(max(at, 0.0), 1.0) for at in parts})
