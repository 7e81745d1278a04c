"""What a pin showed a finger, as data: lines, their edges, false lines."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal

Fate = Literal["shown", "unseen", "merged", "faint"]
Cue = Literal["none", "felt", "direction", "sure"]

CUES: Final[tuple[Cue, ...]] = ("none", "felt", "direction", "sure")
FATES: Final[tuple[Fate, ...]] = ("shown", "unseen", "merged", "faint")


@dataclass(frozen=True, slots=True, kw_only=True)
class Edge:
    """One end of a printed line under one pin, and what became of it. NaN: it did not."""

    time: float
    """When it passed under the spot, s."""
    x: float
    y: float
    """Where that is on the page, m."""
    command: float
    """When the magnet was switched for it, s."""
    response: float
    """When the finger was shown it, s."""
    lag: float
    """What the hand went from `time` to `response`, m."""
    skin: float
    """How far the skin moved for it, m."""
    cue: Cue
    """What the finger makes of that: nothing, a pulse, its direction, its direction for sure."""

    @property
    def latency(self) -> float:
        """From the edge to the response, s."""
        return self.response - self.time


@dataclass(frozen=True, slots=True, kw_only=True)
class Line:
    """One printed line under one pin."""

    pin: int
    begin: Edge
    end: Edge
    fate: Fate
    """Shown; or missed: unseen by the control block, merged into the line before, or too faint: the
    pin did not go along, or the skin did not move enough to be felt."""
    stroke: float
    """How far it moved the pin, m."""
    height: float
    """The pin's highest deflection for it, m."""
    returned: float
    """How far the pin came back from there, before the next line or the hand's stop, m."""
    release: float
    """When the pin broke away from the plate, s."""
    settled: float
    """When the pin had settled after it, s; NaN: it did not."""
    smear: float
    """What the hand went from release to settled, m."""
    overshoot: float
    contrast: float

    @property
    def numbers(self) -> dict[str, float]:
        """What was found, SI, by the names of the table of quantities."""
        return {
            "line.latency_on": self.begin.latency,
            "line.latency_off": self.end.latency,
            "line.lag_on": self.begin.lag,
            "line.lag_off": self.end.lag,
            "line.stroke": self.stroke,
            "line.skin_on": self.begin.skin,
            "line.skin_off": self.end.skin,
            "line.smear_time": self.settled - self.release,
            "line.smear": self.smear,
            "line.overshoot": self.overshoot,
            "line.contrast": self.contrast,
        }


@dataclass(frozen=True, slots=True)
class Echo:
    """A swing of a pin that feels like a line and is none."""

    pin: int
    time: float
    """When it was highest, s."""
    x: float
    y: float
    """Where the pin's spot was then, m."""
    stroke: float
    """How high it was, m."""
