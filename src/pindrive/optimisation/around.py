"""Neighbourhood of a design: maps of the feasible region, other parts, ends of ranges."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from pindrive.optimisation.goals import Variable
from pindrive.optimisation.results import Alternative, Map

if TYPE_CHECKING:
    from pindrive.optimisation.design_space import DesignSpace

Array = NDArray[np.float64]
MAPPED: Final = 3
"""Variables of which each pair is drawn; of scans two."""
NEAREST: Final = 5
"""Parts that are compared with the chosen one."""
_END: Final = 2e-3
"""Part of a range that is its end."""


def maps(space: DesignSpace, point: Array, resolution: int) -> tuple[Map, ...]:
    """The first goal, and where all constraints are met, over pairs of variables.

    Args:
        space: what designs are worth.
        point: the design, which is one of the places.
        resolution: places along an axis that is a range; 0: no map.
    """
    if not resolution:
        return ()
    space = replace(space, coarse=True)
    found = []
    count = 2 if space.scans else MAPPED
    for i, j in combinations(range(min(count, len(point))), 2):
        one, other = space.variables[i], space.variables[j]
        x, y = (_parts(v, resolution, float(point[k])) for v, k in ((one, i), (other, j)))
        across, up = np.meshgrid(x, y)
        points = np.tile(point, (across.size, 1))
        points[:, i], points[:, j] = across.ravel(), up.ravel()
        goals, violation = space(points)
        first = goals[:, 0].reshape(across.shape)
        first = np.where(np.isinf(first), np.nan, first)
        along = tuple(_first(v, parts) for v, parts in ((one, x), (other, y)))
        here = tuple(float(_first(v, point[[k]])[0]) for v, k in ((one, i), (other, j)))
        found.append(
            Map(
                (one, other),
                (along[0], along[1]),
                -first if space.goals[0].maximise else first,
                (violation <= 0.0).reshape(across.shape),
                (here[0], here[1]),
            )
        )
    return tuple(found)


def _parts(variable: Variable, resolution: int, chosen: float) -> Array:
    """Return the map's values of a variable; the design replaces the nearest one."""
    if not variable.choices:
        parts = np.linspace(0.0, 1.0, resolution)
        parts[np.abs(parts - chosen).argmin()] = chosen
        return parts
    row = variable.index(np.array([chosen]))[0]
    rows = np.linspace(0, variable.choices - 1, min(variable.choices, resolution)).round()
    rows[np.abs(rows - row).argmin()] = row
    return (np.unique(rows) + 0.5) / variable.choices


def _first(variable: Variable, parts: Array) -> Array:
    """The values of its first key."""
    return next(iter(variable.columns(parts).values()))


def alternatives(space: DesignSpace, point: Array) -> tuple[Alternative, ...]:
    """The design with other parts of its catalogues, the nearest by their values first."""
    found = []
    for i, variable in enumerate(space.variables):
        catalogue = variable.catalogue
        if catalogue is None:
            continue
        chosen = int(variable.index(point[[i]])[0])
        rows = catalogue.nearest(chosen, NEAREST)
        if not rows:
            continue
        points = np.tile(point, (len(rows), 1))
        points[:, i] = [variable.part(row) for row in rows]
        numbers = space.numbers(points)
        excess = space.excess(numbers).max(axis=2)
        goals = space.minimised(numbers).max(axis=2)
        for place, row in enumerate(rows):
            violations = [
                (constraint, float(over))
                for constraint, over in zip(space.constraints, excess[:, place], strict=True)
                if over > 0.0
            ]
            found.append(
                Alternative(
                    catalogue.name,
                    catalogue.parts[row],
                    {key: values[row] for key, values in catalogue.values.items()},
                    catalogue.prices[row],
                    tuple(
                        float(-value if goal.maximise else value)
                        for goal, value in zip(space.goals, goals[:, place], strict=True)
                    ),
                    tuple(violations),
                )
            )
    return tuple(found)


def at_ends(space: DesignSpace, point: Array) -> tuple[tuple[str, str], ...]:
    """The variables that a design has at an end of their range, and which end."""
    return tuple(
        (variable.name, "lower" if part < 0.5 else "upper")
        for variable, part in zip(space.variables, point, strict=True)
        if not variable.choices and not _END < part < 1.0 - _END
    )
