"""Choice of the noise of a channel by the Bayesian information criterion."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from math import log
from typing import Final

import numpy as np
from numpy.typing import NDArray

from pindrive.fitting.noise import DRIFTS, Noise, column
from pindrive.fitting.whitening import Whitening, estimated

Array = NDArray[np.float64]

MAINS: Final = (50.0, 60.0)
"""Frequencies of hum that are tried, Hz."""
ALIKE: Final = 4.0
"""Excess of the criterion within which noises are as good (Kass and Raftery, 1995: 2 to 6 is
positive evidence)."""
TURNS: Final = 12
"""Iterations of the noise and of a Gauss-Newton step."""
CLOSE: Final = 1e-3
"""Change of the deviance with which they end."""
EXACT: Final = 1e-9
"""Part of the extent of a channel by which residuals without noise may be off."""
GRID: Final = 1e-6
"""Part of a step by which rounded samples may be off its multiples."""
FEW: Final = 0.5
"""Rounded samples have at most this part of as many values as samples."""


@dataclass(frozen=True, slots=True)
class Linearised:
    """Residuals of a channel near the optimum of a fit, and what other channels say.

    Attributes:
        off: Computed less recorded, SI, shape (n,).
        slopes: Derivatives of it, shape (n, k).
        times: Sample times, s, shape (n,).
        span: First and last time of the recording, s.
        interval: Sample interval, s.
        others: Independent residuals of all other channels, shape (m,).
        other_slopes: Derivatives of these, shape (m, k).
    """

    off: Array
    slopes: Array
    times: Array
    span: tuple[float, float]
    interval: float
    others: Array
    other_slopes: Array

    def solved(self, noise: Noise) -> Solved:
        """Return the optimum nearby with a noise."""
        hum = float(noise.hum or 0.0)
        added = [column(key, self.times, self.span, hum) for key in noise.keys]
        slopes = np.column_stack([self.slopes, *added]) if added else self.slopes
        rest = np.zeros((len(self.others), len(added)))
        other_slopes = np.hstack([self.other_slopes, rest])
        off, others, best = self.off, self.others, None
        for _ in range(TURNS):
            made = estimated(noise, off, slopes, self.times, self.interval, 1.0)
            deviance = made.deviance(off) + float(others @ others)
            if best is not None and deviance > best.deviance - CLOSE:
                break
            price = log(len(off)) * (noise.count + (noise.size is None))
            best = Solved(
                made,
                off,
                np.concatenate([made.residuals(off), others]),
                np.vstack([made.slopes(off, slopes), other_slopes]),
                deviance,
                deviance + price,
            )
            step = _step(best)
            off, others = off + slopes @ step, others + other_slopes @ step
        assert best
        return best


@dataclass(frozen=True, slots=True)
class Solved:
    """Optimum under a noise.

    Attributes:
        whitening: Whitening of the channel.
        off: Computed less recorded of the channel, SI, shape (n,).
        residuals: Independent residuals of the channel and of all others, shape (n + m,).
        slopes: Derivatives of these, shape (n + m, k).
        deviance: −2 times the log-likelihood.
        criterion: The criterion of Schwarz (Ann. Statist. 6:461, 1978).
    """

    whitening: Whitening
    off: Array
    residuals: Array
    slopes: Array
    deviance: float
    criterion: float


def _step(at: Solved) -> Array:
    """Return the Gauss-Newton step of all parameters, shape (k,)."""
    size = np.linalg.norm(at.slopes, axis=0)
    size[size == 0.0] = 1.0
    found, *_ = np.linalg.lstsq(at.slopes / size, -at.residuals, rcond=1e-9)
    step: Array = found / size
    return step


def chosen(at: Linearised, start: Noise, recorded: Array) -> tuple[Noise, dict[str, float]]:
    """Return the noise with the least criterion, and by how much others exceed it, by their words.

    Of noises that are as good it is the one with the fewest parameters. Drift, hum, correlation and
    outliers are added one by one where they help most, and left out again where they do not.

    Args:
        at: Residuals of the channel.
        start: Noise with what is known of it.
        recorded: Samples, SI, shape (n,), which tell if they are rounded.
    """
    start = replace(start, choose=False)
    if float(np.abs(at.off).max()) <= EXACT * float(np.ptp(recorded)):
        return start, {}  # there is no noise to choose
    step = step_of(recorded)
    if step is not None and start.size is None and float(np.std(at.off)) < step:
        start = replace(start, step=step)
    known = {start: at.solved(start).criterion}
    best = start
    while True:
        for noise in _neighbours(best):
            if noise not in known:
                known[noise] = at.solved(noise).criterion
        least = min(known, key=lambda noise: known[noise])
        if least == best:
            break
        best = least
    plain = [noise for noise, value in known.items() if value < known[best] + ALIKE]
    best = min(plain, key=lambda noise: (noise.count, known[noise]))
    excess = {str(noise): value - known[best] for noise, value in known.items() if noise != best}
    return best, dict(sorted(excess.items(), key=lambda item: item[1]))


def _neighbours(noise: Noise) -> Iterable[Noise]:
    """Yield noises with one thing more or less."""
    place = DRIFTS.index(noise.drift)
    for drift in range(len(DRIFTS)):
        if drift != place:
            yield replace(noise, drift=DRIFTS[drift])
    if noise.hum is None:
        yield from (replace(noise, hum=frequency) for frequency in MAINS)
    else:
        yield replace(noise, harmonics=3 - noise.harmonics)
        yield replace(noise, hum=None, harmonics=1)
    if noise.step is None:
        yield replace(noise, correlated=not noise.correlated)
        if noise.size is None:
            yield replace(noise, outliers=not noise.outliers)


def step_of(recorded: Array) -> float | None:
    """Return the step of a converter of which all samples are multiples, SI; None of others."""
    values = np.unique(recorded)
    if len(values) < 3 or len(values) > FEW * len(recorded):
        return None
    gaps = np.diff(values)
    step = float(gaps.min())
    parts = gaps / step
    # Decimal digits round each sample.
    slack = max(GRID, 4.0 * np.finfo(float).eps * float(np.abs(values).max()) / step)
    if np.abs(parts - np.round(parts)).max() > 1e3 * slack * max(1.0, parts.max()):
        return None
    return float(np.ptp(values) / np.round((values - values[0]) / step)[-1])
