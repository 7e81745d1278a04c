"""The search: differential evolution with limits, of one goal or of several.

GDE3 of Kukkonen and Lampinen 2005: a child replaces its parent where it is no worse; a design that
meets its limits is better than one that does not, and of those that do not the one that is nearer.
With several goals both stay where neither is better in all, and the best fronts are kept. Children
are made as in JADE (Zhang and Sanderson 2009), from the parent, one of the best, and two others.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Function = Callable[[Array], tuple[Array, Array]]
"""Goals (n, g), least is best, and violations (n,), 0 where all limits are met, of points (n, k) in
the unit cube."""
BEST: Final = 0.15
"""Part of the population that children are drawn to."""
PROGRESS: Final = 1e-5
"""Relative improvement of the goal that counts as progress."""


@dataclass(frozen=True, slots=True)
class Population:
    """Points with what they are worth.

    Attributes:
        points: Points in the unit cube, shape (n, k).
        goals: Least is best, shape (n, g).
        violation: 0 where all limits are met, shape (n,).
    """

    points: Array
    goals: Array
    violation: Array

    def __getitem__(self, which: NDArray[np.int64] | NDArray[np.bool_] | slice) -> Population:
        """Return some members."""
        return Population(self.points[which], self.goals[which], self.violation[which])

    def __add__(self, other: Population) -> Population:
        """All of both."""
        return Population(
            np.concatenate([self.points, other.points]),
            np.concatenate([self.goals, other.goals]),
            np.concatenate([self.violation, other.violation]),
        )

    def best(self, count: int) -> Population:
        """Return the best members: feasible fronts first, then by violation."""
        meets = self.violation <= 0.0
        order = [*np.flatnonzero(meets)[_ranked(self.goals[meets], count)]]
        if len(order) < count:
            others = np.flatnonzero(~meets)
            order += [*others[np.argsort(self.violation[others], kind="stable")]]
        return self[np.array(order[:count], np.int64)]


def search(
    function: Function,
    first: Population,
    *,
    generations: int,
    patience: int,
    rng: np.random.Generator,
    progress: Callable[[], None] = lambda: None,
) -> Population:
    """Improve a population.

    Args:
        function: Function that evaluates points.
        first: First points, at least 4.
        generations: Largest number of generations.
        patience: Generations without progress after which it ends.
        rng: Generator of the children.
        progress: Function called after each generation.

    Returns:
        As many points, the best first.
    """
    size = len(first.points)
    several = first.goals.shape[1] > 1
    now, still = first.best(size), 0
    for _ in range(generations):
        elite = max(2, round(BEST * size))
        children = _children(now.points, elite, rng)
        goals, violation = function(children)
        found = Population(children, goals, violation)
        no_worse = (goals <= now.goals).all(axis=1)
        both = (violation <= 0.0) & (now.violation <= 0.0)
        better = np.where(both, no_worse, violation <= now.violation)
        beside = both & ~better & (goals < now.goals).any(axis=1) & several
        before = now
        kept = Population(
            np.where(better[:, None], found.points, now.points),
            np.where(better[:, None], found.goals, now.goals),
            np.where(better, found.violation, now.violation),
        )
        now = (kept + found[beside]).best(size)
        progress()
        still = 0 if gained(before, now) else still + 1
        if still >= patience:
            break
    return now


def _children(points: Array, elite: int, rng: np.random.Generator) -> Array:
    """A child of each point; points are ordered, the best first."""
    size, keys = points.shape
    towards = points[rng.integers(0, elite, size)]
    one, other = (points[rng.integers(0, size, size)] for _ in range(2))
    step = rng.uniform(0.3, 0.9, (size, 1))
    mutant = points + step * (towards - points) + step * (one - other)
    crossed = rng.random((size, keys)) < rng.choice([0.3, 0.9], (size, 1))
    crossed[np.arange(size), rng.integers(0, keys, size)] = True
    child = np.where(crossed, mutant, points)
    child = np.where(child < 0.0, 0.5 * points, child)
    return np.where(child > 1.0, 0.5 * (1.0 + points), child)


def gained(before: Population, now: Population, progress: float = PROGRESS) -> bool:
    """Return True if the best goal, or the least of several, improved by a fraction."""
    if before.violation[0] > 0.0 or now.violation[0] > 0.0:
        return bool(now.violation[0] < before.violation[0] * (1.0 - progress))
    old, new = (p.goals[p.violation <= 0.0] for p in (before, now))
    if now.goals.shape[1] > 1:
        old, new = np.array([_volume(old, old)]), np.array([_volume(new, old)])
        return bool(new[0] > old[0] * (1.0 + 1e-3))
    least = old.min(axis=0)
    return bool((new.min(axis=0) < least - progress * np.abs(least)).any())


def _volume(goals: Array, reference: Array) -> float:
    """Return the volume below a front, by fixed directions: mean reach from the worst."""
    low, high = reference.min(axis=0), reference.max(axis=0)
    span = np.where(high > low, high - low, 1.0)
    scaled = np.clip((high - goals) / span, 0.0, None)
    directions = _directions(goals.shape[1], 16)
    return float((scaled[None] / directions[:, None]).min(axis=2).max(axis=1).mean())


def _directions(goals: int, count: int) -> Array:
    """Return positive weights spread over the simplex."""
    rng = np.random.default_rng(0)
    directions = np.maximum(rng.dirichlet(np.ones(goals), count), 1e-3)
    directions[:goals] = np.maximum(np.eye(goals), 1e-3)
    found: Array = directions / directions.sum(axis=1, keepdims=True)
    return found


def non_dominated(goals: Array) -> NDArray[np.bool_]:
    """Return True for points (n, g) that no point dominates."""
    kept = np.zeros(len(goals), np.bool_)
    order = np.lexsort(goals.T[::-1])
    front = np.empty((0, goals.shape[1]))
    for i in order:  # in this order no point dominates an earlier one
        point = goals[i]
        if not ((front <= point).all(axis=1) & (front < point).any(axis=1)).any():
            kept[i] = True
            front = np.vstack([front, point])
    return kept


def _ranked(goals: Array, count: int) -> NDArray[np.int64]:
    """The best `count` of points (n, g) in their order: front by front, the loneliest first."""
    if goals.shape[1] == 1 or not len(goals):
        return np.argsort(goals[:, 0], kind="stable")[:count]
    left = _spread(goals, 4 * count) if len(goals) > 4 * count else np.arange(len(goals))
    first = np.unique(goals[left], axis=0, return_index=True)[1]
    repeated = np.delete(left, first)
    left, order = left[np.sort(first)], list[int]()
    while len(left) and len(order) < count:
        front = non_dominated(goals[left])
        members = left[front]
        order += [*members[np.argsort(-_loneliness(goals[members]), kind="stable")]]
        left = left[~front]
    return np.array([*order, *repeated][:count], np.int64)


def _spread(goals: Array, count: int) -> NDArray[np.int64]:
    """Return some of many points near their front: the farthest in each direction."""
    low = goals.min(axis=0)
    span = np.maximum(np.quantile(goals, 0.9, axis=0) - low, 1e-300)
    scaled = ((goals - low) / span).astype(np.float32)
    found: list[NDArray[np.int64]] = []
    directions = _directions(goals.shape[1], 32)
    each = max(1, count // len(directions))
    for direction in directions:
        worst = (scaled / direction.astype(np.float32)).max(axis=1)
        near = np.argpartition(worst, min(each, len(worst) - 1))[:each]
        found.append(near)
    return np.unique(np.concatenate(found))


def _loneliness(goals: Array) -> Array:
    """The crowding distance of Deb and others 2002: how far the neighbours of each are apart."""
    far = np.zeros(len(goals))
    for column in goals.T:
        order = np.argsort(column, kind="stable")
        span = float(column[order[-1]] - column[order[0]]) or 1.0
        far[order[[0, -1]]] = np.inf
        far[order[1:-1]] += (column[order[2:]] - column[order[:-2]]) / span
    return far
