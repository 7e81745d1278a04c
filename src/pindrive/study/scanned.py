"""The numbers that a study can keep of each scan: what became of the lines, in counts and sizes."""

from __future__ import annotations

from dataclasses import replace
from math import nan
from typing import TYPE_CHECKING, Final

from pindrive.quantities_judge import JUDGED, LINE
from pindrive.quantity import Quantity

if TYPE_CHECKING:
    from pindrive.device.verdict import Judgement

_BAD_WHEN_SMALL: Final = ("stroke", "skin_on", "skin_off", "contrast")


def _short(quantity: Quantity) -> str:
    return quantity.name.partition(".")[2]


def _median(quantity: Quantity) -> Quantity:
    meaning = f"median of the lines shown: {quantity.meaning}"
    return replace(quantity, name=f"median.{_short(quantity)}", meaning=meaning)


def _worst(quantity: Quantity) -> Quantity:
    end = "least" if _short(quantity) in _BAD_WHEN_SMALL else "largest"
    meaning = f"{end} of the lines shown: {quantity.meaning}"
    return replace(quantity, name=f"worst.{_short(quantity)}", meaning=meaning)


SCANNED: Final[tuple[Quantity, ...]] = (
    Quantity("judged.shown_part", "r_1", "1", "part of the lines that was shown"),
    *JUDGED,
    *(_median(quantity) for quantity in LINE),
    *(_worst(quantity) for quantity in LINE),
    Quantity("hand.duration", "T_h", "s", "how long the hand moves and pauses"),
    Quantity("magnet.on_part", "D_on", "1", "part of that time that a magnet is on, the largest"),
    Quantity("coil.warming", "ΔT_on", "K", "by how much its coil warms, where one is described"),
)
"""Medians and worst values are of the lines that have the number: one that does not settle has no
smear, and is counted as unsettled."""
COUNTED: Final = tuple(quantity.name for quantity in JUDGED)


def scan_numbers(judgement: Judgement) -> dict[str, float]:
    """The numbers of one scan, SI, by their names; NaN where one does not exist."""
    counts, path = judgement.counts, judgement.scan.path
    lines, duration = counts["judged.lines"], path.end - path.begin
    on = max(sum(end - begin for begin, end in pin.energised) for pin in judgement.scan.pins)
    coil = judgement.scan.device.magnet.coil
    found: dict[str, float] = {
        "judged.shown_part": counts["judged.shown"] / lines if lines else nan,
        **counts,
        "hand.duration": duration,
        "magnet.on_part": on / duration,
        "coil.warming": coil.thermal_resistance * coil.power * on / duration if coil else nan,
    }
    for quantity in LINE:
        name = _short(quantity)
        least, median, largest = judgement.spread(quantity.name)
        found[f"median.{name}"] = median
        found[f"worst.{name}"] = least if name in _BAD_WHEN_SMALL else largest
    return found
