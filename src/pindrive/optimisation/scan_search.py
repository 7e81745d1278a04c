"""The search where each candidate is a scan: few are tried, each where it promises most.

Kriging of all numbers that have been scanned stands for the scans; the differential evolution of
`search` finds on it the best device where all numbers are as expected, and where they are worse or
better by standard deviations. These candidates are scanned, and the model is fitted again:
efficient global optimisation (Jones, Schonlau and Welch 1998) with confidence bounds (Cox and John
1992).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from pindrive.lazy import qmc
from pindrive.optimisation.search import Population, gained, non_dominated, search

if TYPE_CHECKING:
    from pindrive.optimisation.design_space import DesignSpace

Array = NDArray[np.float64]
TRUSTS: Final = (-1.0, 0.0, 1.0, 2.0)
"""Standard deviations by which a candidate of each round may be better than is expected."""
MEMBERS: Final = 32
"""Population of the search on the model, with its generations and its patience."""
GENERATIONS: Final = 30
PATIENCE: Final = 8
SPREAD: Final = 128
"""Random points at the begin of that search, beside the known points."""
CLOSE: Final = 2e-3
"""Two points less apart than that are one."""
BESIDE: Final = 0.05
"""Distance from the best of a point that replaces a known proposal of the model."""
PROGRESS: Final = 1e-3
"""Part of a goal by which it must get better."""


def search_scans(
    space: DesignSpace,
    *,
    size: int,
    rounds: int,
    patience: int,
    rng: np.random.Generator,
    progress: Callable[[], None] = lambda: None,
) -> Population:
    """Improve what has been scanned of a space.

    Args:
        space: Space with some devices scanned at all of its conditions.
        size: Members that come back.
        rounds: Largest number of rounds of scans.
        patience: Rounds without progress after which it ends.
        rng: Generator of all draws.
        progress: Function called after each round.

    Returns:
        The best of all that is known, the best first.
    """
    now, still = space.known().best(size), 0
    for _ in range(rounds):
        space.numbers(_candidates(space, rng))
        before, now = now, space.known().best(size)
        progress()
        still = 0 if gained(before, now, PROGRESS) else still + 1
        if still >= patience:
            break
    return now


def _candidates(space: DesignSpace, rng: np.random.Generator) -> Array:
    """Return the next points to scan, a point per trust in `TRUSTS`."""
    known = space.known().points
    keys = known.shape[1]
    anywhere = qmc.Sobol(keys, rng=rng).random(SPREAD)
    taken = known
    found: list[Array] = []
    for trust in TRUSTS:

        def function(points: Array, trust: float = trust) -> tuple[Array, Array]:
            return space.expected(points, trust)

        points = space.snapped(np.concatenate([known, anywhere]))
        first = Population(points, *function(points)).best(min(MEMBERS, len(points)))
        result = search(function, first, generations=GENERATIONS, patience=PATIENCE, rng=rng)
        point = _newest(space, result, taken, rng)
        found.append(point)
        taken = np.vstack([taken, point])
    return np.array(found)


def _newest(
    space: DesignSpace, result: Population, taken: Array, rng: np.random.Generator
) -> Array:
    """Return the best point that is farthest from all chosen points."""
    meets = result.violation <= 0.0
    best = result[meets] if meets.any() else result[np.zeros(1, np.int64)]
    points = space.snapped(best.points[non_dominated(best.goals)])
    for _ in range(20):
        far = np.abs(points[:, None] - taken[None]).max(axis=2).min(axis=1)
        if far.max() > CLOSE:
            return np.asarray(points[far.argmax()])
        beside = points[:1] + BESIDE * rng.normal(size=points[:1].shape)
        points = space.snapped(np.clip(beside, 0.0, 1.0))
    anywhere: Array = space.snapped(rng.random((1, taken.shape[1])))[0]
    return anywhere
