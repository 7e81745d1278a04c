"""Trajectory of a pin between its turning points, by NumPy; see scan_evaluation.py."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import nan
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pindrive.device.hand import HandPath
from pindrive.device.trajectory import roots
from pindrive.motion.motion import Motion
from pindrive.quantities.status import Side

NODES, WEIGHTS = np.polynomial.legendre.leggauss(8)


class Signal:
    """A quantity of a pin over time, counted forward: monotone between the knots of its course.

    Args:
        of: A method of a `Motion`: its `position` or its `stretch`.
        sign: 1, or -1 where the plate goes backwards.
    """

    def __init__(self, of: Callable[..., NDArray[np.float64]], sign: float) -> None:
        self.of, self.sign = of, sign

    def __call__(self, t: ArrayLike, side: Side = "right") -> NDArray[np.float64]:
        """It at times t (s, any shape); `side` is the limit taken where it jumps."""
        return self.sign * np.asarray(self.of(t, side))

    def __neg__(self) -> Signal:
        """Return the signal counted backwards."""
        return Signal(self.of, -self.sign)


@dataclass(frozen=True, eq=False)
class Trajectory:
    """Trajectory of a pin, piece by piece; times are since the motion's begin, s."""

    motion: Motion

    @cached_property
    def knots(self) -> NDArray[np.float64]:
        """Begin, events, turning points and end, s, shape (n,), increasing."""
        motion, lasts = self.motion, self.motion.duration
        ends = [segment.end for segment in motion.segments if segment.end < lasts]
        events = [event.time for event in motion.events_between(0.0, lasts)]
        turns = motion.extrema("position").time
        return np.unique(np.concatenate([[0.0], ends, events, turns, [lasts]]))

    def within(self, begin: float, end: float) -> NDArray[np.float64]:
        """Return the knots from `begin` to `end`, with both ends."""
        first, last = np.searchsorted(self.knots, (begin, end), ("right"))
        inner = self.knots[first:last]
        return np.concatenate([[begin], inner[inner < end], [end]])

    def pieces(
        self, values: Signal, begin: float, end: float
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """The knots in between, and the values where each piece begins and where it ends."""
        t = self.within(begin, end)
        return t, values(t[:-1]), values(t[1:], "left")

    def highest(self, values: Signal, begin: float, end: float) -> tuple[float, float]:
        """The time and the size of the largest value from `begin` to `end`."""
        t, starts, stops = self.pieces(values, begin, end)
        i, j = int(np.argmax(starts)), int(np.argmax(stops))
        if starts[i] >= stops[j]:
            return float(t[i]), float(starts[i])
        return float(t[j + 1]), float(stops[j])

    def first_at(self, values: Signal, level: float, begin: float, end: float) -> float:
        """The first time in [begin, end] at which the values are at `level` or above; or NaN."""
        t, starts, stops = self.pieces(values, begin, end)
        found = np.flatnonzero((starts >= level) | (stops >= level))
        if not found.size:
            return nan
        i = int(found[0])
        if starts[i] >= level:
            return float(t[i])
        return root(lambda s: values(s, "left") - level, t[i], t[i + 1])

    def last_beyond(
        self, values: Signal, middle: float, band: float, begin: float, end: float
    ) -> float:
        """The last time in [begin, end] at which the values are `band` or more from `middle`.

        For values that do not jump; `begin` where they never are.
        """
        t = self.within(begin, end)
        out = np.flatnonzero(np.abs(values(t) - middle) >= band)
        if not out.size:
            return begin
        i = int(out[-1])
        if i == len(t) - 1:
            return end
        return root(lambda s: band - np.abs(values(s) - middle), t[i], t[i + 1])

    def climbs(self, values: Signal, height: float, begin: float, end: float) -> bool:
        """Return True if the values ever exceed their lowest since `begin` by `height`."""
        y = values(self.within(begin, end))
        return bool((y - np.minimum.accumulate(y) >= height).any())

    def climb(self, values: Signal, height: float, begin: float, end: float) -> tuple[float, float]:
        """Return the first time at which continuous values exceed their lowest by `height`.

        Returns:
            That time, NaN if they never are; and the last time of that lowest value.
        """
        t = self.within(begin, end)
        y = values(t)
        found = np.flatnonzero(y - np.minimum.accumulate(y) >= height)
        if not found.size:
            return nan, float(t[last_lowest(y)])
        i = int(found[0])
        dip = last_lowest(y[: i + 1])
        base = float(y[dip])
        return root(lambda s: values(s) - base - height, t[i - 1], t[i]), float(t[dip])

    def swings(self, values: Signal, begin: float, end: float) -> list[tuple[float, float]]:
        """From when to when values that do not jump climb, from each lowest to the next highest."""
        t = self.within(begin, end)
        up = np.diff(values(t)) > 0.0
        steps = np.diff(np.concatenate([[False], up, [False]]).astype(int))
        return list(zip(t[steps == 1].tolist(), t[steps == -1].tolist(), strict=True))

    def held(self) -> list[tuple[float, float]]:
        """From when to when the plate holds the pin."""
        held: list[tuple[float, float]] = []
        for segment in self.motion.segments:
            if segment.plate == 0 and segment.begin < self.motion.duration:
                begin, end = segment.begin, min(segment.end, self.motion.duration)
                if held and held[-1][1] == begin:
                    begin, _ = held.pop()
                held.append((begin, end))
        return held

    def rests(self, t: float) -> bool:
        """Return True if the finger holds the pin just before a time."""
        i = int(np.searchsorted(self._ends, t))
        segments = self.motion.segments
        segment = segments[min(i, len(segments) - 1)]
        return segment.mode == "resting" and float(self.motion.velocity(t, "left")) == 0.0

    @cached_property
    def _ends(self) -> NDArray[np.float64]:
        return np.array([segment.end for segment in self.motion.segments])


def last_lowest(values: NDArray[np.float64]) -> int:
    """The index of the lowest value, the last one of several."""
    return int(np.flatnonzero(values == values.min())[-1])


def root(f: Callable[[Any], NDArray[np.float64]], low: float, high: float) -> float:
    """The first time at which f, negative at `low`, is so no longer; it is at least 0 at `high`."""
    return float(roots(f, np.array([low]), np.array([high]), np.array([-1.0]))[0])


class Way:
    """The length of the hand's way over the page."""

    def __init__(self, path: HandPath) -> None:
        self.path = path
        times = path.times
        self._lengths = np.concatenate([[0.0], np.cumsum(self._length(times[:-1], times[1:]))])

    def _length(self, begin: NDArray[np.float64], end: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the length of stretches with linear velocity: exact on straight paths."""
        half = 0.5 * (end - begin)
        t = begin[:, None] + half[:, None] * (1.0 + NODES)
        speed = np.hypot(*self.path.velocity(np.clip(t, self.path.begin, self.path.end)))
        return np.asarray(half * (speed @ WEIGHTS))

    def __call__(self, t: ArrayLike) -> NDArray[np.float64]:
        """The length gone by times t (s, shape (n,)), m."""
        at = np.atleast_1d(np.asarray(t, np.float64))
        i = np.clip(np.searchsorted(self.path.times, at, "right") - 1, 0, len(self._lengths) - 2)
        return self._lengths[i] + self._length(self.path.times[i], at)

    def between(self, begin: float, end: float) -> float:
        """Return the path length between two times, m; NaN for a NaN."""
        if not begin <= end:
            return nan if begin != begin or end != end else -self.between(end, begin)
        first, last = self((begin, end))
        return float(last - first)
