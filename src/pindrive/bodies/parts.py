"""The parts of a system of several bodies: their values, and what contradicts itself in them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from math import inf
from typing import Final

from pindrive.bodies.inputs import Given, input_of
from pindrive.motion.function import Function
from pindrive.motion.profile import Profile
from pindrive.quantities.bodies import PARTS
from pindrive.quantities.refusal import quoted, refusal
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
        pressed_by: Contact or stop that adds to `load`: "contact.NAME", "stop.NAME"; None: none.
        share: Load per load of that contact, or per force (1/N) of that elastic stop.
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
    pressed_by: str | None = None
    share: float | None = None


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


@concise
@dataclass(frozen=True, slots=True)
class Feedback:
    """A controller that leads the distance of two bodies along a reference; by `System.feedback`.

    Attributes:
        name: Name: "pin-hand" unless another was given.
        between: Bodies on which its force and the opposite act; the second may be "ground".
        measured: Bodies whose distance is measured, likewise.
        proportional: Gain of the error, N/m.
        derivative: Gain of the rate of the error, N*s/m.
        integral: Gain of the integral of the error, N/(m*s).
        reference: Intended position of the first measured body less that of the second, m.
        period: Time between two samples, s; 0: continuous.
    """

    name: str
    between: tuple[str, str]
    measured: tuple[str, str]
    proportional: float = 0.0
    derivative: float = 0.0
    integral: float = 0.0
    reference: Given = 0.0
    period: float = 0.0


Entry = Body | Spring | ContactPair | Stop | Feedback

TABLES: Final = {
    "body": "bodies",
    "spring": "springs",
    "contact": "contacts",
    "stop": "stops",
    "feedback": "feedbacks",
}
"""Attribute of a system that has the parts of each kind."""


def values_of(entry: Entry) -> list[str]:
    """Names of the values of a part that are given."""
    own = [f.name for f in fields(entry) if f.name not in ("name", "between", "measured")]
    return [name for name in own if getattr(entry, name) is not None]


def check_name(name: object, kind: str, taken: Mapping[str, object]) -> None:
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
    by_stop = (contact.pressed_by or "").startswith("stop.")
    if by_stop and contact.stiffness < inf and not contact.damping:
        required = "that of a skin with a damping, or of a rigid contact, which a stop may press"
        raise ValueError(refusal(f"{label}.damping", required, "0 N*s/m"))
    if contact.pressed_by is None and contact.share is not None:
        required = "given beside pressed_by"
        raise ValueError(refusal(f"{label}.share", required, repr(contact.share)))


def _check_feedback(feedback: Feedback) -> None:
    """Refuse a reference that jumps under a continuous gain of its rate, and no gain at all."""
    label = f"feedback.{feedback.name}"
    gains = (feedback.proportional, feedback.derivative, feedback.integral)
    if not any(gains):
        required = "with a gain: proportional, derivative or integral"
        raise ValueError(refusal(label, required, "none"))
    if feedback.derivative and not feedback.period:
        given = feedback.reference
        if getattr(given, "unit", "") != "m/s":
            table = PARTS["feedback"]
            input_of(table, "reference", given, f"{label}.reference", continuous=True)


def check_part(part: Entry) -> None:
    """Refuse a part whose values contradict each other."""
    if isinstance(part, Spring):
        _check_spring(part)
    elif isinstance(part, ContactPair):
        _check_contact(part)
    elif isinstance(part, Stop):
        _check_stop(part)
    elif isinstance(part, Feedback):
        _check_feedback(part)
