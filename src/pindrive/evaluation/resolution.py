"""Largest hand speed at which two neighbouring lines are distinct.

Two lines, black, stand `pitch` apart; an even hand goes straight over them, at the angle of the
drive axis (`array.axis`) to the drive. Two lines are **distinct** at a speed if, whatever the phase
of the control block's samples,

- between them the pin comes back at least `part` of its way from its highest place to where spring
  and dragging plate balance, before the second line takes it along, and
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
missed. Within a sampling interval of the control block a border is chance.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import copysign, cos, inf, isnan, nan, pi, sin
from typing import Final, overload

import numpy as np
from numpy.typing import NDArray

from pindrive import lazy
from pindrive.device.device import Criteria, Device
from pindrive.device.hand import HandPath
from pindrive.device.page import Scene
from pindrive.device.pin_array import PinArray
from pindrive.device.pin_scan import PinState, Progress
from pindrive.device.scanning import scan
from pindrive.device.trajectory import brackets, check_vibration
from pindrive.evaluation.line_crossings import FATES, PrintedLines
from pindrive.evaluation.perception import Columns, evaluated
from pindrive.lazy import mpl_figure, xr
from pindrive.motion.drive import Drive
from pindrive.quantities import budgets
from pindrive.quantities.refusal import refusal
from pindrive.quantities.status import Status
from pindrive.quantities.table import QUANTITIES, check, default
from pindrive.quantities.value import concise, equal_by_value

Band = tuple[float, float]

PHASES: Final = 4
"""Largest number of phases: one between each two edges of two lines."""
TRIED: Final = 32
"""Speeds in the grid."""
_TRIALS: Final = 3 * TRIED
"""Trials of one pitch: of the grid, of borders, and of single lines."""
STUDIED: Final[Band] = (0.020, 0.100)
"""Hand speeds in finger studies, m/s (arXiv 2505.11162)."""
PRECISION: Final = 1e-3
"""Relative precision of a border."""
FINE: Final = 40.0
"""Pixels in the thinner of line and gap."""
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
    """Part of its way that the pin comes back between the lines; 0 where they merge."""
    skin: float
    """Displacement of the skin by the fainter line, m."""
    until: tuple[float, ...]
    """Time at which the second line takes the pin along, per phase, s since the trial's begin."""
    ahead: tuple[float, ...] = ()
    """Phases: distance by which the spot is ahead, m."""

    def distinct(self, part: float, direction: float) -> bool:
        """Return True if two lines are felt; direction is in m."""
        return self.back >= part and self.skin >= direction


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

    @property
    def speed(self) -> float:
        """The largest hand speed at which the lines are distinct, m/s; NaN: at none they are.

        Of the first interval: a faster one beyond it is chance. If that interval does not begin
        with the slowest hand, `distinct` has its begin.
        """
        return self.distinct[0][1] if self.distinct else nan

    @property
    def settled_speed(self) -> float:
        """The largest up to which the pin settles in between, m/s; NaN: there is none."""
        return self.settled[0][1] if self.settled else nan


@equal_by_value
@dataclass(frozen=True, eq=False, repr=False)
class SpeedLimits(lazy.NotebookHtml, Sequence[SpeedLimit]):
    """Largest hand speeds over two lines of several pitches; a sequence of limits.

    Attributes:
        limits: Limit of each pitch, in the given order.
        part: Required return of the pin between two lines, as a part of its deflection.
        criteria: Criteria of a felt line.
    """

    limits: tuple[SpeedLimit, ...]
    part: float
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
        from pindrive.plot.resolution import plot_speeds

        return plot_speeds(self.limits, self.part, self.criteria, device)

    def to_dataset(self) -> xr.Dataset:
        """The speeds and the width of the lines over `speed_pitch`, with units."""
        columns = {
            "speed.pitch": [one.pitch for one in self.limits],
            "speed.width": [one.width for one in self.limits],
            "speed.distinct": [one.speed for one in self.limits],
            "speed.settled": [one.settled_speed for one in self.limits],
        }
        data = {
            name.replace(".", "_"): ("speed_pitch", values, QUANTITIES[name].attributes)
            for name, values in columns.items()
        }
        status = {"status": self.status.name, "speed_part": self.part}
        return xr.Dataset(data, attrs=status).set_coords("speed_pitch")


