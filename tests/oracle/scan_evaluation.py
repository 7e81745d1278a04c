"""Evaluation of scans in Python: the reference of include/pindrive/device, which replaced it.

Printed lines, trajectories between turning points, and each pin's lines and false lines, by NumPy
over the interface of `Motion`. It shares motions, `Scene.at` and `HandPath.position` with the
evaluation in C++; tests/device/test_reference.py compares the latter two with NumPy.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from math import cos, nan, pi, sin
from typing import Final

import numpy as np
from numpy.typing import NDArray

from oracle.pin_trajectory import Signal, Trajectory, Way
from pindrive.device.device import Criteria, Device
from pindrive.device.hand import HandPath
from pindrive.device.page import Scene
from pindrive.device.pin_scan import PinScan
from pindrive.device.scanning import Scan
from pindrive.device.touch import spans
from pindrive.device.trajectory import roots
from pindrive.evaluation.line_crossings import CUES, Cue, Edge, FalseLine, Fate, Line
from pindrive.motion.profile import Profile

settling_band: Final = 0.05
AT_ONCE: Final = 1 << 18
FINER: Final = 4.0
GRAZED: Final = 0.5


@dataclass(frozen=True, slots=True)
class Printed:
    """A line printed across a pin's way, while its spot was on it."""

    begin: float
    """Time at which the spot entered the line, s."""
    end: float
    """Time at which the spot left the line, s."""
    whole: bool
    """True for a whole crossing: no begin, end or turn of the path on the line."""


def evaluated(scan: Scan, limits: Criteria) -> tuple[list[Line], list[FalseLine]]:
    """The lines and the false lines of all pins."""
    stops, way = turnings(scan.path, scan.device.array.axis), Way(scan.path)
    lines: list[Line] = []
    false_lines: list[FalseLine] = []
    lines_passed = printed(scan.device, scan.path, scan.scene)
    for pin, passed in zip(scan.pins, lines_passed, strict=True):
        one = EvaluatedPin(scan, pin, passed, stops, way, limits)
        lines += one.lines()
        false_lines += one.false_lines()
    return lines, false_lines


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


@dataclass(frozen=True, slots=True)
class _Pull:
    """One time its magnet was on, and how the pin answered."""

    on: float
    off: float
    begin: float
    """Time at which the pin came forward; NaN: never."""
    dip: float
    """Time of the lowest position before that."""
    release: float
    """Time of the break-away from the plate."""
    sign: float
    """Sign of the plate's velocity."""


