"""Exact derivatives of a motion with respect to its parameters, and where they do not exist."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from functools import cached_property, partial
from itertools import pairwise
from math import inf, isfinite, nan, sqrt
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

import pindrive
from pindrive import _core
from pindrive.lazy import mpl_figure, xr
from pindrive.motion.core_numbers import (
    PLACES,
    ROWS,
    CoreNumbers,
    Input,
    Place,
    Rows,
    entry,
    mapped,
    replaced,
)
from pindrive.motion.drive import Contact, Drive
from pindrive.motion.friction import (
    COEFFICIENTS,
    PRESSED_BY,
    PRESSING,
    normal_force,
    normal_force_by,
)
from pindrive.motion.function import Function, rates_of
from pindrive.quantities.drive import COLUMNS
from pindrive.quantities.quantity import counted
from pindrive.quantities.refusal import refusal
from pindrive.quantities.results import SERIES
from pindrive.quantities.status import Side, Status
from pindrive.quantities.table import QUANTITIES
from pindrive.views import NotebookHtml, figure

__all__ = ["Sensitivity"]

_STEP = 2.0**-26
"""Relative distance of the neighbours that show if a derivative exists."""
_KINK = 1e-3
"""A number whose change to a neighbour is off its derivative by this part jumps or bends there."""

Direction = Callable[["pindrive.Motion", str], tuple[CoreNumbers, float]]
"""Derivative of the numbers of a motion by a parameter, and the size of the parameter."""

_PLACES: dict[str, Place] = {name.replace(".", "_"): place for name, place in PLACES.items()}
_COEFFICIENTS = (
    *(
        f"{table}_{COEFFICIENTS[part]}"
        for table in PRESSED_BY
        for part in ("kinetic", "static", "breakaway", "viscous")
    ),
    *PRESSING,
)
"""Parameters that the core knows by the forces that follow from them."""
_INPUTS = tuple(name for name in ROWS if name in PLACES)
_ROW = re.compile(
    r"(?:(plate_curve|finger_curve)\[(\d+)\]\.(speed|force)"
    r"|(mouse_velocity|plate_load|force|across_velocity|finger_load)\[(\d+)\]\.(time|value))"
)


class Sensitivity(NotebookHtml):
    """Derivatives of a motion, SI units of the quantity per SI unit of the parameter.

    Attributes:
        parameters: Names of the parameters, in the order of the first axis of every array.
        gaps: Time and reason for each parameter whose smallest change gives the motion other
            events; derivatives after that time do not exist and are NaN.
    """

    def __init__(
        self,
        motion: pindrive.Motion,
        parameters: Sequence[str],
        direction: Direction | None = None,
    ) -> None:
        if isinstance(parameters, str) or not parameters:
            raise ValueError(refusal("parameters", "a list of names", repr(parameters)))
        self._motion = motion
        self.parameters = tuple(parameters)
        of = direction or direction_of
        self._derivatives = tuple(_Derivative(motion, given, of) for given in parameters)
        self.gaps = {d.name: d.gap for d in self._derivatives if d.gap}

    def __repr__(self) -> str:
        """The parameters, in a line."""
        return f"<Sensitivity to {', '.join(self.parameters)}, {self.status.name}>"

    @property
    def status(self) -> Status:
        """`incomplete` where a derivative does not exist; `gaps` says which and why."""
        return Status.incomplete if self.gaps else Status.ok

    @property
    def duration(self) -> float:
        """That of the motion, s."""
        return self._motion.duration

    @property
    def sizes(self) -> tuple[float, ...]:
        """Size of each parameter, SI; of a zero parameter, the size of comparable ones."""
        return tuple(derivative.size for derivative in self._derivatives)

    def plot(self) -> mpl_figure.Figure:
        """Plot the change of the pin's position with each parameter, over time."""
        return figure(self, "plot")

    def to_dataset(self, times: ArrayLike | None = None) -> xr.Dataset:
        """All derivatives with their units.

        Args:
            times: s, shape (n,); 1001 even ones unless given.

        Returns:
            `position` and `velocity` over (parameter, time), `event_time` over (parameter, event),
            and each number over `parameter`, SI units of the quantity, over those of the parameter
            in the coordinate `parameter_unit`; NaN where a derivative does not exist.
        """
        t = np.linspace(0.0, self.duration, 1001) if times is None else np.asarray(times, float)
        data: dict[str, Any] = {
            name: (("parameter", "time"), values, {"units": SERIES[name].unit})
            for name, values in (("position", self.position(t)), ("velocity", self.velocity(t)))
        }
        data["event_time"] = (("parameter", "event"), self.event_times, {"units": "s"})
        for name, slopes in self.numbers.items():
            quantity = QUANTITIES[name]
            attributes = {"units": quantity.unit, "long_name": f"derivative: {quantity.meaning}"}
            data[name.replace(".", "_")] = ("parameter", [*slopes.values()], attributes)
        coords = {
            "parameter": [*self.parameters],
            "parameter_unit": ("parameter", [_unit(name) for name in self.parameters]),
            "time": ("time", t, {"units": "s"}),
        }
        return xr.Dataset(data, coords=coords, attrs={"status": self.status.name})

    def position(self, t: ArrayLike, side: Side = "right") -> NDArray[np.float64]:
        """∂x/∂p at fixed times t (s), shape (parameters, *t.shape)."""
        self._motion.position(t, side)  # refuses what the motion would
        return self._evaluate("position", t, side)

    def velocity(self, t: ArrayLike, side: Side = "right") -> NDArray[np.float64]:
        """∂x'/∂p at fixed times t (s), shape (parameters, *t.shape)."""
        self._motion.velocity(t, side)
        return self._evaluate("velocity", t, side)

    def stretch(self, t: ArrayLike, side: Side = "right") -> NDArray[np.float64]:
        """The derivative of the skin's stretch at fixed times t (s), (parameters, *t.shape)."""
        self._motion.stretch(t, side)
        return self._evaluate("stretch", t, side)

    def _evaluate(self, quantity: str, t: ArrayLike, side: Side) -> NDArray[np.float64]:
        times = np.asarray(t, dtype=np.float64)
        flat = np.ascontiguousarray(times).ravel()
        rows = []
        for d in self._derivatives:
            values = getattr(d.core, quantity)(flat, side == "right")
            rows.append(np.where(flat < d.course_until, values, nan))
        return np.array(rows).reshape(len(rows), *times.shape)

    @cached_property
    def event_times(self) -> NDArray[np.float64]:
        """∂t/∂p of the events of the motion, shape (parameters, events)."""
        table = _core.simulate(*self._motion.core_numbers).segments()
        plate, finger = table["plate_event"], table["finger_event"]
        # Events as in `Motion.events`: two equal events at one instant are one.
        count = np.where(plate == finger, plate != 0, (plate != 0) + (finger != 0).astype(int))
        count = count + (table["stop_event"] != 0)
        return np.array(
            [
                np.repeat(
                    np.where(table["end"] < d.course_until, d.core.segments()["end"], nan), count
                )
                for d in self._derivatives
            ]
        )

    @cached_property
    def numbers(self) -> dict[str, dict[str, float]]:
        """The derivative of every number of `Motion.numbers()`: by its name, then by parameter."""
        each = {d.name: d.numbers() for d in self._derivatives}
        names = next(iter(each.values()))
        return {name: {p: values[name] for p, values in each.items()} for name in names}


