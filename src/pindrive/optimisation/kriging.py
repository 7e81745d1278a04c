"""Kriging: interpolation of a number between known points, with its standard deviation.

A Gaussian process with a constant mean, Matérn's correlation 5/2 with a length for each variable,
and a nugget for what jumps; all by maximum likelihood, as in Jones, Schonlau and Welch 1998.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from pindrive.lazy import linalg, optimize

Array = NDArray[np.float64]
LENGTHS: Final = (0.05, 20.0)
"""Correlation lengths, in unit cubes."""
NUGGET: Final = (1e-6, 0.1)
"""Part of the variance."""
STARTS: Final = (0.3, 1.5)
"""Lengths from which the likelihood is climbed."""
STEPS: Final = 30
"""Likelihoods for each variable, of a climb."""
DECADES: Final = 3.0
"""Ratio of the largest to the least from which positive values are modelled by their logarithm."""


class Kriging:
    """A model of a number over the unit cube."""

    def __init__(
        self, points: Array, values: Sequence[float] | Array, before: Kriging | None = None
    ) -> None:
        """Fit it.

        Args:
            points: Shape (n, k), n at least 2.
            values: Finite, shape (n,).
            before: A model of fewer points, from which the likelihood is climbed on.
        """
        y = np.asarray(values, np.float64)
        self._log = bool((y > 0.0).all() and y.max() > DECADES * y.min())
        y = np.log(y) if self._log else y
        self._middle, self._scale = float(y.mean()), float(y.std()) or 1.0
        self._points = points
        self._y = (y - self._middle) / self._scale
        self._fit(before)

    def __call__(self, points: Array, trust: float = 0.0) -> tuple[Array, Array]:
        """The number at points (m, k), `trust` standard deviations below and above its mean."""
        near = _correlation(points / self._lengths, self._points / self._lengths)
        mean = self._mean + near @ self._weights
        off = np.zeros(len(points))
        if trust:
            known = ((near @ self._inverse) ** 2).sum(axis=1)
            off = trust * np.sqrt(self._variance * np.maximum(1.0 - known, 0.0))
        low, high = (self._middle + self._scale * (mean + side * off) for side in (-1.0, 1.0))
        return (np.exp(low), np.exp(high)) if self._log else (low, high)

    def _fit(self, before: Kriging | None) -> None:
        keys = self._points.shape[1]
        starts = [np.log([*[start] * keys, 1e-3]) for start in STARTS]
        if before:
            starts = [starts[0], before.theta]
        found = [
            optimize.minimize(
                self._likelihood,
                start,
                method="Nelder-Mead",  # L-BFGS-B starts threads for each of its tiny products
                bounds=[np.log(LENGTHS)] * keys + [np.log(NUGGET)],
                options={"maxfev": STEPS * keys},
            )
            for start in starts
        ]
        self.theta: Array = min(found, key=lambda each: float(each.fun)).x
        """Logarithms of the lengths and of the nugget."""
        self._likelihood(self.theta)
        root = linalg.solve_triangular(self._root, np.eye(len(self._y)), lower=True)
        self._inverse: Array = root.T  # many small products cost less than as many solutions

    def _likelihood(self, theta: Array) -> float:
        """The negative logarithm of the likelihood; all that predictions need is left behind."""
        self._lengths = np.exp(theta[:-1])
        scaled = self._points / self._lengths
        matrix = _correlation(scaled, scaled) + np.exp(theta[-1]) * np.eye(len(self._y))
        self._root = linalg.cholesky(matrix, lower=True, check_finite=False)
        whole = (self._root, True)
        ones = linalg.cho_solve(whole, np.ones(len(self._y)), check_finite=False)
        self._mean = float(ones @ self._y / ones.sum())
        off = self._y - self._mean
        self._weights: Array = linalg.cho_solve(whole, off, check_finite=False)
        self._variance = max(float(off @ self._weights) / len(off), 1e-12)
        volume = 2.0 * float(np.log(np.diag(self._root)).sum())
        return len(off) * float(np.log(self._variance)) + volume


def _correlation(one: Array, other: Array) -> Array:
    """Matérn's, 5/2, between points (m, k) and (n, k) that are measured in lengths."""
    square = (one**2).sum(axis=1)[:, None] + (other**2).sum(axis=1) - 2.0 * one @ other.T
    far = np.sqrt(5.0 * np.maximum(square, 0.0))
    found: Array = (1.0 + far + far * far / 3.0) * np.exp(-far)
    return found
