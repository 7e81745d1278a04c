"""The motion of a system of several bodies: its bodies, contacts and springs at any time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from math import inf
from os import PathLike
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pindrive import _core
from pindrive.bodies.core_numbers import stop_ends
from pindrive.bodies.ending import ENDINGS, SystemEnding, ending_of, numbers_of_ending
from pindrive.bodies.motion_parts import (
    BodyMotion,
    ContactMotion,
    FeedbackMotion,
    SpringMotion,
    StopMotion,
)
from pindrive.bodies.parts import Body, ContactPair, Feedback, Spring, Stop
from pindrive.bodies.system import System
from pindrive.lazy import mpl_figure, xr
from pindrive.quantities.names import Names
from pindrive.quantities.quantity import counted
from pindrive.quantities.refusal import refusal
from pindrive.quantities.status import Side, Status
from pindrive.quantities.table import default
from pindrive.quantities.value import concise
from pindrive.views import NotebookHtml, csv_file, figure

Kind = Literal["stick", "slip", "reverse", "stop", "leave"]


@concise
@dataclass(frozen=True, slots=True)
class SystemEvent:
    """A change at a contact or a stop.

    Attributes:
        time: s.
        contact: Name of the contact or the stop.
        kind: `stick`: sliding stopped and the contact holds; `slip`: it begins to slide; `reverse`:
            the sliding velocity changes sign. At a stop `stop`: the bodies meet it; `leave`: it
            ceases to push.
        before: Direction of slip before: -1, 1, or 0 in stick. Of a stop 0 where it pushes, -1 or 1
            at its lower or upper end where it does not.
        after: Direction of slip after, likewise; at an impact, after which the bodies part at once,
            that before.
    """

    time: float
    contact: str
    kind: Kind
    before: int
    after: int


@concise
@dataclass(frozen=True, slots=True)
class SystemLedger:
    """Energy over a motion, J: `after` - `before` = `inputs` - `dampers` - `contacts` - `stops`.

    Attributes:
        before: Energy of motion and of springs at t = 0.
        after: Energy of motion and of springs at the end.
        inputs: Work of forces, feedbacks, prescribed motions and moving surfaces.
        dampers: Loss in the dampers beside springs.
        contacts: Loss in contacts, with the energy that their skin holds at the end.
        stops: Loss at impacts and in elastic stops, with the energy that these hold at the end.
    """

    before: float
    after: float
    inputs: float
    dampers: float
    contacts: float
    stops: float

    @property
    def residual(self) -> float:
        """Difference of both sides, J: rounding alone."""
        lost = self.dampers + self.contacts + self.stops
        return self.after - self.before - self.inputs + lost


@concise
@dataclass(frozen=True, slots=True)
class SystemCertificate:
    """Largest violation of each law, found without the solver, relative to the largest quantity.

    Attributes:
        motion: Mass times acceleration against the sum of the forces, over the largest force.
        kinematics: Velocities against the rates of positions and stretches, over the largest speed.
        friction: Friction in slip against kinetic friction, and in stick beyond static friction.
        sliding: Sliding against the direction of slip, and in stick, over the largest speed.
        stops: Bodies beyond a rigid stop, a stop that pulls, and impacts against Newton's law.
        continuity: Jumps of positions, and of velocities without an impact.
        energy: Balance of the energy, over all that was exchanged.
    """

    motion: float
    kinematics: float
    friction: float
    sliding: float
    stops: float
    continuity: float
    energy: float

    @property
    def worst(self) -> float:
        """The largest of all."""
        return max(
            *(self.motion, self.kinematics, self.friction),
            *(self.sliding, self.stops, self.continuity, self.energy),
        )


class SystemMotion(NotebookHtml):
    """Exact motion of a system of several bodies, made by `System.simulate`.

    `motion["pin"]` is the motion of a body, `motion.contact("pin", "hand")` that of a contact.

    Attributes:
        system: The system that was simulated.
        duration: s.
    """

    def __init__(self, system: System, numbers: Any, core: Any, duration: float) -> None:
        self.system = system
        self.core_numbers = numbers
        self.core = core
        self.duration = duration

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle the system, which is simulated again."""
        return _simulated, (self.system, self.duration)

    def __repr__(self) -> str:
        """Return bodies, events and status in a line."""
        bodies = counted(len(self.system.bodies), "body", "bodies")
        kind = self.ending.kind
        rest = "" if kind == "unknown" else f", {ENDINGS[kind]}"
        return (
            f"<SystemMotion of {bodies} over {self.duration:.6g} s, "
            f"{counted(len(self.events), 'event')}{rest}, {self.status.name}>"
        )

    def __getitem__(self, body: str | Body) -> BodyMotion:
        """Return the motion of a body.

        Raises:
            ValueError: The body is unknown.
        """
        name = body.name if isinstance(body, Body) else body
        return BodyMotion(self, _found("body", name, self.system.bodies))

    def contact(
        self, name: str | Body | ContactPair, other: str | Body | None = None
    ) -> ContactMotion:
        """Return a contact under way.

        Args:
            name: The contact or its name, or its first body.
            other: Second body, or "ground"; None: `name` is that of the contact.

        Raises:
            ValueError: The contact is unknown, or there are several between both bodies.
        """
        contacts = self.system.contacts
        return ContactMotion(self, _between("contact", name, other, contacts))

    def spring(self, name: str | Body | Spring, other: str | Body | None = None) -> SpringMotion:
        """Return a spring under way; arguments and errors as for `contact`."""
        return SpringMotion(self, _between("spring", name, other, self.system.springs))

    def stop(self, name: str | Body | Stop, other: str | Body | None = None) -> StopMotion:
        """Return a stop under way; arguments and errors as for `contact`."""
        return StopMotion(self, _between("stop", name, other, self.system.stops))

    def feedback(
        self, name: str | Body | Feedback, other: str | Body | None = None
    ) -> FeedbackMotion:
        """Return a feedback under way; arguments and errors as for `contact`."""
        return FeedbackMotion(self, _between("feedback", name, other, self.system.feedbacks))

    @property
    def status(self) -> Status:
        """Complete, or the reason for its end (`Status.explanation`)."""
        return Status(self.core.status)

    @property
    def rests(self) -> bool:
        """True if rigid contacts hold all bodies at the end and no input changes any more."""
        return bool(self.core.rests)

    @cached_property
    def ending(self) -> SystemEnding:
        """How the motion ends: at rest, settled, periodic, drifting, or unknown."""
        return ending_of(self)

    @cached_property
    def events(self) -> tuple[SystemEvent, ...]:
        """Changes at contacts, in order."""
        names = [*self.system.contacts]
        ends = [*stop_ends(self.system)]
        table = self.core.changes()
        rows = zip(*(table[column].tolist() for column in table), strict=True)
        found = []
        for time, place, before, after in rows:
            j = int(place) - len(names)
            if j < 0:
                kind = _kind(before, after)
                found.append(SystemEvent(time, names[int(place)], kind, int(before), int(after)))
                continue
            name, _, _, side = ends[j]
            kind = "stop" if after == 0 or before == after else "leave"
            if before == 0 or after == 0 or before == after:
                was, now = (0 if slip == 0 else side for slip in (before, after))
                found.append(SystemEvent(time, name, kind, was, now))
        return tuple(found)

    @cached_property
    def shared(self) -> tuple[str, ...]:
        """Contacts whose friction is not unique at times, by name.

        Rigid contacts and stops that hold, and close a loop, determine only sums of their forces;
        each contact then has a part in proportion to its static friction.
        """
        system = self.system
        ends = [f"stop {i}" for i, _ in enumerate(stop_ends(system))]
        rigid = {name: c.between for name, c in system.contacts.items() if c.stiffness == inf}
        rigid |= {
            end: stop.between
            for end, (_, stop, _, _) in zip(ends, stop_ends(system), strict=True)
            if stop.stiffness == inf
        }
        names = [*system.contacts, *ends]
        table = self.core.changes()
        _, touching, pushing = self.core.at(np.zeros(1), True)
        slips = dict(
            zip(system.contacts, touching[3 * len(system.contacts) :].tolist(), strict=True)
        )
        slips |= {end: float(push <= 0.0) for end, push in zip(ends, pushing, strict=False)}
        found: set[str] = set()
        seen: set[frozenset[str]] = set()
        places = [-1, *map(int, table["contact"])]
        for place, after in zip(places, [0.0, *table["after"].tolist()], strict=True):
            if place >= 0:
                slips[names[place]] = after
            holding = frozenset(name for name in rigid if slips[name] == 0.0)
            if holding not in seen:
                seen.add(holding)
                found |= _in_loops({name: rigid[name] for name in holding})
        return tuple(name for name in system.contacts if name in found)

    @cached_property
    def _certified(self) -> dict[str, dict[str, float]]:
        found: dict[str, dict[str, float]] = _core.certify_system(self.core_numbers, self.duration)
        return found

    def certificate(self) -> SystemCertificate:
        """The worst residual of each law, computed from inputs and polynomials alone."""
        return SystemCertificate(**self._certified["laws"])

    @property
    def energy(self) -> SystemLedger:
        """Energy of the motion, and where it went."""
        return SystemLedger(**self._certified["energy"])

    # ---- over time -------------------------------------------------------------------------------

    def known(self, t: ArrayLike, side: Side = "right") -> NDArray[np.float64]:
        """Times at which the motion is known, s.

        Raises:
            ValueError: A time is not a number, or out of [0, duration].
        """
        if side not in ("left", "right"):
            raise ValueError(refusal("side", '"left" or "right"', repr(side)))
        try:
            times = np.asarray(t, dtype=np.float64)
        except (TypeError, ValueError):
            raise ValueError(refusal("t", "numbers, in seconds", repr(t))) from None
        good = (times >= 0.0) & (times <= self.core.end)
        if not good.all():
            required = f"from 0 s to {self.core.end!r} s"
            raise ValueError(refusal("t", required, f"{float(times[~good].flat[0])!r} s"))
        return times

    def state_at(
        self, t: NDArray[np.float64], side: Side = "right"
    ) -> tuple[NDArray[np.float64], ...]:
        """Return all quantities at times.

        Args:
            t: s, shape (n,).
            side: Side of an event on which the limit is taken.

        Returns:
            Position, velocity and acceleration of the bodies, shape (3, bodies, n); friction force,
            stretch, sliding speed and slip of the contacts, shape (4, contacts, n); forces of the
            stops and of the feedbacks on the first bodies, shapes (stops, n) and (feedbacks, n).
        """
        moving, touching, pushing = self.core.at(np.ascontiguousarray(t), side == "right")
        counts = len(self.system.bodies), len(self.system.contacts)
        names = [*self.system.stops]
        force = np.zeros((len(names), len(t)))
        forces = pushing.reshape(-1, len(t))
        ends = [*stop_ends(self.system)]
        for (name, _, _, way), push in zip(ends, forces, strict=False):
            force[names.index(name)] -= way * push
        return (
            moving.reshape(3, counts[0], len(t)),
            touching.reshape(4, counts[1], len(t)),
            force,
            forces[len(ends) :],
        )

    def sample_times(self, count: int = 1001) -> NDArray[np.float64]:
        """`count` even times over [0, duration] and the events among them, s, shape (n,)."""
        if not count >= 2:
            raise ValueError(refusal("count", "at least 2", repr(count)))
        events = [event.time for event in self.events]
        return np.union1d(np.linspace(0.0, self.core.end, count), events)

    def numbers(self) -> dict[str, float]:
        """Numbers of the motion, SI, by name: of each body, its energy, and the events.

        "body.pin.end" is the position at the end, `least` and `largest` are those in between,
        `end_velocity` is the velocity at the end, and `drift` the mean one of the ending.
        """
        found: dict[str, float] = {}
        moving, *_ = self.state_at(np.array([self.core.end]), "left")
        for i, name in enumerate(self.system.bodies):
            least, largest = self.core.range(i)
            found |= {
                f"body.{name}.end": float(moving[0, i, 0]),
                f"body.{name}.end_velocity": float(moving[1, i, 0]),
                f"body.{name}.least": least,
                f"body.{name}.largest": largest,
            }
        of_contact = len(self.system.contacts)
        places = self.core.changes()["contact"]
        for i, name in enumerate(self.system.contacts):
            found[f"contact.{name}.events"] = float(np.count_nonzero(places == i))
        ends = [name for name, *_ in stop_ends(self.system)]
        for name in self.system.stops:
            own = [of_contact + i for i, end in enumerate(ends) if end == name]
            found[f"stop.{name}.events"] = float(np.count_nonzero(np.isin(places, own)))
        energy = self._certified["energy"]
        return (
            found
            | numbers_of_ending(self.ending)
            | {f"energy.{name}": value for name, value in energy.items()}
        )

    def sensitivity(self, parameters: Sequence[str]) -> Any:
        """Exact derivatives of the motion by some parameters of the system.

        Args:
            parameters: Names among `System.parameters`, as "body.pin.mass" or "pin.mass".

        Returns:
            Derivatives of positions, velocities and event times, NaN where one does not exist.

        Raises:
            ValueError: A parameter is unknown.
        """
        from pindrive.bodies.system_sensitivity import SystemSensitivity

        return SystemSensitivity(self, parameters)

    def plot(self) -> mpl_figure.Figure:
        """Positions of the bodies, forces and slip of the contacts over time, as a figure."""
        return figure(self, "plot")

    def to_dataset(self, times: ArrayLike | None = None) -> xr.Dataset:
        """The motion over time, its events and its numbers, with units, as an xarray Dataset.

        Args:
            times: s, shape (n,); `sample_times()` unless given.

        Returns:
            Variables over (body, time), (contact, time), (spring, time) and over `event`; the
            inputs in the attributes.
        """
        from pindrive.bodies.dataset import dataset

        t = self.sample_times() if times is None else np.atleast_1d(self.known(times))
        if t.ndim != 1:
            raise ValueError(refusal("times", "of one dimension", f"{t.ndim}"))
        return dataset(self, t)

    def to_csv(self, path: str | PathLike[str], rate: float | str = default("rate")) -> Path:
        """Write the motion at even times as CSV, and its events to a file of their own.

        Args:
            path: The file of samples; the events go beside it: those of "m.csv" to "m-events.csv".
            rate: Samples a second, Hz, from 1e-6 to 1e12.

        Returns:
            The path of the events.

        Raises:
            ValueError: A rate out of its range; too many samples; a file that is there and holds
                something else, or one that cannot be written.
        """
        return csv_file(self, "to_csv", path, rate)