class _Derivative:
    """The derivative of a motion along one parameter, and how far it exists.

    A derivative exists while the motions of two close neighbours, in plain numbers, have the
    same events. If their events differ, the motion is at the border between two kinds.
    """

    def __init__(self, motion: pindrive.Motion, name: str, direction: Direction) -> None:
        numbers, hand = motion.core_numbers, motion.release.mouse_velocity
        along, size = direction(motion, name)
        self.name, self.size = name, size
        self._motion = motion
        self._own = _core.simulate(*numbers)
        self.core = _core.differentiate(numbers, along)
        self._neighbours: list[tuple[float, _core.Motion]] = []
        self.course_until, self._same_ending, self.gap = inf, True, ""
        for step in (_STEP * size, -_STEP * size):
            there = mapped(lambda x, d, h=step: x + h * d if d else x, numbers, along)
            if motion.release.velocity is None and isinstance(hand, Function):
                there = replaced(there, (8,), _core.function_at(there[5], np.zeros(1))[0])
            if _in_range(there):
                self._compare(step, _core.simulate(*there))

    def _compare(self, step: float, neighbour: _core.Motion) -> None:
        self._neighbours.append((step, neighbour))
        parting = _parting(self._own, neighbour)
        self.course_until = min(self.course_until, parting)
        way = f"for a value {'greater' if step > 0 else 'smaller'} by {abs(step):.1e}"
        if parting <= self._motion.duration:
            self.gap = f"from {self.course_until:.6g} s on: other events {way}"
        elif self._own.end != neighbour.end:
            self._same_ending = False
            self.gap = self.gap or f"in numbers of the ending: another ending {way}"

    def numbers(self) -> dict[str, float]:
        """The derivatives of the numbers, NaN where one does not exist."""
        duration = self._motion.duration
        band = self._motion.settling_band
        at, slopes = _numbers(self._own, duration, band), _numbers(self.core, duration, band)
        around = [(step, _numbers(core, duration, band)) for step, core in self._neighbours]

        def exists(name: str) -> bool:
            known = at.get(_KNOWN_AT.get(name, ""), duration)
            ends = name.startswith("ending.") or name in _OF_THE_ENDING
            if not (isfinite(at[name]) and known < self.course_until):
                return False
            if ends and not self._same_ending:
                return False
            # The neighbours' numbers lie where the derivative says that they do.
            size = max(abs(slopes[name]), abs(at[name] / self.size))
            changes = [(numbers[name] - at[name]) / step for step, numbers in around]
            return all(abs(change - slopes[name]) <= _KINK * size for change in changes)

        return {name: slope if exists(name) else nan for name, slope in slopes.items()}


