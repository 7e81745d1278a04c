"""Largest hand speed at which two neighbouring lines are distinct.

Two lines, black, stand `pitch` apart; an even hand goes straight over them, at the angle of the
drive axis (`array.axis`) to the drive. Two lines are **distinct** at a speed if, whatever the phase
of the control block's samples,

- both are shown, by the rules of the evaluation of scans: between them the pin comes back by
  `Criteria.distinct` of its way to where spring and dragging plate balance, and
- each of them moves the skin, forward or back, enough for its direction to be perceived (of a rigid
  finger: the pin).

The lines are **settled** if, in addition, the transient after the first line alone is over before
the second line takes the pin along. Every trial is an exact simulation.

An even hand makes the motion depend on that phase only by the numbers of samples on the lines and
between them: another phase with the same numbers shifts the whole motion in time. The numbers
change where a sample meets an edge, so that one phase between each two of the four edges stands
for all of them. With pulses, their own phase counts too, and is that of one hand.

Distinct speeds need not be one interval: a swing may fit by chance, and a slow hand may leave the
pin where the finger's friction holds it. Therefore a geometric grid of speeds is evaluated first,
and bisection finds the border of each interval; intervals between two speeds of the grid may be
missed. Within a sampling interval of the control block a border is chance: at the limit a whole
number of samples fits on the lines or between them, and limits of devices that differ a little are
equal. Beside it stands the limit of drive and finger alone, with a control block that samples 100
times as often.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import isnan, nan, pi
from typing import Any, Final, overload

import numpy as np

from pindrive import _core
from pindrive.device.controller import ControlBlock
from pindrive.device.device import Criteria, Device
from pindrive.device.pin_scan import Progress
from pindrive.device.trajectory import check_vibration
from pindrive.lazy import mpl_figure, xr
from pindrive.motion.drive import Drive
from pindrive.quantities import budgets
from pindrive.quantities.refusal import refusal
from pindrive.quantities.status import SimulationError, Status
from pindrive.quantities.table import QUANTITIES, check, default
from pindrive.quantities.value import concise, equal_by_value
from pindrive.views import NotebookHtml, figure

Band = tuple[float, float]

PHASES: Final = 4
"""Largest number of phases: one between each two edges of two lines."""
TRIED: Final = _core.tried_speeds
"""Speeds in the grid."""
_TRIALS: Final = 3 * TRIED
"""Trials of one pitch: of the grid, of borders, and of single lines."""
STUDIED: Final[Band] = (0.020, 0.100)
"""Hand speeds in finger studies, m/s (arXiv 2505.11162)."""
PRECISION: Final = _core.speed_precision
"""Relative precision of a border."""
FINE: Final = 40.0
"""Pixels in the thinner of line and gap."""
IDEAL: Final = 100.0
"""Factor on the sample rate of a control block that binds no limit."""
HIGHEST: Final = 1e6
"""Highest sample rate, Hz."""
NEAR: Final = 0.5, 3.0
"""Parts of the limit between which that of drive and finger alone is searched."""
BINDS: Final = 0.99
"""Part of the limit of drive and finger alone below which the control block binds."""
GROWN: Final = 10.0
"""Fastest hand tried where no limit is found below and none is given, m/s."""
MOMENT: Final = 0.002
"""From the begin of a trial to the first line, s, and a sampling interval more."""

LONGEST: Final = 200.0
"""Longest simulated transient, in radians of its natural frequency."""


@equal_by_value
@concise
@dataclass(frozen=True, slots=True)
class Trial:
    """Two lines at one speed: the worst of all phases."""

    speed: float
    """m/s"""
    back: float
    """Part of its way that the pin comes back between the lines."""
    skin: float
    """Displacement of the skin by the fainter line, m."""
    shown: bool
    """True if both lines are felt and do not merge."""

    def distinct(self, direction: float) -> bool:
        """Return True if both lines are felt and each moves the skin by `direction` (m)."""
        return self.shown and self.skin >= direction


@equal_by_value
@concise
@dataclass(frozen=True, slots=True, kw_only=True)
class SpeedLimit:
    """Largest hand speed over two lines."""

    pitch: float
    width: float
    """Width of the lines, m."""
    tried: Band
    """The slowest hand and the fastest, m/s."""
    distinct: tuple[Band, ...]
    """From which speed to which the lines are distinct, m/s, the slowest first."""
    settled: tuple[Band, ...]
    """From which to which they are distinct and the pin settles in between."""
    beyond: Trial | None
    """Failure of a hand just faster than the limit; None: no hand is that fast."""
    alone: float = nan
    """Largest hand speed of drive and finger alone, under an ideal control block, m/s."""

    @property
    def speed(self) -> float:
        """The largest hand speed at which the lines are distinct, m/s; NaN: at none they are.

        Of the first interval: a faster one beyond it is chance. If that interval does not begin
        with the slowest hand, `distinct` has its begin.
        """
        return self.distinct[0][1] if self.distinct else nan

    @property
    def bound(self) -> str:
        """Part of the device that binds the limit: "control block" or "drive"; "" without one."""
        if isnan(self.speed) or self.beyond is None or isnan(self.alone):
            return ""
        return "control block" if self.speed < BINDS * self.alone else "drive"

    @property
    def settled_speed(self) -> float:
        """The largest up to which the pin settles in between, m/s; NaN: there is none."""
        return self.settled[0][1] if self.settled else nan


@equal_by_value
@dataclass(frozen=True, eq=False, repr=False)
class SpeedLimits(NotebookHtml, Sequence[SpeedLimit]):
    """Largest hand speeds over two lines of several pitches; a sequence of limits.

    Attributes:
        limits: Limit of each pitch, in the given order.
        criteria: Criteria of a felt line.
    """

    limits: tuple[SpeedLimit, ...]
    criteria: Criteria

    @overload
    def __getitem__(self, index: int) -> SpeedLimit: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[SpeedLimit, ...]: ...
    def __getitem__(self, index: int | slice) -> SpeedLimit | tuple[SpeedLimit, ...]:
        """The limit of a pitch, by its place."""
        return self.limits[index]

    def __len__(self) -> int:
        """Return the number of pitches."""
        return len(self.limits)

    def __repr__(self) -> str:
        """The speed of each pitch, in a line."""
        shown = [f"{1e3 * one.speed:.4g} mm/s at {1e3 * one.pitch:g} mm" for one in self.limits[:3]]
        more = ", ..." if len(self.limits) > 3 else ""
        return f"<SpeedLimits {', '.join(shown)}{more}, {self.status.name}>"

    @property
    def status(self) -> Status:
        """`incomplete` where lines are distinct at no speed."""
        return Status.incomplete if any(isnan(one.speed) for one in self.limits) else Status.ok

    def plot(self, device: str = "") -> mpl_figure.Figure:
        """The speeds over the pitch; `device` is a name for the title."""
        return figure(self, "plot", self.criteria, device)

    def to_dataset(self) -> xr.Dataset:
        """The speeds and the width of the lines over `speed_pitch`, with units."""
        columns = {
            "speed.pitch": [one.pitch for one in self.limits],
            "speed.width": [one.width for one in self.limits],
            "speed.distinct": [one.speed for one in self.limits],
            "speed.settled": [one.settled_speed for one in self.limits],
            "speed.alone": [one.alone for one in self.limits],
        }
        data = {
            name.replace(".", "_"): ("speed_pitch", values, QUANTITIES[name].attributes)
            for name, values in columns.items()
        }
        status = {"status": self.status.name, "criteria_distinct": self.criteria.distinct}
        return xr.Dataset(data, attrs=status).set_coords("speed_pitch")


def largest_speeds(
    device: Device,
    pitches: Sequence[float],
    *,
    width: float | None = None,
    slowest: float = default("speed.slowest"),
    fastest: float | None = None,
    criteria: Criteria | None = None,
    progress: Progress | None = None,
) -> SpeedLimits:
    """The largest hand speed at which two lines stay distinct, for each pitch.

    Args:
        device: Device with drive, magnet and control block; one pin is evaluated.
        pitches: Distances between lines, m, greater than 0.
        width: Width of the lines, m, less than each pitch; None: half of the pitch.
        slowest: Hand tried, m/s, greater than 0.
        fastest: Hand tried, m/s, greater than `slowest`; None: 1 m/s, and faster ones up to 10 m/s
            until a limit is found.
        criteria: Criteria of a felt line; None: those of the literature.
        progress: Function called after each trial.

    Raises:
        ValueError: No pitch is given, a value is out of range, or the work exceeds a budget of
            `pindrive.quantities.budgets`.
    """
    budgets.PITCHES.check(len(pitches))
    steps = [check("speed.pitch", pitch, label="pitch") for pitch in pitches]
    if not steps:
        raise ValueError(refusal("pitches", "at least one", "none"))
    tried = check_tried(slowest, default("speed.fastest") if fastest is None else fastest)
    limits = criteria or Criteria()
    lines = [
        check("speed.width", 0.5 * pitch if width is None else width, label="width")
        for pitch in steps
    ]
    for pitch, line in zip(steps, lines, strict=True):
        if not line < pitch:
            raise ValueError(refusal("width", f"less than the pitch, {pitch!r} m", f"{line!r} m"))
    check_work(device, steps, lines, tried)
    found: list[SpeedLimit] = []
    for pitch, line in zip(steps, lines, strict=True):
        done = len(found)

        def report(trials: int, done: int = done) -> None:
            if progress:
                progress(done * _TRIALS + min(trials, _TRIALS), len(steps) * _TRIALS)

        found.append(_limit(device, pitch, line, tried, limits, report, grows=fastest is None))
        report(_TRIALS)
    return SpeedLimits(tuple(found), limits)


def check_tried(slowest: float, fastest: float) -> Band:
    """The slowest hand and the fastest that are to be tried, m/s.

    Raises:
        ValueError: A value is no speed, or the slowest is not below the fastest.
    """
    least, most = (
        check(f"speed.{name}", value, label=name)
        for name, value in (("slowest", slowest), ("fastest", fastest))
    )
    if not least < most:
        raise ValueError(
            refusal("fastest", f"greater than the slowest, {least!r} m/s", f"{most!r}")
        )
    return least, most


def check_work(
    device: Device, pitches: Sequence[float], widths: Sequence[float], tried: Band
) -> None:
    """Reject trials beyond the budgets, before the first trial.

    Args:
        device: Device, as for `largest_speeds`.
        pitches: Distances between lines, m.
        widths: Width of the lines of each pitch, m.
        tried: Slowest and fastest speed of the hand, m/s.

    Raises:
        ValueError: The trials exceed a budget.

    The slowest trial takes the most samples, the fastest the most pixels; the grid of speeds
    determines the ratio of all samples to those of the slowest trial.
    """
    drive = device.drive
    alone = _clear(device) + max(_followed(drive), 4.0 * pi / drive.natural_frequency)
    slowest, fastest = tried
    all_trials = sum(slowest / speed for speed in np.geomspace(*tried, TRIED).tolist())
    samples = 0.0
    for pitch, width in zip(pitches, widths, strict=True):
        of = f"for lines {1e3 * pitch:g} mm apart and {1e3 * width:g} mm wide"
        lasts = (pitch + width) / slowest + alone
        samples += PHASES * device.control.sample_rate * all_trials * (pitch + width) / slowest
        samples += PHASES * device.control.sample_rate * TRIED * alone
        check_vibration(drive, TRIED * alone + all_trials * lasts, PHASES)
        pixel = min(width, pitch - width) / FINE
        most = (
            pitch + width + fastest * (alone + MOMENT + 2.0 / device.control.sample_rate)
        ) / pixel
        budgets.PIXELS.check(most, of)
        if pulses := device.magnet.pulses:
            budgets.SWITCHINGS.check(PHASES * 2.0 * pulses.frequency * lasts, of)
    of = f"{len(pitches)} pitches, hands from {slowest:g} m/s, at {device.control.sample_rate:g} Hz"
    budgets.SAMPLES_OF_CONTROL.check(samples, of)


def _followed(drive: Drive) -> float:
    """Return the simulated time of a transient until it settles, s."""
    return 8.0 / max(drive.slowest_rate, 8.0 / LONGEST * drive.natural_frequency)


def _limit(
    device: Device,
    pitch: float,
    width: float,
    tried: Band,
    criteria: Criteria,
    progress: Callable[[int], None],
    *,
    grows: bool,
) -> SpeedLimit:
    """Return the limit for one pitch; report the number of trials after each."""

    def searched(block: ControlBlock, hands: Band) -> tuple[Any, Any, Any]:
        with_block = replace(device, control=block)
        distinct, settled, beyond, status = _core.speed_limit(
            with_block.core, pitch, width, criteria.numbers, hands, progress
        )
        _check_status(status, pitch)
        return distinct, settled, beyond

    distinct, settled, beyond = searched(device.control, tried)
    while grows and distinct and beyond is None and tried[1] < GROWN:
        tried = tried[0], min(2.0 * tried[1], GROWN)
        distinct, settled, beyond = searched(device.control, tried)
    rate = min(IDEAL * device.control.sample_rate, HIGHEST)
    speed = distinct[0][1] if distinct else None
    near = tried if speed is None else (max(tried[0], NEAR[0] * speed), NEAR[1] * speed)
    ideal, *_ = searched(replace(device.control, sample_rate=rate), near)
    return SpeedLimit(
        pitch=pitch,
        width=width,
        tried=tried,
        distinct=tuple(distinct),
        settled=tuple(settled),
        beyond=None if beyond is None else Trial(*beyond[:4]),
        alone=ideal[0][1] if ideal else nan,
    )


def two_lines(
    device: Device, pitch: float, width: float, speed: float, criteria: Criteria
) -> Trial:
    """Go over two lines at an even speed, with each sequence of samples of the control block.

    Args:
        device: Device of which one pin is evaluated.
        pitch: m.
        width: m.
        speed: m/s.
        criteria: Criteria of a felt line.

    Raises:
        SimulationError: The simulation had to be given up.
    """
    found = _core.two_lines(device.core, pitch, width, criteria.numbers, speed)
    _check_status(found[-1], pitch)
    return Trial(*found[:4])


def _check_status(status: int, pitch: float) -> None:
    if status != Status.ok:
        raise SimulationError(f"lines {1e3 * pitch:g} mm apart", Status(status))


def _clear(device: Device) -> float:
    """From a line's end until the pull of its magnet has decayed, s."""
    return device.control.latency + 8.0 * device.magnet.fall_constant


def criterion(criteria: Criteria) -> str:
    """Criterion of distinct lines, in a sentence."""
    return (
        f"Two lines are distinct where the pin comes back at least {criteria.distinct:.0%} of its "
        f"way between them, and each moves the skin {1e3 * criteria.direction:g} mm or more."
    )
