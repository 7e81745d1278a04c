"""The least squares of a model: from many candidates to the best one, by trust regions."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Final

import numpy as np

from pindrive.fitting.candidates import candidates
from pindrive.fitting.model import Model
from pindrive.lazy import optimize

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    Array = NDArray[np.float64]

ROUGH: Final = 250
"""Samples of each recording with which candidates are refined."""
REFINED: Final = 16
"""Candidates that are refined on them."""
BEGINNING: Final = 0.35
"""The part of a recording with which a search begins, beside one with all of it."""
STEPS: Final = 10
"""Parts of the range of a parameter without a derivative."""
SCANNED: Final = 40
"""Values of one that are compared, closer together where it is small."""
OF_EACH: Final = 2
"""Candidates of each part."""
FINISHED: Final = 3
"""Of those, how many are refined on all samples."""
FEW: Final = 25
"""The most evaluations of the refinement of a candidate."""
MANY: Final = 200
"""Those of the last one."""
ROUNDS: Final = 10
"""Better optima beyond kinks that are followed."""
DRAWN: Final = 60
"""Points around an optimum."""
SIZES: Final = (0.5, 2.0, 8.0)
"""How far they lie, in standard errors."""
BETTER: Final = 1e-2
"""A cost that is lower by so much is better; the end of an interval lies 3.84 higher."""
RANK: Final = 1e-9
"""A singular value so much smaller than the largest is zero, of columns of length one."""
_FAR: Final = 1e3
"""A sample that a motion does not reach is off by so many times its channel's extent."""
APART: Final = 0.02
"""Two candidates this part of their range apart in every parameter are one."""


@dataclass(frozen=True, slots=True)
class Optimum:
    """Where a refinement ended."""

    theta: Array
    cost: float
    """Weighted sum of squares."""
    converged: bool


class Problem:
    """A model with the weights of its samples, one over the noise of each."""

    def __init__(self, model: Model, weights: Array) -> None:
        self.model, self.weights = model, weights
        self.lower = np.array([p.lower for p in model.parameters])
        self.upper = np.array([p.upper for p in model.parameters])
        self._extent = np.concatenate(
            [
                np.full(block.size, size)
                for block, size in zip(model.blocks, model.range, strict=True)
            ]
        )
        self._last: tuple[bytes, Array, Array] | None = None

    def residuals(self, theta: Array) -> Array:
        """Computed less recorded over the noise, shape (n,)."""
        return self._whole(theta)[0]

    def cost(self, theta: Array) -> float:
        """The sum of their squares."""
        off = self._whole(theta)[0]
        return float(off @ off)

    def slopes(self, theta: Array) -> Array:
        """The derivatives of the residuals, shape (n, k)."""
        return self._whole(theta)[1]

    def _whole(self, theta: Array) -> tuple[Array, Array]:
        key = np.asarray(theta, float).tobytes()
        if self._last is None or self._last[0] != key:
            values, slopes = self.model.linearise(theta)
            slopes = np.where(np.isfinite(slopes), slopes, 0.0)
            self._last = key, self._off(values), slopes * self.weights[:, None]
        return self._last[1:]

    def plain_cost(self, theta: Array) -> float:
        """The sum of their squares, without the derivatives."""
        off = self._off(self.model.predict(theta))
        return float(off @ off)

    def _off(self, values: Array) -> Array:
        off = np.where(np.isfinite(values), values - self.model.data, _FAR * self._extent)
        weighted: Array = off * self.weights
        return weighted

    def refined(
        self, theta: Array, free: Sequence[int] | None = None, most: int = MANY, tol: float = 1e-8
    ) -> Optimum:
        """The optimum that is reached from `theta`, varying the parameters `free` alone."""
        places = np.arange(len(theta)) if free is None else np.asarray(free, np.intp)
        theta = np.clip(theta, self.lower, self.upper)
        if not len(places):
            return Optimum(theta, self.cost(theta), True)
        low, high = self.lower[places], self.upper[places]
        margin = 1e-9 * (high - low)
        size = np.maximum(np.abs(theta[places]), 1e-3 * (high - low))

        def full(part: Array) -> Array:
            whole = theta.copy()
            whole[places] = part * size
            return whole

        found = optimize.least_squares(
            lambda part: self.residuals(full(part)),
            np.clip(theta[places], low + margin, high - margin) / size,
            lambda part: self.slopes(full(part))[:, places] * size,
            (low / size, high / size),
            x_scale="jac",
            ftol=tol,
            xtol=tol,
            gtol=tol,
            max_nfev=most,
        )
        best = full(found.x)
        cost = 2.0 * float(found.cost)
        # A trust region keeps clear of the bounds; what lies on one is set on it.
        near = (best - self.lower <= 1e-6 * (self.upper - self.lower)) & np.isin(
            np.arange(len(best)), places
        )
        if near.any():
            on = np.where(near, self.lower, best)
            at = self.cost(on)
            if at <= cost * (1.0 + 1e-12):
                best, cost = on, at
        return Optimum(best, cost, bool(found.status > 0) or self._flat(best, places))

    def _flat(self, theta: Array, places: NDArray[np.intp]) -> bool:
        """Whether a Gauss-Newton step would change the cost by next to nothing."""
        inner = places[(theta > self.lower)[places] & (theta < self.upper)[places]]
        slopes = self.slopes(theta)[:, inner]
        part, *_ = np.linalg.lstsq(slopes, self.residuals(theta), rcond=RANK)
        return float(np.sum((slopes @ part) ** 2)) < BETTER


