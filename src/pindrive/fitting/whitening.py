"""Statistical independence: the residuals of a channel as independent ones of variance one."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, log, pi
from typing import Final

import numpy as np
from numpy.typing import NDArray

from pindrive.fitting.noise import Noise
from pindrive.lazy import optimize, special

Array = NDArray[np.float64]

UNLIKELY: Final = 1e-3
"""Independent residuals whose tests have a lower p-value have structure."""
SMALLEST: Final = 1e-150
"""Least size of a noise, SI, where a fit hits each sample."""
LEAST: Final = 1e-12
"""Least variance of a residual that its neighbour leaves open, of samples close together."""
FINEST: Final = 1.0 / 12.0
"""Least noise before a converter, a part of its step, with which the cost remains smooth."""
MOST_CORRELATED: Final = 0.999
DEGREES: Final = (1.5, 100.0)
"""Degrees of freedom of outliers, from heavy tails to none."""
TURNS: Final = 30
"""Iterations of the size and the weights of noise with outliers."""
CLOSE: Final = 1e-3
"""Part of its argument at which the root of the log-likelihood of a rounded sample is a line."""


@dataclass(frozen=True, slots=True, eq=False)
class Whitening:
    """Map from the residuals of a channel to independent ones.

    Attributes:
        size: Standard deviation, SI; of rounded samples that before the converter.
        decay: Correlation of each residual with the one before, shape (n − 1,); None: zero.
        correlation: Correlation of residuals one sample interval apart.
        degrees: Degrees of freedom of outliers; infinite: normal noise.
        weights: Root of the weight of each independent residual, shape (n,); None: one.
        half: Half a step of the converter, SI; 0: samples are not rounded.
    """

    size: float
    decay: Array | None = None
    correlation: float = 0.0
    degrees: float = inf
    weights: Array | None = None
    half: float = 0.0

    @property
    def is_white(self) -> bool:
        """True if the residuals are divided by their size alone."""
        return self.decay is None and self.weights is None and not self.half

    def residuals(self, off: Array) -> Array:
        """Return independent residuals, shape (n,)."""
        if self.half:
            return _rounded(off, self.size, self.half)[0]
        return self._independent(off / self.size)

    def slopes(self, off: Array, slopes: Array) -> Array:
        """Return the derivatives of independent residuals, shape (n, k)."""
        if self.half:
            scaled: Array = _rounded(off, self.size, self.half)[1][:, None] * slopes
            return scaled
        return self._independent(slopes / self.size)

    def _independent(self, values: Array) -> Array:
        found = values
        if self.decay is not None:
            found = uncorrelated(values, self.decay)
        if self.weights is not None:
            found = (found.T * self.weights).T
        return found

    def scores(self, off: Array) -> Array:
        """Return residuals of mean zero for tests, shape (n,); of rounded ones their scores."""
        if not self.half:
            return self.residuals(off)
        found, slopes = _rounded(off, self.size, self.half)
        scores: Array = found * slopes
        return scores / (float(np.sqrt(np.mean(scores**2))) or 1.0)

    def deviance(self, off: Array) -> float:
        """Return −2 times the log-likelihood of residuals, SI, shape (n,)."""
        n = len(off)
        if self.half:
            return float(-2.0 * np.sum(_of_interval(off, self.size, self.half)))
        found = off / self.size
        total = 2.0 * n * log(self.size)
        if self.decay is not None:
            found = uncorrelated(found, self.decay)
            total += float(np.sum(np.log(np.maximum(1.0 - self.decay**2, LEAST))))
        if np.isfinite(self.degrees):
            return total + _student(found, self.degrees)
        return total + n * log(2.0 * pi) + float(found @ found)


def estimated(
    noise: Noise, off: Array, slopes: Array, times: Array, interval: float, spare: float
) -> Whitening:
    """Return the whitening whose numbers are those of the residuals.

    Args:
        noise: Noise, SI.
        off: Residuals, SI, shape (n,).
        slopes: Derivatives of these, shape (n, k), on which the estimated correlation depends: a
            fit takes up slow noise.
        times: Sample times, s, shape (n,).
        interval: Sample interval, s.
        spare: Samples that remain after the fitted parameters, a part of all.
    """
    size = None if noise.size is None else float(noise.size)
    if noise.step is not None:
        half = 0.5 * float(noise.step)
        if size is None:
            size = _size_before(off, half)
        return Whitening(size, half=half)
    decay, correlation = None, 0.0
    independent = off
    if noise.correlated:
        gaps = np.diff(times) / interval
        correlation = _correlation(off, slopes, gaps)
        decay = correlation**gaps
        independent = uncorrelated(off, decay)
    if noise.outliers and size is None:
        return _with_outliers(independent, decay, correlation, spare)
    if size is None:
        size = max(float(np.sqrt(np.mean(independent**2) / spare)), SMALLEST)
    return Whitening(size, decay, correlation)


def uncorrelated(values: Array, decay: Array) -> Array:
    """Return values of a first-order process as independent ones of equal variance."""
    found = np.array(values, copy=True)
    shape = (slice(None), *([None] * (values.ndim - 1)))
    found[1:] -= decay[shape] * values[:-1]
    found[1:] /= np.sqrt(np.maximum(1.0 - decay**2, LEAST))[shape]
    return found


def _correlation(off: Array, slopes: Array, gaps: Array) -> float:
    """Return the correlation of neighbours of the greatest restricted likelihood.

    Patterson and Thompson (1971): the likelihood of what no fit can reach, so that the slow part of
    the noise that the parameters take up is not missed.
    """
    known = slopes[:, slopes.any(axis=0)]
    known = known / np.linalg.norm(known, axis=0) if known.size else known

    def restricted(correlation: float) -> float:
        decay = correlation**gaps
        x, y = uncorrelated(known, decay), uncorrelated(off, decay)
        across, values, _ = np.linalg.svd(x, full_matrices=False)
        seen = values > 1e-9 * values.max(initial=0.0)
        rest = y - across[:, seen] @ (across[:, seen].T @ y)
        spare = len(y) - int(np.count_nonzero(seen))
        return float(
            spare * np.log(max(float(rest @ rest), SMALLEST**2))
            + np.sum(np.log(np.maximum(1.0 - decay**2, LEAST)))
            + 2.0 * np.sum(np.log(values[seen]))
        )

    found = optimize.minimize_scalar(
        restricted, bounds=(0.0, MOST_CORRELATED), method="bounded", options={"xatol": 1e-3}
    )
    return float(found.x)


def _with_outliers(
    independent: Array, decay: Array | None, correlation: float, spare: float
) -> Whitening:
    """Return the whitening of Student's t distribution.

    Weights are those at which a weighted fit has the greatest likelihood, and the size that of the
    estimates' scatter (Huber, Robust Statistics, 1981, section 6.5).
    """
    size = 1.4826 * float(np.median(np.abs(independent))) or float(np.std(independent))
    size = max(size, SMALLEST)

    def deviance(logarithm: float) -> tuple[float, float]:
        degrees, scale = float(np.exp(logarithm)), size
        for _ in range(TURNS):
            weights = (degrees + 1.0) / (degrees + (independent / scale) ** 2)
            last, scale = scale, max(float(np.sqrt(np.mean(weights * independent**2))), SMALLEST)
            if abs(scale - last) < 1e-4 * scale:
                break
        at = 2.0 * len(independent) * log(scale) + _student(independent / scale, degrees)
        return at, scale

    ends = np.log(DEGREES)
    found = optimize.minimize_scalar(
        lambda logarithm: deviance(logarithm)[0], bounds=ends, method="bounded"
    )
    degrees, scale = float(np.exp(found.x)), deviance(found.x)[1]
    part = independent / scale
    weights = (degrees + 1.0) / (degrees + part**2)
    rate = (degrees + 1.0) * (degrees - part**2) / (degrees + part**2) ** 2
    scatter = float(np.sqrt(np.mean((weights * part) ** 2)) / np.mean(rate))
    roots = np.sqrt(weights / weights.mean()) / (scatter / np.sqrt(spare))
    return Whitening(scale, decay, correlation, degrees, roots)


def _student(part: Array, degrees: float) -> float:
    """Return −2 times the log-likelihood of Student's t distribution of scale one."""
    ends = special.gammaln((degrees + 1.0) / 2.0) - special.gammaln(degrees / 2.0)
    each = 0.5 * np.log(degrees * pi) - ends
    tail = (degrees + 1.0) * np.log1p(part**2 / degrees)
    return float(2.0 * len(part) * each + np.sum(tail))