class EvaluatedPin:
    """One pin's lines and swings. Times are since the scan's begin, s.

    Args:
        scan: The scan.
        pin: One of the pins of the scan.
        passed: The lines printed along its way.
        stops: Times at which the hand stops or turns back, s.
        way: The length of the hand's way.
        criteria: Criteria of a felt line.
    """

    def __init__(
        self,
        scan: Scan,
        pin: PinScan,
        passed: Sequence[Printed],
        stops: NDArray[np.float64],
        way: Way,
        criteria: Criteria,
    ) -> None:
        self.scan, self.pin, self.criteria = scan, pin, criteria
        self.begin, self.way = pin.begin, way
        self.passed = [
            Printed(line.begin - pin.begin, line.end - pin.begin, line.whole) for line in passed
        ]
        self.stops = stops - pin.begin
        self.latency = scan.device.control.latency
        self.trajectory, self.end = Trajectory(pin.motion), pin.motion.duration
        self.held = self.trajectory.held()
        self.plate = scan.path.plate_velocity(scan.device.array.axis)
        self.touching = spans(pin.finger_load)
        self.pulls = self._pulls()

    # ---- what the magnet did -----------------------------------------------------------------

    def _pulls(self) -> list[_Pull]:
        spans = [(on - self.begin, off - self.begin) for on, off in self.pin.energised]
        pulls = []
        for (on, off), (limit, _) in zip(spans, [*spans[1:], (self.end, nan)], strict=False):
            sign = self._sign(max(0.0, on - self.latency))
            x = Signal(self.pin.motion.position, sign)
            stop = min(limit, self._stop(off))
            begin, dip = self.trajectory.climb(x, self.criteria.felt, on, stop)
            release = next((end for start, end in self.held if start <= off < end), off)
            pulls.append(_Pull(on, off, begin, dip, release, sign))
        return pulls

    def _sign(self, t: float) -> float:
        """Return the direction of the plate at a time; forward at rest."""
        return -1.0 if self.plate(t) < 0.0 else 1.0

    def _stop(self, t: float) -> float:
        """Return the next stop or turn of the hand after a time, or the scan's end."""
        i = int(np.searchsorted(self.stops, t, "right"))
        return min(float(self.stops[i]), self.end) if i < len(self.stops) else self.end

    def _until(self, k: int) -> float:
        """Return the end of pull k: the next pull, or the stop of the hand."""
        stop = max(self._stop(self.pulls[k].off), self.pulls[k].off)
        later = self.pulls[k + 1 : k + 2]
        return min([stop, *(p.dip if p.begin == p.begin else p.on for p in later)])

    # ---- the printed lines -------------------------------------------------------------------

    def lines(self) -> list[Line]:
        """Each whole line that passed under the pin."""
        found = []
        begun: set[int] = set()
        for i, line in enumerate(self.passed):
            mine = [
                k
                for k, pull in enumerate(self.pulls)
                if pull.on - self.latency <= line.end and pull.off - self.latency >= line.begin
            ]
            first = next((k for k in mine if k not in begun), None)
            last = mine[-1] if mine and not self._goes_on(mine[-1], i) else None
            begun.update(mine)
            if line.whole:
                found.append(self._line(line, first, last, bool(mine)))
        return found

    def _goes_on(self, k: int, i: int) -> bool:
        """Return True if the magnet stays on from line i into the next."""
        later = self.passed[i + 1 : i + 2]
        return any(self.pulls[k].off - self.latency >= line.begin for line in later)

    def _line(self, line: Printed, first: int | None, last: int | None, seen: bool) -> Line:
        """A printed line, for which pull `first` began and pull `last` ended."""
        sign = self._sign(line.begin)
        x, skin = Signal(self.pin.motion.position, sign), self._skin(sign)
        fate: Fate = "shown"
        stroke = height = returned = release = settled = overshoot = contrast = nan
        on = off = (nan, nan, nan)  # command, response, motion of the skin
        cue_on = cue_off = CUES[0]
        if first is None:
            fate = "merged" if seen else "unseen"
        elif self._still_held(first):
            fate = "merged"
        else:
            pull = self.pulls[first]
            on = (pull.on, nan, nan)
            if pull.begin == pull.begin:
                peak_time, peak = self.trajectory.highest(x, pull.begin, self._until(first))
                stroke = peak - float(x(pull.dip))
                moved, cue_on = self._moved(skin, pull.dip, peak_time)
                on = (pull.on, pull.begin, moved)
        if last is not None:
            pull, limit = self.pulls[last], self._until(last)
            release = min(pull.release, limit)
            peak_time, peak = self.trajectory.highest(x, pull.on, limit)
            low = -self.trajectory.highest(-x, peak_time, limit)[1]
            back = self.trajectory.climb(-x, self.criteria.felt, pull.off, limit)[0]
            off = (pull.off, back, nan)
            if back == back:
                moved, cue_off = self._moved(-skin, peak_time, limit)
                off = (pull.off, back, moved)
            height, returned = peak, peak - low
            contrast = (peak - low) / (abs(peak) + abs(low)) if peak > low else 0.0
            settled, overshoot = self._settling(x, release, peak, low, limit)
        went, felt = on[1] == on[1], (cue_on, cue_off) != (CUES[0], CUES[0])
        if fate == "shown" and not (went and felt):
            fate = "faint"
        return Line(
            pin=self.pin.number,
            begin=self._edge(line.begin, *on, cue_on),
            end=self._edge(line.end, *off, cue_off),
            fate=fate,
            stroke=stroke,
            height=height,
            returned=returned,
            release=self.begin + release,
            settled=self.begin + settled,
            smear=self.way.between(self.begin + release, self.begin + settled),
            overshoot=overshoot,
            contrast=contrast,
        )

    def _edge(self, time: float, command: float, response: float, skin: float, cue: Cue) -> Edge:
        x, y = self._spot(time)
        return Edge(
            time=self.begin + time,
            x=x,
            y=y,
            command=self.begin + command,
            response=self.begin + response,
            lag=self.way.between(self.begin + time, self.begin + response),
            skin=skin,
            cue=cue,
        )

    def _spot(self, t: float) -> tuple[float, float]:
        """Return the place of the pin's spot on the page."""
        x, y = self.scan.spot(self.pin.number, [min(self.begin + t, self.pin.end)])[0].tolist()
        return x, y

    def _still_held(self, k: int) -> bool:
        """Return True if the pin had not come back from the pull before when pull k moved it on."""
        before, pull = self.pulls[max(k - 1, 0)], self.pulls[k]
        if k == 0 or before.sign != pull.sign or before.begin != before.begin:
            return False  # nothing before it, or nothing that had moved the pin
        until = pull.begin if pull.begin == pull.begin else self._until(k)
        x = Signal(self.pin.motion.position, pull.sign)
        way = self.trajectory.highest(x, before.on, until)[1] - self._drag(until)
        least = max(self.criteria.felt, self.criteria.distinct * way)
        return not self.trajectory.climbs(-x, least, before.off, until)

    # ---- numbers -----------------------------------------------------------------------------

    def _skin(self, sign: float) -> Signal:
        """Return the position of the skin; for a rigid finger, of the pin."""
        motion = self.pin.motion
        return Signal(motion.position if motion.drive.finger.rigid else motion.stretch, sign)

    def _moved(self, skin: Signal, begin: float, end: float) -> tuple[float, Cue]:
        """Return the forward displacement of the skin between two times, and the perceived cue."""
        times = [(max(begin, touch), min(end, lift)) for touch, lift in self.touching]
        moved = [self._moved_in(skin, touch, lift) for touch, lift in times if touch < lift]
        return max(moved, key=lambda found: (CUES.index(found[1]), found[0]), default=(0.0, "none"))

    def _moved_in(self, skin: Signal, begin: float, end: float) -> tuple[float, Cue]:
        """Return displacement and cue between two times of one touch."""
        limits = self.criteria
        base = float(skin(begin, "left"))
        way = self.trajectory.highest(skin, begin, end)[1] - base
        soon = begin + limits.direction_sure / limits.direction_speed
        if way >= limits.direction_sure:
            sure = base + limits.direction_sure
            if self.trajectory.first_at(skin, sure, begin, end) <= soon:
                return way, "sure"
        if way < limits.felt:
            return way, "none"
        return way, "direction" if way >= limits.direction else "felt"

    def _settling(
        self, x: Signal, release: float, peak: float, low: float, limit: float
    ) -> tuple[float, float]:
        """Return the settling time of the pin after a release, and its overshoot."""
        if not limit > release:
            return nan, nan
        end = float(x(limit))
        band = settling_band * abs(float(x(release)) - end)
        since = self.trajectory.last_beyond(x, end, band, release, limit)
        settles = limit - since >= self._patience or self.trajectory.rests(limit)
        place = end if settles else self._drag(limit)
        returned = peak - place > 1e-15 * abs(peak)
        over = max(0.0, (place - low) / (peak - place)) if returned else nan
        return since if settles else nan, over

    def _drag(self, t: float) -> float:
        """Return the deflection at which spring and dragging plate balance, m."""
        load = self.pin.finger_load
        pressed = load(t) if isinstance(load, Profile) else load
        return self.scan.device.drag(finger_load=pressed)

    @property
    def _patience(self) -> float:
        """Time within its band after which a pin counts as settled, s."""
        drive = self.pin.motion.drive
        half = pi / drive.natural_frequency
        return max(half, 1.0 / drive.slowest_rate) if drive.damping_ratio > 1.0 else half

    # ---- false lines -------------------------------------------------------------------------

    def false_lines(self) -> list[FalseLine]:
        """Swings forward that no magnet made, and that are as high as the criteria ask."""
        found = []
        times = np.unique(np.concatenate([[0.0], self.stops, [self.end]]))
        for begin, end in zip(times[:-1].tolist(), times[1:].tolist(), strict=True):
            if self.plate(0.5 * (begin + end)) != 0.0:
                found += self._false_lines(begin, end)
        return found

    def _false_lines(self, begin: float, end: float) -> list[FalseLine]:
        """Return the false lines of one stroke of the hand."""
        sign = self._sign(0.5 * (begin + end))
        x, skin = Signal(self.pin.motion.position, sign), self._skin(sign)
        swings = [
            (low, high, float(x(high) - x(low)), self._puller(low, high))
            for low, high in self.trajectory.swings(x, begin, end)
        ]
        heights: dict[int, float] = {}  # highest swing of each pull, by its line
        for _, _, height, k in swings:
            if k is not None:
                heights[k] = max(heights.get(k, 0.0), height)
        before = next(iter(heights.values()), nan)
        found = []
        for low, high, height, k in swings:
            if k is not None:
                before = heights[k]
                continue
            usual = self.criteria.false_line * before if before == before else 0.0
            least = self.criteria.direction if usual else self.criteria.direction_sure
            if height >= max(usual, least) and self._moved(skin, low, high)[0] >= least:
                px, py = self._spot(high)
                found.append(FalseLine(self.pin.number, self.begin + high, px, py, height))
        return found

    def _puller(self, low: float, high: float) -> int | None:
        """The last pull that has a part in a swing."""
        mine = [k for k, p in enumerate(self.pulls) if p.on < high and max(p.off, p.release) > low]
        return mine[-1] if mine else None
