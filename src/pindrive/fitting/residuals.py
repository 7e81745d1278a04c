"""Residuals of a fit: size, and test for structure."""

from __future__ import annotations

from dataclasses import dataclass
from math import nan, sqrt
from typing import Final

import numpy as np
from numpy.typing import NDArray

from pindrive.lazy import stats

Array = NDArray[np.float64]

LAGS: Final = 20
"""Lags of the Ljung-Box test; a fifth of the samples where they are fewer."""
UNLIKELY: Final = 1e-3
"""Residuals whose tests have a lower p-value have structure."""


@dataclass(frozen=True, slots=True)
class Residuals:
    """Residuals of one channel of one recording.

    Attributes:
        recording: Index of the recording.
        channel: "position", "velocity", "acceleration" or "force".
        count: Number of samples.
        noise: The standard deviation, SI: the known one, or that of the residuals.
        known: True for a given noise.
        reduced: Mean square of the residuals over the square of the noise; 1 where it is estimated.
        ljung_box: P-value of the Ljung-Box test for autocorrelation (Biometrika 65:297, 1978).
        runs: P-value of the Wald-Wolfowitz test for the number of runs of one sign.
        correlation: Correlation of neighbouring residuals.
    """

    recording: int
    channel: str
    count: int
    noise: float
    known: bool
    reduced: float
    ljung_box: float
    runs: float
    correlation: float

    @property
    def structured(self) -> bool:
        """True if the residuals are not white noise: the drive does more than the model."""
        return min(self.ljung_box, self.runs) < UNLIKELY or self.excessive

    @property
    def excessive(self) -> bool:
        """True if the residuals exceed the given noise."""
        return self.known and bool(stats.chi2.sf(self.reduced * self.count, self.count) < UNLIKELY)

    @property
    def widening(self) -> float:
        """Factor by which correlated residuals widen the intervals, for a first-order process."""
        near = min(max(self.correlation, 0.0), 0.999)
        return sqrt((1.0 + near) / (1.0 - near))


def tested(
    off: Array, recording: int, channel: str, noise: float, known: bool, parameters: int
) -> Residuals:
    """The residuals of a block, SI, with their tests.

    Args:
        off: Recorded less computed, shape (n,).
        recording: Index of the recording.
        channel: Channel of the recording.
        noise: Standard deviation.
        known: True for a given noise.
        parameters: Number of parameters fitted to the channel.
    """
    n = len(off)
    centred = off - off.mean()
    power = float(centred @ centred)
    lags = min(LAGS, max(1, n // 5))
    rho = np.array([float(centred[k:] @ centred[:-k]) for k in range(1, lags + 1)]) / (power or 1.0)
    statistic = n * (n + 2) * float(np.sum(rho**2 / (n - np.arange(1, lags + 1))))
    degrees = max(1, lags - parameters) if n < 200 else lags
    return Residuals(
        recording=recording,
        channel=channel,
        count=n,
        noise=noise,
        known=known,
        reduced=float(off @ off) / (n * noise**2) if known else 1.0,
        ljung_box=float(stats.chi2.sf(statistic, degrees)) if power else nan,
        runs=_runs(off),
        correlation=float(rho[0]),
    )


def _runs(off: Array) -> float:
    """The p-value of the number of runs of one sign, by its normal approximation."""
    positive = off > 0.0
    ups, downs = int(np.count_nonzero(positive)), int(np.count_nonzero(~positive))
    n = ups + downs
    if not ups or not downs or n < 3:
        return 0.0
    runs = 1 + int(np.count_nonzero(positive[1:] != positive[:-1]))
    expected = 1.0 + 2.0 * ups * downs / n
    variance = (expected - 1.0) * (expected - 2.0) / (n - 1.0)
    return (
        float(2.0 * stats.norm.sf(abs(runs - expected) / sqrt(variance))) if variance > 0 else 0.0
    )


def first_noise(values: Array) -> float:
    """The noise of samples of something smooth, by their second differences."""
    second = np.diff(values, 2) / sqrt(6.0)
    spread = 1.4826 * float(np.median(np.abs(second)))
    return max(spread, 1e-6 * float(np.ptp(values)), 1e-300)
