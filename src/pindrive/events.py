"""What happened in a motion: its events and its segments, from the core's table of segments."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

Cause = Literal["plate", "finger", "both"]
EventKind = Literal["stick", "slip", "cross"]
ModeName = Literal["slip", "carried", "resting"]
QuantityName = Literal["position", "velocity", "acceleration"]
Table = dict[str, "NDArray[Any]"]
"""The core's columns, one row a segment."""

# In the order of `Kind` and `Slide` in model.hpp.
_KINDS: tuple[EventKind, ...] = ("stick", "slip", "cross")
_EACH: tuple[Cause, ...] = ("plate", "finger")
_BOTH: tuple[Cause, ...] = ("both",)
_SLIDING = {-1: -1, 0: 0, 1: 1, 2: None, 3: 0}


@dataclass(frozen=True, slots=True)
class Event:
    """A change of mode."""

    time: float
    """s"""
    contact: Cause
    """Where; `both` when plate and finger, at one velocity, do the same."""
    kind: EventKind
    """`stick`: sliding stopped and the contact holds; `slip`: it breaks loose; `cross`: sliding
    reversed without sticking."""
    position: float
    """m"""
    velocity: float
    """m/s"""


@dataclass(frozen=True, slots=True)
class Segment:
    """A stretch of time in one mode, where the motion is one closed form."""

    begin: float
    """s"""
    end: float
    """s; infinite for a mode that lasts for ever."""
    mode: ModeName
    """`slip`; `carried` (stuck to the moving plate); `resting` (stuck to what does not move)."""
    plate: int | None
    """Sign of the sliding velocity, 0 while stuck, None for a frictionless contact."""
    finger: int | None
    """The same; 0 also while compliant skin grips."""


class Extrema(NamedTuple):
    """Extrema of a quantity of a motion, in order."""

    time: NDArray[np.float64]
    """s, shape (n,), not decreasing: the two sides of a jump have one time."""
    value: NDArray[np.float64]
    """m, m/s or m/s², shape (n,)."""


class Crossings(NamedTuple):
    """Where a quantity of a motion crosses a level, in order."""

    time: NDArray[np.float64]
    """s, shape (n,)."""
    direction: NDArray[np.int8]
    """1 where the quantity rises, -1 where it falls, in turn; shape (n,)."""


def events_of(table: Table, state_at: Callable[[float], tuple[float, float]]) -> tuple[Event, ...]:
    """Every change at a contact, in order, the plate's first.

    Args:
        table: the core's segments.
        state_at: position (m) and velocity (m/s) at a time, asked for where no segment follows.
    """
    rows = {name: column.tolist() for name, column in table.items()}
    events = []
    for i, kinds in enumerate(zip(rows["plate_event"], rows["finger_event"], strict=True)):
        if not any(kinds):
            continue
        end = rows["end"][i]
        follows = i + 1 < len(rows["end"])
        state = (rows["position"][i + 1], rows["velocity"][i + 1]) if follows else state_at(end)
        events += events_at(end, kinds, state)
    return tuple(events)


def events_at(time: float, kinds: tuple[int, int], state: tuple[float, float]) -> list[Event]:
    """What happens at the end of a segment, the plate's first.

    Args:
        time: s.
        kinds: of the events at plate and finger, as in the core's table.
        state: position (m) and velocity (m/s) then.
    """
    causes = _BOTH if kinds[0] == kinds[1] else _EACH
    return [
        Event(time, contact, _KINDS[kind - 1], *state)
        for contact, kind in zip(causes, kinds, strict=False)
        if kind
    ]


def segments_of(table: Table) -> tuple[Segment, ...]:
    """The modes in order."""
    columns = ("begin", "end", "plate", "finger", "velocity", "acceleration")
    rows = zip(*(table[name].tolist() for name in columns), strict=True)
    return tuple(
        Segment(
            begin,
            end,
            _mode(plate, finger, velocity == acceleration == 0.0),
            _SLIDING[plate],
            _SLIDING[finger],
        )
        for begin, end, plate, finger, velocity, acceleration in rows
    )


def _mode(plate: int, finger: int, still: bool) -> ModeName:
    if 0 not in (plate, finger):
        return "slip"
    return "resting" if still or finger == 0 else "carried"
