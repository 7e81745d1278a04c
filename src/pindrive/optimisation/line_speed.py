"""The largest hand speed at which lines stay distinct, for many devices, with few trials each.

The criterion is that of `largest_speeds`; a trial is a hand that goes over two lines once. Lines
that are distinct at a speed are assumed distinct at all lower speeds, so that a few trials find a
bracket. A device to be confirmed is evaluated over the whole grid of speeds.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import isnan, nan, sqrt
from typing import Final

import numpy as np

from pindrive.evaluation.resolution import PRECISION, TRIED, check_work, two_lines
from pindrive.files.device import DeviceFile
from pindrive.optimisation.goals import SpeedRequest
from pindrive.quantities.table import default
from pindrive.study.study import Study

FINE: Final = 1e-2
"""Part of a speed to which it is found, unless it is confirmed."""
COARSE: Final = 5e-2
"""Coarse precision for a device that is slower than required."""
STEP: Final = 1.05
"""Ratio of the first two speeds of a bracket; that of the next is its square."""
SLOWEST: Final[float] = default("speed.slowest")
FASTEST: Final[float] = default("speed.fastest")


def speeds(study: Study, portion: Sequence[SpeedRequest]) -> list[tuple[float, int]]:
    """The largest speed of each device, m/s, and the trials that it took.

    NaN where there is no such device, or no speed was found at which the lines are distinct.
    """
    return [_speed(study, requested) for requested in portion]


def _speed(study: Study, requested: SpeedRequest) -> tuple[float, int]:
    assert study.page
    found, count = np.inf, 0
    try:
        file = study.device_at(requested.at)
        device = file.device
        pitches = [group.pitch for group in study.page.page.grating or ()]
        check_work(device, pitches, [0.5 * p for p in pitches], (SLOWEST, FASTEST))
        for pitch in pitches:
            climb = Climb(file, pitch)
            if requested.confirmed:
                own = climb.first_interval()
            else:  # the least of several counts: no pitch is followed beyond the one before
                near = requested.near if found == np.inf else found
                own = climb.bracket(near, requested.beat, min(found, FASTEST))
            count += len(climb.trials)
            if isnan(own):
                return nan, count
            found = min(found, own)
    except (ValueError, ArithmeticError, MemoryError):
        return nan, count
    return found, count


@dataclass
class Climb:
    """The way to the speed from which on two lines merge."""

    file: DeviceFile
    pitch: float
    trials: dict[float, bool] = field(default_factory=dict)

    def distinct(self, speed: float) -> bool:
        """Return True if the lines are distinct, by a new trial or an earlier one."""
        if speed not in self.trials:
            self.trials[speed] = self._tried(speed)
        return self.trials[speed]

    def _tried(self, speed: float) -> bool:
        file, device = self.file, self.file.device
        criteria = file.criteria
        if device.hand is not None:
            from pindrive.evaluation.hand_speed import two_lines_under_hand

            reading, touch = file.reading, file.touch
            return two_lines_under_hand(device, reading, self.pitch, speed, touch, criteria)
        trial = two_lines(device, self.pitch, 0.5 * self.pitch, speed, criteria)
        return trial.distinct(criteria.direction)

    def first_interval(self) -> float:
        """The upper end of the first interval of the grid, as `SpeedLimit.speed` is."""
        grid = [float(speed) for speed in np.geomspace(SLOWEST, FASTEST, TRIED)]
        begin = next((i for i, speed in enumerate(grid) if self.distinct(speed)), None)
        if begin is None:
            return nan
        slow = grid[begin]
        for fast in grid[begin + 1 :]:
            if not self.distinct(fast):
                return self.border(slow, fast, PRECISION)
            slow = fast
        return FASTEST

    def bracket(self, near: float, beat: float, most: float) -> float:
        """A speed at which the lines are distinct, just below one at which they are not.

        Args:
            near: Estimate of the speed; NaN: unknown.
            beat: Below it the border is found coarsely.
            most: Beyond which none is tried.
        """
        if isnan(near):
            slow, fast = SLOWEST, most
        else:
            speed, step = min(max(near, SLOWEST), most), STEP
            up = self.distinct(speed)
            slow = fast = speed
            while self.distinct(speed) == up:
                slow, fast = (speed, fast) if up else (slow, speed)
                if speed == (most if up else SLOWEST):
                    return most if up else nan
                speed = min(speed * step, most) if up else max(speed / step, SLOWEST)
                step *= step
            slow, fast = (slow, speed) if up else (speed, fast)
        while fast > (1.0 + (COARSE if fast <= beat else FINE)) * slow:
            middle = sqrt(slow * fast)
            slow, fast = (middle, fast) if self.distinct(middle) else (slow, middle)
        return slow if self.distinct(slow) else nan

    def border(self, slow: float, fast: float, precision: float) -> float:
        """The speed between these at which they cease to be distinct."""
        while fast - slow > precision * slow:
            middle = 0.5 * (slow + fast)
            slow, fast = (middle, fast) if self.distinct(middle) else (slow, middle)
        return slow
