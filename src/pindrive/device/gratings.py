"""Groups of lines of a grating: "4 mm", "12 x 4 mm" (twelve lines), "4 mm over 60 mm"."""

from __future__ import annotations

import re
from typing import Final, NamedTuple

from pindrive.quantities.refusal import check_whole, quoted, refusal
from pindrive.quantities.table import QUANTITIES, check
from pindrive.quantities.units import UnitError, to_si

USUAL: Final = 4
"""Lines of a group without a number of its own."""
_COUNTED: Final = re.compile(r"\s*(\S+)\s+[x×]\s+(.*)")
_LONG: Final = re.compile(r"(.*?)\s+over\s+(.*)")
_WHOLE: Final = 1e-9
"""Part of a pitch that a length may lack to hold another line."""


class LineGroup(NamedTuple):
    """Lines of equal pitch, each half as wide.

    Attributes:
        pitch: Distance between the begins of neighbours, m.
        number: Number of lines, at least 1.
    """

    pitch: float
    number: int

    @property
    def words(self) -> str:
        """Notation of the group: "12 x 4 mm"."""
        pitch = f"{1e3 * self.pitch:.12g} mm"
        return pitch if self.number == USUAL else f"{self.number} x {pitch}"


def line_group(given: object, label: str, where: str = "") -> LineGroup:
    """Read a group of lines.

    Args:
        given: A pitch (m, or text with a unit), a `LineGroup` or a pair of pitch and count, or text
            such as "12 x 4 mm" or "4 mm over 60 mm", as many lines as a length holds.
        label: Name of the value in messages.
        where: Place of the value in messages.

    Raises:
        ValueError: A length or a count is malformed or out of its range.
    """
    if isinstance(given, tuple):
        pitch, count = given
        return LineGroup(
            check("pitch", pitch, label=label, where=where), check_whole(count, "count")
        )
    if not isinstance(given, str):
        pitch = check("pitch", given, label=label, where=where)  # type: ignore[arg-type]
        return LineGroup(pitch, USUAL)
    if counted := _COUNTED.fullmatch(given):
        return LineGroup(_length(counted[2], label, where), _count(counted[1], where))
    if long := _LONG.fullmatch(given):
        pitch = _length(long[1], label, where)
        return LineGroup(pitch, max(1, int(_length(long[2], "length", where) / pitch + _WHOLE)))
    return LineGroup(_length(given, label, where), USUAL)


def _length(text: str, label: str, where: str) -> float:
    try:
        value = to_si(text, QUANTITIES["pitch"].unit, "4 mm")
    except UnitError as error:
        raise ValueError(refusal(label, str(error), quoted(text), where)) from None
    return check("pitch", value, where=where, label=label, given=quoted(text))


def _count(text: str, where: str) -> int:
    if not text.isdecimal() or int(text) < 1:
        required = 'a whole number of lines, like "12 x 4 mm"'
        raise ValueError(refusal("count", required, quoted(text), where))
    return int(text)