def largest_speeds(
    device: Device,
    pitches: Sequence[float],
    *,
    width: float | None = None,
    part: float = default("speed.part"),
    slowest: float = default("speed.slowest"),
    fastest: float = default("speed.fastest"),
    criteria: Criteria | None = None,
    progress: Progress | None = None,
) -> SpeedLimits:
    """The largest hand speed at which two lines stay distinct, for each pitch.

    Args:
        device: Device with drive, magnet and control block; one pin is evaluated.
        pitches: Distances between lines, m, greater than 0.
        width: Width of the lines, m, less than each pitch; None: half of the pitch.
        part: Required return of the pin between two lines, as a part of its deflection, in (0, 1].
        slowest: Hand tried, m/s, greater than 0.
        fastest: Hand tried, m/s, greater than `slowest`.
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
    tried = check_tried(slowest, fastest)
    needed = check("speed.part", part, label="part")
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

        found.append(_limit(device, pitch, line, needed, tried, limits, report))
        report(_TRIALS)
    return SpeedLimits(tuple(found), needed, limits)


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
    of = f"{len(pitches)} pitches, hands from {slowest:g} m/s, at {device.control.sample_rate:g} Hz"
    budgets.SAMPLES_OF_CONTROL.check(samples, of)


def _followed(drive: Drive) -> float:
    """Return the simulated time of a transient until it settles, s."""
    return 8.0 / max(drive.slowest_rate, 8.0 / LONGEST * drive.natural_frequency)


def _limit(
    device: Device,
    pitch: float,
    width: float,
    part: float,
    tried: Band,
    criteria: Criteria,
    progress: Callable[[int], None],
) -> SpeedLimit:
    """The limit for one pitch; tells the number of trials after each."""
    speeds = np.geomspace(*tried, TRIED).tolist()
    trials: dict[float, Trial] = {}
    calm: dict[float, bool] = {}

    def trial(speed: float) -> Trial:
        if speed not in trials:
            trials[speed] = two_lines(device, pitch, width, speed, criteria)
            progress(len(trials) + len(calm))
        return trials[speed]

    def bands(holds: Callable[[Trial], bool]) -> list[Band]:
        """The intervals in which something holds: from the grid, with borders by bisection."""
        borders = [-inf] if holds(trial(speeds[0])) else []
        for slow, fast in pairwise(speeds):
            if holds(trial(slow)) != holds(trial(fast)):
                borders.append(border(slow, fast, holds))
        if holds(trials[speeds[-1]]):
            borders.append(inf)
        ends = np.clip(borders, *tried).tolist()
        return list(zip(ends[::2], ends[1::2], strict=True))

    def border(slow: float, fast: float, holds: Callable[[Trial], bool]) -> float:
        """The speed at which it begins or ceases to hold, on the side on which it holds."""

        def sign(speeds: NDArray[np.float64]) -> NDArray[np.float64]:
            return np.array([[1.0 if holds(trial(v)) else -1.0 for v in speeds.ravel().tolist()]])

        before = holds(trials[slow])
        ends = np.array([slow]), np.array([fast])
        low, high = brackets(sign, *ends, sign(ends[0]).ravel(), 2, PRECISION)
        return float(low[0] if before else high[0])

    def distinct(trial: Trial) -> bool:
        return trial.distinct(part, criteria.direction)

    def settled(trial: Trial) -> bool:
        if distinct(trial) and trial.speed not in calm:
            calm[trial.speed] = settles(device, pitch, width, trial, criteria)
            progress(len(trials) + len(calm))
        return calm.get(trial.speed, False)

    apart = bands(distinct)
    faster = [speed for speed in sorted(trials) if apart and speed > apart[0][1]]
    return SpeedLimit(
        pitch=pitch,
        width=width,
        tried=tried,
        distinct=tuple(apart),
        settled=tuple(bands(settled)),
        beyond=trials[faster[0]] if faster else None,
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
    """
    after = _clear(device) + 4.0 * pi / device.drive.natural_frequency
    ahead = _phases(device, (0.0, pitch), pitch, width, speed)
    table, dips = _pass(device, (0.0, pitch), pitch, width, speed, after, criteria, ahead)
    merged = (table["fate"] == FATES.index("merged")).any(axis=1)
    back = np.where(merged, 0.0, _back(device, table["height"][:, 0], table["returned"][:, 0]))
    skin = np.nan_to_num(np.fmax(table["skin_on"], table["skin_off"]))
    until = tuple(float(each[1]) if len(each) > 1 else 0.0 for each in dips)
    return Trial(speed, float(back.min()), float(skin.min()), until, ahead)


def settles(device: Device, pitch: float, width: float, trial: Trial, criteria: Criteria) -> bool:
    """Return True if the pin settles after the first line alone before the second line.

    Args:
        device: Device of the trial.
        pitch: m, as in the trial.
        width: m, as in the trial.
        trial: Trial that `two_lines` returned.
        criteria: Criteria of the trial.
    """
    after = _clear(device) + _followed(device.drive)
    alone, _ = _pass(device, (0.0,), pitch, width, trial.speed, after, criteria, trial.ahead)
    return bool((alone["settled"][:, 0] <= trial.until).all())


def _begin(device: Device, speed: float) -> float:
    """Place of the hand at the begin of a trial, m: the first line begins at 0."""
    return -speed * (MOMENT + 1.0 / device.control.sample_rate)