def polished(problem: Problem, best: Optimum, covariance: Array, seed: int) -> Optimum:
    """A better optimum near one, if there is any beyond a kink or a jump of the cost.

    Where other events happen, the cost has a kink, and where the pin just sticks or does not, a
    jump. A trust region stops there; points drawn around it lie on both sides.

    Args:
        problem: of all samples.
        best: where a refinement ended.
        covariance: of the parameters there; infinite on the diagonal where there is none.
        seed: of the points.
    """
    rng = np.random.default_rng(seed)
    spread = np.sqrt(np.diag(covariance))
    told = np.isfinite(spread) & (spread > 0.0)
    for _ in range(ROUNDS):
        factor = _root(covariance[np.ix_(told, told)])
        normal = rng.normal(size=(DRAWN, int(np.count_nonzero(told))))
        near = np.tile(best.theta, (DRAWN, 1))
        size = rng.choice(SIZES, (DRAWN, 1))
        near[:, told] += size * normal @ factor.T
        near[:, ~told] *= 2.0 ** rng.uniform(-3.0, 3.0, (DRAWN, int(np.count_nonzero(~told))))
        near = np.clip(near, problem.lower, problem.upper)
        costs = np.array([problem.plain_cost(theta) for theta in near])
        # Far points cost more by their distance alone; of that their size is a measure.
        order = np.argsort(costs - size[:, 0] ** 2 * len(best.theta), kind="stable")
        ends = [problem.refined(near[i], most=FEW) for i in order[:FINISHED]]
        end = min(ends, key=lambda found: found.cost)
        if end.cost > best.cost - BETTER:
            return best
        best = problem.refined(end.theta)
    return best


def _root(covariance: Array) -> Array:
    """A factor of a covariance that may be singular."""
    values, vectors = np.linalg.eigh(covariance)
    root: Array = vectors * np.sqrt(np.maximum(values, 0.0))
    return root


