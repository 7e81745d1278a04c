"""The results of a motion as data: events, segments, transient, ending, energy, certificate.

All SI; NaN where a number does not exist within the duration. `pindrive.quantities.results` says
what each means.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import astuple, dataclass
from math import isnan
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

from pindrive import _core
from pindrive.quantities.status import End

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

    from pindrive import _core

Side = Literal["left", "right"]
Rows = Sequence[tuple[float, float]]
ContactNumbers = tuple[float, float, float, Rows]
CoreNumbers = tuple[
    float, float, float, ContactNumbers, ContactNumbers, Rows, Rows, float, float, float, float
]
"""In the order of `Numbers` in _core.cpp."""
ContactName = Literal["plate", "finger"]


def flattened(tree: dict[str, Any], prefix: str = "") -> list[tuple[str, float]]:
    """The numbers of nested dictionaries, with dotted names."""
    rows = []
    for name, value in tree.items():
        if isinstance(value, dict):
            rows += flattened(value, f"{prefix}{name}.")
        else:
            rows.append((prefix + name, value))
    return rows


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
    """s; infinite for a mode that lasts forever."""
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
        state_at: position (m) and velocity (m/s) at a time, used where no segment follows.
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


EndKind = Literal["moving", "resting", "decaying", "steady"]
Cycle = Literal["free", "grazing", "stick-slip", "limit cycle"]

_KIND: dict[End, EndKind] = {
    End.moving: "moving",
    End.resting: "resting",
    End.decaying: "decaying",
}
_CYCLE: dict[End, Cycle] = {
    End.free: "free",
    End.grazing: "grazing",
    End.stick_slip: "stick-slip",
    End.limit_cycle: "limit cycle",
}


@dataclass(frozen=True, slots=True)
class ContactUse:
    """What one contact did during the motion."""

    reversals: int
    """How often its sliding velocity came to zero, whether the pin then stuck or crossed."""
    time_stuck: float
    """s"""
    distance_slid: float
    """m"""
    dissipated: float
    """J"""
    peak_force: float
    """Largest friction force on the pin, N."""


@dataclass(frozen=True, slots=True)
class Transient:
    """The transient after the release; the paper's names and equations in brackets."""

    peak_displacement: float
    """First turning point on the way out, or the start (x_m,a, eq. 14), m."""
    peak_time: float
    """(t_a, eq. 13), s."""
    trough_displacement: float
    """The turning point that follows (x_m,c, eq. 16), m."""
    trough_time: float
    """(t_c, eq. 15), s; infinite when the trough is approached but never reached."""
    swing: float
    """From peak to trough (eq. 17), m."""
    return_velocity: float
    """Extreme velocity on the way back (v_m,b, eq. 20), m/s."""
    return_velocity_time: float
    """(t_b, eq. 19), s."""
    first_reversal_time: float
    """First time the pin stops sliding on the plate (t_1, eq. 21), s."""
    settling_time: float
    """The paper's time of the transitional period, s: from then on x stays within the settling band
    about x_end; for a steady oscillation, when that begins."""
    rest_time: float
    """From then on the pin stays at rest, s; infinite for a motion that never comes to rest: one
    that decays without end, or a steady oscillation."""
    last_event_time: float
    """Last change of a contact's state after the release, s: it sticks, slips or crosses; 0 without
    any, infinite where they go on forever, as in a stick-slip cycle."""
    peak_stretch: float
    """Largest stretch of a compliant finger's skin, m; NaN for a rigid one."""
    peak_stretch_rate: float
    """How fast it stretched or relaxed at the most, m/s."""
    plate: ContactUse
    finger: ContactUse

    @property
    def settled(self) -> bool:
        """Whether the motion settled within its duration."""
        return not isnan(self.settling_time)


@dataclass(frozen=True, slots=True)
class Ending:
    """How a motion ends."""

    end: End
    """Which of all endings it is; `kind` and `cycle` follow from it."""
    position: float
    """Resting place, or middle of the final oscillation, m."""
    steady_since: float
    """When a steady oscillation began, s."""
    amplitude: float
    """Of a steady oscillation, m."""
    period: float
    """Of a steady oscillation, s."""

    @property
    def kind(self) -> EndKind:
        """In which way it ends.

        `resting`: at rest forever; `steady`: an oscillation that lasts; `decaying`: a free damped
        oscillation or creep towards `position` without another event; `moving`: not known yet.
        """
        return _KIND.get(self.end, "steady")

    @property
    def cycle(self) -> Cycle | None:
        """Of a steady oscillation, which it is.

        `free` of any event, `grazing` the plate's velocity once a period, `stick-slip`, or a `limit
        cycle` that falling friction sustains without a carried phase.
        """
        return _CYCLE.get(self.end)

    @classmethod
    def of(cls, core: _core.Motion, numbers: dict[str, float]) -> Ending:
        """The ending that the core found, with the numbers measured on the segments."""
        return cls(
            End(core.end),
            numbers["end_position"],
            core.steady_since,
            numbers["amplitude"],
            core.period,
        )


@dataclass(frozen=True, slots=True)
class Ledger:
    """Where the energy came from and where it went, J.

    The damper's share is integrated, not inferred: the terms add up only if the motion is right.
    """

    kinetic_start: float
    kinetic_end: float
    spring_start: float
    spring_end: float
    skin_start: float
    """In a compliant finger."""
    skin_end: float
    plate_work: float
    """What the moving plate put in through friction."""
    inertia_work: float
    """What the housing put in by accelerating."""
    damper_dissipated: float
    plate_dissipated: float
    finger_dissipated: float
    residual: float
    """What the terms leave over: rounding alone."""


@dataclass(frozen=True, slots=True)
class Certificate:
    """The worst violation of each law over the motion, found without using the solver.

    Dimensionless: a part of the largest force, velocity, displacement or energy in the motion.
    """

    motion_law: float
    """m x'' + b x' + k x = R_plate + R_finger + m v_p'."""
    kinematics: float
    """x' and x'' are the derivatives of x."""
    friction_law: float
    """A sliding contact carries its kinetic friction."""
    force_bound: float
    """A stuck contact carries no more than its static friction."""
    sliding_sign: float
    """Friction opposes the sliding: no level was passed unseen."""
    sticking: float
    """A stuck contact does not slide."""
    continuity: float
    """x and x' do not jump."""
    transitions: float
    """A contact breaks loose or crosses only where it cannot hold."""
    energy: float
    """The ledger adds up."""
    dissipation: float
    """Friction and damper take energy, never give."""

    @property
    def worst(self) -> float:
        """The largest of all."""
        return float(max(astuple(self)))
