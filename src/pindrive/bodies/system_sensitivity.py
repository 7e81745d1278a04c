"""Exact derivatives of a motion of several bodies by its parameters, and where they end."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, nan
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pindrive import _core
from pindrive.bodies.core_numbers import PLACES, stop_ends
from pindrive.bodies.inputs import integrated
from pindrive.bodies.parts import TABLES, Body
from pindrive.bodies.system import System
from pindrive.bodies.system_motion import SystemMotion
from pindrive.motion.core_numbers import entry, mapped, replaced
from pindrive.motion.function import rates_of
from pindrive.motion.profile import Profile
from pindrive.quantities.refusal import refusal
from pindrive.quantities.status import Side, Status

_STEP: Final = 2.0**-26
"""Relative distance of the neighbours that show if a derivative exists."""


class SystemSensitivity:
    """Derivatives of a motion, SI units of the quantity per SI unit of the parameter.

    Attributes:
        parameters: Keys of the parameters, in the order of the first axis of every array.
        gaps: Time and reason for each parameter whose smallest change gives the motion other
            events; derivatives after that time do not exist and are NaN.
    """

    def __init__(self, motion: SystemMotion, parameters: Sequence[str]) -> None:
        if isinstance(parameters, str) or not parameters:
            raise ValueError(refusal("parameters", "a list of names", repr(parameters)))
        self._motion = motion
        self.parameters = tuple(motion.system.key_of(given) for given in parameters)
        self.gaps: dict[str, str] = {}
        self._until: list[float] = []
        self._cores: list[Any] = []
        for key in self.parameters:
            along = direction_of(motion.system, motion.core_numbers, key)
            numbers, duration = motion.core_numbers, motion.core.end
            self._cores.append(_core.differentiate_system(numbers, along, duration))
            size = abs(motion.system.inputs()[key]) or 1.0
            until = inf
            for step in (_STEP * size, -_STEP * size):
                there = mapped(
                    lambda x, d, h=step: x + h * d if d and isinstance(x, float) else x,
                    numbers,
                    along,
                )
                parting = self._parting(_core.simulate_system(there, duration))
                if parting < until:
                    way = "greater" if step > 0 else "smaller"
                    words = f"other events for a value {way} by {abs(step):.1e}"
                    self.gaps[key] = f"from {parting:.6g} s on: {words}"
                    until = parting
            self._until.append(until)

    def __repr__(self) -> str:
        """Return the parameters in a line."""
        return f"<SystemSensitivity to {', '.join(self.parameters)}, {self.status.name}>"

    @property
    def status(self) -> Status:
        """`incomplete` where a derivative does not exist; `gaps` says which and why."""
        return Status.incomplete if self.gaps else Status.ok

    def position(self, body: str | Body, t: ArrayLike, side: Side = "right") -> NDArray[np.float64]:
        """Derivative of a position at fixed times t (s), shape ``(parameters, *t.shape)``."""
        return self._of(0, body, t, side)

    def velocity(self, body: str | Body, t: ArrayLike, side: Side = "right") -> NDArray[np.float64]:
        """Derivative of a velocity at fixed times t (s), shape ``(parameters, *t.shape)``."""
        return self._of(1, body, t, side)

    @property
    def event_times(self) -> NDArray[np.float64]:
        """Derivative of the time of each event, shape (parameters, events)."""
        times = np.array([event.time for event in self._motion.events])
        rows = [
            np.where(times < until, core.changes()["time"], nan)
            for core, until in zip(self._cores, self._until, strict=True)
        ]
        return np.array(rows).reshape(len(rows), len(times))

    def _of(self, quantity: int, body: str | Body, t: ArrayLike, side: Side) -> NDArray[np.float64]:
        times = self._motion.known(t, side)
        flat = np.ascontiguousarray(times.ravel())
        names = [*self._motion.system.bodies]
        place = names.index(self._motion[body].name)
        rows = []
        for core, until in zip(self._cores, self._until, strict=True):
            moving, *_ = core.at(flat, side == "right")
            found = moving.reshape(3, len(names), len(flat))[quantity, place]
            rows.append(np.where(flat < until, found, nan))
        return np.array(rows).reshape(len(rows), *times.shape)

    def _parting(self, neighbour: Any) -> float:
        """Time from which another motion has other events, s; infinite if all events agree."""
        begin, contacts = np.zeros(1), len(self._motion.system.contacts)
        slips = [core.at(begin, True)[1][3 * contacts :] for core in (self._motion.core, neighbour)]
        if (slips[0] != slips[1]).any():
            return 0.0
        one, other = self._motion.core.changes(), neighbour.changes()
        common = min(len(one["time"]), len(other["time"]))
        differ = np.zeros(common, bool)
        for column in ("contact", "before", "after"):
            differ |= one[column][:common] != other[column][:common]
        at = np.flatnonzero(differ)
        if at.size:
            return float(min(one["time"][at[0]], other["time"][at[0]]))
        longer = max(one["time"], other["time"], key=len)
        return float(longer[common]) if len(longer) > common else inf


def direction_of(system: System, numbers: Any, key: str) -> Any:
    """Return the derivative of the numbers of the core by a parameter.

    Args:
        system: System of the parameter.
        numbers: The system as the core has it.
        key: Key of the parameter.

    Raises:
        ValueError: The parameter is of an input that is a sum of two that change over time.
    """
    kind, name, part, *parameter = key.split(".")
    if kind == "stop":
        return _along_stop(system, numbers, name, part)
    if part == "period":
        raise ValueError(refusal("parameter", "one with a derivative, not a period", key))
    table = [*TABLES].index(kind)
    entries: dict[str, Any] = getattr(system, TABLES[kind])
    row = [*entries].index(name)
    along = mapped(lambda x: x if isinstance(x, int) else 0.0, numbers)
    column = "length" if part == "motion" else part
    places = [(table, row, PLACES[kind].index(column))]
    given = entries[name]
    if kind == "contact" and part == "kinetic" and given.kinetic == given.static:
        places.append((table, row, PLACES[kind].index("static")))
    for place in places:
        at = entry(numbers, place)
        if isinstance(at, float):
            along = replaced(along, place, 1.0)
        elif parameter:
            along = replaced(along, place, _along_function(given, part, parameter[0], key))
        else:
            along = replaced(along, place, _along_constant(at))
    return along


def _along_stop(system: System, numbers: Any, name: str, part: str) -> Any:
    """Return the derivative by a value of a stop, which each of its ends has."""
    along = mapped(lambda x: x if isinstance(x, int) else 0.0, numbers)
    for row, (of, _, _, side) in enumerate(stop_ends(system)):
        end = {"lower": -1, "upper": 1}.get(part)
        if of == name and end in (None, side):
            column = 2 if end else PLACES["stop"].index(part)
            along = replaced(along, (3, row, column), 1.0)
    return along


def _along_constant(at: Any) -> Any:
    """Return the derivative of an input by a constant that is added to it."""
    if len(at[0]) == 2:
        return [(0.0, 1.0) for _ in at]
    return [
        (0.0, (1.0, *(0.0 for _ in polynomial[1:])), [(0.0,) * 4 for _ in terms])
        for _, polynomial, terms in at
    ]


def _along_function(given: Any, part: str, parameter: str, key: str) -> Any:
    """Return the derivative of the pieces of a function by a parameter of that function."""
    if part in ("length", "motion"):
        other = given.motion if part == "length" else given.length
        if other is not None and not isinstance(other, float):
            required = "one of a spring of which only length or motion changes over time"
            raise ValueError(refusal("parameter", required, key))
        if isinstance(other, Profile):
            raise ValueError(refusal("parameter", "one of a Function alone", key))
    function = getattr(given, part)
    rates, _ = rates_of(function, parameter)
    if part in ("motion", "reference") and integrated(function) is not function:
        return _core.function_integral_along(function.core, rates)
    return rates
