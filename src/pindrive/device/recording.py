"""Recorded hand motion: what a recording is, how a raw one is smoothed, and the path through it.

A mouse reports whole steps (counts), 1000 to the inch, about a thousand times a second. Between two
reports a speed of 60 mm/s is 2 or 3 steps, so that differences of such places are no speed. A
recording is **raw** if its data say so, whatever the unit of its header: if neighbouring places
scatter independently, as rounded or noisy ones do, and that scatter is more than a hundredth of the
peak speed. A raw recording is smoothed:

- Its places are taken at even times, the median interval apart: linear between reports, and
  unchanged while none came, as a mouse that rests reports nothing.
- A low-pass follows, a Butterworth filter of second order forwards and backwards
  (`scipy.signal.sosfiltfilt`), as is usual for recorded movements: no delay, and at the cut-off
  1/sqrt(2) of an amplitude (-3 dB) is left. The gain is 1 / (1 + 0.414 (f / f_c)^4).
- It lowers the peak speed of a minimum-jerk stroke of duration T by the part 0.102 / (f_c T)^4: at
  20 Hz, 0.13 % of a stroke of 0.15 s, and 1e-5 of one of half a second.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import pi, sqrt
from os import PathLike
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pindrive.device.hand import RECORDED as EXAMPLE
from pindrive.device.hand import HandPath
from pindrive.lazy import signal
from pindrive.quantities import budgets
from pindrive.quantities.csv_table import CsvTable
from pindrive.quantities.refusal import quoted, refusal
from pindrive.quantities.rows import check_increasing
from pindrive.quantities.table import QUANTITIES, check, default

COUNTS: Final = ("count", "counts")
"""Units of mouse counts in a header."""
INCH: Final = 0.0254
TWO_PASSES: Final = (sqrt(2.0) - 1.0) ** 0.25
"""Cut-off of both passes over that of one (Winter 2009, Biomechanics and Motor Control)."""
PEAK_LOSS: Final = 384.0 * (sqrt(2.0) - 1.0) / (2.0 * pi) ** 4
"""0.102: what of a minimum-jerk peak is lost, times (f_c T)^4; its fourth derivative over it."""
LOST: Final = 0.01
"""The part of a peak that a report calls lost."""
WHITE: Final = 1.3
"""Fourth over third differences of independent errors, at least; of 1.87 on average."""
NOISY: Final = 0.01
"""Part of the peak speed beyond which errors of the speed make a recording raw."""
SMALL_STEPS: Final = 20.5
GRID: Final = 0.15
"""So far from whole numbers of steps, of up to `SMALL_STEPS`, is no recording in steps."""
HOLE: Final = 2.5
"""Intervals without a report in which the mouse rested."""


def through(
    t: ArrayLike,
    x: ArrayLike,
    y: ArrayLike,
    *,
    acceleration: float | str = default("hand_acceleration"),
) -> HandPath:
    """A path along recorded places, with a velocity that does not jump.

    Half-way in time between two places the hand has their mean velocity and is half-way between
    them, exactly; at a place its velocity is the mean over both its neighbours. The path follows
    the recording without drift, with rounded corners.

    Args:
        t: s, shape (n,), n >= 2, increasing.
        x: m, shape (n,).
        y: m, shape (n,).
        acceleration: Largest acceleration of the hand, m/s²; a larger one is a jump of the speed,
            and refused.

    Raises:
        ValueError: Too few places, times that do not increase, or a speed that jumps.
    """
    most = check("hand_acceleration", acceleration, label="acceleration")
    time, px, py = (np.array(column, np.float64) for column in (t, x, y))
    return HandRecording(time, px, py).through(most)


@dataclass(frozen=True, eq=False)
class HandRecording:
    """Places of the hand at recorded times.

    Args:
        t: s, shape (n,), n >= 2, increasing.
        x: m, shape (n,).
        y: m, shape (n,).
        step: Step of the mouse, m, of positions in whole steps; None: found in the positions.
        where: The file, for messages.
        rows: Number of each row in that file.

    Raises:
        ValueError: Too few places, or times that do not increase.
    """

    t: NDArray[np.float64]
    x: NDArray[np.float64]
    y: NDArray[np.float64]
    step: float | None = None
    where: str = ""
    rows: Sequence[int] | None = None

    def __post_init__(self) -> None:
        """Validate."""
        if self.t.ndim != 1 or len(self.t) < 2 or not self.t.shape == self.x.shape == self.y.shape:
            given = f"{self.t.shape}, {self.x.shape} and {self.y.shape}"
            required = "columns of one length, at least 2"
            raise ValueError(refusal("t, x and y", required, given, self.where))
        check_increasing(self.t.tolist(), "s", where=self.where, label=self._time)

    def _time(self, i: int) -> str:
        """Return the time of a place for messages."""
        return f"t[{i}]" if self.rows is None else f"row {self.rows[i]}: time"

    @classmethod
    def read(
        cls, path: str | PathLike[str], resolution: float = default("mouse_resolution")
    ) -> HandRecording:
        """A recording from a CSV, UTF-8, whose header is like `time [s], x [m], y [m]`.

        Args:
            path: The file; `dx` and `dy` instead are the ways since the row before. Places may be
                in `count`, the steps of a mouse. See `CsvTable` for the rest.
            resolution: Resolution of the mouse, counts per m, of positions in counts.

        Raises:
            ValueError: The file cannot be read, the header lacks a column or a unit, a cell is no
                number or out of bounds; file and row are named.
        """
        table = CsvTable.read(path, "a recorded path", EXAMPLE)
        relative = "dx" in table and "x" not in table
        names = ("dx", "dy") if relative else ("x", "y")
        table.check_header({"time", *names} <= {*table.names}, f"like {quoted(EXAMPLE)}")
        times = table.column("time", QUANTITIES["hand.time"])
        step = 1.0 / resolution
        counted = [table.unit(name) in COUNTS for name in names]
        places = [
            np.array(
                table.column(name, QUANTITIES["hand.place"], step if counts else None), np.float64
            )
            for name, counts in zip(names, counted, strict=True)
        ]
        table.check_rows("a recorded path", 2)
        if relative:
            places = [np.cumsum(place) for place in places]
        own = step if all(counted) else None
        return cls(np.array(times), places[0], places[1], own, table.file, table.numbers)

    @cached_property
    def interval(self) -> float:
        """The median time between two rows, s."""
        return float(np.median(np.diff(self.t)))

    @property
    def rate(self) -> float:
        """Rows per second, from the median interval, Hz."""
        return 1.0 / self.interval

    @cached_property
    def resolved(self) -> float | None:
        """The step of which all places are whole numbers, m; None where there is none."""
        if self.step is not None:
            return self.step
        steps = np.abs(np.concatenate([np.diff(self.x), np.diff(self.y)]))
        steps = steps[steps > 1e-9]
        if len(steps) < 3:
            return None
        step = float(steps.min())
        few = steps[steps < 4.5 * step]
        step = float(few.sum() / np.round(few / step).sum())  # the mean, of rounded text
        counts = steps[steps < SMALL_STEPS * step] / step
        whole = np.abs(counts - np.round(counts)) < GRID
        return step if whole.all() and len(counts) > 0.5 * len(steps) else None

    @cached_property
    def speed_noise(self) -> float:
        """Standard deviation of difference quotients by independent errors of the places, m/s.

        From fourth differences over even rows, to which the motion of a hand adds little; 0 if
        these are no larger than third differences make a smooth motion.
        """
        even = np.diff(self.t) < HOLE * self.interval
        windows = np.lib.stride_tricks.sliding_window_view
        found = 0.0
        for place in (self.x, self.y):
            if len(place) < 5:
                break
            fives = windows(place, 5)[windows(even, 4).all(axis=1)]
            fives = fives[np.ptp(fives, axis=1) > 0.0]  # a hand at rest shows no errors
            if not len(fives):
                continue
            third, fourth = (
                sqrt(float(np.mean(np.diff(fives, order, axis=1) ** 2))) for order in (3, 4)
            )
            if fourth > WHITE * third:
                found = max(found, fourth / sqrt(70.0))
        return sqrt(2.0) * found / self.interval

    @property
    def raw(self) -> bool:
        """True for places with such errors that their differences are no speed."""
        over_four = [np.abs(place[4:] - place[:-4]) for place in (self.x, self.y)]
        if not over_four[0].size:
            return False
        fastest = float(np.max(np.hypot(*over_four) / (self.t[4:] - self.t[:-4])))
        return self.speed_noise > NOISY * fastest

    def peak_speed(self) -> float:
        """The largest difference quotient of its places, m/s."""
        way = np.hypot(np.diff(self.x), np.diff(self.y))
        return float((way / np.diff(self.t)).max())

    def smoothed(self, cutoff: float = default("smoothing_cutoff")) -> HandRecording:
        """Return the recording at even times, low-pass filtered at a cut-off (Hz), as stated above.

        Raises:
            ValueError: The cut-off is not below a fifth of the rate, or there are too many rows.
        """
        low = check("smoothing_cutoff", cutoff)
        if not low <= 0.2 * self.rate:
            required = f"at most a fifth of the recording's rate, {0.2 * self.rate:.4g} Hz"
            raise ValueError(refusal("smoothing_cutoff", required, f"{low:g} Hz", self.where))
        lasts = float(self.t[-1] - self.t[0])
        count = max(2, round(lasts / self.interval) + 1)
        of = f"{lasts:g} s of recording, a row each {1e3 * self.interval:.4g} ms"
        budgets.INPUT_ROWS.check(lasts / self.interval + 1.0, of, where=self.where)
        rested = np.flatnonzero(np.diff(self.t) > HOLE * self.interval)
        held = self.t[rested + 1] - self.interval
        times = np.insert(self.t, rested + 1, held)
        even = np.linspace(self.t[0], self.t[-1], count)
        sections = signal.butter(2, low / TWO_PASSES, fs=(count - 1) / lasts, output="sos")
        pad = min(count - 1, round(2.0 * self.rate / low))
        places = []
        for place in (self.x, self.y):
            reported = np.insert(place, rested + 1, place[rested])
            taken = np.interp(even, times, reported)
            places.append(np.asarray(signal.sosfiltfilt(sections, taken, padlen=pad), np.float64))
        return HandRecording(even, places[0], places[1], None, self.where)

    def path(
        self,
        acceleration: float = default("hand_acceleration"),
        cutoff: float = default("smoothing_cutoff"),
        smooth: bool | None = None,
    ) -> HandPath:
        """The hand's path through its places, smoothed or not.

        Args:
            acceleration: Largest acceleration of the hand, m/s²; more is refused as a jump.
            cutoff: Cut-off frequency of the smoothing, Hz.
            smooth: True to smooth, False to use the places as they are. None: `raw` decides.

        Raises:
            ValueError: The recording is invalid, as for `through` and `smoothed`.
        """
        smooth = self.raw if smooth is None else smooth
        about = self.words(cutoff, smooth)
        if not smooth:
            return self.through(acceleration, about)
        even = replace(self.smoothed(cutoff), where=f"{self.where}, smoothed")
        return even.through(acceleration, about)

    def through(self, most: float, about: str = "") -> HandPath:
        """The path through its places, as the function `through` makes it.

        Args:
            most: Acceleration of the hand, m/s².
            about: Description of the recording in the path.
        """
        lasts = np.diff(self.t)
        middles = self.t[:-1] + 0.5 * lasts
        speeds = [np.diff(place) / lasts for place in (self.x, self.y)]
        jump = np.hypot(*(np.diff(v) for v in speeds)) / np.diff(middles)
        if (jump > most).any():
            i = int(np.argmax(jump))
            before, after = (1e3 * float(np.hypot(*(v[j] for v in speeds))) for j in (i, i + 1))
            required = f"without a jump of the hand's speed, a change of at most {most:g} m/s^2"
            given = (
                f"{jump[i]:.4g} m/s^2 at {self.t[i + 1]:g} s, where it moves at {before:.4g} mm/s "
                f"before and {after:.4g} mm/s after"
            )
            label = self._time(i + 1).removesuffix(": time")
            raise ValueError(refusal(label, required, given, self.where))
        nodes = np.empty(2 * len(self.t) - 1)
        nodes[::2], nodes[1::2] = self.t, middles
        columns = []
        for v in speeds:
            column = np.empty_like(nodes)
            column[1::2] = v
            column[0], column[-1] = v[0], v[-1]
            column[2:-1:2] = (lasts[:-1] * v[:-1] + lasts[1:] * v[1:]) / (lasts[:-1] + lasts[1:])
            columns.append(column)
        keep = np.append(True, np.diff(nodes) > 0.0)  # places too close in time for one between
        vx, vy = (column[keep] for column in columns)
        return HandPath(nodes[keep], vx, vy, (float(self.x[0]), float(self.y[0])), about)

    def words(self, cutoff: float, smooth: bool) -> str:
        """Return the recording and its processing in one or two sentences."""
        step, speed = self.resolved, QUANTITIES["hand_speed"]
        lasts = float(self.t[-1] - self.t[0])
        said = f"The recording: {len(self.t)} rows over {lasts:.4g} s, {self.rate:.4g} Hz"
        if step is not None:
            said += f", in steps of {1e3 * step:.4g} mm ({INCH / step:.4g} dpi)"
        if self.speed_noise > 0.0:
            said += f"; noise of the speed {speed.text(self.speed_noise)}"
        said += f"; peak speed {speed.text(self.peak_speed())} from row to row"
        if not smooth:
            return f"{said}. It is used without smoothing."
        left = self.smoothed(cutoff).peak_speed()
        shortest = (PEAK_LOSS / LOST) ** 0.25 / cutoff
        return (
            f"{said}, {speed.text(left)} smoothed. Smoothing: Butterworth of 2nd order forwards "
            f"and backwards, -3 dB at {cutoff:g} Hz; it takes {LOST:.0%} off the peak speed of a "
            f"minimum-jerk stroke of {1e3 * shortest:.3g} ms, less off longer ones."
        )


def read_csv(
    path: str | PathLike[str],
    *,
    acceleration: float | str = default("hand_acceleration"),
    resolution: float | str = default("mouse_resolution"),
    cutoff: float | str = default("smoothing_cutoff"),
    smooth: bool | None = None,
) -> HandPath:
    """A recorded path from a CSV; a raw recording of a mouse is smoothed.

    Args:
        path: The file, as for `HandRecording.read`.
        acceleration: m/s²; more is taken for a jump of the hand's speed, and refused.
        resolution: Resolution of a mouse with positions in counts, 1/m.
        cutoff: Cut-off frequency of the smoothing, Hz.
        smooth: True to smooth, False not to. None: `HandRecording.raw` decides.

    Raises:
        ValueError: The recording is invalid, as for `HandRecording.read` and `HandRecording.path`.
    """
    recording = HandRecording.read(path, check("mouse_resolution", resolution, label="resolution"))
    most = check("hand_acceleration", acceleration, label="acceleration")
    return recording.path(most, check("smoothing_cutoff", cutoff), smooth)
