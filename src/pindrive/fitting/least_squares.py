"""The least squares of a model: its cost and slopes, and their refinement by trust regions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final, Protocol

import numpy as np
from numpy.typing import NDArray

from pindrive.fitting.whitening import Whitening
from pindrive.lazy import optimize

Array = NDArray[np.float64]

MANY: Final = 200
"""Steps of the refinement of one optimum, unless told otherwise."""
BETTER: Final = 1e-2
"""A cost that is lower by so much is better; the end of an interval lies 3.84 higher."""
RANK: Final = 1e-9
"""A singular value so much smaller than the largest is zero, of columns of length one."""
_FAR: Final = 1e3
"""Residual of a sample beyond the end of a motion, in extents of its channel."""


@dataclass(frozen=True, slots=True)
class Optimum:
    """Result of a refinement."""

    theta: Array
    cost: float
    """Weighted sum of squares."""
    converged: bool


class FittedModel(Protocol):
    """Fitted model, as far as the solver needs it: `pindrive.fitting.model.Model`."""

    parameters: tuple[Any, ...]
    """Each with a `start` between `lower` and `upper`."""
    blocks: list[Any]
    """Blocks of samples, each with its `size` and its `place` among all."""
    data: Array

    @property
    def range(self) -> Array:
        """The extent of each block."""

    def predict(self, theta: Array) -> Array:
        """Return the samples, shape (n,)."""

    def linearise(self, theta: Array) -> tuple[Array, Array]:
        """Return the samples and their derivatives, shape (n, k)."""


class Problem:
    """A model with the noise of its samples.

    Args:
        model: Fitted model.
        noise: Whitening of each block, or the weight of each sample, one over its noise.
    """

    def __init__(self, model: FittedModel, noise: Array | Sequence[Whitening]) -> None:
        self.model, self.noise = model, noise
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
        """Computed less recorded as independent residuals of variance one, shape (n,)."""
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
            off, slopes = self.linearised(theta)
            self._last = key, self._independent(off), self._independent_slopes(off, slopes)
        return self._last[1:]

    def linearised(self, theta: Array) -> tuple[Array, Array]:
        """Computed less recorded, SI, shape (n,), and the derivatives, shape (n, k)."""
        values, slopes = self.model.linearise(theta)
        return self._off(values), np.where(np.isfinite(slopes), slopes, 0.0)

    def plain_cost(self, theta: Array) -> float:
        """The sum of their squares, without the derivatives."""
        off = self._independent(self._off(self.model.predict(theta)))
        return float(off @ off)

    def _off(self, values: Array) -> Array:
        off: Array = np.where(np.isfinite(values), values - self.model.data, _FAR * self._extent)
        return off

    def _independent(self, off: Array) -> Array:
        if isinstance(self.noise, np.ndarray):
            weighted: Array = off * self.noise
            return weighted
        each = zip(self.noise, self.model.blocks, strict=True)
        return np.concatenate([noise.residuals(off[block.place]) for noise, block in each])

    def _independent_slopes(self, off: Array, slopes: Array) -> Array:
        if isinstance(self.noise, np.ndarray):
            weighted: Array = slopes * self.noise[:, None]
            return weighted
        each = zip(self.noise, self.model.blocks, strict=True)
        return np.concatenate(
            [noise.slopes(off[block.place], slopes[block.place]) for noise, block in each]
        )

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
        """Return True if a Gauss-Newton step would hardly change the cost."""
        inner = places[(theta > self.lower)[places] & (theta < self.upper)[places]]
        slopes = self.slopes(theta)[:, inner]
        part, *_ = np.linalg.lstsq(slopes, self.residuals(theta), rcond=RANK)
        return float(np.sum((slopes @ part) ** 2)) < BETTER