def _phases(
    device: Device, begins: Sequence[float], pitch: float, width: float, speed: float
) -> tuple[float, ...]:
    """Return one phase for each sequence of samples: distances by which a spot is ahead, m."""
    step, control = speed / device.control.sample_rate, device.control
    pixel = min(width, pitch - width) / FINE
    page = _page(begins, width, -4.0 * pixel, begins[-1] + width + 4.0 * pixel, pixel)
    row = page.luminance[0]
    middles = np.asarray(page.origin[0] + pixel * (np.arange(len(row)) + 0.5), np.float64)
    edges = [
        *_passes(middles, -row, 0.5 * control.hysteresis - control.threshold),
        *_passes(middles, row, control.threshold + 0.5 * control.hysteresis),
    ]
    met = np.sort(np.mod(np.array(edges) - _begin(device, speed), step))
    met = met[np.diff(met, prepend=-step) > 1e-9 * step]  # edges that one sample meets together
    if not met.size:
        return (0.0,)
    return tuple(np.mod(0.5 * (met + np.append(met[1:], met[0] + step)), step).tolist())


def _passes(x: NDArray[np.float64], y: NDArray[np.float64], level: float) -> NDArray[np.float64]:
    """Return the places at which a piecewise-linear function rises above a level."""
    i = np.flatnonzero((y[:-1] <= level) & (y[1:] > level))
    return x[i] + (level - y[i]) / (y[i + 1] - y[i]) * (x[i + 1] - x[i])


def _pass(
    device: Device,
    begins: Sequence[float],
    pitch: float,
    width: float,
    speed: float,
    after: float,
    criteria: Criteria,
    ahead: Sequence[float],
) -> tuple[Columns, list[NDArray[np.float64]]]:
    """Go evenly over lines that begin at these places (m), once for each phase, and `after` (s).

    Returns:
        Columns of the lines of shape (phases, lines); the times before each motion, as `evaluated`.
    """
    interval = 1.0 / device.control.sample_rate
    begin, end = _begin(device, speed), begins[-1] + width + speed * after
    pixel = min(width, pitch - width) / FINE
    axis, count = device.array.axis, len(ahead)
    spots = [(s * cos(axis), -s * sin(axis)) for s in ahead]  # s ahead along the hand's way
    phases = PinArray([(0.0, float(i)) for i in range(count)], spots, axis)
    page = _page(begins, width, begin - pixel, end + speed * interval + pixel, pixel)
    lasts = (end - begin) / speed
    path = HandPath([0.0, lasts], [speed] * 2, [0.0] * 2, (begin, 0.5 * pixel))
    done = scan(
        replace(device, array=phases), page, path, start=[steady(device)] * count, threads=1
    )
    lines = []
    for shift in ahead:
        times = (np.array(begins) - begin - shift) / speed
        whole = np.ones(len(times), np.uint8)
        lines.append(PrintedLines(times, times + width / speed, whole))
    table, dips = evaluated(done, lines, criteria)
    columns = {name: column for name, column in table.items() if not name.startswith("false_line")}
    return {name: column.reshape(count, len(begins)) for name, column in columns.items()}, dips


def _clear(device: Device) -> float:
    """From a line's end until the pull of its magnet has decayed, s."""
    return device.control.latency + 8.0 * device.magnet.fall_constant


def steady(device: Device) -> PinState:
    """Return the state of a pin under a hand in long uniform motion: dragged, and at rest."""
    finger, along = device.drive.finger, cos(device.array.axis)
    position = copysign(device.drag(device.array.axis), along)
    if finger.rigid:
        return PinState(position=position)
    plate = device.drive.plate.kinetic * device.load(device.magnet.residual) * abs(along)
    held = plate if plate <= finger.static_friction else finger.kinetic
    return PinState(position=position, skin_stretch=copysign(held / finger.stiffness, along))


def _page(begins: Sequence[float], width: float, left: float, right: float, pixel: float) -> Scene:
    """Lines that begin at these places; a border between pixels is as dark as it covers."""
    first = int(np.floor(left / pixel))
    borders = pixel * np.arange(first, int(np.ceil(right / pixel)) + 1)
    covered = sum(np.clip(borders, x, x + width) for x in begins)
    row = 1.0 - np.clip(np.diff(covered) / pixel, 0.0, 1.0)
    return Scene(row[np.newaxis], pixel, (first * pixel, 0.0), title="lines")


def _back(
    device: Device, height: NDArray[np.float64], returned: NDArray[np.float64]
) -> NDArray[np.float64]:
    """The part of its way back to its place of rest that the pin comes after a line."""
    high = height - device.drag(device.array.axis)
    part = np.divide(returned, high, out=np.zeros_like(high), where=high > 0.0)
    return np.nan_to_num(part)


def criterion(part: float, direction: float) -> str:
    """Criterion of distinct lines, in a sentence."""
    return (
        f"Two lines are distinct where the pin comes back at least {part:.0%} of its way between "
        f"them, and each moves the skin {1e3 * direction:g} mm or more."
    )
