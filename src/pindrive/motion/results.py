"""The results of a motion as data: events, segments, transient, ending, energy, certificate.

All SI; NaN where a number does not exist within the duration. `pindrive.quantities.results` says
what each means.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import astuple, dataclass, fields
from math import isnan
from operator import itemgetter
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pindrive.quantities.status import End
from pindrive.quantities.value import concise, equal_by_value

ContactName = Literal["plate", "finger", "stop"]


Cause = Literal["plate", "finger", "both", "stop"]
EventKind = Literal["stick", "slip", "reverse", "stop", "leave"]
ModeName = Literal["slip", "carried", "resting"]
QuantityName = Literal["position", "velocity", "acceleration"]
Table = dict[str, "NDArray[Any]"]
"""The core's columns, one row a segment."""

# In the order of `Kind` and `Slide` in model.hpp.
_KINDS: tuple[EventKind, ...] = ("stick", "slip", "reverse")
_EACH: tuple[Cause, ...] = ("plate", "finger")
_BOTH: tuple[Cause, ...] = ("both",)
_AT_STOP: tuple[EventKind, ...] = ("stop", "leave", "stop")
"""Likewise: it is met, left, or met for an instant."""
_SLIDING = {-1: -1, 0: 0, 1: 1, 2: None, 3: 0, 4: 2}


@concise
@dataclass(frozen=True, slots=True)
class Event:
    """A change of mode."""

    time: float
    """s"""
    contact: Cause
    """Contact of the event; `both` if plate and finger change alike at one velocity; `stop`: an end
    stop."""
    kind: EventKind
    """`stick`: sliding stopped and the contact holds; `slip`: it begins to slide; `reverse`: the
    sliding velocity changes sign; at a `stop`: the pin meets it, `stop`, or leaves it, `leave`."""
    position: float
    """m"""
    velocity: float
    """m/s"""


@concise
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
    """Sign of the sliding velocity, 0 while stuck, 2 while the plate slides across too, None for a
    frictionless contact."""
    finger: int | None
    """Friction of the finger, N; 0 also while compliant skin sticks."""


class Extrema(NamedTuple):
    """Extrema of a quantity of a motion, in order."""

    time: NDArray[np.float64]
    """s, shape (n,), not decreasing: the two sides of a jump have one time."""
    value: NDArray[np.float64]
    """m, m/s or m/s², shape (n,)."""


class Crossings(NamedTuple):
    """Crossings of a level by a quantity of a motion, in order."""

    time: NDArray[np.float64]
    """s, shape (n,)."""
    direction: NDArray[np.int8]
    """1 where the quantity rises, -1 where it falls, in turn; shape (n,)."""


def events_of(table: Table, state_at: Callable[[float], tuple[float, float]]) -> tuple[Event, ...]:
    """Every change at a contact, in order, the plate's first.

    Args:
        table: The core's segments.
        state_at: Position (m) and velocity (m/s) at a time, used where no segment follows.
    """
    rows = {name: column.tolist() for name, column in table.items()}
    events = []
    for i, kinds in enumerate(
        zip(*(rows[f"{name}_event"] for name in ("plate", "finger", "stop")), strict=True)
    ):
        if not any(kinds):
            continue
        end = rows["end"][i]
        follows = i + 1 < len(rows["end"])
        state = (rows["position"][i + 1], rows["velocity"][i + 1]) if follows else state_at(end)
        events += events_at(end, kinds, state)
    return tuple(events)


def events_at(time: float, kinds: tuple[int, int, int], state: tuple[float, float]) -> list[Event]:
    """Return the events at the end of a segment, the plate's first.

    Args:
        time: s.
        kinds: Kinds of the events at plate, finger and stop, as in the table of the core.
        state: Position (m) and velocity (m/s) then.
    """
    *friction, stop = kinds
    causes = _BOTH if friction[0] == friction[1] else _EACH
    found = [
        Event(time, contact, _KINDS[kind - 1], *state)
        for contact, kind in zip(causes, friction, strict=False)
        if kind
    ]
    return [*found, Event(time, "stop", _AT_STOP[stop - 1], *state)] if stop else found