def _parting(one: _core.Motion, other: _core.Motion) -> float:
    """From when on two motions go through other modes and events, s; infinite if they never do."""
    a, b = _modes(one), _modes(other)
    common = min(len(a["end"]), len(b["end"]))

    def first(edge: str, *names: str) -> float:
        differ = np.any([a[name][:common] != b[name][:common] for name in names], axis=0)
        # One of two cycles may have been recognised a period later.
        if edge == "end" and one.cycle_begin == other.cycle_begin == 0.0:
            differ[-1] |= len(a["end"]) != len(b["end"])
        at = np.flatnonzero(differ)
        return float(min(a[edge][at[0]], b[edge][at[0]])) if at.size else inf

    return min(first("begin", *_MODE), first("end", *_EVENTS))


_MODE = ("plate", "finger", "plate_branch", "finger_branch", "stop")
_EVENTS = ("plate_event", "finger_event", "stop_event")


def _modes(core: _core.Motion) -> dict[str, NDArray[Any]]:
    """Modes and events of a motion; segments of one mode without an event between them are one."""
    table = core.segments()
    mode, event = (np.stack([table[name] for name in names]) for names in (_MODE, _EVENTS))
    changes = (mode[:, 1:] != mode[:, :-1]).any(axis=0) | (event[:, :-1] != 0).any(axis=0)
    first = np.flatnonzero(np.append(True, changes))
    last = np.append(first[1:], len(table["end"])) - 1
    return {name: table[name][first] for name in ("begin", *_MODE)} | {
        name: table[name][last] for name in ("end", *_EVENTS)
    }


_OF_THE_ENDING = ("transient.settling_time", "transient.rest_time", "transient.last_event_time")

_KNOWN_AT = {
    f"transient.{name}": f"transient.{time}"
    for name, time in {
        "peak_displacement": "peak_time",
        "peak_time": "peak_time",
        "trough_displacement": "trough_time",
        "trough_time": "trough_time",
        "swing": "trough_time",
        "return_velocity": "trough_time",
        "return_velocity_time": "trough_time",
        "first_reversal_time": "first_reversal_time",
    }.items()
}
"""Time from which a number no longer depends on the motion; of all other numbers, its duration."""


