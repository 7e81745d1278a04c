"""The search against answers that are known: one goal, limits, and fronts of two and three."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from pindrive.optimisation.search import Population, non_dominated, search

Array = NDArray[np.float64]


def started(function: object, keys: int, size: int = 40, seed: int = 1) -> Population:
    points = np.random.default_rng(seed).random((size, keys))
    return Population(points, *function(points))  # type: ignore[operator]


def test_one_goal_within_a_limit_ends_where_both_meet() -> None:
    """The least sum of squares about a corner, beyond a plane: its foot on the plane."""

    def worth(points: Array) -> tuple[Array, Array]:
        goal = ((points - 0.1) ** 2).sum(axis=1)
        return goal[:, None], np.maximum(1.5 - points.sum(axis=1), 0.0)

    found = search(
        worth, started(worth, 3), generations=300, patience=25, rng=np.random.default_rng(2)
    )
    assert found.violation[0] == 0.0
    assert found.points[0] == pytest.approx(np.full(3, 0.5), abs=2e-3)


def test_infeasible_search_ends_at_the_nearest_point() -> None:
    def worth(points: Array) -> tuple[Array, Array]:
        return points[:, :1], 2.0 - points.sum(axis=1) + 0.5

    found = search(
        worth, started(worth, 2), generations=200, patience=25, rng=np.random.default_rng(2)
    )
    assert found.violation[0] == pytest.approx(0.5, abs=1e-3)


@pytest.mark.parametrize("goals", [2, 3])
def test_a_front_is_where_it_must_be_and_spread(goals: int) -> None:
    """DTLZ2 of Deb and others 2002: the front is the part of the unit sphere above 0."""

    def worth(points: Array) -> tuple[Array, Array]:
        far = 1.0 + ((points[:, goals - 1 :] - 0.5) ** 2).sum(axis=1)
        angles = 0.5 * np.pi * points[:, : goals - 1]
        columns = [far * np.cos(angles).prod(axis=1)]
        for i in range(goals - 1):
            part = np.cos(angles[:, : goals - 2 - i]).prod(axis=1)
            columns.append(far * part * np.sin(angles[:, goals - 2 - i]))
        return np.array(columns).T, np.zeros(len(points))

    first = started(worth, goals + 3, size=60)
    found = search(worth, first, generations=200, patience=25, rng=np.random.default_rng(3)).goals
    front = found[non_dominated(found)]
    assert len(front) > 40
    radius = np.sqrt((front**2).sum(axis=1))
    assert np.median(radius) < 1.02 and radius.max() < 1.1
    assert (front.min(axis=0) < 0.03).all() and (front.max(axis=0) > 0.97).all()
    for way in np.eye(goals) @ np.full((goals, goals), 0.2) + 0.5 * np.eye(goals):
        way = way / np.linalg.norm(way)
        assert np.linalg.norm(front - way, axis=1).min() < 0.2


def test_non_dominated_equals_its_definition() -> None:
    goals = np.random.default_rng(4).integers(0, 6, (200, 3)).astype(float)
    slow = [
        not any((other <= one).all() and (other < one).any() for other in goals) for one in goals
    ]
    assert non_dominated(goals).tolist() == slow