def search(model: Model, weights: Array, seed: int) -> tuple[Optimum, Array]:
    """The best optimum from the best of many candidates, and those candidates, shape (n, k)."""
    counts = [len(recording.time) for recording in model.recordings]
    strides = [max(1, n // ROUGH) for n in counts]
    looks = [max(1, n // 40) for n in counts]
    args = model.parameters, model.drive, model.releases, model.recordings
    coarse = Model(*args, looks)
    rough = Model(*args, strides)
    thin, few = _thinned(model, rough, weights), _thinned(model, coarse, weights)
    problem = Problem(rough, thin)
    tried = candidates(coarse, few, seed)
    starts = _distinct(tried, problem)
    # What sticks too early is far off from then on whatever the rest is: begin with the first part.
    first = candidates(coarse, few * _beginning(coarse), seed)
    early = Problem(rough, thin * _beginning(rough))
    starts += [
        _stepped(problem, early.refined(theta, most=FEW, tol=1e-3).theta, early)
        for theta in _distinct(first, problem)
    ]
    ends = sorted(
        (problem.refined(theta, most=FEW, tol=1e-4) for theta in starts),
        key=lambda end: end.cost,
    )
    again = _by_steps(problem, ends[0].theta, (tried, first))
    ends += [problem.refined(theta, most=FEW, tol=1e-4) for theta in again]
    ends.sort(key=lambda end: end.cost)
    whole = Problem(model, weights)
    best = [whole.refined(end.theta) for end in _apart(ends, problem)[:FINISHED]]
    return min(best, key=lambda end: end.cost), tried


def _by_steps(problem: Problem, theta: Array, lists: Sequence[Array]) -> list[Array]:
    """More candidates, along parameters that change the samples by steps alone.

    Static friction may only decide at which turn the pin stays. No derivative leads from one such
    step to the next, so that the best candidates of each part of its range are refined too.
    """
    found: list[Array] = []
    for i in np.flatnonzero(~problem.slopes(theta).any(axis=0)):
        for tried in lists:
            ends = np.quantile(tried[:, i], np.linspace(0.0, 1.0, STEPS + 1))
            for low, high in pairwise(ends):
                inside = (tried[:, i] >= low) & (tried[:, i] <= high)
                found += [*tried[np.flatnonzero(inside)[:OF_EACH]]]
    return found


def _stepped(problem: Problem, theta: Array, early: Problem) -> Array:
    """The best values of parameters that the first part of a recording does not tell."""
    found = theta.copy()
    for i in np.flatnonzero(~early.slopes(theta).any(axis=0)):
        tried = np.tile(found, (SCANNED, 1))
        span = problem.upper[i] - problem.lower[i]
        tried[:, i] = problem.lower[i] + span * np.linspace(0.0, 1.0, SCANNED) ** 3
        found = tried[int(np.argmin([problem.plain_cost(each) for each in tried]))]
    return found


def _beginning(model: Model) -> Array:
    """One for samples in the first part of their recording, zero for the others."""
    parts = []
    for block in model.blocks:
        times = model.times(block.recording)
        end = times[0] + BEGINNING * (times[-1] - times[0])
        parts.append(np.where(times <= end, 1.0, 0.0))
    return np.concatenate(parts)


def _thinned(model: Model, other: Model, weights: Array) -> Array:
    """The weights of the blocks of another model of the same recordings."""
    return np.concatenate(
        [
            np.full(thin.size, weights[block.place.start])
            for block, thin in zip(model.blocks, other.blocks, strict=True)
        ]
    )


def _distinct(tried: Array, problem: Problem) -> list[Array]:
    """The best candidates, no two of them in one place."""
    extent = problem.upper - problem.lower
    found: list[Array] = []
    for theta in tried[: 20 * REFINED]:
        if all(np.any(np.abs(theta - other) > APART * extent) for other in found):
            found.append(theta)
        if len(found) == REFINED:
            break
    return found


def _apart(ends: list[Optimum], problem: Problem) -> list[Optimum]:
    """The best ends, those that are alike once."""
    found: list[Optimum] = []
    for end in ends:
        if all(abs(end.cost - other.cost) > 1e-3 * other.cost for other in found):
            found.append(end)
    return found or [problem.refined(np.array([p.start for p in problem.model.parameters]))]