def _numbers(
    core: _core.Motion | _core.Derivative, duration: float, band: float
) -> dict[str, float]:
    """The numbers of a motion over a fixed duration, by their names in `Motion.numbers()`."""
    energy: dict[str, float] = core.ledger(duration)
    del energy["residual"]  # nothing but rounding
    return core.transient(duration, band) | {f"energy.{name}": n for name, n in energy.items()}


# ---- parameters ----------------------------------------------------------------------------------


def direction_of(motion: pindrive.Motion, given: str) -> tuple[CoreNumbers, float]:
    """Return the derivative of the core's numbers by a parameter, and the size of the parameter.

    By a key of a device file the derivative includes what follows from that key: the damping,
    where a ratio gives it.
    """
    numbers, drive = motion.core_numbers, motion.drive
    table, _, own = given.partition(".")
    if given == "drive.damping_ratio":
        critical = 2.0 * sqrt(drive.mass * drive.stiffness)
        along = replaced(mapped(lambda _: 0.0, numbers), PLACES["damping"], critical)
        return along, drive.damping_ratio or 1.0
    if table in ("drive", "motion") and own:
        along, size = direction_of(motion, own)
        if drive.by_ratio and own in ("mass", "stiffness"):
            follows = 0.5 * drive.damping / getattr(drive, own)
            along = replaced(along, PLACES["damping"], follows)
        return along, size
    if (name := key_as_name(given)) in _COEFFICIENTS:
        return _along_friction(motion, name)
    if along := _along_function(motion, name):
        return along
    places = _places(numbers, given)
    size = max(abs(entry(numbers, place)) for place in places) or _natural_size(motion, places[0])
    for contact, (kinetic, static, _, curve, law, *_) in ((3, numbers[3]), (4, numbers[4])):
        first_row = [(contact, 3, 0, 1)] if curve else []
        if law[1]:  # friction at rest is another number
            if (contact, 4, 1) in places and static == law[1]:
                places = [*places, (contact, 1)]
            continue
        if not {(contact, 0), *first_row}.isdisjoint(places):
            # One number of the user: kinetic friction, the curve's force at rest, and
            # static friction that is not greater.
            tied = [(contact, 1)] if static == kinetic else []
            places = [(contact, 0), *first_row, *tied]
    along = mapped(lambda _: 0.0, numbers)
    for place, slope in (dict.fromkeys(places, 1.0) | _friction_slopes(motion.drive, name)).items():
        along = replaced(along, place, slope)
    if motion.release.velocity is None:
        along = replaced(
            along, (8,), _start_slope(_rows_of(numbers[5]), _rows_of(along[5])) + along[8]
        )
    return along, size


def _along_function(motion: pindrive.Motion, given: str) -> tuple[CoreNumbers, float] | None:
    """Return the derivative by a parameter of a function, as `mouse_velocity.amplitude`."""
    name, _, parameter = given.partition(".")
    function = getattr(motion.release, name, None) if name in _INPUTS else None
    if not isinstance(function, Function) or not parameter:
        return None
    if parameter not in function.parameters:
        known = ", ".join(f"{name}.{part}" for part in function.parameters) or "none of a sum"
        raise ValueError(refusal("parameter", f"one of {known}", repr(given)))
    rates, at_begin = rates_of(function, parameter)
    along = replaced(mapped(lambda _: 0.0, motion.core_numbers), PLACES[name], rates)
    if name == "mouse_velocity" and motion.release.velocity is None:
        along = replaced(along, (8,), at_begin)
    return along, abs(function.parameters[parameter]) or function.size or 1.0


