"""The hand's path over the page, and strokes of minimum jerk."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, hypot, sin
from typing import Any, Final

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import ArrayLike, NDArray

from pindrive import _core
from pindrive.motion.function import Function, function_of
from pindrive.motion.profile import Profile
from pindrive.quantities import budgets
from pindrive.quantities.refusal import refusal
from pindrive.quantities.rows import check_increasing
from pindrive.quantities.table import check, default
from pindrive.quantities.value import concise, equal_by_value

PEAK: Final = 1.875
"""Peak speed of a minimum-jerk stroke over its mean (Flash & Hogan 1985, J. Neurosci. 5:1688)."""
STROKE: Final = (0.0, 30.0, -30.0)
"""Bend of a minimum-jerk stroke over its mean speed."""
MEANS: Final = np.array([1.0 / 6.0, 1.0 / 12.0, 1.0 / 20.0])
"""Means over a stretch of s (1 - s), s² (1 - s) and s³ (1 - s)."""
SLOW: Final = 0.1
"""Below this part of the peak speed the direction of motion says nothing."""
RECORDED: Final = "time [s], x [m], y [m]"
"""The header of a CSV with a recorded path."""

Point = tuple[float, float]
Column = NDArray[np.float64]


@equal_by_value
@concise
@dataclass(frozen=True, slots=True, eq=False)
class HandPath:
    """Path of the hand over time, made by `strokes`, `lines`, `through` or `read_csv`.

    Args:
        times: s, shape (n,), n >= 2, increasing.
        vx, vy: Velocity on the page at these times, m/s, shape (n,).
        start: Place on the page at the first, m.
        about: Description of the recording, for reports.
        bend_x, bend_y: Coefficients b of the velocity between two times, m/s, shape (n - 1, 3);
            None or empty: linear. With s from 0 to 1 between them, s (1 - s) (b₀ + b₁ s + b₂ s²)
            is added.

    Raises:
        ValueError: Times do not increase, shapes differ, or a number is not finite.
    """

    times: NDArray[np.float64]
    vx: NDArray[np.float64]
    vy: NDArray[np.float64]
    x: NDArray[np.float64]
    y: NDArray[np.float64]
    bend_x: NDArray[np.float64]
    bend_y: NDArray[np.float64]
    about: str

    def __init__(
        self,
        times: ArrayLike,
        vx: ArrayLike,
        vy: ArrayLike,
        start: Point,
        about: str = "",
        *,
        bend_x: ArrayLike | None = None,
        bend_y: ArrayLike | None = None,
    ) -> None:
        """Validate, and integrate."""
        object.__setattr__(self, "about", about)
        columns = {
            name: np.array(column, np.float64)
            for name, column in (("times", times), ("vx", vx), ("vy", vy))
        }
        t = columns["times"]
        for name, column in columns.items():
            if column.ndim != 1 or len(column) < 2 or column.shape != t.shape:
                required = "of one dimension and one length, at least 2"
                raise ValueError(refusal(name, required, f"shape {column.shape}"))
            if not np.isfinite(column).all():
                raise ValueError(refusal(name, "finite", f"{column[~np.isfinite(column)][0]!r}"))
        check_increasing(t.tolist(), "s", label="times[{}]")
        bends = {"bend_x": bend_x, "bend_y": bend_y}
        bent = any(given is not None and np.size(given) > 0 for given in bends.values())
        for name, given in bends.items():
            columns[name] = _bends(name, given, len(t) - 1 if bent else 0)
        x0, y0 = (check("hand.place", place, label="start") for place in start)
        lasts = np.diff(t)
        for axis, at in (("x", x0), ("y", y0)):
            v = columns[f"v{axis}"]
            means = 0.5 * (v[1:] + v[:-1])
            if bent:
                means = means + columns[f"bend_{axis}"] @ MEANS
            columns[axis] = np.cumsum(np.concatenate([[at], means * lasts]))
        for name, column in columns.items():
            column.flags.writeable = False
            object.__setattr__(self, name, column)

    @property
    def begin(self) -> float:
        """Begin of the path, s."""
        return float(self.times[0])

    @property
    def end(self) -> float:
        """End of the path, s."""
        return float(self.times[-1])

    @property
    def peak_speed(self) -> float:
        """The largest speed, m/s."""
        within = map(self._peak, range(len(self.bend_x)))
        return max(float(np.hypot(self.vx, self.vy).max()), max(within, default=0.0))

    def _peak(self, i: int) -> float:
        """Largest speed within a stretch, m/s."""
        s = Polynomial([0.0, 1.0])
        x, y = (
            v[i] + (v[i + 1] - v[i]) * s + s * (1.0 - s) * Polynomial(bend[i])
            for v, bend in ((self.vx, self.bend_x), (self.vy, self.bend_y))
        )
        turns = (x * x + y * y).deriv().roots()
        inside = turns.real[(abs(turns.imag) < 1e-6) & (turns.real > 0.0) & (turns.real < 1.0)]
        return float(np.hypot(x(inside), y(inside)).max(initial=0.0))

    @property
    def rows(self) -> tuple[Column, Column, Column, Column, Column, Column, Column]:
        """Columns of the path: times, velocity (x, y) and place (x, y), and bends (x, y), SI."""
        return self.times, self.vx, self.vy, self.x, self.y, self.bend_x, self.bend_y

    def position(self, t: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Place (x, y) on the page at times t (s, any shape) from begin to end, m."""
        times = self._within(t)
        x, y = _core.hand_position(self.rows, times.ravel())
        return x.reshape(times.shape), y.reshape(times.shape)

    def velocity(self, t: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Velocity (x, y) on the page at times t (s, any shape) from begin to end, m/s."""
        times = self._within(t)
        x, y = _core.hand_velocity(self.rows, times.ravel())
        return x.reshape(times.shape), y.reshape(times.shape)

    def way(self, t: ArrayLike) -> NDArray[np.float64]:
        """Length of the way from the begin to times t (s, any shape), m."""
        times = self._within(t)
        return _core.way(self.rows, times.ravel()).reshape(times.shape)

    def turnings(self, axis: float = default("axis")) -> NDArray[np.float64]:
        """Stops and turns of the hand along an axis (rad) of the page, s, in order."""
        return _core.turnings(self.rows, axis)

    def _within(self, t: ArrayLike) -> NDArray[np.float64]:
        """Times that are within the path, s."""
        times = np.asarray(t, np.float64, order="C")
        if not ((times >= self.begin) & (times <= self.end)).all():
            required = f"from {self.begin!r} s to {self.end!r} s"
            given = f"{float(times.min())!r} to {float(times.max())!r} s"
            raise ValueError(refusal("t", required, given))
        return times

    def plate_velocity(self, axis: float = default("axis")) -> Profile | Function:
        """The velocity at which the plate passes under the mouse, over the time since `begin`.

        Args:
            axis: Direction of the drive axis on the page, rad.

        Returns:
            The hand's velocity along that axis. Its sign is that of the hand: x, the pin's
            deflection, is positive against the mouse's own motion along the axis (docs/theory.md).
        """
        times, along, *_ = _core.plate_velocity(self.rows, axis)
        return _input(times, *along)

    def across_velocity(self, axis: float = default("axis")) -> Profile | Function | float:
        """The velocity of the plate across the drive axis, over the time since `begin`.

        Args:
            axis: Direction of the drive axis on the page, rad.

        Returns:
            The hand's velocity a right angle from that axis, towards the left; 0 for a hand that
            moves along the axis, to the rounding of its speed.
        """
        times, _, across, oblique = _core.plate_velocity(self.rows, axis)
        return _input(times, *across) if oblique else 0.0

    def angles(self, axis: float = default("axis")) -> tuple[float, float]:
        """The angle between motion and drive axis, rad: the largest, and the mean over the way.

        From 0 to a right angle; where the hand moves at less than a tenth of its peak speed it is
        left out, and 0 for a hand that never moves.
        """
        vx, vy = (np.diff(place) / np.diff(self.times) for place in (self.x, self.y))
        speed = np.hypot(vx, vy)
        moving = speed > SLOW * speed.max()
        if not moving.any():
            return 0.0, 0.0
        along = np.abs(vx * cos(axis) + vy * sin(axis))
        across = np.abs(vy * cos(axis) - vx * sin(axis))
        angle = np.arctan2(across, along)[moving]
        way = (speed * np.diff(self.times))[moving]
        return float(angle.max()), float((angle * way).sum() / way.sum())

    def between(self, begin: float, end: float) -> HandPath:
        """Return the path from one time to another, s, on its own clock."""
        if not self.begin <= begin < end <= self.end:
            required = f"increasing and within {self.begin!r} s to {self.end!r} s"
            raise ValueError(refusal("begin and end", required, f"{begin!r} s and {end!r} s"))
        inner = self.times[(self.times > begin) & (self.times < end)]
        times = np.concatenate([[begin], inner, [end]])
        vx, vy = self.velocity(times)
        x, y = self.position(begin)
        bends: dict[str, Column] = {}
        if len(self.bend_x):
            i = np.searchsorted(self.times, times[:-1], "right") - 1
            lasts = np.diff(self.times)[i]
            since, part = (times[:-1] - self.times[i]) / lasts, np.diff(times) / lasts
            bends = {
                name: _part_of_bends(np.diff(v)[i], np.diff(now), bend[i], since, part)
                for name, v, now, bend in (
                    ("bend_x", self.vx, vx, self.bend_x),
                    ("bend_y", self.vy, vy, self.bend_y),
                )
            }
        return HandPath(times, vx, vy, (float(x), float(y)), self.about, **bends)


def _bends(name: str, given: ArrayLike | None, count: int) -> Column:
    """Bends of the stretches; zeros where none are given."""
    bends = (
        np.zeros((count, 3))
        if given is None or np.size(given) == 0
        else np.array(given, np.float64)
    )
    if bends.shape != (count, 3):
        raise ValueError(refusal(name, f"of shape ({count}, 3)", f"shape {bends.shape}"))
    if not np.isfinite(bends).all():
        raise ValueError(refusal(name, "finite", f"{bends[~np.isfinite(bends)][0]!r}"))
    return bends


def _part_of_bends(
    whole: Column, change: Column, bends: Column, since: Column, part: Column
) -> Column:
    """Bends of parts of stretches that begin at `since` and last `part` of the stretches.

    `whole` and `change`: change of the velocity over each stretch, and over the part.
    """
    b0, b1, b2 = bends.T
    first, second, third, fourth = whole + b0, b1 - b0, b2 - b1, -b2  # coefficients by powers of s
    rate = first + since * (2.0 * second + since * (3.0 * third + since * 4.0 * fourth))
    curvature = second + since * (3.0 * third + since * 6.0 * fourth)
    begins = part * rate - change  # so that a hand that begins from rest does so exactly
    return np.stack([begins, part**2 * curvature + begins, -(part**4) * fourth], axis=-1)


def _input(times: Column, rows: Column, pieces: list[Any]) -> Profile | Function:
    """Velocity as an input of a motion."""
    return function_of(pieces, "m/s") if pieces else Profile(times.tolist(), rows.tolist())


# ---- strokes -------------------------------------------------------------------------------------


def strokes(
    stops: Sequence[tuple[float | str, float | str]],
    speeds: float | str | Sequence[float | str],
    *,
    pause: float | str = 0.0,
) -> HandPath:
    """Straight strokes of minimum jerk from stop to stop, each from rest to rest.

    Args:
        stops: Places on the page, m, at least two, each another than the one before.
        speeds: Peak speed of each stroke, m/s, greater than 0; one for all of them, or one each.
        pause: Rest after each stroke, s, at least 0.

    Raises:
        ValueError: A value is not a number or out of its range, or there are too many strokes.

    A stroke of length D in time T has the speed (D/T) 30 s² (1 − s)² at t = s T (Flash & Hogan
    1985). The motion under a stroke is as exact as under a constant speed.
    """
    if len(stops) < 2:
        raise ValueError(refusal("stops", "at least two places", str(len(stops))))
    peaks = [speeds] * (len(stops) - 1) if isinstance(speeds, (int, float, str)) else list(speeds)
    if len(peaks) != len(stops) - 1:
        raise ValueError(refusal("speeds", f"one or {len(stops) - 1}", str(len(peaks))))
    rest = check("pause", pause)
    budgets.INPUT_ROWS.check(len(peaks) * (2 if rest > 0.0 else 1) + 1, f"{len(peaks)} strokes")
    times, means = [0.0], []  # mean velocity of each stretch, m/s
    places = [tuple(check("hand.place", at, label="stops") for at in stop) for stop in stops]
    paths = zip(places[:-1], places[1:], peaks, strict=True)
    for i, ((x0, y0), (x1, y1), speed) in enumerate(paths):
        dx, dy = (check("hand.place", way, label="stroke") for way in (x1 - x0, y1 - y0))
        label = f"the way from stops[{i}] to stops[{i + 1}]"
        length = check("stroke.length", hypot(dx, dy), label=label)
        lasts = PEAK * length / check("hand_speed", speed, label="speeds")
        times.append(times[-1] + lasts)
        means.append((dx / lasts, dy / lasts))
        if rest > 0.0:
            times.append(times[-1] + rest)
            means.append((0.0, 0.0))
    still = np.zeros(len(times))
    bend_x, bend_y = (np.outer(v, STROKE) for v in np.transpose(means))
    start = places[0][0], places[0][1]
    return HandPath(times, still, still, start, bend_x=bend_x, bend_y=bend_y)


def lines(
    rows: Sequence[float | str],
    left: float | str,
    right: float | str,
    *,
    speed: float | str,
    return_speed: float | str,
    pause: float | str = 0.0,
) -> HandPath:
    """Line by line over a page: along each row from left to right, then back to the next.

    Args:
        rows: Y of each line on the page, m, at least one.
        left: x where the hand begins to read, m.
        right: x where it ends, m.
        speed: Peak speed while it reads, m/s.
        return_speed: Peak speed on the way back, m/s.
        pause: Rest after each stroke, s.

    Raises:
        ValueError: A value is not a number or out of its range; no way between left and right.
    """
    if not rows:
        raise ValueError(refusal("rows", "at least one line", "none"))
    stops = [place for y in rows for place in ((left, y), (right, y))]
    speeds = [return_speed if i % 2 else speed for i in range(len(stops) - 1)]
    return strokes(stops, speeds, pause=pause)