def segments_of(table: Table) -> tuple[Segment, ...]:
    """The modes in order."""
    columns = ("begin", "end", "plate", "finger", "stop", "velocity", "acceleration")
    rows = zip(*(table[name].tolist() for name in columns), strict=True)
    return tuple(
        Segment(
            begin,
            end,
            _mode(plate, finger, stop, velocity == acceleration == 0.0),
            _SLIDING[plate],
            _SLIDING[finger],
        )
        for begin, end, plate, finger, stop, velocity, acceleration in rows
    )


def _mode(plate: int, finger: int, stop: int, still: bool) -> ModeName:
    if stop and still:
        return "resting"
    if 0 not in (plate, finger):
        return "slip"
    return "resting" if still or finger == 0 else "carried"


EndKind = Literal[
    "moving", "resting", "decaying", "drifting", "steady", "irregular", "growing", "approaching"
]
Cycle = Literal["free", "grazing", "stick-slip", "limit cycle", "driven"]

_KIND: dict[End, EndKind] = {
    End.moving: "moving",
    End.resting: "resting",
    End.decaying: "decaying",
    End.drifting: "drifting",
    End.irregular: "irregular",
    End.growing: "growing",
    End.approaching: "approaching",
}
_CYCLE: dict[End, Cycle] = {
    End.free: "free",
    End.grazing: "grazing",
    End.stick_slip: "stick-slip",
    End.limit_cycle: "limit cycle",
    End.driven: "driven",
}


@equal_by_value
@concise
@dataclass(frozen=True, slots=True)
class ContactUse:
    """Use of one contact in the transient, SI; the peak force is that of the whole motion.

    `pindrive.quantities.QUANTITIES` says what each is, under "transient.plate." and its name.
    """

    reversals: int
    time_stuck: float
    distance_slid: float
    dissipated: float
    peak_force: float


@equal_by_value
@concise
@dataclass(frozen=True, slots=True)
class Afterwards:
    """Use of one contact after the transient, in one period of a steady motion, SI.

    `pindrive.quantities.QUANTITIES` has the meanings, under "ending.plate." and the name. The power
    also exists where the plate slides under a pin at rest; other numbers are NaN then.
    """

    reversals: float
    time_stuck: float
    distance_slid: float
    dissipated: float
    power: float


@equal_by_value
@concise
@dataclass(frozen=True, slots=True)
class Transient:
    """The transient after the release, SI.

    `pindrive.quantities.QUANTITIES` says what each is, under "transient." and its name, with the
    paper's symbol and equation. `trough_time` is infinite where the trough is approached but never
    reached; the settling time of a steady oscillation is when that begins.
    """

    peak_displacement: float
    peak_time: float
    trough_displacement: float
    trough_time: float
    swing: float
    return_velocity: float
    return_velocity_time: float
    first_reversal_time: float
    settling_time: float
    rest_time: float
    last_event_time: float
    peak_stretch: float
    peak_stretch_rate: float
    end_time: float
    plate: ContactUse
    finger: ContactUse

    @property
    def settled(self) -> bool:
        """True if the motion settled within its duration."""
        return not isnan(self.settling_time)