def _along_friction(motion: pindrive.Motion, name: str) -> tuple[CoreNumbers, float]:
    """Return the derivative by a coefficient, or by the normal force on a coefficient."""
    slopes = _friction_slopes(motion.drive, name)
    if name == "load_exponent":
        slopes[PLACES[name]] = 1.0
    table, _, part = name.partition("_")
    owner = getattr(motion.drive, table) if part in COEFFICIENTS.values() else motion.drive
    value = getattr(owner, name if owner is motion.drive else part)
    if not slopes or value is None:
        raise ValueError(refusal("parameter", "one that this motion was given", repr(name)))
    along = mapped(lambda _: 0.0, motion.core_numbers)
    for place, slope in slopes.items():
        along = replaced(along, place, slope)
    largest = max(map(abs, slopes.values())) or 1.0
    return along, abs(value) or _natural_size(motion, next(iter(slopes))) / largest


def _friction_slopes(drive: Drive, name: str) -> dict[Place, float]:
    """Return the derivative of friction forces given by coefficients: (μ N)' = μ' N + μ N'."""
    found: dict[Place, float] = {}
    value = partial(getattr, drive)
    for i, table in ((3, "plate"), (4, "finger")):
        contact = getattr(drive, table)
        if contact.coefficient is None:
            continue
        own_static, rows = contact.static_coefficient, contact.coefficient_curve or ()
        at_rest = own_static
        if at_rest is None:
            at_rest = contact.breakaway_coefficient or contact.coefficient
        pressed = normal_force_by(table, name, value) if name in PRESSED_BY[table] else 0.0
        if pressed:
            found[i, 0], found[i, 1] = contact.coefficient * pressed, at_rest * pressed
            found |= {(i, 3, j, 1): each * pressed for j, (_, each) in enumerate(rows)}
            found |= {place: each * pressed for place, each in _law_coefficients(contact, i)}
        force = normal_force(table, value)
        if name == f"{table}_coefficient":
            tied = [(i, 1)] if at_rest == contact.coefficient and not contact.falls else []
            found |= dict.fromkeys([(i, 0), *([(i, 3, 0, 1)] if rows else []), *tied], force)
        elif name == f"{table}_static_coefficient":
            found[i, 1] = force
        elif name == f"{table}_breakaway_coefficient":
            tied = [(i, 1)] if own_static is None else []
            found |= dict.fromkeys([(i, 4, 1), *tied], force)
        elif name == f"{table}_viscous_coefficient":
            found[i, 4, 4] = force
    return found


def _law_coefficients(contact: Contact, i: int) -> list[tuple[Place, float]]:
    """The coefficients of a contact's law with the places of their forces."""
    coefficients = ((1, contact.breakaway_coefficient), (4, contact.viscous_coefficient))
    return [((i, 4, j), each) for j, each in coefficients if each is not None]


_PRESSING = {QUANTITIES[name].key: name for name in PRESSING}
"""Names of the forces that press on a contact, by their keys."""


def key_as_name(given: str) -> str:
    """A device file's key as the name of a parameter."""
    return _PRESSING.get(given) or re.sub(r"^(plate|finger)\.", r"\1_", given)


def _unit(given: str) -> str:
    """The SI unit of a parameter."""
    name = re.sub(r"^(plate|finger)_", r"\1.", given)
    table, _, column = name.partition("[")
    if not column:
        keys = (name, given, given.rpartition(".")[2])
        return next(QUANTITIES[key].unit for key in keys if key in QUANTITIES)
    part = column.partition("].")[2]
    across = QUANTITIES[COLUMNS[QUANTITIES[table].rows_of][0]]
    return across.unit if across.name.endswith(part) else QUANTITIES[table].unit


