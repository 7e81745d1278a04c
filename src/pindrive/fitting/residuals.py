"""Residuals of a fit: size, and test for structure."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import hypot, nan, sqrt
from typing import Final

import numpy as np
from numpy.typing import NDArray

from pindrive.fitting.model import Block
from pindrive.fitting.noise import Noise
from pindrive.fitting.recording import display_of
from pindrive.fitting.whitening import UNLIKELY, Whitening
from pindrive.lazy import stats
from pindrive.quantities.quantity import significant

Array = NDArray[np.float64]

BINS: Final = 12
"""Parts of the time, the speed and the position in which residuals are compared."""
LAGS: Final = 20
"""Lags of the Ljung-Box test; a fifth of the samples where they are fewer."""


@dataclass(frozen=True, slots=True)
class Place:
    """Test of residuals against a quantity.

    Attributes:
        p_value: P-value of equal means, or of equal spreads, in parts of the range.
        begin: Begin of the part that is farthest off, SI.
        end: End of that part.
    """

    p_value: float
    begin: float = nan
    end: float = nan


@dataclass(frozen=True, slots=True)
class Residuals:
    """Residuals of one channel of one recording.

    Attributes:
        recording: Index of the recording.
        channel: "position", "velocity", "acceleration" or "force".
        count: Number of samples.
        model: Noise that was given or chosen.
        noise: The standard deviation, SI: the known one, or that of the residuals; of rounded
            samples that before the converter.
        correlation: Correlation of neighbours of correlated noise; 0 of other noise.
        degrees: Degrees of freedom of outliers; infinite of other noise.
        added: Values that the sensor adds, by their key, SI: the offset, in the middle of the
            recording; the drift, from the first time to the last; the bend, the middle less the
            ends; hum.
        rejected: Excess of the information criterion of other noises, by their words; empty where
            the noise was given.
        reduced: Mean square of the residuals over the square of the noise; 1 where it is estimated.
        deviance: −2 times the log-likelihood of the residuals.
        ljung_box: P-value of the Ljung-Box test for autocorrelation (Biometrika 65:297, 1978), of
            the residuals as independent ones.
        runs: P-value of the Wald-Wolfowitz test for the number of runs of one sign; NaN of rounded
            samples, whose signs are not even.
        neighbours: Correlation of neighbouring residuals as independent ones.
        places: Tests of the residuals as independent ones over "time", "speed" and "position" of
            the pin, SI.
    """

    recording: int
    channel: str
    count: int
    model: Noise
    noise: float
    correlation: float
    degrees: float
    added: dict[str, float]
    rejected: dict[str, float]
    reduced: float
    deviance: float
    ljung_box: float
    runs: float
    neighbours: float
    places: dict[str, Place]

    @property
    def known(self) -> bool:
        """True for a noise of given size."""
        return self.model.size is not None

    @property
    def description(self) -> str:
        """Noise in words, with its numbers."""
        unit, scale = display_of(self.channel)

        def shown(value: float) -> str:
            return f"{significant(abs(value) * scale, 3)} {unit}".rstrip()

        parts = [f"{key} {shown(value)}" for key, value in self.added.items() if "_" not in key]
        for key, words in (("hum", "hum"), ("hum2", "its harmonic")):
            if f"{key}_sine" in self.added:
                size = hypot(self.added[f"{key}_sine"], self.added[f"{key}_cosine"])
                parts.append(f"{words} {shown(size)}")
        if self.model.correlated:
            parts.append(f"correlation {self.correlation:.2f}")
        if self.model.outliers:
            parts.append(f"outliers, t of {self.degrees:.1f} degrees")
        if self.model.step is not None:
            parts.append(f"steps of {shown(float(self.model.step))}")
        return ", ".join(parts) or "white"

    @property
    def structured(self) -> bool:
        """True if the residuals are no noise: the drive does more than the model."""
        tests = (self.ljung_box, self.runs, *(place.p_value for place in self.places.values()))
        return any(p < UNLIKELY for p in tests) or self.excessive

    @property
    def excessive(self) -> bool:
        """True if the residuals exceed the given noise."""
        return self.known and bool(stats.chi2.sf(self.reduced * self.count, self.count) < UNLIKELY)


def tested(
    off: Array,
    independent: Array,
    made: Whitening,
    *,
    block: Block,
    noise: Noise,
    added: dict[str, float],
    rejected: dict[str, float],
    over: dict[str, Array],
    parameters: int,
) -> Residuals:
    """The residuals of a block with their tests.

    Args:
        off: Recorded less computed, SI, shape (n,).
        independent: Independent residuals of variance one, shape (n,).
        made: Whitening that makes them so.
        block: Samples of one channel of one recording.
        noise: Noise that was given or chosen.
        added: Values that the sensor adds, by their key.
        rejected: Excess of the criterion of other noises.
        over: Time, speed and position of the pin at the samples, SI, by name, shape (n,).
        parameters: Number of fitted parameters.
    """
    n = len(off)
    centred = independent - independent.mean()
    power = float(centred @ centred)
    lags = min(LAGS, max(1, n // 5))
    rho = np.array([float(centred[k:] @ centred[:-k]) for k in range(1, lags + 1)]) / (power or 1.0)
    statistic = n * (n + 2) * float(np.sum(rho**2 / (n - np.arange(1, lags + 1))))
    degrees = max(1, lags - parameters) if n < 200 else lags
    return Residuals(
        recording=block.recording,
        channel=block.channel,
        count=n,
        model=noise,
        noise=made.size,
        correlation=made.correlation,
        degrees=made.degrees,
        added=added,
        rejected=rejected,
        reduced=float(independent @ independent) / n if noise.size is not None else 1.0,
        deviance=made.deviance(-off),
        ljung_box=float(stats.chi2.sf(statistic, degrees)) if power else nan,
        runs=nan if made.half else _runs(independent),
        neighbours=float(rho[0]),
        places=places(independent, over),
    )


def places(scores: Array, over: Mapping[str, Array]) -> dict[str, Place]:
    """Return tests of residuals against quantities.

    Args:
        scores: Residuals that are independent and have variance one, shape (n,).
        over: Quantities by name, shape (n,).
    """
    return {name: _place(scores, values) for name, values in over.items()}


def binned(scores: Array, values: Array) -> tuple[Array, Array]:
    """Return parts of a range by their edges, (m + 1,), and their means in standard errors, (m,).

    Args:
        scores: Residuals that are independent and have variance one, shape (n,).
        values: Quantity whose range is parted, with as many samples in each part, shape (n,).
    """
    edges = np.unique(np.quantile(values, np.linspace(0.0, 1.0, BINS + 1)))
    if len(edges) < 3:
        return edges, np.zeros(max(len(edges) - 1, 0))
    part = np.clip(np.searchsorted(edges, values, side="right") - 1, 0, len(edges) - 2)
    count = np.bincount(part, minlength=len(edges) - 1)
    sums = np.bincount(part, scores, minlength=len(count))
    size = np.sqrt(np.maximum(count, 1) * np.mean(scores**2))
    return edges, np.divide(sums, size, out=np.zeros(len(count)), where=size > 0.0)


def _place(scores: Array, values: Array) -> Place:
    edges, off = binned(scores, values)
    if not off.any():
        return Place(1.0)
    p_value = float(stats.chi2.sf(float(off @ off), len(off)))
    worst = int(np.abs(off).argmax())
    return Place(p_value, float(edges[worst]), float(edges[worst + 1]))


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
