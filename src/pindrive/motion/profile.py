"""An input that changes over time, as rows between which it is linear. SI units."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import pairwise
from math import isnan
from typing import TYPE_CHECKING, Any, Final, overload

from pindrive.quantities.drive import DRIVE_QUANTITIES, PARTS
from pindrive.quantities.part import Part
from pindrive.quantities.refusal import quoted, refusal
from pindrive.quantities.rows import check_slopes, check_times
from pindrive.quantities.units import UnitError, to_si
from pindrive.quantities.value import concise

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

_TABLE: Final = Part((*DRIVE_QUANTITIES, *PARTS))


@concise
@dataclass(frozen=True, slots=True, init=False)
class Profile:
    """A quantity over time: linear between its rows, constant before the first and after the last.

    Two rows at one time are a step: from that time on the later one holds. A load may have steps, a
    velocity may not.

    Args:
        times: s, or text with a unit, from -1e12 to 1e12, none less than the one before, no three
            alike; at least one.
        values: Values, one for each time, SI, or text with a unit, such as "60 mm/s", from -1e12 to
            1e12, as is the rate between two rows.

    Attributes:
        unit: The SI unit of values that were text, empty where none was: `Release` refuses those of
            another quantity.

    Raises:
        ValueError: Lengths differ, times decrease, a number or a rate is out of range, or a text is
            in no unit of a quantity that may change over time.
    """

    times: tuple[float, ...]
    values: tuple[float, ...]
    unit: str = field(compare=False, repr=False)

    def __init__(self, times: Iterable[float | str], values: Iterable[float | str]) -> None:
        """Validate, and keep tuples of plain floats."""
        unit, numbers = in_si(_listed(values), "values")
        t = _column(_listed(times), "profile.time", "times")
        y = _column(numbers, "profile.value", "values")
        if not t:
            raise ValueError(refusal("times", "at least one", "none"))
        if len(t) != len(y):
            raise ValueError(refusal("values", f"as many as times, {len(t)}", len(y)))
        check_times(t, label="times[{}]")
        check_slopes(list(zip(t, y, strict=True)), _TABLE.rows["profile.rate"], label="profile")
        object.__setattr__(self, "times", t)
        object.__setattr__(self, "values", y)
        object.__setattr__(self, "unit", unit)

    @property
    def changes(self) -> bool:
        """True if the profile takes more than one value."""
        return any(value != self.values[0] for value in self.values)

    @property
    def steps(self) -> tuple[float, ...]:
        """The times at which its value jumps, s."""
        return tuple(t for (t, y), (after, z) in pairwise(self.rows) if t == after and y != z)

    @property
    def rows(self) -> tuple[tuple[float, float], ...]:
        """Its rows (time, value), SI."""
        return tuple(zip(self.times, self.values, strict=True))

    @overload
    def __call__(self, t: float) -> float: ...
    @overload
    def __call__(self, t: ArrayLike) -> NDArray[np.float64]: ...
    def __call__(self, t: ArrayLike) -> float | NDArray[np.float64]:
        """Return the value at time t (s): a float for a float, else an array of equal shape.

        At a step it is the value after it.
        """
        if not isinstance(t, (float, int)):
            import numpy as np

            return np.interp(np.asarray(t, dtype=np.float64), self.times, self.values)
        i = bisect_right(self.times, t)
        if i == 0 or i == len(self.times):
            return self.values[max(i - 1, 0)]
        (t0, t1), (y0, y1) = self.times[i - 1 : i + 1], self.values[i - 1 : i + 1]
        return y0 + (y1 - y0) * ((t - t0) / (t1 - t0))


def _listed(values: Iterable[float | str]) -> list[Any]:
    try:
        return values.tolist() if hasattr(values, "tolist") else list(values)
    except TypeError:
        raise ValueError(refusal("a profile", "sequences of numbers", repr(values))) from None


def in_si(values: list[Any], label: str) -> tuple[str, list[Any]]:
    """Return the SI unit of texts among values, empty for numbers alone, and all values in SI."""
    if str not in set(map(type, values)):
        return "", values
    over_time = [quantity for quantity in _TABLE.rows.values() if quantity.rows_of == "profile"]
    # A prescribed motion of a system of bodies may be positions.
    usual_of = {q.unit: q.usual for q in reversed(over_time)} | {"m": "1 mm"}
    units = [*dict.fromkeys(quantity.unit for quantity in over_time), "m"]
    for unit in units:
        with suppress(UnitError):
            return unit, [to_si(y, unit, "") if isinstance(y, str) else y for y in values]
    usual = " or all like ".join(quoted(usual_of[unit]) for unit in units)
    texts = ", ".join(quoted(y) for y in values if isinstance(y, str))
    raise ValueError(refusal(label, f"numbers in SI, or text all like {usual}", texts))


def _column(values: list[Any], name: str, label: str) -> tuple[float, ...]:
    """Numbers of the quantity called `name`, each checked; plain finite floats all at once."""
    bounds = _TABLE.rows[name].limits
    plain = set(map(type, values)) == {float} and not any(map(isnan, values))
    if plain and min(values) in bounds and max(values) in bounds:
        return tuple(values)
    return tuple(_TABLE.check(name, y, label=f"{label}[{i}]") for i, y in enumerate(values))


def check_continuous(name: str, velocity: Profile) -> None:
    """Refuse a velocity of the hand with a step: it would take an infinite force."""
    for t in velocity.steps:
        i = bisect_right(velocity.times, t)
        y, z = velocity.values[i - 2 : i]
        required = "without a step (a jump would take an infinite force)"
        given = f"one from {y!r} m/s to {z!r} m/s at {t!r} s"
        raise ValueError(refusal(name, required, given))