def _places(numbers: CoreNumbers, given: str) -> list[Place]:
    """Return the places of the numbers of a parameter."""
    name = key_as_name(given)
    if row := _ROW.fullmatch(name):
        table, index, column = (group for group in row.groups() if group)
        rows = entry(numbers, ROWS[table])
        if int(index) >= len(rows):
            one = f"one of {counted(len(rows), 'row')} of {table}"
            raise ValueError(refusal("parameter", one, name))
        place = (*ROWS[table], int(index), int(column in ("force", "value")))
        if column != "time":
            return [place]
        # The time of a step is that of both its rows.
        time = rows[int(index)][0]
        return [(*ROWS[table], i, 0) for i, (t, _) in enumerate(rows) if t == time]
    if name not in _PLACES:
        names = ", ".join(dict.fromkeys((*_PLACES, *_COEFFICIENTS)))
        known = f"one of {names}, or a row like mouse_velocity[0].value"
        raise ValueError(refusal("parameter", known, repr(given)))
    place = _PLACES[name]
    if place[1:] in ((4, 1), (4, 2)) and not entry(numbers, (place[0], 4, 0)):
        raise ValueError(refusal("parameter", "one that this motion was given", repr(given)))
    if name in ROWS:
        return [(*place, i, 1) for i in range(len(entry(numbers, place)))]
    if not isfinite(entry(numbers, place)):
        raise ValueError(refusal("parameter", "one that this motion was given", repr(given)))
    return [place]


def _start_slope(rows: Rows, along: Rows) -> float:
    """Return the derivative of the plate's velocity at t = 0 in a direction of its breakpoints."""
    times, values = np.transpose(rows)
    d_times, d_values = np.transpose(along)
    i = int(np.searchsorted(times, 0.0, side="right"))
    slope = (values[i] - values[i - 1]) / (times[i] - times[i - 1]) if 0 < i < len(rows) else 0.0
    return float(np.interp(0.0, times, d_values - slope * d_times))


def _natural_size(motion: pindrive.Motion, place: Place) -> float:
    """A size, in this motion, for a parameter that is zero."""
    drive, omega = motion.drive, motion.drive.natural_frequency
    at_first = motion.core_numbers[7:9]
    speeds = (abs(v) for _, v in _rows_of(motion.core_numbers[5]))
    displacement, velocity = map(abs, at_first)
    length = max(displacement, max(velocity, *speeds) / omega) or 1e-3
    match place:
        case (0 | 1 | 2,) | (13, 2) | (3 | 4, 4, 4):
            return drive.mass * omega
        case (5 | 11, _, 1) | (8,) | (3 | 4, 3, _, 0) | (3 | 4, 4, 2):
            return length * omega
        case (6 | 12, _, 1):
            return 1.0
        case (5 | 6 | 10 | 11 | 12, _, 0):
            return 1.0 / omega
        case (7 | 9,) | (13, 0):
            return length
    return length * drive.stiffness


def _rows_of(given: Input) -> Rows:
    """The rows of an input; of a function, its begins with the values there."""
    return [
        (row[0], row[1]) if len(row) == 2 else (row[0], row[1][0] + sum(t[0] for t in row[2]))
        for row in given
    ]


def _in_range(numbers: CoreNumbers) -> bool:
    """Return True if the core can compute a motion; damping may be negative there."""

    def increase(rows: Rows) -> bool:
        return all(a[0] < b[0] for a, b in pairwise(rows))

    mass, stiffness, _, plate, finger, *_ = numbers
    *_, stretch, _, _, _, stops, _, _ = numbers
    mouse_velocity, plate_load, force, across, finger_load = (
        _rows_of(entry(numbers, (i,))) for i in (5, 6, 10, 11, 12)
    )
    contacts = all(
        static >= kinetic >= 0.0
        and give > 0.0
        and increase(curve)
        and all(f >= 0 for _, f in curve)
        and (not law[1] or static >= law[1] >= kinetic)
        and law[2] > 0.0
        and law[4] >= 0.0
        and damping >= 0.0
        for kinetic, static, give, curve, law, damping, _ in (plate, finger)
    )
    return (
        mass > 0.0
        and stiffness > 0.0
        and stops[0] > 0.0
        and stops[1] > 0.0
        and stops[2] >= 0.0
        and contacts
        and increase(mouse_velocity)
        and increase(across)
        and all(
            a[0] <= b[0] for rows in (plate_load, force, finger_load) for a, b in pairwise(rows)
        )
        and all(load >= 0.0 for _, load in (*plate_load, *finger_load))
        and not abs(stretch) * finger[2] > finger[1] * finger_load[0][1]
    )
