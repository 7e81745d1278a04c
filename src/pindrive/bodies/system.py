"""System of several bodies on one axis, with springs, dampers and dry friction between them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from math import inf
from typing import Any

import pindrive
from pindrive import _core
from pindrive.bodies.core_numbers import numbers_of_system, stop_ends
from pindrive.bodies.ending import STEPS
from pindrive.bodies.inputs import Given, input_of, integrated, negative
from pindrive.bodies.parts import (
    GROUND,
    TABLES,
    Body,
    ContactPair,
    Entry,
    Feedback,
    Spring,
    Stop,
    check_name,
    check_part,
    values_of,
)
from pindrive.motion.function import Function
from pindrive.motion.profile import Profile
from pindrive.quantities.bodies import PARTS
from pindrive.quantities.names import Names
from pindrive.quantities.refusal import quoted, refusal
from pindrive.quantities.status import Status
from pindrive.quantities.table import check


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
        self.feedbacks: dict[str, Feedback] = {}

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
        check_name(name, "body", self.bodies)
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
            None if motion is None else _motion_of(f"spring.{name}.motion", motion),
        )
        check_part(made)
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
        pressed_by: str | ContactPair | Stop | None = None,
        share: float | str | None = None,
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
            pressed_by: A contact, whose load adds to `load`, or an elastic stop with one end, whose
                force does; their name, or "stop.NAME" where both have one.
            share: Load per load of that contact, or per newton of that stop, at least 0; None: 1.
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
            self._pressing(name, pressed_by),
            None
            if share is None and pressed_by is None
            else _checked("contact", name, "share", 1.0 if share is None else share),
        )
        check_part(made)
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
        check_part(made)
        self.stops[name] = made
        return made

    def feedback(
        self,
        body: str | Body,
        other: str | Body = GROUND,
        *,
        proportional: float | str = 0.0,
        derivative: float | str = 0.0,
        integral: float | str = 0.0,
        reference: float | str | Profile | Function = 0.0,
        measured: str | Body | tuple[str | Body, str | Body] | None = None,
        period: float | str = 0.0,
        name: str = "",
    ) -> Feedback:
        """Add a controller, whose force on a body leads a distance along a reference.

        With the error e, the reference less the distance, the force is `proportional` e +
        `derivative` e' + `integral` ∫ e dt. A sampled controller reads e and e' at multiples of its
        `period`, from t = 0 on, takes the sum of e times the period for the integral, and holds its
        force until the next sample.

        Args:
            body: First body, on which the force acts.
            other: Second body, on which the opposite force acts, or "ground".
            proportional: Gain of the error, N/m.
            derivative: Gain of the rate of the error, N*s/m.
            integral: Gain of the integral of the error, N/(m*s).
            reference: Intended distance: positions (m) or, as `minimum_jerk` has them, velocities
                (m/s), then from 0 on.
            measured: Body, or both bodies, of the distance: the position of the first less that of
                the second; None: `body` and `other`.
            period: Time between two samples, s; 0: continuous.
            name: Name; "pin-hand" unless given, and "pin-hand 2" for a second one.

        Raises:
            ValueError: A body is unknown, no gain is given, or a value is out of range.
        """
        between = self._between(body, other)
        pair = measured if isinstance(measured, tuple) else (measured, GROUND)
        seen = between if measured is None else self._between(*pair)
        name = self._named(name, "feedback", between, self.feedbacks)
        label = f"feedback.{name}.reference"
        made = Feedback(
            name,
            between,
            seen,
            _checked("feedback", name, "proportional", proportional),
            _checked("feedback", name, "derivative", derivative),
            _checked("feedback", name, "integral", integral),
            _motion_of(label, reference)
            if isinstance(reference, (Profile, Function))
            else _checked("feedback", name, "reference", reference),
            _checked("feedback", name, "period", period),
        )
        check_part(made)
        self.feedbacks[name] = made
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
            for part in values_of(entry):
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
        for table in TABLES.values():
            setattr(changed, table, dict(getattr(self, table)))
        for given, value in values.items():
            kind, name, part, *parameter = _split(self.key_of(given))
            entries: dict[str, Any] = getattr(changed, TABLES[kind])
            entry = entries[name]
            if parameter:
                new: Any = getattr(entry, part).replace(**{parameter[0]: value})
            else:
                new = _checked(kind, name, part, value)
            # Kinetic friction takes static friction along where both were one number.
            tied = {part: new}
            if kind == "contact" and part == "kinetic" and entry.kinetic == entry.static:
                tied["static"] = new
            entries[name] = replace(entry, **tied)
        for _, changed_part in changed._entries():
            check_part(changed_part)
        return changed

    # ---- motion ----------------------------------------------------------------------------------

    def simulate(self, duration: float | str | None = None) -> pindrive.SystemMotion:
        """Follow the bodies from their initial state, exactly.

        Args:
            duration: s, above 0; None: until the motion's `ending` is known: rest, a motion that
                repeats, or a drift.

        Returns:
            The motion, whose `status` says if it was followed to its end.

        Raises:
            ValueError: There is no body; the duration is out of range, or missing of a motion whose
                ending is not found; or a load becomes negative.
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
        numbers = numbers_of_system(frozen)
        if end is not None:
            return SystemMotion(frozen, numbers, _core.simulate_system(numbers, end), end)
        for steps in STEPS:
            core = _core.simulate_system(numbers, inf, steps)
            motion = SystemMotion(frozen, numbers, core, core.end)
            given_up = core.status not in (Status.ok, Status.stopped)
            if given_up or motion.ending.kind != "unknown":
                return motion
        required = "given, as the motion neither rests nor repeats"
        raise ValueError(refusal("duration", required, f"None ({core.end:g} s were followed)"))

    def _check_stops(self) -> None:
        """Refuse bodies that begin beyond a rigid stop."""
        for name, stop, end, side in stop_ends(self):
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
        parts += [counted(len(self.feedbacks), "feedback")] if self.feedbacks else []
        return f"<System of {', '.join(parts[:-1])} and {parts[-1]}>"

    # ---- names -----------------------------------------------------------------------------------

    def _entries(self) -> Iterator[tuple[str, Entry]]:
        for kind, table in TABLES.items():
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

    def _pressing(self, name: str, given: object) -> str | None:
        """Key of the contact or the stop that presses another contact."""
        if given is None:
            return None
        label = f"contact.{name}.pressed_by"
        kind = "stop" if isinstance(given, Stop) else "contact"
        words = f"{kind}.{given.name}" if isinstance(given, (Stop, ContactPair)) else given
        known = {f"contact.{each}": () for each in self.contacts}
        known |= {f"stop.{each}": () for each in self.stops}
        if not isinstance(words, str) or not known:
            required = "a contact or an elastic stop of the system"
            raise ValueError(refusal(label, required, repr(given)))
        key = Names("contact or stop", known).find(words, label)
        kind, _, pressing = key.partition(".")
        if kind == "contact" and self.contacts[pressing].pressed_by:
            required = "a contact that no other one presses"
            raise ValueError(refusal(label, required, quoted(pressing)))
        if kind == "stop":
            stop = self.stops[pressing]
            if stop.stiffness == inf or None not in (stop.lower, stop.upper):
                required = "an elastic stop with one end"
                words = "a rigid one" if stop.stiffness == inf else "one with two"
                raise ValueError(refusal(label, required, f"{quoted(pressing)}, {words}"))
        return key

    def _named(
        self, given: str, kind: str, between: tuple[str, str], taken: Mapping[str, object]
    ) -> str:
        if given:
            check_name(given, kind, taken)
            return given
        usual = "-".join(between)
        names = (usual, *(f"{usual} {n}" for n in range(2, len(taken) + 2)))
        return next(name for name in names if name not in taken)


def _split(key: str) -> list[str]:
    """Kind, name, part and, of a function, parameter of a key; no name has a dot."""
    return key.split(".")


def _checked(kind: str, name: str, part: str, value: Any) -> float:
    return PARTS[kind].check(part, value, label=f"{kind}.{name}.{part}")


def _input(kind: str, name: str, part: str, value: Any, *, continuous: bool = False) -> Given:
    return input_of(PARTS[kind], part, value, f"{kind}.{name}.{part}", continuous=continuous)


def _motion_of(label: str, motion: Profile | Function) -> Profile | Function:
    if motion.unit not in ("", "m", "m/s"):
        required = f"a {type(motion).__name__} of positions in m or velocities in m/s"
        raise ValueError(refusal(label, required, f"values in {motion.unit}"))
    integrated(motion, label)
    return motion
