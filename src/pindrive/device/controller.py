"""Control block: samples the luminance at its own rate, and switches the coils after a delay."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil

import numpy as np
from numpy.typing import NDArray

from pindrive.device.current import Commands
from pindrive.quantities import budgets
from pindrive.quantities.part import Number
from pindrive.quantities.refusal import refusal
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
        check_band(self.threshold, self.hysteresis)

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

    def decide(
        self,
        luminance: NDArray[np.float64],
        sample_times: NDArray[np.float64],
        end: float,
        before: Decision | None = None,
    ) -> tuple[Commands, Decision]:
        """The commands that one spot's luminance leads to.

        Args:
            luminance: Luminance at each sample, shape (n,).
            sample_times: Times of the samples, s, shape (n,), as from `sample_times`.
            end: Until when, s; a switching due then or later is left pending.
            before: State of the control block at the first sample; None: all magnets off.

        Returns:
            The switchings before `end`, and where the control block stands then.
        """
        before = before or Decision()
        dark = luminance < self.threshold - 0.5 * self.hysteresis
        light = luminance > self.threshold + 0.5 * self.hysteresis
        decided = np.flatnonzero(dark | light)
        on = np.concatenate([[before.on], dark[decided]])
        changes = decided[on[1:] != on[:-1]]
        due = np.concatenate([before.pending, sample_times[changes] + self.latency])
        times = due[due < end]
        switched = before.switched ^ (len(times) % 2 == 1)
        after = Decision(bool(on[-1]), switched, tuple(due[due >= end].tolist()))
        return Commands(times, before.switched), after


def check_band(threshold: float, hysteresis: float) -> None:
    """Refuse a band of luminance that is not within [0, 1]: it would never switch back."""
    widest = 2.0 * min(threshold, 1.0 - threshold)
    if hysteresis > widest:
        required = f"at most {widest:g} about a threshold of {threshold:g}"
        raise ValueError(refusal("hysteresis", required, repr(hysteresis)))
