"""The lines along a pin's way, as printed and as shown: found to the instant, and as data."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from pindrive import _core
from pindrive.device.device import Device
from pindrive.device.hand import HandPath
from pindrive.device.page import Scene
from pindrive.quantities import budgets
from pindrive.quantities.value import concise, equal_by_value


@dataclass(frozen=True, slots=True, eq=False)
class PrintedLines:
    """Lines printed across the way of one pin."""

    begin: NDArray[np.float64]
    """Times at which the spot enters each line, s, shape (n,)."""
    end: NDArray[np.float64]
    """Times at which the spot leaves it, s."""
    whole: NDArray[np.uint8]
    """1 for a whole crossing: no begin, end or turn of the path on the line; else 0."""


def printed_lines(device: Device, path: HandPath, scene: Scene) -> list[PrintedLines]:
    """The lines along the way of each pin: where the luminance is below the threshold.

    A line on which the hand turns back is not whole, nor is one under the spot at the begin or end
    of the path. Edges are found to the last bit between samples, four to a pixel.

    Raises:
        ValueError: Too many lines.
    """
    spots = np.ascontiguousarray(device.array.on_page(device.array.spots), np.float64)
    found, edges = _core.printed_lines(
        scene.raster, path.rows, device.array.axis, device.control.threshold, spots, MOST_EDGES
    )
    budgets.LINES.check(0.5 * edges, f"up to pin {len(found)} of {len(spots)}")
    return [PrintedLines(*columns) for columns in found]


MOST_EDGES: Final = 2 * int(budgets.LINES.most) + 2
"""Number of edges of printed lines at which an evaluation ends."""
Fate = Literal["shown", "unseen", "merged", "faint"]
Cue = Literal["none", "felt", "direction", "sure"]

CUES: Final[tuple[Cue, ...]] = ("none", "felt", "direction", "sure")
FATES: Final[tuple[Fate, ...]] = ("shown", "unseen", "merged", "faint")


@equal_by_value
@concise
@dataclass(frozen=True, slots=True, kw_only=True)
class Edge:
    """One end of a printed line under one pin, with its response. NaN: no response."""

    time: float
    """Time of its passage under the spot, s."""
    x: float
    y: float
    """Height of the passage on the page, m."""
    command: float
    """Time of the switching of the magnet, s."""
    response: float
    """Time of the response at the finger, s."""
    lag: float
    """Distance of the hand from `time` to `response`, m."""
    skin: float
    """Displacement of the skin, m."""
    cue: Cue
    """Perceived cue: nothing, a pulse, its direction, its direction with certainty."""

    @property
    def latency(self) -> float:
        """From the edge to the response, s."""
        return self.response - self.time


@equal_by_value
@concise
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
    """Displacement of the pin, m."""
    height: float
    """The pin's highest deflection for it, m."""
    returned: float
    """Return of the pin before the next line or the hand's stop, m."""
    release: float
    """Time of the pin's break-away from the plate, s."""
    settled: float
    """Settling time of the pin, s; NaN: not settled."""
    smear: float
    """Distance of the hand from release to settling, m."""
    overshoot: float
    contrast: float

    @property
    def numbers(self) -> dict[str, float]:
        """Results, SI, by the names of the table of quantities."""
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


@equal_by_value
@concise
@dataclass(frozen=True, slots=True)
class FalseLine:
    """A swing of a pin that feels like a line and is none."""

    pin: int
    time: float
    """Time of the highest position, s."""
    x: float
    y: float
    """Height of the pin's spot at that time, m."""
    stroke: float
    """Height of the swing, m."""
