"""The lines along a pin's way, as printed and as shown: found to the instant, and as data."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from math import cos, sin
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from pindrive.device.device import Device
from pindrive.device.hand import HandPath
from pindrive.device.page import AT_ONCE, FINER, Scene
from pindrive.device.trajectory import Way, roots
from pindrive.quantities import budgets
from pindrive.quantities.value import concise, equal_by_value

GRAZED: Final = 0.5
"""Fraction of a pixel below which a crossing is a grazed edge, neither line nor gap."""


@dataclass(frozen=True, slots=True)
class Printed:
    """A line printed across a pin's way, while its spot was on it."""

    begin: float
    """Time at which the spot entered the line, s."""
    end: float
    """Time at which the spot left the line, s."""
    whole: bool
    """True for a whole crossing: no begin, end or turn of the path on the line."""


def printed(device: Device, path: HandPath, scene: Scene) -> list[list[Printed]]:
    """The lines along the way of each pin: where the luminance is below the threshold.

    The luminance is linear between the middles of pixels (`Scene.at`), its edges are found by
    cutting brackets. A line on which the hand turns back is not whole, nor is one under the spot at
    the path's begin or end.

    Raises:
        ValueError: Too many lines.
    """
    way = Way(path)
    lengths = np.diff(way(path.times))
    counts = 1 + np.ceil(lengths * FINER / scene.pixel).astype(int)
    turned = turnings(path, device.array.axis)
    threshold = device.control.threshold
    offsets = device.array.on_page(device.array.spots)
    found: list[list[Printed]] = []
    passed = 0.0
    for dx, dy in offsets.tolist():

        def lightness(
            t: NDArray[np.float64], dx: float = dx, dy: float = dy
        ) -> NDArray[np.float64]:
            x, y = path.position(t)
            return scene.at(x + dx, y + dy) - threshold

        edges, first, last = _edges(lightness, _sample_times(path, counts))
        passed += 0.5 * len(edges)
        budgets.LINES.check(passed, f"up to pin {len(found)} of {len(offsets)}")
        times = np.concatenate([[path.begin], edges, [path.end]])
        times = times[0 if first else 1 : None if last else -1]
        begins, ends = times[::2], times[1::2]
        shortest = GRAZED * scene.pixel
        gaps = way(begins[1:]) - way(ends[:-1]) > shortest if len(begins) else np.zeros(0, bool)
        begins = begins[np.append(True, gaps)] if len(begins) else begins
        ends = ends[np.append(gaps, True)] if len(ends) else ends
        long = way(ends) - way(begins) > shortest if len(begins) else np.zeros(0, bool)
        found.append(
            [
                Printed(
                    a,
                    b,
                    path.begin < a and b < path.end and not ((turned > a) & (turned < b)).any(),
                )
                for a, b in zip(begins[long].tolist(), ends[long].tolist(), strict=True)
            ]
        )
    return found


def _edges(
    lightness: Callable[[NDArray[np.float64]], NDArray[np.float64]],
    sample_times: Iterator[NDArray[np.float64]],
) -> tuple[NDArray[np.float64], bool, bool]:
    """Return the changes between dark and light, s, and the darkness at both ends.

    Args:
        lightness: Luminance above the threshold at times, s.
        sample_times: Times that find each change, in order, some at a time.
    """
    low, high, sign = [np.zeros(0)], [np.zeros(0)], [np.zeros(0)]
    first, before, was = False, np.zeros(0), np.zeros(0, bool)
    for some in sample_times:
        t = np.concatenate([before, some])
        dark = np.concatenate([was, lightness(some) < 0.0])
        changes = np.flatnonzero(dark[1:] != dark[:-1])
        budgets.LINES.check(0.5 * sum(map(len, low)) + 0.5 * len(changes))
        low.append(t[changes])
        high.append(t[changes + 1])
        sign.append(np.where(dark[changes], -1.0, 1.0))
        first = first if before.size else bool(dark[0])
        before, was = t[-1:], dark[-1:]
    edges = roots(lightness, *(np.concatenate(parts) for parts in (low, high, sign)))
    return edges, first, bool(was[0])


def _sample_times(path: HandPath, counts: NDArray[np.int64]) -> Iterator[NDArray[np.float64]]:
    """Return the sampling times of the page, s, in order: several per row of a path."""
    starts = np.concatenate([[0], np.cumsum(counts)])
    lasts = np.diff(path.times)
    for first in range(0, int(starts[-1]), AT_ONCE):
        k = np.arange(first, min(first + AT_ONCE, int(starts[-1])))
        row = np.searchsorted(starts, k, "right") - 1
        yield path.times[row] + lasts[row] * (k - starts[row]) / counts[row]
    yield path.times[-1:]


def turnings(path: HandPath, axis: float) -> NDArray[np.float64]:
    """Return the stops and turns of the hand along an axis (rad) of the page, s, in order."""
    along = path.vx * cos(axis) + path.vy * sin(axis)
    along[np.abs(along) < 1e-9 * np.abs(along).max()] = 0.0  # across the axis except for rounding
    still = path.times[1:-1][(along[1:-1] == 0.0) & ((along[:-2] != 0.0) | (along[2:] != 0.0))]
    through = np.flatnonzero(along[1:] * along[:-1] < 0.0)
    part = along[through] / (along[through] - along[through + 1])
    across = path.times[through] + part * (path.times[through + 1] - path.times[through])
    return np.union1d(still, across)


# ---- what was shown ------------------------------------------------------------------------------


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
