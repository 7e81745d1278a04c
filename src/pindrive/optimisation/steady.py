"""Designs whose variables may all move by a margin: the worst place within it counts."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from pindrive.lazy import qmc
from pindrive.optimisation.rounding import rounded
from pindrive.optimisation.search import Population, search
from pindrive.optimisation.tolerance import Built

if TYPE_CHECKING:
    from pindrive.optimisation.design_space import DesignSpace

Array = NDArray[np.float64]
MEMBERS: Final = 32
"""Designs of the search."""
GENERATIONS: Final = 60
"""Largest number of its generations."""
PATIENCE: Final = 10
"""Generations without progress after which it ends."""
SPREAD: Final = 1024
"""Designs over all ranges that it begins with, and devices that verify its result."""
SEARCHES: Final = 6
"""Largest number of searches, each with the places that were worse than expected."""
ADDED: Final = 16
"""Such places that the next search considers."""
WORSE: Final = 0.01
"""Relative worsening of a goal, within the margin, that is worse than expected."""


class Steady:
    """Designs with what they are worth at the worst place within a margin of each variable."""

    def __init__(
        self, space: DesignSpace, margin: float, built: Built | None, least: float | None
    ) -> None:
        """Begin with the middle of the margin and of its faces.

        Args:
            space: Space of the designs, with its conditions, constraints and goals.
            margin: Part of its value by which each variable with a range may move.
            built: Devices within the tolerances; None where no yield is demanded.
            least: The yield that is demanded.
        """
        self._space, self._built, self._least = space, built, least or 0.0
        keys = [key for v in space.variables if not v.choices for key in v.axes]
        faces = np.full((2 * len(keys) + 1, len(keys)), 0.5)
        for i in range(len(keys)):
            faces[2 * i, i], faces[2 * i + 1, i] = 0.0, 1.0
        tolerances = {key: f"{100.0 * margin:g} %" for key in keys}
        self._within = Built(space=space, tolerances=tolerances, parts=faces)

    def __call__(self, points: Array) -> tuple[Array, Array]:
        """Goals (n, g) and violations (n,) at worst, of designs (n, k)."""
        numbers = self._within.numbers(points)
        flat = {name: values.reshape(len(points), -1) for name, values in numbers.items()}
        goals, violation = self._space.worth(flat)
        if self._built is not None:
            violation = self._built.with_yield(points, violation, self._least)
        return goals, violation

    def best(self, starts: Array, rng: np.random.Generator, seed: int) -> Array | None:
        """Return the best design, with few digits; None if none was found.

        Args:
            starts: Designs to begin with, shape (n, k).
            rng: Generator of the search.
            seed: Seed of the designs over all ranges, and of the places that verify the result.
        """
        spread = qmc.Sobol(starts.shape[1], scramble=True, rng=seed).random(SPREAD)
        points = np.concatenate([starts, spread])
        for attempt in range(SEARCHES):
            first = Population(points, *self(points)).best(MEMBERS)
            found = search(self, first, generations=GENERATIONS, patience=PATIENCE, rng=rng)
            if found.violation[0] > 0.0:
                return None
            goals = found.goals[0]
            if self._holds(found.points[0], goals, seed + attempt):
                return rounded(
                    self._space,
                    self,
                    found.points[0],
                    lambda near, goals=goals: self._holds(near, goals, seed),  # type: ignore[misc]
                )
            points = np.concatenate([found.points, spread])
        return None

    def _holds(self, point: Array, goals: Array, seed: int) -> bool:
        """Return True if no place within the margin is worse; worse ones count from then on."""
        within = self._within
        inside = np.random.default_rng(seed).random((SPREAD, within.parts.shape[1]))
        numbers = replace(within, parts=inside).numbers(point[None])
        misses = self._space.excess(numbers)[:, 0].max(axis=2) > 0.0
        worst = self._space.minimised(numbers)[:, 0].max(axis=2)
        worse = misses.any(axis=0) | (worst > (goals + WORSE * np.abs(goals))[:, None]).any(axis=0)
        if worse.any():
            parts = np.concatenate([within.parts, inside[worse][:ADDED]])
            self._within = replace(within, parts=parts)
        return not worse.any()
