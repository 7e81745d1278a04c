"""How figures and tables of studies name keys and numbers: words, symbols, units."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from pindrive import template
from pindrive.captions import short
from pindrive.study.outputs import NUMBERS, SCAN_MEASURED, label
from pindrive.study.plan import variable

if TYPE_CHECKING:
    from collections.abc import Mapping

    from pindrive.quantity import Quantity

QUANTITY: Final[dict[str, Quantity]] = {
    variable(key): q for key, q in template.NUMBERS.items()
} | NUMBERS
"""Inputs and numbers by the names of their variables."""

_WORDS: Final = {
    "plate_kinetic": "plate friction",
    "plate_static": "static plate friction",
    "finger_kinetic": "finger friction",
    "finger_static": "static finger friction",
    "finger_stiffness": "skin stiffness",
    "velocity": "release velocity",
    "latency": "latency of the control block",
    "fall_time": "fall time of the pull",
    "rise_time": "rise time of the pull",
    "judged_shown_part": "part of the lines shown",
    "judged_shown": "lines shown",
    "judged_unseen": "lines unseen",
    "judged_merged": "lines merged",
    "judged_faint": "lines too faint",
    "judged_echoes": "false lines",
    "judged_unsettled": "lines not settled",
    "judged_direction": "lines with a direction",
    "judged_sure": "lines with a sure direction",
    "median_skin": "median skin motion",
    "worst_skin": "least skin motion",
    "hand_duration": "time of the hand's way",
    "magnet_on_part": "part of the time a magnet is on",
    "coil_warming": "warming of the coil",
}
_TALL: Final = re.compile(r"([A-Za-z'α-ωΑ-Ω]+)_(.+)")


def words(name: str) -> str:
    """A variable in words: "plate friction", "settling time", "median lag at a line's end"."""
    if name in SCAN_MEASURED and name.endswith(("_on", "_off")):
        name, _, edge = name.rpartition("_")
        return f"{words(name)} at a line's {'begin' if edge == 'on' else 'end'}"
    return _WORDS.get(name, label(name).replace("_", " "))


def symbol(name: str) -> str:
    r"""Its symbol for mathtext: "$F_\mathrm{p}$"; empty where it has none."""
    text = QUANTITY[name].symbol
    parts = _TALL.fullmatch(text)
    if parts is None:
        return f"${text}$" if text else ""
    if " " in text:
        return ""
    return rf"${parts[1]}_\mathrm{{{parts[2].replace('_', ' ')}}}$"


def axis_label(name: str) -> str:
    r"""What stands along an axis: "plate friction $F_\mathrm{p}$ (mN)"."""
    unit = QUANTITY[name].display_unit
    said = " ".join(filter(None, (words(name), symbol(name))))
    return f"{said} ({unit})" if unit else said


def value(name: str, number: float) -> str:
    """A value with its symbol: "$m$ = 10 g"."""
    return f"{symbol(name) or words(name)} = {short(QUANTITY[name].name, number)}"


def values(given: Mapping[str, float], width: int) -> str:
    """Values one after the other, broken into lines of about so many characters."""
    lines = [""]
    for name, number in given.items():
        said = value(name, number)
        shown = re.sub(r"[$\\{}_]|mathrm", "", f"{lines[-1]}, {said}")
        if lines[-1] and len(shown) > width:
            lines.append(said)
        else:
            lines[-1] = f"{lines[-1]}, {said}" if lines[-1] else said
    return ",\n".join(lines)
