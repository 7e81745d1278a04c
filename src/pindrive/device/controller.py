"""Control block: samples the luminance at its own rate, and switches the coils after a delay."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil

import numpy as np
from numpy.typing import NDArray

from pindrive.quantities import budgets
from pindrive.quantities.contradictions import refuse
from pindrive.quantities.part import Number
from pindrive.quantities.table import checked, default


@dataclass(frozen=True, slots=True)
class Decision:
    """The state of the control block for one coil."""

    on: bool = False
    """Last decision."""
    switched: bool = False
    """State of the coil."""
    pending: tuple[float, ...] = ()
    """Time of the pending switching, s."""


@checked
class ControlBlock:
    """A threshold with hysteresis, at a sample rate, with latency.

    A coil is switched on when the luminance falls below threshold - hysteresis/2, off when it rises
    above threshold + hysteresis/2: the black line energises the magnet (the paper, introduction).

    Args:
        sample_rate: Sampling rate, Hz, greater than 0; samples are at multiples of 1/sample_rate.
        latency: Delay from sampling to switching, s, at least 0.
        threshold: Luminance in [0, 1].
        hysteresis: Width of the band about it, in [0, 1]; the band lies within [0, 1].

    Raises:
        ValueError: A value is not a number or out of its range.
    """

    sample_rate: Number = default("sample_rate")
    latency: Number = default("latency")
    threshold: Number = default("threshold")
    hysteresis: Number = default("hysteresis")

    def __post_init__(self) -> None:
        """Validate what follows from them."""
        band = {"control.threshold": self.threshold, "control.hysteresis": self.hysteresis}
        refuse(band, whole=True)

    def sample_times(self, begin: float, end: float) -> NDArray[np.float64]:
        """Return the sampling instants in [begin, end), s, shape (n,)."""
        self.check_samples(begin, end)
        first, last = ceil(begin * self.sample_rate), ceil(end * self.sample_rate)
        times = np.arange(first - 1, last + 1, dtype=np.float64) / self.sample_rate
        return times[(times >= begin) & (times < end)]

    def check_samples(self, begin: float, end: float, pins: int = 1) -> None:
        """Reject too many samples of the pins from `begin` to `end` (s)."""
        each, lasts = ceil((end - begin) * self.sample_rate), end - begin
        of = f"{pins} pins, {lasts:g} s at {self.sample_rate:g} Hz"
        budgets.SAMPLES_OF_CONTROL.check(float(pins * each), of)
