"""The checks of rows (place, value): in order, and with slopes in range."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import islice, pairwise
from math import copysign, inf
from operator import lt

from pindrive.quantities.quantity import Quantity
from pindrive.quantities.refusal import refusal


def check_increasing(
    values: Sequence[float],
    unit: str,
    *,
    where: str = "",
    label: str | Callable[[int], str] = "[{}]",
    why: str = "",
) -> None:
    """Refuse values of which one is not greater than the one before; `label` is of its index."""
    if all(map(lt, values, islice(values, 1, None))):
        return
    named = label.format if isinstance(label, str) else label
    for i in range(1, len(values)):
        if not values[i - 1] < values[i]:
            required = f"greater than the one before, {values[i - 1]!r} {unit}{why}"
            raise ValueError(refusal(named(i), required, f"{values[i]!r} {unit}", where))


def slopes_of(rows: Sequence[tuple[float, float]]) -> list[float]:
    """The slopes between rows but for steps; infinite where the quotient overflows."""
    return [
        (y1 - y0) / (x1 - x0) if x1 - x0 > abs(y1 - y0) * 1e-300 else copysign(inf, y1 - y0)
        for (x0, y0), (x1, y1) in pairwise(rows)
        if x1 > x0
    ]


def check_slopes(
    rows: Sequence[tuple[float, float]], slope: Quantity, *, where: str = "", label: str
) -> None:
    """Refuse rows of which two lie so close that the slope between them is out of its limits."""
    bounds = slope.limits
    slopes = slopes_of(rows)
    if all(bounds.lower <= slope <= bounds.upper for slope in slopes):
        return
    worst = max(slopes, key=abs)
    shown = f"{worst:g} {slope.unit}"
    raise ValueError(refusal(f"{label} slope", bounds.words(slope.unit), shown, where))


def check_times(
    times: Sequence[float],
    *,
    where: str = "",
    label: str | Callable[[int], str] = "[{}]",
    steps: bool = True,
    why: str = "",
) -> None:
    """Reject times (s) out of order; with `steps` a time may occur twice, never three times.

    `label` is of the index of the one that is wrong, `why` says why there may be no step.
    """
    if not steps:
        check_increasing(times, "s", where=where, label=label, why=why)
        return
    named = label.format if isinstance(label, str) else label
    for i in range(1, len(times)):
        before, given = f"the one before, {times[i - 1]!r} s", f"{times[i]!r} s"
        if not times[i - 1] <= times[i]:
            raise ValueError(refusal(named(i), f"at least {before}", given, where))
        if i > 1 and times[i - 2] == times[i]:
            required = f"greater than {before}: two rows at one time are a step, a third is none"
            raise ValueError(refusal(named(i), required, given, where))
