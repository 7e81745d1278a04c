"""What is demanded of a motion or a scan: "settling_time <= 60 ms"."""

from __future__ import annotations

import re
from dataclasses import dataclass
from math import inf
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from pindrive.quantities import refusal
from pindrive.study.outputs import NUMBERS, OUTPUTS, is_measured, known_output, label
from pindrive.units import UnitError, quoted, to_si

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

_CONDITION: Final = re.compile(r"\s*(<=|>=|≤|≥)\s*(.+)")
LARGEST: Final = 1e100
"""Of a limit: so that squares of what is beyond it are numbers."""
_AT_MOST: Final = ("<=", "≤")


@dataclass(frozen=True, slots=True)
class Demand:
    """A limit on one number: at most, or at least, `limit` (SI)."""

    name: str
    at_most: bool
    limit: float

    def met(self, values: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Which values meet it; a number that does not exist never does."""
        return values <= self.limit if self.at_most else values >= self.limit

    def excess(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """How far beyond the limit, SI: negative within it, infinite for what does not exist."""
        beyond = values - self.limit if self.at_most else self.limit - values
        return np.where(np.isnan(values), inf, beyond)

    def text(self) -> str:
        """As a person reads it: "settling_time ≤ 60.00 ms"."""
        return f"{label(self.name)} {'≤' if self.at_most else '≥'} {self.shown()}"

    def shown(self) -> str:
        """The limit in the unit a person reads it in."""
        quantity = NUMBERS[self.name]
        return f"{quantity.display_scale * self.limit:.6g} {quantity.display_unit}".rstrip()


def demands(
    table: Any, file: str, problems: list[str], among: Sequence[str] = OUTPUTS
) -> tuple[Demand, ...]:
    """The demands of a [specification] on outputs; what is wrong is appended to `problems`."""
    found = []
    for given, conditions in table.items():
        try:
            name = known_output(given, f"{file}: specification", among)
            if not is_measured(name):
                raise ValueError(f"{file}: specification.{given} is no number to be demanded")
        except ValueError as error:
            problems.append(str(error))
            continue
        for condition in conditions if isinstance(conditions, list) else [conditions]:
            try:
                found.append(_demand(name, condition, f"specification.{given}", file))
            except ValueError as error:
                problems.append(str(error))
    return tuple(found)


def _demand(name: str, condition: object, where: str, file: str) -> Demand:
    quantity = NUMBERS[name]
    example = f'"<= 60 {quantity.display_unit}"'.replace(' "', '"')
    match = _CONDITION.fullmatch(condition) if isinstance(condition, str) else None
    if not match:
        raise ValueError(
            refusal(where, f"a limit with <= or >=, like {example}", quoted(condition), file)
        )
    try:
        limit = to_si(match[2], quantity.unit or "1", f"60 {quantity.display_unit}".rstrip())
    except UnitError as error:
        raise ValueError(refusal(where, f"a limit: {error}", quoted(condition), file)) from None
    if not abs(limit) <= LARGEST:
        required = f"a finite limit, of at most {LARGEST:g} in size"
        raise ValueError(refusal(where, required, quoted(condition), file))
    return Demand(name, match[1] in _AT_MOST, limit)
