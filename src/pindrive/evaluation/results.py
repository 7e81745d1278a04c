"""What the finger was shown in a scan, as data: lines, their edges, false lines, and counts."""

from __future__ import annotations

from dataclasses import dataclass
from math import isnan, nan
from typing import TYPE_CHECKING, Any, Final, Literal

import numpy as np

from pindrive import lazy
from pindrive.device.device import Criteria
from pindrive.lazy import xr
from pindrive.quantities.quantity import counted
from pindrive.quantities.results import LINE
from pindrive.quantities.status import Status
from pindrive.quantities.table import QUANTITIES

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from pindrive.device.scanning import Scan

Fate = Literal["shown", "unseen", "merged", "faint"]
Cue = Literal["none", "felt", "direction", "sure"]

CUES: Final[tuple[Cue, ...]] = ("none", "felt", "direction", "sure")
FATES: Final[tuple[Fate, ...]] = ("shown", "unseen", "merged", "faint")


@dataclass(frozen=True, slots=True, kw_only=True)
class Edge:
    """One end of a printed line under one pin, and what became of it. NaN: it did not."""

    time: float
    """When it passed under the spot, s."""
    x: float
    y: float
    """Where that is on the page, m."""
    command: float
    """When the magnet was switched for it, s."""
    response: float
    """When the finger was shown it, s."""
    lag: float
    """What the hand went from `time` to `response`, m."""
    skin: float
    """How far the skin moved for it, m."""
    cue: Cue
    """What the finger makes of that: nothing, a pulse, its direction, its direction for sure."""

    @property
    def latency(self) -> float:
        """From the edge to the response, s."""
        return self.response - self.time


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
    """How far it moved the pin, m."""
    height: float
    """The pin's highest deflection for it, m."""
    returned: float
    """How far the pin came back from there, before the next line or the hand's stop, m."""
    release: float
    """When the pin broke away from the plate, s."""
    settled: float
    """When the pin had settled after it, s; NaN: it did not."""
    smear: float
    """What the hand went from release to settled, m."""
    overshoot: float
    contrast: float

    @property
    def numbers(self) -> dict[str, float]:
        """What was found, SI, by the names of the table of quantities."""
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


@dataclass(frozen=True, slots=True)
class Echo:
    """A swing of a pin that feels like a line and is none."""

    pin: int
    time: float
    """When it was highest, s."""
    x: float
    y: float
    """Where the pin's spot was then, m."""
    stroke: float
    """How high it was, m."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Judgement(lazy.NotebookHtml):
    """What the finger was shown in a scan."""

    scan: Scan
    criteria: Criteria
    lines: tuple[Line, ...]
    """Pin after pin, in the order of time. Lines that the way does not cross whole are left out."""
    echoes: tuple[Echo, ...]
    """False lines."""

    def __repr__(self) -> str:
        """What became of the lines, in a line."""
        lines, missed = len(self.lines), len(self.lines) - len(self.shown)
        shown = f"{lines - missed} of {counted(lines, 'line')} shown"
        return f"<Judgement of {self.scan.scene.title}: {shown}, {len(self.echoes)} false>"

    @property
    def status(self) -> Status:
        """That of the scan."""
        return self.scan.status

    def plot(self, pin: int | None = None) -> Figure:
        """The scan and one pin of it, from 0, as `Scan.plot` draws them."""
        figure: Figure = lazy.call("pindrive.plot.scan:plot_scan", self, pin)
        return figure

    def to_dataset(self) -> xr.Dataset:
        """Each line under each pin, each false line, and the counts, with units.

        Returns:
            Variables over `line`: `pin`, `fate`, `time_begin` and `time_end` (s, when its edges
            passed under the spot) and the numbers of `Line.numbers`; over `echo`: those of `Echo`;
            a scalar for each of `counts`.
        """
        from pindrive import __version__

        lines, echoes = self.lines, self.echoes
        data: dict[str, Any] = {
            "pin": ("line", np.array([line.pin for line in lines], np.int64)),
            "fate": ("line", np.array([line.fate for line in lines], "<U6")),
        }
        for end in ("begin", "end"):
            times = np.array([getattr(line, end).time for line in lines], np.float64)
            words = {"long_name": f"when the {end} of the line passed under the spot", "units": "s"}
            data[f"time_{end}"] = ("line", times, words)
        rows = [line.numbers for line in lines]
        for quantity in LINE:
            values = np.array([row[quantity.name] for row in rows], np.float64)
            data[quantity.name.replace(".", "_")] = ("line", values, quantity.attributes)
        data["echo_pin"] = ("echo", np.array([echo.pin for echo in echoes], np.int64))
        for name, unit, meaning in (
            ("time", "s", "when it was highest"),
            ("x", "m", "where the spot was then, across the page"),
            ("y", "m", "where the spot was then, down the page"),
            ("stroke", "m", "how high it was"),
        ):
            values = np.array([getattr(echo, name) for echo in echoes], np.float64)
            data[f"echo_{name}"] = ("echo", values, {"long_name": meaning, "units": unit})
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
        """How many lines, and what became of them, by the names of the table of quantities."""
        shown = self.shown
        cues = [CUES.index(line.begin.cue) for line in shown]
        return {
            "judged.lines": len(self.lines),
            **{f"judged.{fate}": sum(line.fate == fate for line in self.lines) for fate in FATES},
            "judged.echoes": len(self.echoes),
            "judged.unsettled": sum(isnan(line.settled) for line in shown),
            "judged.direction": sum(cue >= CUES.index("direction") for cue in cues),
            "judged.sure": sum(cue >= CUES.index("sure") for cue in cues),
        }

    def spread(self, name: str) -> tuple[float, float, float]:
        """Least, median and largest of a number of the lines shown, SI; NaN where none has it.

        Args:
            name: of `Line.numbers`.
        """
        values = np.array([line.numbers[name] for line in self.shown])
        known = values[~np.isnan(values)]
        if not known.size:
            return nan, nan, nan
        return float(known.min()), float(np.median(known)), float(known.max())
