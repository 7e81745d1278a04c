"""Largest hand speed over a page: fate of its lines at many speeds."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import isnan, nan, sqrt
from typing import Final

import numpy as np

import pindrive
from pindrive.device.device import Criteria, Device
from pindrive.device.page_description import Page
from pindrive.device.pin_scan import Progress
from pindrive.device.reading import Reading
from pindrive.device.scanning import scan
from pindrive.evaluation.perception import evaluate
from pindrive.evaluation.resolution import Band, check_tried
from pindrive.lazy import mpl_figure, xr
from pindrive.quantities.status import Status
from pindrive.quantities.table import QUANTITIES, default
from pindrive.quantities.value import equal_by_value
from pindrive.views import NotebookHtml, figure

TRIED: Final = 12
"""Speeds in the grid."""
PRECISION: Final = 1e-2
"""Relative precision of a border."""
_MOST: Final = TRIED + 14
"""Largest number of trials: the grid, and two bisections of an interval."""
Property = Callable[[Mapping[str, int]], bool]
COUNTED: Final = ("crossed", "shown", "unsettled", "sure", "false")


@equal_by_value
@dataclass(frozen=True, eq=False, repr=False)
class PageSpeeds(NotebookHtml):
    """Fate of the lines of a page, by the speed of the hand.

    Attributes:
        title: Title of the page.
        tried: The slowest hand and the fastest, m/s.
        counts: Numbers of lines and of false lines for each evaluated speed, m/s in ascending
            order, by the names of `Evaluation.counts`.
    """

    title: str
    tried: tuple[float, float]
    counts: Mapping[float, Mapping[str, int]]

    def __repr__(self) -> str:
        """The two limits, in a line."""
        shown, settled = (f"{1e3 * v:.4g} mm/s" for v in (self.shown_speed, self.settled_speed))
        limits = f"shown up to {shown}, settled up to {settled}"
        return f"<PageSpeeds of {self.title}: {limits}, {self.status}>"

    @property
    def status(self) -> Status:
        """`incomplete` where all lines are shown at no speed."""
        return Status.incomplete if isnan(self.shown_speed) else Status.ok

    @property
    def shown_speed(self) -> float:
        """The largest speed up to which all lines are shown and none is false, m/s; or NaN."""
        return self._largest(all_shown)

    @property
    def settled_speed(self) -> float:
        """The largest up to which the pin also settles after each line, m/s; or NaN."""
        return self._largest(all_settled)

    def _largest(self, holds: Property) -> float:
        return largest(self.counts, holds)

    def to_dataset(self) -> xr.Dataset:
        """The counts over `hand_speed`, and the two limits, with units."""
        speed = QUANTITIES["hand_speed"].attributes
        data = {
            name: ("hand_speed", [counts[f"lines.{name}"] for counts in self.counts.values()])
            for name in COUNTED
        }
        limits = {
            "shown_speed": ((), self.shown_speed, {"units": "m/s"}),
            "settled_speed": ((), self.settled_speed, {"units": "m/s"}),
        }
        coords = {"hand_speed": ("hand_speed", [*self.counts], speed)}
        return xr.Dataset({**data, **limits}, coords=coords)

    def plot(self, device: str = "") -> mpl_figure.Figure:
        """The part of the lines shown over the speed; `device` is a name for the title."""
        return figure(self, "plot", device)


def all_shown(counts: Mapping[str, int]) -> bool:
    """Return True if all lines are shown and none is false."""
    return counts["lines.shown"] == counts["lines.crossed"] and not counts["lines.false"]


def all_settled(counts: Mapping[str, int]) -> bool:
    """Return True if the pin also settles after each line."""
    return all_shown(counts) and not counts["lines.unsettled"]


def largest(counts: Mapping[float, Mapping[str, int]], holds: Property) -> float:
    """Return the largest speed up to which a property holds at every trial, m/s; or NaN."""
    found = nan
    for speed, numbers in counts.items():
        if not holds(numbers):
            break
        found = speed
    return found


def speeds_over_page(
    device: Device,
    reading: Reading,
    page: Page,
    *,
    touch: float | pindrive.Profile | None = None,
    criteria: Criteria | None = None,
    slowest: float = default("speed.slowest"),
    fastest: float = default("speed.fastest"),
    progress: Progress | None = None,
) -> PageSpeeds:
    """Scan a page at many hand speeds, and evaluate its lines at each.

    Args:
        device: Device that is moved over the page.
        reading: Reading hand; its speed is varied.
        page: A page that the hand reads in strokes.
        touch: Touch of the finger; None: constant touch.
        criteria: Criteria of a felt line; None: those of the literature.
        slowest: Peak speed of the slowest hand, m/s, greater than 0.
        fastest: Largest speed, m/s, greater than `slowest`.
        progress: Function called after each scan.

    Raises:
        ValueError: The speeds are out of their ranges, or the page is followed by a recorded hand.
    """
    tried = check_tried(slowest, fastest)
    if page.path is not None:
        raise ValueError(f"page must be read in strokes, whose speed can vary, got {page.path}")

    def trial(speed: float) -> Mapping[str, int]:
        at_speed = replace(reading, hand_speed=speed)
        scene = page.scene(at_speed, device.array)
        hand = page.hand(at_speed, scene, device.array)
        done = scan(device, scene, hand, touch=touch, max_angle=reading.max_angle)
        return evaluate(done, criteria or Criteria()).counts

    found = trials(trial, tried, (all_shown, all_settled), progress)
    return PageSpeeds(page.words, tried, found)


def trials(
    trial: Callable[[float], Mapping[str, int]],
    tried: Band,
    properties: Sequence[Property],
    progress: Progress | None,
) -> dict[float, Mapping[str, int]]:
    """Counts at a grid of speeds, and at the borders of some properties, by speed in m/s.

    Args:
        trial: Function that returns the counts at a speed, m/s.
        tried: Slowest and fastest speed, m/s.
        properties: Properties of the counts, each of whose first end is refined by bisection.
        progress: Function called after each trial.
    """
    found: dict[float, Mapping[str, int]] = {}

    def counts(speed: float) -> Mapping[str, int]:
        if speed not in found:
            found[speed] = trial(speed)
            if progress:
                progress(min(len(found), _MOST - 1), _MOST)
        return found[speed]

    grid = np.geomspace(*tried, TRIED).tolist()
    for holds in properties:
        every = [holds(counts(speed)) for speed in grid]
        for (slow, before), (fast, after) in pairwise(zip(grid, every, strict=True)):
            if before and not after:
                while fast > (1.0 + PRECISION) * slow:
                    middle = sqrt(slow * fast)
                    slow, fast = (middle, fast) if holds(counts(middle)) else (slow, middle)
                break
    if progress:
        progress(_MOST, _MOST)
    return dict(sorted(found.items()))
