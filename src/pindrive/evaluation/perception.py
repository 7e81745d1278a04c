"""Evaluation of a scan against the printed page: line by line, edge by edge.

All times are roots of closed forms, never samples. Deflections are positive in the direction in
which the plate passes under the mouse while the line is read.

- **Response.** A pin responds to the begin of a line when it has moved forward by the motion that
  is felt as a pulse, from its lowest position since its magnet was switched on. It responds to the
  end when it has moved back by as much, from its highest position since the magnet was switched
  off.
- **Latency** is the time from the edge under the spot to the response, **lag** the path of the
  hand on the page during that time.
- **Smear** is the path of the hand from the release of the pin until the pin has settled: until it
  stays within 5 % of its way from the release to the final position. A position is final if the
  pin is at rest, or stays in that band for half a natural period and one time constant of the
  slowest decay, before the next line moves it or the hand stops. A pin that does not settle has no
  smear, and is counted.
- **Overshoot** is the largest swing beyond that position, as a part of the way back to it. A pin
  that does not settle has the position at which spring and dragging plate balance.
- **Contrast** is (P - T) / (|P| + |T|) with the highest deflection P for a line and the lowest T
  after it, before the next line or the stop of the hand (Michelson's, of crest and trough): 1 if
  the pin returns completely, 0 if it stays.
- **Skin** moves as far as a compliant finger stretches. For a rigid finger it moves as far as the
  pin, the most that skin could move. A lifted finger feels nothing: the motion of the skin is that
  within one touch.
- **False lines** are forward swings without a magnet that reach `false_line` times the height of
  the line before (before the first line of a stroke of the hand: of the first line) and move the
  skin enough for a direction; in a stroke without lines, enough for a sure direction. The height
  of a line is that of the highest swing while its magnet pulled, without ripple.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import isnan, nan, pi
from operator import attrgetter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pindrive import lazy
from pindrive._core import settling_band
from pindrive.device.device import Criteria
from pindrive.device.scanning import PinScan, Scan
from pindrive.device.touch import spans
from pindrive.device.trajectory import Signal, Trajectory, Way
from pindrive.evaluation.line_crossings import (
    CUES,
    FATES,
    Cue,
    Edge,
    FalseLine,
    Fate,
    Line,
    Printed,
    printed,
    turnings,
)
from pindrive.lazy import mpl_figure, xr
from pindrive.motion.profile import Profile
from pindrive.quantities.quantity import counted
from pindrive.quantities.results import BAD_WHEN_SMALL, EDGES, LINE, last_part
from pindrive.quantities.status import Status
from pindrive.quantities.table import QUANTITIES
from pindrive.quantities.value import equal_by_value


@equal_by_value
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Evaluation(lazy.NotebookHtml):
    """Evaluation of a scan."""

    scan: Scan
    criteria: Criteria
    lines: tuple[Line, ...]
    """Pin after pin, in the order of time. Lines that the way does not cross whole are left out."""
    false_lines: tuple[FalseLine, ...]
    """False lines."""

    def __repr__(self) -> str:
        """Return the counts of the lines in a line."""
        lines, missed = len(self.lines), len(self.lines) - len(self.shown)
        shown = f"{lines - missed} of {counted(lines, 'line')} shown"
        return f"<Evaluation of {self.scan.scene.title}: {shown}, {len(self.false_lines)} false>"

    @property
    def status(self) -> Status:
        """That of the scan."""
        return self.scan.status

    def plot(self, pin: int | None = None) -> mpl_figure.Figure:
        """Plot the scan and one pin, from 0, as `Scan.plot`."""
        from pindrive.plot.scan import plot_scan

        return plot_scan(self, pin)

    def columns(self) -> dict[str, NDArray[Any]]:
        """Each line under each pin, by the names of datasets and files; arrays of shape (n,), SI.

        `pin`, `fate`, what the finger made of its edges, `cue_on` and `cue_off`, when and where
        they passed under the spot, and the numbers of `Line.numbers`.
        """
        lines, rows = self.lines, [line.numbers for line in self.lines]
        found: dict[str, NDArray[Any]] = {
            "pin": np.array([line.pin for line in lines], np.int64),
            "fate": np.array([line.fate for line in lines], "<U6"),
            "cue_on": np.array([line.begin.cue for line in lines], "<U9"),
            "cue_off": np.array([line.end.cue for line in lines], "<U9"),
        }
        for quantity in EDGES:
            place = attrgetter(quantity.name)
            found[quantity.variable] = np.array([place(line) for line in lines], np.float64)
        for quantity in LINE:
            found[quantity.variable] = np.array([row[quantity.name] for row in rows], np.float64)
        return found

    def to_dataset(self) -> xr.Dataset:
        """Each line under each pin, each false line, and the counts, with units.

        Returns:
            Variables over `line`: `columns`; over `false_line`: those of `FalseLine`; a scalar for
            each number in `counts`.
        """
        from pindrive import __version__

        false_lines = self.false_lines
        stated = {quantity.variable: quantity.attributes for quantity in (*EDGES, *LINE)}
        data: dict[str, Any] = {
            name: ("line", values, stated.get(name)) for name, values in self.columns().items()
        }
        data["false_line_pin"] = (
            "false_line",
            np.array([line.pin for line in false_lines], np.int64),
        )
        for name, unit, meaning in (
            ("time", "s", "time of its peak"),
            ("x", "m", "place of the spot at the peak, across the page"),
            ("y", "m", "place of the spot at the peak, down the page"),
            ("stroke", "m", "height of the peak"),
        ):
            values = np.array([getattr(line, name) for line in false_lines], np.float64)
            data[f"false_line_{name}"] = (
                "false_line",
                values,
                {"long_name": meaning, "units": unit},
            )
        for name, count in self.counts.items():
            data[name.replace(".", "_")] = ((), count, QUANTITIES[name].attributes)
        title = f"Lines of {self.scan.scene.title}, as they were shown"
        return xr.Dataset(data, attrs={"title": title, "source": f"pindrive {__version__}"})

    @property
    def shown(self) -> tuple[Line, ...]:
        """The lines that were shown."""
        return tuple(line for line in self.lines if line.fate == "shown")

    @property
    def counts(self) -> dict[str, int]:
        """Counts of the lines, by the names of the table of quantities."""
        shown = self.shown
        cues = [CUES.index(line.begin.cue) for line in shown]
        return {
            "lines.crossed": len(self.lines),
            **{f"lines.{fate}": sum(line.fate == fate for line in self.lines) for fate in FATES},
            "lines.false": len(self.false_lines),
            "lines.unsettled": sum(isnan(line.settled) for line in shown),
            "lines.direction": sum(cue >= CUES.index("direction") for cue in cues),
            "lines.sure": sum(cue >= CUES.index("sure") for cue in cues),
        }

    def spread(self, name: str) -> tuple[float, float, float]:
        """Least, median and largest of a number of the lines shown, SI; NaN where none has it.

        Args:
            name: Name of a number in `Line.numbers`.
        """
        values = np.array([line.numbers[name] for line in self.shown])
        known = values[~np.isnan(values)]
        if not known.size:
            return nan, nan, nan
        return float(known.min()), float(np.median(known)), float(known.max())

    @property
    def numbers(self) -> dict[str, float]:
        """Numbers of a scan for studies, SI, by their names there; NaN for missing ones."""
        counts, path = self.counts, self.scan.path
        lines, duration = counts["lines.crossed"], path.end - path.begin
        on = max(sum(end - begin for begin, end in pin.energised) for pin in self.scan.pins)
        coil = self.scan.device.magnet.coil
        found: dict[str, float] = {
            "lines.shown_part": counts["lines.shown"] / lines if lines else nan,
            **counts,
            "hand.duration": duration,
            "magnet.on_part": on / duration,
            "coil.warming": coil.thermal_resistance * coil.power * on / duration if coil else nan,
        }
        for quantity in LINE:
            name = last_part(quantity)
            least, median, largest = self.spread(quantity.name)
            found[f"median.{name}"] = median
            found[f"worst.{name}"] = least if name in BAD_WHEN_SMALL else largest
        return found


def evaluate(scan: Scan, criteria: Criteria | None = None) -> Evaluation:
    """Hold what each pin did in a scan against what is printed along its way.

    Args:
        scan: The scan.
        criteria: Criteria of a felt line; None: the middle of the literature.
    """
    limits = criteria or Criteria()
    stops, way = turnings(scan.path, scan.device.array.axis), Way(scan.path)
    lines: list[Line] = []
    false_lines: list[FalseLine] = []
    lines_passed = printed(scan.device, scan.path, scan.scene)
    for pin, passed in zip(scan.pins, lines_passed, strict=True):
        evaluated = EvaluatedPin(scan, pin, passed, stops, way, limits)
        lines += evaluated.lines()
        false_lines += evaluated.false_lines()
    return Evaluation(
        scan=scan, criteria=limits, lines=tuple(lines), false_lines=tuple(false_lines)
    )


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
        back = -Signal(self.pin.motion.position, pull.sign)
        return not self.trajectory.climbs(back, self.criteria.felt, before.off, until)

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
        load = self.pin.finger_load
        pressed = load(limit) if isinstance(load, Profile) else load
        place = end if settles else self.scan.device.drag(finger_load=pressed)
        over = max(0.0, (place - low) / (peak - place)) if peak > place else nan
        return since if settles else nan, over

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
