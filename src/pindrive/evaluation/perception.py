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

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from math import nan
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from pindrive import _core
from pindrive.device.device import Criteria
from pindrive.device.scanning import Scan
from pindrive.evaluation.line_crossings import (
    CUES,
    FATES,
    MOST_EDGES,
    Edge,
    FalseLine,
    Line,
)
from pindrive.lazy import mpl_figure, xr
from pindrive.quantities import budgets
from pindrive.quantities.quantity import counted
from pindrive.quantities.results import BAD_WHEN_SMALL, EDGES, HAND_PATH, LINE, last_part
from pindrive.quantities.status import Status
from pindrive.quantities.table import QUANTITIES
from pindrive.quantities.value import equal_by_value
from pindrive.views import NotebookHtml, figure

Columns = Mapping[str, NDArray[Any]]

_FALSE_LINE: Final = (
    ("time", "s", "time of its peak"),
    ("x", "m", "place of the spot at the peak, across the page"),
    ("y", "m", "place of the spot at the peak, down the page"),
    ("stroke", "m", "height of the peak"),
)
"""Columns of the false lines: name, unit and meaning."""


@equal_by_value
@dataclass(frozen=True, kw_only=True, eq=False)
class Evaluation(NotebookHtml):
    """Evaluation of a scan."""

    scan: Scan
    criteria: Criteria
    core: _core.Evaluation = field(repr=False, compare=False)

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle the scan, whose evaluation is repeated."""
        return evaluate, (self.scan, self.criteria)

    @cached_property
    def table(self) -> Columns:
        """Numbers of all lines and false lines, SI, by name."""
        return self.core.columns()

    @cached_property
    def lines(self) -> tuple[Line, ...]:
        """Pin after pin, in the order of time; without lines that the way does not cross whole."""
        columns = {
            name: column.tolist()
            for name, column in self.table.items()
            if not name.startswith("false_line")
        }
        rows = (dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True))
        return tuple(_line(row) for row in rows)

    @cached_property
    def false_lines(self) -> tuple[FalseLine, ...]:
        """False lines, pin after pin."""
        columns = [
            self.table["false_line_pin"],
            *(self.table[f"false_line_{n}"] for n, *_ in _FALSE_LINE),
        ]
        return tuple(
            FalseLine(*row) for row in zip(*(column.tolist() for column in columns), strict=True)
        )

    def __repr__(self) -> str:
        """Return the counts of the lines in a line."""
        counts = self.counts
        lines = counts["lines.crossed"]
        shown = f"{counts['lines.shown']} of {counted(lines, 'line')} shown"
        return f"<Evaluation of {self.scan.scene.title}: {shown}, {counts['lines.false']} false>"

    @property
    def status(self) -> Status:
        """That of the scan."""
        return self.scan.status

    def plot(self, pin: int | None = None) -> mpl_figure.Figure:
        """Plot the scan and one pin, from 0, as `Scan.plot`."""
        return figure(self, "plot", pin)

    def columns(self) -> dict[str, NDArray[Any]]:
        """Each line under each pin, by the names of datasets and files; arrays of shape (n,), SI.

        `pin`, `fate`, what the finger made of its edges, `cue_on` and `cue_off`, when and where
        they passed under the spot, and the numbers of `Line.numbers`.
        """
        table = self.table
        return {
            "pin": table["pin"],
            "fate": np.array(FATES)[table["fate"]],
            "cue_on": np.array(CUES)[table["cue_on"]],
            "cue_off": np.array(CUES)[table["cue_off"]],
            **{quantity.variable: table[quantity.variable] for quantity in EDGES},
            **{quantity.variable: table[last_part(quantity)] for quantity in LINE},
        }

    def to_dataset(self) -> xr.Dataset:
        """Each line under each pin, each false line, and the counts, with units.

        Returns:
            Variables over `line`: `columns`; over `false_line`: those of `FalseLine`; a scalar for
            each number in `counts`.
        """
        from pindrive import __version__

        stated = {quantity.variable: quantity.attributes for quantity in (*EDGES, *LINE)}
        data: dict[str, Any] = {
            name: ("line", values, stated.get(name)) for name, values in self.columns().items()
        }
        data["false_line_pin"] = ("false_line", self.table["false_line_pin"])
        for name, unit, meaning in _FALSE_LINE:
            attributes = {"long_name": meaning, "units": unit}
            data[f"false_line_{name}"] = (
                "false_line",
                self.table[f"false_line_{name}"],
                attributes,
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
        return {f"lines.{name}": count for name, count in self.core.counts().items()}

    def spread(self, name: str) -> tuple[float, float, float]:
        """Least, median and largest of a number of the lines shown, SI; NaN where none has it.

        Args:
            name: Name of a number in `Line.numbers`.
        """
        return self._spreads[name.partition(".")[2]]

    @cached_property
    def _spreads(self) -> dict[str, tuple[float, float, float]]:
        return self.core.spreads()

    @property
    def _hand_numbers(self) -> dict[str, float]:
        """Numbers of the path of a hand that gave way; NaN where nothing could slow the hand."""
        hand = self.scan.hand
        return hand.numbers if hand else dict.fromkeys((q.name for q in HAND_PATH), nan)

    @property
    def numbers(self) -> dict[str, float]:
        """Numbers of a scan for studies, SI, by their names there; NaN for missing ones."""
        counts, path = self.counts, self.scan.path
        lines, duration = counts["lines.crossed"], path.end - path.begin
        on = max(self.scan.core.energised())
        coil = self.scan.device.magnet.coil
        found: dict[str, float] = {
            "lines.shown_part": counts["lines.shown"] / lines if lines else nan,
            **counts,
            "hand.duration": duration,
            **self._hand_numbers,
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
    """Compare what each pin did in a scan with the lines printed along its way.

    Args:
        scan: The scan.
        criteria: Criteria of a felt line; None: the middle of the literature.
    """
    limits = criteria or Criteria()
    found, edges, pins = _core.evaluate(scan.core, limits.numbers, MOST_EDGES)
    budgets.LINES.check(0.5 * edges, f"up to pin {pins} of {len(scan.device.array)}")
    return Evaluation(scan=scan, criteria=limits, core=found)


def _line(row: Mapping[str, Any]) -> Line:
    """Return a line from its numbers by name."""
    begin, end = (
        Edge(
            time=row[f"{end}_time"],
            x=row[f"{end}_x"],
            y=row[f"{end}_y"],
            command=row[f"{end}_command"],
            response=row[f"{end}_response"],
            lag=row[f"lag_{side}"],
            skin=row[f"skin_{side}"],
            cue=CUES[row[f"cue_{side}"]],
        )
        for end, side in (("begin", "on"), ("end", "off"))
    )
    own = ("stroke", "height", "returned", "release", "settled", "smear", "overshoot", "contrast")
    numbers = {name: row[name] for name in own}
    return Line(pin=row["pin"], begin=begin, end=end, fate=FATES[row["fate"]], **numbers)
