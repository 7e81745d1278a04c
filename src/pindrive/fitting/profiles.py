"""Profile likelihood: how well a fit remains when one parameter is held elsewhere."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, sqrt
from typing import Final

import numpy as np
from numpy.typing import NDArray

from pindrive.fitting.least_squares import BETTER, Optimum, Problem

Array = NDArray[np.float64]

POINTS: Final = 4
"""Steps from the optimum to the end of an interval, about."""
MOST: Final = 60
"""Points of one side, before it is called open."""


@dataclass(frozen=True, slots=True)
class ProfileLikelihood:
    """Least cost over all other parameters, at values of one parameter.

    Attributes:
        values: Values of the parameter, SI, increasing, shape (n,).
        excess: The cost there less that of the optimum, shape (n,).
        interval: Interval in which the excess is below the threshold; infinite on an open side.
    """

    values: Array
    excess: Array
    interval: tuple[float, float]


class BetterOptimum(Exception):
    """A profile met a better fit."""

    def __init__(self, end: Optimum) -> None:
        super().__init__()
        self.end = end


def profile(
    problem: Problem, best: Optimum, i: int, covariance: Array, threshold: float
) -> ProfileLikelihood:
    """The profile of parameter i, from the optimum both ways past `threshold` or to its bound.

    Raises:
        BetterOptimum: The other parameters reach a lower cost than the optimum.
    """
    sides = [_Side(problem, best, i, covariance, threshold, way) for way in (-1.0, 1.0)]
    found = [side.follow() for side in sides]
    points = sorted({**sides[0].points, **sides[1].points, float(best.theta[i]): 0.0}.items())
    values, excess = np.array(points).T
    return ProfileLikelihood(values, excess, (found[0], found[1]))


class _Side:
    """One side of a profile."""

    def __init__(
        self,
        problem: Problem,
        best: Optimum,
        i: int,
        covariance: Array,
        threshold: float,
        way: float,
    ) -> None:
        self._problem, self._best, self._i, self._way = problem, best, i, way
        self._target = sqrt(threshold)
        self._others = [j for j in range(len(best.theta)) if j != i]
        self._end = float((problem.upper if way > 0 else problem.lower)[i])
        spread = covariance[i, i]
        extent = float(problem.upper[i] - problem.lower[i])
        determined = 0.0 < spread < inf
        self._tangent = covariance[:, i] / spread if determined else np.zeros(len(best.theta))
        self._sigma = min(sqrt(spread), extent) if determined else 1e-2 * extent
        self.points: dict[float, float] = {}
        self._near = {float(best.theta[i]): best.theta}

    def follow(self) -> float:
        """Return the value at which the profile crosses the threshold; infinite if not crossed."""
        start = float(self._best.theta[self._i])
        at, root = start, 0.0  # the square root of the excess, which is linear near the optimum
        step = self._sigma * self._target / POINTS
        for _ in range(MOST):
            value = at + self._way * step
            last = (value - self._end) * self._way >= 0.0
            value = self._end if last else value
            if value == at:
                return self._way * inf
            reached = self._root(value)
            if reached >= self._target:
                return self._between(at, root, value, reached)
            if last:
                return self._way * inf
            rise = (reached - root) / abs(value - at)
            at, root = value, reached
            wanted = self._target / POINTS
            step *= min(4.0, max(0.3, wanted / max(rise * step, 1e-300)))
        return self._way * inf

    def _between(self, low: float, low_root: float, high: float, high_root: float) -> float:
        """The crossing between a value below the threshold and one above, by regula falsi."""
        scale = abs(high - float(self._best.theta[self._i]))
        for turn in range(30):
            part = (self._target - low_root) / (high_root - low_root)
            part = 0.5 if turn % 3 == 2 else min(0.99, max(0.01, part))
            value = low + part * (high - low)
            if abs(high_root - low_root) < 0.02 * self._target or abs(high - low) < 2e-3 * scale:
                break
            root = self._root(value)
            if abs(root - self._target) < 2e-3 * self._target:
                return value
            if root < self._target:
                low, low_root = value, root
            else:
                high, high_root = value, root
        part = (self._target - low_root) / (high_root - low_root)
        return low + part * (high - low)

    def _root(self, value: float) -> float:
        """The square root of the excess with the parameter at `value`."""
        nearest = min(self._near, key=lambda at: abs(at - value))
        theta = self._near[nearest] + self._tangent * (value - nearest)
        theta[self._i] = value
        found = self._problem.refined(theta, self._others, most=40, tol=1e-7)
        excess = found.cost - self._best.cost
        if excess < -BETTER:
            raise BetterOptimum(found)
        if excess < self._target**2:  # beyond a jump of the cost the others may have gone astray
            self._near[value] = found.theta
        self.points[value] = max(excess, 0.0)
        return sqrt(max(excess, 0.0))