@equal_by_value
@concise
@dataclass(frozen=True, slots=True)
class Ending:
    """Ending of a motion."""

    end: End
    """Kind of the ending; `kind` and `cycle` follow from it."""
    position: float
    """Resting place, centre of the final oscillation, or position of a drift's line at t = 0, m."""
    steady_since: float
    """Time from which the motion is steady, s."""
    amplitude: float
    """Half of the range of a steady or irregular motion, m."""
    period: float
    """Period of a steady motion, mean time of a round of an irregular motion, s."""
    least_amplitude: float
    """Half of the range of the smallest round, m."""
    peak_velocity: float
    """Largest speed of a steady or irregular motion, m/s."""
    rounds: float
    """Rounds about the centre in one period of a steady motion."""
    decay_energy: float
    """Energy that a final decay has left to dissipate, J."""
    drift_velocity: float
    """Velocity of the line that a drifting pin follows, m/s."""
    lag: float
    """Distance of a drifting pin behind the position at which the spring balances the inputs, m.

    NaN under a load that grows, as the distance then grows too."""
    growth: float
    """Factor in one period: of the range of a growing motion, of the distance from the limit that a
    motion approaches."""
    plate: Afterwards
    finger: Afterwards

    @property
    def kind(self) -> EndKind:
        """In which way it ends.

        `resting`: at rest forever; `steady`: an oscillation that lasts; `decaying`: a free damped
        oscillation or creep towards `position` without another event; `drifting`: under inputs
        that grow for ever it follows the line `position + drift_velocity * t` without another
        event, where `settling_time` is about that line; `irregular`: chaotic or
        quasi-periodic, without a return within 15 360 events or 5700 periods of the inputs;
        `growing`: its range grew from period to period, by the factor `growth` in the last ones,
        and no ending was found; `approaching`: it tends to a limit, from which the distance shrinks
        by the factor `growth` in a period, so that the motion would take more than 200 000 periods;
        `moving`: not known yet.
        """
        return _KIND.get(self.end, "steady")

    @property
    def cycle(self) -> Cycle | None:
        """Kind of a steady oscillation.

        `free` of any event, `grazing` the plate's velocity once a period, `stick-slip`, a `limit
        cycle` that falling friction sustains without a carried phase, or `driven` by inputs that
        repeat, once in one or several of their periods.
        """
        return _CYCLE.get(self.end)


def _reader(cls: type, table: str) -> Callable[[Mapping[str, float]], tuple[Any, ...]]:
    """Return a function that takes the numbers of a dataclass, in order, from the core's numbers.

    Fields that are dataclasses themselves come last, and are left out.
    """
    own = [field.name for field in fields(cls) if field.name not in ("end", "plate", "finger")]
    return itemgetter(*(f"{table}.{name}" for name in own))


_TRANSIENT = _reader(Transient, "transient")
_ENDING = _reader(Ending, "ending")
_USES = [_reader(ContactUse, f"transient.{contact}") for contact in _EACH]
_AFTERWARDS = [_reader(Afterwards, f"ending.{contact}") for contact in _EACH]


def transient_of(numbers: Mapping[str, float]) -> Transient:
    """Return the transient by the core's numbers."""
    return Transient(*_TRANSIENT(numbers), *(ContactUse(*read(numbers)) for read in _USES))


def ending_of(end: End, numbers: Mapping[str, float]) -> Ending:
    """Return the ending by its kind and the core's numbers."""
    each = (Afterwards(*read(numbers)) for read in _AFTERWARDS)
    return Ending(end, *_ENDING(numbers), *each)


@equal_by_value
@concise
@dataclass(frozen=True, slots=True)
class Ledger:
    """Energy ledger: sources and sinks, J.

    The damper's share is integrated, not inferred: the terms add up only if the motion is right.
    `pindrive.quantities.QUANTITIES` says what each is, under "energy." and its name.
    """

    kinetic_start: float
    kinetic_end: float
    spring_start: float
    spring_end: float
    skin_start: float
    skin_end: float
    stop_start: float
    stop_end: float
    plate_work: float
    inertia_work: float
    force_work: float
    damper_dissipated: float
    plate_dissipated: float
    finger_dissipated: float
    stop_dissipated: float
    skin_dissipated: float
    residual: float


@equal_by_value
@concise
@dataclass(frozen=True, slots=True)
class Certificate:
    """The worst violation of each law over the motion, found without using the solver.

    Dimensionless: a part of the largest force, velocity, displacement or energy in the motion.
    `pindrive.quantities.QUANTITIES` names the laws, under "certificate." and their names.
    """

    motion_law: float
    kinematics: float
    friction_law: float
    force_bound: float
    sliding_sign: float
    sticking: float
    continuity: float
    transitions: float
    energy: float
    dissipation: float
    period: float
    steady_since: float

    @property
    def worst(self) -> float:
        """The largest of all."""
        return float(max(astuple(self)))