# ---- rounded samples -----------------------------------------------------------------------------


def _of_interval(off: Array, size: float, half: float) -> Array:
    """Return the log-likelihood of each rounded sample: of its interval, under normal noise."""
    near, far = (np.abs(off) - half) / size, (np.abs(off) + half) / size
    upper, lower = special.log_ndtr(-near), special.log_ndtr(-far)
    found: Array = upper + np.log1p(-np.exp(np.minimum(lower - upper, -1e-15)))
    return found


def _rounded(off: Array, size: float, half: float) -> tuple[Array, Array]:
    """Return residuals whose square is the deviance over that of a hit, and their derivatives."""
    peak = float(_of_interval(np.zeros(1), size, half)[0])
    level = _of_interval(off, size, half)
    found = np.sign(off) * np.sqrt(np.maximum(2.0 * (peak - level), 0.0))
    near, far = (off - half) / size, (off + half) / size
    with np.errstate(over="ignore", under="ignore"):
        rise = np.exp(-0.5 * near**2 - level) - np.exp(-0.5 * far**2 - level)
    rise /= np.sqrt(2.0 * pi) * size
    bend = 2.0 * half / size**3 * np.exp(-0.5 * (half / size) ** 2 - peak) / np.sqrt(2.0 * pi)
    close = np.abs(found) < CLOSE
    slope = np.where(close, np.sqrt(bend), rise / np.where(close, 1.0, found))
    return np.where(close, np.sqrt(bend) * off, found), slope


def _size_before(off: Array, half: float) -> float:
    """Return the noise before a converter, of the greatest likelihood."""
    least = 2.0 * half * FINEST
    largest = max(4.0 * float(np.sqrt(np.mean(off**2))), 2.0 * least)
    found = optimize.minimize_scalar(
        lambda logarithm: -np.sum(_of_interval(off, float(np.exp(logarithm)), half)),
        bounds=(log(least), log(largest)),
        method="bounded",
    )
    return float(np.exp(found.x))
