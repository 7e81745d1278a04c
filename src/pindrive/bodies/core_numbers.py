"""A system of several bodies as the core has it: tuples of numbers, in the order of the parts."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Final

from pindrive.bodies.inputs import integrated, summed
from pindrive.bodies.parts import GROUND, Stop

if TYPE_CHECKING:
    from pindrive.bodies.system import System

PLACES: Final = {
    "body": ("mass", "force", "position", "velocity"),
    "spring": ("", "", "stiffness", "damping", "length"),
    "contact": (
        *("", "", "kinetic", "static", "stiffness", "damping"),
        *("load", "velocity", "stretch", "", "share"),
    ),
    "stop": ("", "", "", "", "stiffness", "damping", "restitution"),
    "feedback": (*("", "", "", ""), *("proportional", "derivative", "integral", "reference")),
}
"""Values of each part in the order in which the core has them."""


def stop_ends(system: System) -> Iterator[tuple[str, Stop, float, int]]:
    """Yield each end of each stop, in the order of the core: name, stop, place, and side."""
    for name, stop in system.stops.items():
        if stop.lower is not None:
            yield name, stop, stop.lower, -1
        if stop.upper is not None:
            yield name, stop, stop.upper, 1


def numbers_of_system(system: System) -> Any:
    """Return bodies, springs, contacts, ends of stops and feedbacks, a list of tuples each."""
    place = {GROUND: -1} | {name: i for i, name in enumerate(system.bodies)}
    contacts, ends = [*system.contacts], [name for name, *_ in stop_ends(system)]
    pressing = {f"contact.{name}": i for i, name in enumerate(contacts)}
    pressing |= {f"stop.{name}": len(contacts) + i for i, name in enumerate(ends)}
    return (
        [(b.mass, summed(b.force), b.position, b.velocity) for b in system.bodies.values()],
        [
            (
                *(place[name] for name in s.between),
                s.stiffness,
                s.damping,
                summed(s.length, None if s.motion is None else integrated(s.motion)),
            )
            for s in system.springs.values()
        ],
        [
            (
                *(place[name] for name in c.between),
                *(c.kinetic, c.static, c.stiffness, c.damping),
                *(summed(c.load), summed(c.velocity)),
                c.stretch,
                -1 if c.pressed_by is None else pressing[c.pressed_by],
                c.share or 0.0,
            )
            for c in system.contacts.values()
        ],
        [
            (*(place[n] for n in s.between), end, side, s.stiffness, s.damping, s.restitution)
            for _, s, end, side in stop_ends(system)
        ],
        [
            (
                *(place[name] for name in (*f.between, *f.measured)),
                *(f.proportional, f.derivative, f.integral),
                summed(integrated(f.reference)),
                f.period,
            )
            for f in system.feedbacks.values()
        ],
    )
