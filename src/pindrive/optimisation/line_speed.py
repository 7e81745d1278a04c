"""The largest hand speed at which lines stay distinct, for many devices, with few trials each.

The criterion and the grid of speeds are those of `largest_speeds`; a trial is a hand that goes over
two lines once. Where only a device that beats a speed matters, one trial at that speed tells most
of them.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import isnan, nan
from typing import TYPE_CHECKING, Final

import numpy as np

from pindrive.evaluation.resolution import TRIED, check_work, two_lines
from pindrive.quantities.table import default
from pindrive.study.design import device_at

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from pindrive.device.device import Criteria, Device
    from pindrive.study.design import Plan

PRECISION: Final = 1e-2
"""Of a speed, a part of it, during a search."""
GAIN: Final = 1.01
"""By which a device must beat a speed: by less it does not matter."""
SLOWEST: Final[float] = default("speed.slowest")
FASTEST: Final[float] = default("speed.fastest")
Asked = tuple["Mapping[str, float]", float]
"""The values of keys, SI, and the speed to beat; NaN: there is none."""


def speeds(plan: Plan, portion: Sequence[Asked]) -> list[tuple[float, int]]:
    """The largest speed of each device, m/s, and the trials that it took.

    NaN where there is no such device, or it merges the lines at any speed; of a device that does
    not beat its speed, any speed that does not.
    """
    return [_speed(plan, at, beat) for at, beat in portion]


def _speed(plan: Plan, at: Mapping[str, float], beat: float) -> tuple[float, int]:
    assert plan.page
    found, count = np.inf, 0
    try:
        file = device_at(plan, at)
        assert file.whole
        device, criteria = file.device, file.criteria
        pitches = plan.page.page.grating or ()
        check_work(device, pitches, [0.5 * p for p in pitches], (SLOWEST, FASTEST))
        for pitch in pitches:
            climb = _Climb(device, pitch, criteria)
            found = min(found, climb.limit(beat))
            count += climb.trials
            if not isnan(beat) and not found > beat:
                break
    except (ValueError, ArithmeticError, MemoryError):
        return np.nan, count
    return found, count


@dataclass
class _Climb:
    """The way over the grid of speeds, from one at which lines are distinct to where they merge."""

    device: Device
    pitch: float
    criteria: Criteria
    trials: int = 0
    grid: list[float] = field(
        default_factory=lambda: [float(v) for v in np.geomspace(SLOWEST, FASTEST, TRIED)]
    )

    def distinct(self, speed: float) -> bool:
        self.trials += 1
        trial = two_lines(self.device, self.pitch, 0.5 * self.pitch, speed, self.criteria)
        return trial.distinct(default("speed.part"), self.criteria.direction)

    def limit(self, beat: float) -> float:
        """The largest speed, as `SpeedLimit.speed` is; 0 where it does not beat `beat`.

        NaN where the lines are distinct at no speed of the grid.
        """
        slow = GAIN * beat
        if not isnan(beat):
            if slow >= FASTEST or not self.distinct(slow):
                return 0.0
            below = [v for v in self.grid if v < slow]
            if not self.unbroken(below):
                return 0.0
        else:
            begin = next((i for i, v in enumerate(self.grid) if self.distinct(v)), None)
            if begin is None:
                return nan
            slow = self.grid[begin]
        for fast in (v for v in self.grid if v > slow):
            if not self.distinct(fast):
                return self.border(slow, fast)
            slow = fast
        return FASTEST

    def unbroken(self, below: list[float]) -> bool:
        """Whether the lines are distinct at all these speeds from the first at which they are."""
        place = len(below)
        while place and self.distinct(below[place - 1]):
            place -= 1
        return not any(self.distinct(speed) for speed in below[:place])

    def border(self, slow: float, fast: float) -> float:
        """The speed between these at which they cease to be distinct."""
        while fast - slow > PRECISION * slow:
            middle = 0.5 * (slow + fast)
            slow, fast = (middle, fast) if self.distinct(middle) else (slow, middle)
        return slow
