"""A motion as a picture needs it: phase by phase on a fine grid, with both limits at a jump."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, isfinite, nan, sqrt, tau
from typing import TYPE_CHECKING, Final

import numpy as np

from pindrive.plot.style import MM

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    from pindrive.motion.motion import Motion
    from pindrive.motion.results import Event, Segment

MOST_PHASES, MOST_PERIODS = 5000, 2500
"""Limits of the trace of a very long motion, from its start: phases, and periods in motion.

While the pin is stuck nothing swings, however long that takes."""
STUCK: Final = ("carried", "resting")
_STUCK_POINTS: Final = 200
"""Points in a phase in which the pin is stuck: its position is a parabola over time."""

_MOST_CLOSER: Final = 30.0
"""Largest refinement of the grid for sticking skin, which acts as a stiffer spring."""

MICRON: Final = 1e6  # separate intervals


@dataclass(frozen=True, slots=True)
class Trace:
    """The motion phase by phase on a fine grid, in the units of the axes."""

    end: float
    """Until when it is drawn, s."""
    phases: tuple[tuple[Segment, float], ...]
    """Segments, and how much later than themselves they are drawn (another round of a cycle), s."""
    starts: NDArray[np.intp]
    """Begin of each phase in the columns; each phase includes both ends."""
    t: NDArray[np.float64]
    x: NDArray[np.float64]
    v: NDArray[np.float64]
    a: NDArray[np.float64]
    s: NDArray[np.float64]
    """Stretch of the skin, µm; 0 of a rigid finger."""
    f: NDArray[np.float64]
    """Force of the end stops on the pin, N; 0 without them."""
    events: tuple[tuple[Event, float], ...]
    """Events, and their delay."""
    unit: str
    """Unit of time."""
    scale: float
    """Units of time in a second."""

    @classmethod
    def of(cls, motion: Motion) -> Trace:
        """Trace a motion; a very long one from its start, as far as a picture can show."""
        ratio, frequency = motion.drive.damping_ratio, motion.drive.natural_frequency
        oscillates, period = ratio < 1.0, tau / frequency
        end = motion.duration
        phases = tuple(_phases(motion, end))
        if len(phases) == MOST_PHASES:
            last, delay = phases[-1]
            end = min(end, last.end + delay)
        if oscillates:
            end = _until(phases, end, MOST_PERIODS * period)
            phases = tuple((phase, delay) for phase, delay in phases if phase.begin + delay < end)
        free = sum(
            min(phase.end + delay, end) - phase.begin - delay
            for phase, delay in phases
            if phase.mode not in STUCK
        )
        density = 2000.0 / end
        if oscillates:
            density = min(200.0 / period, max(90.0 / period, 20_000 / (free or end)))
        fastest = frequency * (ratio + sqrt(max(0.0, ratio**2 - 1.0)))
        skin, spring = motion.drive.finger, motion.drive.stiffness
        gripped = 1.0 if skin.rigid else min(sqrt(1.0 + skin.stiffness / spring), _MOST_CLOSER)
        grids = [
            np.linspace(phase.begin, last, _STUCK_POINTS)
            if phase.mode in STUCK
            else _grid(
                phase.begin, last, density * (gripped if phase.finger == 0 else 1.0), fastest
            )
            for phase, delay in phases
            for last in [min(phase.end, end - delay)]
        ]
        sizes = np.array([len(grid) for grid in grids])
        lasts = np.cumsum(sizes) - 1
        t = np.concatenate(grids)
        x, v, a = motion.position(t), motion.velocity(t), motion.acceleration(t)
        v[lasts] = motion.velocity(t[lasts], "left")  # jumps where a pin strikes a rigid stop
        a[lasts] = motion.acceleration(t[lasts], "left")
        s = motion.stretch(t)
        s[lasts] = motion.stretch(t[lasts], "left")
        f = motion.force("stop", t)
        f[lasts] = motion.force("stop", t[lasts], "left")
        delays = np.repeat([delay for _, delay in phases], sizes)
        unit, scale = ("ms", 1e3) if end < 2.0 else ("s", 1.0)
        return cls(
            end,
            phases,
            np.append(0, lasts[:-1] + 1),
            (t + delays) * scale,
            x * MM,
            v * MM,
            a,
            s * MICRON,
            f,
            tuple(_events(motion, end)),
            unit,
            scale,
        )

    def stuck(self, mode: str) -> list[tuple[float, float]]:
        """Begin and length of each phase stuck in this way, in the unit of the time axis."""
        return self._spans(lambda phase: phase.mode == mode)

    def gripping(self) -> list[tuple[float, float]]:
        """Return the phases in which compliant skin sticks to the pin."""
        return self._spans(lambda phase: phase.finger == 0)

    def _spans(self, chosen: Callable[[Segment], bool]) -> list[tuple[float, float]]:
        return [
            (self.scale * (phase.begin + delay), self.scale * (end - phase.begin))
            for phase, delay in self.phases
            if chosen(phase)
            for end in [min(phase.end, self.end - delay)]
        ]

    def broken(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """A column with a gap between phases, so that a line does not slope across a jump."""
        return np.insert(values, self.starts[1:], nan)

    def only(self, mode: str, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """A column where the motion is in this mode, NaN elsewhere; phases with a gap between."""
        sizes = np.diff(np.append(self.starts, len(values)))
        there = np.repeat([phase.mode == mode for phase, _ in self.phases], sizes)
        return self.broken(np.where(there, values, nan))


def _until(phases: tuple[tuple[Segment, float], ...], end: float, room: float) -> float:
    """Return the time after a given duration of free motion, s; at most the end."""
    for phase, delay in phases:
        if phase.mode not in STUCK:
            begin = phase.begin + delay
            length = min(phase.end + delay, end) - begin
            if length > room:
                return begin + room
            room -= length
    return end


def _rounds(motion: Motion) -> tuple[float, float]:
    """Begin and period of what repeats forever; infinite if nothing with events does."""
    last = motion.segments[-1].end
    if motion.ending.kind == "steady" and isfinite(last):
        return last - motion.ending.period, motion.ending.period
    return inf, inf


def _phases(motion: Motion, until: float) -> Iterator[tuple[Segment, float]]:
    """Segments with their delays, in order, a cycle round after round."""
    begin, period = _rounds(motion)
    delay, count = 0.0, 0
    rounding = 1e-12 * until
    segments = motion.segments
    while True:
        for segment in segments:
            if until - delay - segment.begin <= rounding or count == MOST_PHASES:
                return
            if segment.end > segment.begin:
                count += 1
                yield segment, delay
        if period == inf:
            return
        delay += period
        segments = tuple(s for s in motion.segments if (s.begin + s.end) / 2 > begin)


def _events(motion: Motion, until: float) -> Iterator[tuple[Event, float]]:
    """Events with their delays, in order, a cycle round after round."""
    begin, period = _rounds(motion)
    delay = 0.0
    events = motion.events
    while events and events[0].time + delay <= until:
        for event in events:
            if event.time + delay <= until:
                yield event, delay
        if period == inf:
            return
        delay += period
        events = tuple(e for e in motion.events if e.time > begin + 1e-9 * period)


def _grid(begin: float, end: float, density: float, fastest: float) -> NDArray[np.float64]:
    """Times from end to end, closer at the beginning where a fast mode dies away there."""
    grid = np.linspace(begin, end, max(6, int(density * (end - begin))))
    if fastest < density / tau:  # fine enough already
        return grid
    layer = begin + np.linspace(0.0, 6.0, 60) / fastest
    return np.union1d(grid, layer[layer < end])