def _in_loops(between: dict[str, tuple[str, str]]) -> set[str]:
    """Return the names of the pairs that others connect too."""
    found = set()
    for name, (one, other) in between.items():
        reached, rest = {one}, [pair for each, pair in between.items() if each != name]
        while more := {b for pair in rest for b in pair if reached & {*pair}} - reached:
            reached |= more
        if other in reached:
            found.add(name)
    return found


def _kind(before: float, after: float) -> Kind:
    if after == 0:
        return "stick"
    return "slip" if before == 0 else "reverse"


def _found(kind: str, name: object, known: dict[str, Any]) -> str:
    if name not in known:
        names = Names(kind, {each: () for each in known})
        raise ValueError(names.unknown(name if isinstance(name, str) else repr(name)))
    return str(name)


def _between(kind: str, name: Any, other: str | Body | None, known: dict[str, Any]) -> str:
    given = getattr(name, "name", name)
    if other is None:
        return _found(kind, given, known)
    pair = (given, getattr(other, "name", other))
    fits = [each for each, entry in known.items() if entry.between == pair]
    if len(fits) == 1:
        return fits[0]
    if not fits:
        return _found(kind, "-".join(map(str, pair)), known)
    raise ValueError(f"between {pair[0]} and {pair[1]} are the {kind}s {', '.join(fits)}; name one")


def _simulated(system: System, duration: float) -> SystemMotion:
    return system.simulate(duration)
