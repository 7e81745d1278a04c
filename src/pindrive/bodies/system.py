"""System of several bodies on one axis, with springs, dampers and dry friction between them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields, replace
from math import inf
from typing import Any, Final

import pindrive
from pindrive import _core
from pindrive.bodies.inputs import Given, input_of, integrated, negative, summed
from pindrive.motion.function import Function
from pindrive.motion.profile import Profile
from pindrive.quantities.bodies import PARTS
from pindrive.quantities.names import Names
from pindrive.quantities.refusal import quoted, refusal
from pindrive.quantities.status import Status
from pindrive.quantities.table import check
from pindrive.quantities.value import concise

GROUND: Final = "ground"
"""Name of the ground, in place of a body."""


@concise
@dataclass(frozen=True, slots=True)
class Body:
    """A body of a system; made by `System.body`.

    Attributes:
        name: Name of the body.
        mass: kg.
        position: At t = 0, m.
        velocity: At t = 0, m/s.
        force: External force, N; constant or over time.
    """

    name: str
    mass: float
    position: float = 0.0
    velocity: float = 0.0
    force: Given = 0.0


@concise
@dataclass(frozen=True, slots=True)
class Spring:
    """A spring with a damper beside it; made by `System.spring`.

    Attributes:
        name: Name: "pin-hand" unless another was given.
        between: Names of the first and the second body; the second may be "ground".
        stiffness: N/m.
        damping: N*s/m.
        length: Position of the first body less that of the second, m, at which the spring rests.
        motion: Prescribed motion of the other end, m or m/s; None: it has none.
    """

    name: str
    between: tuple[str, str]
    stiffness: float = 0.0
    damping: float = 0.0
    length: Given = 0.0
    motion: Profile | Function | None = None


@concise
@dataclass(frozen=True, slots=True)
class ContactPair:
    """Dry friction between two bodies, or a body and the ground; made by `System.contact`.

    Attributes:
        name: Name: "pin-hand" unless another was given.
        between: Names of the first and the second body; the second may be "ground".
        kinetic: Friction force in slip, N.
        static: Largest friction force in stick, N.
        stiffness: Stiffness of the skin, N/m; infinite: a rigid contact.
        damping: Damping coefficient of the skin, N*s/m.
        load: Factor of both frictions.
        velocity: Velocity of the surface along the second body, m/s.
        stretch: Stretch of the skin at t = 0, m.
    """

    name: str
    between: tuple[str, str]
    kinetic: float
    static: float
    stiffness: float = inf
    damping: float = 0.0
    load: Given = 1.0
    velocity: Given = 0.0
    stretch: float = 0.0


@concise
@dataclass(frozen=True, slots=True)
class Stop:
    """Stops of the distance between two bodies, or of a body and the ground; made by `System.stop`.

    Attributes:
        name: Name: "pin-hand" unless another was given.
        between: Names of the first and the second body; the second may be "ground".
        lower: Least position of the first body less that of the second, m; None: no stop there.
        upper: Largest, m; None: no stop there.
        stiffness: N/m; infinite: rigid stops.
        damping: Damping coefficient of elastic stops, N*s/m.
        restitution: Speed after an impact on a rigid stop over that before.
    """

    name: str
    between: tuple[str, str]
    lower: float | None = None
    upper: float | None = None
    stiffness: float = inf
    damping: float = 0.0
    restitution: float = 0.0


Entry = Body | Spring | ContactPair | Stop


class System:
    """Bodies on one axis, built part by part, and simulated exactly.

    A number may be text with a unit, such as "1 g"; a bare number is SI. An input is a number, a
    `Profile` or a `Function`.

    Examples:
        >>> import pindrive as pd
        >>> system = pd.System()
        >>> hand = system.body("hand", mass=0.55)
        >>> arm = system.spring(hand, pd.minimum_jerk("60 mm", "0.8 s"), stiffness=135, damping=6.5)
        >>> pin = system.body("pin", mass="1 g")
        >>> spring = system.spring(pin, hand, stiffness=250, damping=0.5)
        >>> plate = system.contact(pin, "ground", kinetic="0.2 N", static="0.25 N")
        >>> system
        <System of 2 bodies, 2 springs and 1 contact>
        >>> motion = system.simulate(duration=1)
        >>> motion.contact("pin", "ground").events[0].kind
        'slip'
    """

    def __init__(self) -> None:
        self.bodies: dict[str, Body] = {}
        self.springs: dict[str, Spring] = {}
        self.contacts: dict[str, ContactPair] = {}
        self.stops: dict[str, Stop] = {}

    # ---- building --------------------------------------------------------------------------------

    def body(
        self,
        name: str,
        mass: float | str,
        *,
        position: float | str = 0.0,
        velocity: float | str = 0.0,
    ) -> Body:
        """Add a body.

        Args:
            name: Name of the body, which no other body has.
            mass: kg, above 0.
            position: Position at t = 0, m.
            velocity: Velocity at t = 0, m/s.

        Returns:
            The body, which other methods take in place of its name.

        Raises:
            ValueError: The name is empty, "ground", has a dot or is taken; a value is out of range.
        """
        _check_name(name, "body", self.bodies)
        made = Body(
            name,
            _checked("body", name, "mass", mass),
            _checked("body", name, "position", position),
            _checked("body", name, "velocity", velocity),
        )
        self.bodies[name] = made
        return made

    def spring(
        self,
        body: str | Body,
        other: str | Body | Profile | Function = GROUND,
        *,
        stiffness: float | str = 0.0,
        damping: float | str = 0.0,
        length: float | str | Profile | Function = 0.0,
        name: str = "",
    ) -> Spring:
        """Add a spring with a damper beside it.

        Args:
            body: First body.
            other: Second body, "ground", or the prescribed motion of the other end: positions (m)
                or, as `minimum_jerk` has them, velocities (m/s), then from position 0 on.
            stiffness: N/m, at least 0.
            damping: N*s/m, at least 0.
            length: Position of the first body less that of the other end at rest, m. It may change
                over time, as an actuator's does.
            name: Name; "pin-hand" unless given, and "pin-hand 2" for a second one.

        Raises:
            ValueError: A body is unknown, or a value out of range.
        """
        motion = other if isinstance(other, (Profile, Function)) else None
        between = self._between(body, GROUND if motion else other)
        name = self._named(name, "spring", between, self.springs)
        made = Spring(
            name,
            between,
            _checked("spring", name, "stiffness", stiffness),
            _checked("spring", name, "damping", damping),
            _input("spring", name, "length", length),
            None if motion is None else _motion_of(name, motion),
        )
        _check_spring(made)
        self.springs[name] = made
        return made

    def contact(
        self,
        body: str | Body,
        other: str | Body = GROUND,
        *,
        kinetic: float | str,
        static: float | str | None = None,
        stiffness: float | str = inf,
        damping: float | str = 0.0,
        load: float | str | Profile | Function = 1.0,
        velocity: float | str | Profile | Function = 0.0,
        stretch: float | str = 0.0,
        name: str = "",
    ) -> ContactPair:
        """Add dry friction between two bodies, or a body and the ground.

        Args:
            body: First body.
            other: Second body, or "ground".
            kinetic: Friction force in slip, N, at least 0.
            static: Largest friction force in stick, N, at least `kinetic`; None: the same.
            stiffness: Stiffness of the skin between them, N/m; infinite: a rigid contact.
            damping: Damping coefficient of the skin, N*s/m, which needs a stiffness.
            load: Factor of both frictions, at least 0.
            velocity: Velocity of the surface along the second body, m/s, without steps, as of a
                belt.
            stretch: Stretch of the skin at t = 0, m.
            name: Name; "pin-hand" unless given, and "pin-hand 2" for a second one.

        Raises:
            ValueError: A body is unknown, or a value out of range.
        """
        between = self._between(body, other)
        name = self._named(name, "contact", between, self.contacts)
        fixed = kinetic if static is None else static
        made = ContactPair(
            name,
            between,
            _checked("contact", name, "kinetic", kinetic),
            _checked("contact", name, "static", fixed),
            _checked("contact", name, "stiffness", stiffness),
            _checked("contact", name, "damping", damping),
            _input("contact", name, "load", load),
            _input("contact", name, "velocity", velocity, continuous=True),
            _checked("contact", name, "stretch", stretch),
        )
        _check_contact(made)
        self.contacts[name] = made
        return made

    def stop(
        self,
        body: str | Body,
        other: str | Body = GROUND,
        *,
        lower: float | str | None = None,
        upper: float | str | None = None,
        stiffness: float | str = inf,
        damping: float | str = 0.0,
        restitution: float | str = 0.0,
        name: str = "",
    ) -> Stop:
        """Add stops, which push two bodies apart or hold them together, and never pull.

        A rigid stop ends the approach at an impact: the bodies part with `restitution` times the
        speed of their approach. Bounces come shorter and shorter, and end when they would last less
        than the resolution of time. Friction has a limit and holds no impulse.

        Args:
            body: First body.
            other: Second body, or "ground".
            lower: Least position of the first body less that of the second, m; None: no stop there.
            upper: Largest, m, greater than `lower`; None: no stop there.
            stiffness: N/m; infinite: rigid stops.
            damping: Damping coefficient of elastic stops, N*s/m.
            restitution: Restitution of rigid stops, from 0 (the bodies stay together) to 1.
            name: Name; "pin-hand" unless given, and "pin-hand 2" for a second one.

        Raises:
            ValueError: A body is unknown, neither end is given, or a value is out of range.
        """
        between = self._between(body, other)
        name = self._named(name, "stop", between, self.stops)
        made = Stop(
            name,
            between,
            None if lower is None else _checked("stop", name, "lower", lower),
            None if upper is None else _checked("stop", name, "upper", upper),
            _checked("stop", name, "stiffness", stiffness),
            _checked("stop", name, "damping", damping),
            _checked("stop", name, "restitution", restitution),
        )
        _check_stop(made)
        self.stops[name] = made
        return made

    def force(self, body: str | Body, force: float | str | Profile | Function) -> None:
        """Set the external force on a body, N, constant or over time; functions are added by `+`.

        Raises:
            ValueError: The body is unknown, or the force of another unit or out of range.
        """
        name = self._body(body)
        self.bodies[name] = replace(self.bodies[name], force=_input("body", name, "force", force))

    def initial(
        self,
        body: str | Body,
        position: float | str | None = None,
        velocity: float | str | None = None,
    ) -> None:
        """Set position (m) and velocity (m/s) of a body at t = 0; None: as it was.

        Raises:
            ValueError: The body is unknown, or a value out of range.
        """
        name = self._body(body)
        given = {"position": position, "velocity": velocity}
        changed: dict[str, Any] = {
            part: _checked("body", name, part, value)
            for part, value in given.items()
            if value is not None
        }
        self.bodies[name] = replace(self.bodies[name], **changed)

    # ---- parameters ------------------------------------------------------------------------------

    def inputs(self) -> dict[str, Any]:
        """Every value of the system, SI, by its key: "body.pin.mass", "contact.pin-hand.load".

        A profile or a function is one value; the keys of the parameters of a function follow it, as
        "body.pin.force.amplitude".
        """
        found: dict[str, Any] = {}
        for kind, entry in self._entries():
            for part in _values(entry):
                value = getattr(entry, part)
                key = f"{kind}.{entry.name}.{part}"
                found[key] = value
                if isinstance(value, Function):
                    found |= {f"{key}.{name}": x for name, x in value.parameters.items()}
        return found

    @property
    def parameters(self) -> tuple[str, ...]:
        """Keys of the values that are one number each, which studies and derivatives vary."""
        return tuple(key for key, value in self.inputs().items() if isinstance(value, float))

    def key_of(self, given: str) -> str:
        """The key that is meant by a parameter's name, such as "pin.mass" for "body.pin.mass".

        Raises:
            ValueError: The name is unknown, or several parameters may be meant.
        """
        return Names("parameter", {key: () for key in self.parameters}).find(given, "")

    def with_values(self, values: Mapping[str, float | str]) -> System:
        """Return a system with other values of some `parameters`.

        Args:
            values: Values by key, SI, or text with a unit.

        Raises:
            ValueError: A parameter is unknown or a value out of range.
        """
        changed = System()
        changed.bodies = dict(self.bodies)
        changed.springs = dict(self.springs)
        changed.contacts = dict(self.contacts)
        changed.stops = dict(self.stops)
        for given, value in values.items():
            kind, name, part, *parameter = _split(self.key_of(given))
            table: dict[str, Any] = getattr(changed, _TABLES[kind])
            entry = table[name]
            if parameter:
                new: Any = getattr(entry, part).replace(**{parameter[0]: value})
            else:
                new = _checked(kind, name, part, value)
            # Kinetic friction takes static friction along where both were one number.
            tied = {part: new}
            if kind == "contact" and part == "kinetic" and entry.kinetic == entry.static:
                tied["static"] = new
            table[name] = replace(entry, **tied)
        for spring in changed.springs.values():
            _check_spring(spring)
        for contact in changed.contacts.values():
            _check_contact(contact)
        for stop in changed.stops.values():
            _check_stop(stop)
        return changed

    # ---- motion ----------------------------------------------------------------------------------

    def simulate(self, duration: float | str | None = None) -> pindrive.SystemMotion:
        """Follow the bodies from their initial state, exactly.

        Args:
            duration: s, above 0; None: until all bodies rest, held by rigid contacts.

        Returns:
            The motion, whose `status` says if it was followed to its end.

        Raises:
            ValueError: There is no body; the duration is out of range, or missing of a motion that
                does not come to rest; or a load becomes negative.
        """
        from pindrive.bodies.system_motion import SystemMotion

        if not self.bodies:
            raise ValueError(refusal("a system", "one with at least one body", "none"))
        end = None if duration is None else check("duration", duration)
        for contact in self.contacts.values():
            if refused := negative(f"contact.{contact.name}.load", contact.load, end):
                raise ValueError(refused)
        self._check_stops()
        frozen = self.with_values({})
        numbers = frozen.core_numbers()
        core = _core.simulate_system(numbers, inf if end is None else end)
        followed = core.status in (Status.ok, Status.stopped)
        if end is None and followed and not core.rests:
            required = "given, as the bodies do not come to rest"
            raise ValueError(refusal("duration", required, f"None ({core.end:g} s were followed)"))
        return SystemMotion(frozen, numbers, core, core.end if end is None else end)

    def core_numbers(self) -> Any:
        """Bodies, springs and contacts as the core has them."""
        place = {GROUND: -1} | {name: i for i, name in enumerate(self.bodies)}
        return (
            [(b.mass, summed(b.force), b.position, b.velocity) for b in self.bodies.values()],
            [
                (
                    *(place[name] for name in s.between),
                    s.stiffness,
                    s.damping,
                    summed(s.length, None if s.motion is None else integrated(s.motion)),
                )
                for s in self.springs.values()
            ],
            [
                (
                    *(place[name] for name in c.between),
                    c.kinetic,
                    c.static,
                    c.stiffness,
                    c.damping,
                    summed(c.load),
                    summed(c.velocity),
                    c.stretch,
                )
                for c in self.contacts.values()
            ],
            [
                (
                    *(place[name] for name in s.between),
                    end,
                    side,
                    s.stiffness,
                    s.damping,
                    s.restitution,
                )
                for _, s, end, side in self.stop_ends()
            ],
        )

    def stop_ends(self) -> Iterator[tuple[str, Stop, float, int]]:
        """Yield each end of each stop, in the order of the core: name, stop, place, and side."""
        for name, stop in self.stops.items():
            if stop.lower is not None:
                yield name, stop, stop.lower, -1
            if stop.upper is not None:
                yield name, stop, stop.upper, 1

    def _check_stops(self) -> None:
        """Refuse bodies that begin beyond a rigid stop."""
        for name, stop, end, side in self.stop_ends():
            places = [self.bodies[b].position if b != GROUND else 0.0 for b in stop.between]
            beyond = side * (places[0] - places[1] - end)
            if stop.stiffness == inf and beyond > 1e-15 * max(map(abs, (*places, end))):
                required = f"within {end!r} m at t = 0, the end of stop.{name}"
                words = f"the position of {stop.between[0]}"
                raise ValueError(refusal(words, required, f"{places[0] - places[1]!r} m"))

    def __eq__(self, other: object) -> bool:
        """Return True if all parts are equal."""
        return isinstance(other, System) and list(self._entries()) == list(other._entries())

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        """Return the numbers of its parts in a line."""
        from pindrive.quantities.quantity import counted

        parts = [
            counted(len(self.bodies), "body", "bodies"),
            counted(len(self.springs), "spring"),
            counted(len(self.contacts), "contact"),
        ]
        parts += [counted(len(self.stops), "stop")] if self.stops else []
        return f"<System of {', '.join(parts[:-1])} and {parts[-1]}>"

    # ---- names -----------------------------------------------------------------------------------

    def _entries(self) -> Iterator[tuple[str, Entry]]:
        for kind, table in _TABLES.items():
            for entry in getattr(self, table).values():
                yield kind, entry

    def _body(self, given: str | Body) -> str:
        name: object = given.name if isinstance(given, Body) else given
        if not isinstance(name, str) or not self.bodies:
            raise ValueError(refusal("a body", "a Body or its name", repr(given)))
        if name not in self.bodies:
            raise ValueError(Names("body", {known: () for known in self.bodies}).unknown(name))
        return name

    def _between(self, body: str | Body, other: object) -> tuple[str, str]:
        one = self._body(body)
        if isinstance(other, str) and other == GROUND:
            return one, GROUND
        two = self._body(other)  # type: ignore[arg-type]
        if one == two:
            raise ValueError(refusal("the second body", f"another one than {quoted(one)}", "it"))
        return one, two

    def _named(
        self, given: str, kind: str, between: tuple[str, str], taken: Mapping[str, object]
    ) -> str:
        if given:
            _check_name(given, kind, taken)
            return given
        usual = "-".join(between)
        names = (usual, *(f"{usual} {n}" for n in range(2, len(taken) + 2)))
        return next(name for name in names if name not in taken)


_TABLES: Final = {"body": "bodies", "spring": "springs", "contact": "contacts", "stop": "stops"}


def _values(entry: Entry) -> list[str]:
    """Names of the values of a part that are given."""
    own = [f.name for f in fields(entry) if f.name not in ("name", "between")]
    return [name for name in own if getattr(entry, name) is not None]


def _split(key: str) -> list[str]:
    """Kind, name, part and, of a function, parameter of a key; no name has a dot."""
    return key.split(".")


def _checked(kind: str, name: str, part: str, value: Any) -> float:
    return PARTS[kind].check(part, value, label=f"{kind}.{name}.{part}")


def _input(kind: str, name: str, part: str, value: Any, *, continuous: bool = False) -> Given:
    return input_of(PARTS[kind], part, value, f"{kind}.{name}.{part}", continuous=continuous)


def _motion_of(name: str, motion: Profile | Function) -> Profile | Function:
    label = f"spring.{name}.motion"
    if motion.unit not in ("", "m", "m/s"):
        required = f"a {type(motion).__name__} of positions in m or velocities in m/s"
        raise ValueError(refusal(label, required, f"values in {motion.unit}"))
    integrated(motion, label)
    return motion


def _check_name(name: object, kind: str, taken: Mapping[str, object]) -> None:
    """Refuse a name that is empty, has a dot or is taken."""
    label = f"the name of a {kind}"
    if not isinstance(name, str) or not name.strip() or "." in name or name == GROUND:
        raise ValueError(refusal(label, 'text without a dot, and not "ground"', repr(name)))
    if name in taken:
        raise ValueError(refusal(label, f"none of {', '.join(taken)}", quoted(name)))


def _check_spring(spring: Spring) -> None:
    """Refuse a damper whose end jumps."""
    if not spring.damping:
        return
    for part in ("length", "motion"):
        given = getattr(spring, part)
        position = given is not None and getattr(given, "unit", "") != "m/s"
        if position:
            input_of(PARTS["spring"], part, given, f"spring.{spring.name}.{part}", continuous=True)


def _check_stop(stop: Stop) -> None:
    """Refuse stops without an end, or with parts that contradict each other."""
    label = f"stop.{stop.name}"
    if stop.lower is None and stop.upper is None:
        raise ValueError(refusal(label, "given with lower, upper or both", "neither"))
    if stop.lower is not None and stop.upper is not None and not stop.lower < stop.upper:
        required = f"greater than lower ({stop.lower!r} m)"
        raise ValueError(refusal(f"{label}.upper", required, f"{stop.upper!r} m"))
    if stop.stiffness == inf and stop.damping:
        given = f"{stop.damping!r} N*s/m"
        raise ValueError(refusal(f"{label}.damping", "0 of a rigid stop", given))
    if stop.stiffness < inf and stop.restitution:
        required = "0 of an elastic stop, which has a damping"
        raise ValueError(refusal(f"{label}.restitution", required, repr(stop.restitution)))


def _check_contact(contact: ContactPair) -> None:
    """Refuse frictions and a skin that contradict each other."""
    label = f"contact.{contact.name}"
    if not contact.static >= contact.kinetic:
        required = f"at least kinetic ({contact.kinetic!r} N)"
        raise ValueError(refusal(f"{label}.static", required, f"{contact.static!r} N"))
    if contact.stiffness == inf and (contact.damping or contact.stretch):
        part = "damping" if contact.damping else "stretch"
        unit = "N*s/m" if contact.damping else "m"
        given = f"{getattr(contact, part)!r} {unit}"
        raise ValueError(refusal(f"{label}.{part}", "0 of a rigid contact", given))
    holds = contact.static * (
        contact.load if isinstance(contact.load, float) else contact.load(0.0)
    )
    if contact.stretch and contact.stiffness * abs(contact.stretch) > holds:
        required = f"at most what the skin holds, {holds / contact.stiffness!r} m"
        raise ValueError(refusal(f"{label}.stretch", required, f"{contact.stretch!r} m"))
