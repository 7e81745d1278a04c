"""The motion of several bodies as tables in a terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.console import Group, RenderableType

from pindrive.cli.tables import new_table, whole_lines
from pindrive.quantities.quantity import counted, significant

if TYPE_CHECKING:
    from pindrive.bodies.system_motion import SystemMotion


def _ending(motion: SystemMotion) -> str:
    """Say how a motion ends."""
    ending = motion.ending
    if ending.kind == "unknown":
        return motion.status.explanation
    words = {
        "rest": "at rest",
        "settled": "settled to 1e-8 of the motion",
        "periodic": f"repeating every {significant(ending.period)} s",
        "drifting": "drifting",
    }
    return words[ending.kind]


def system_report(motion: SystemMotion, name: str) -> RenderableType:
    """Report bodies, contacts and energy of a motion."""
    numbers, system = motion.numbers(), motion.system
    bodies = new_table("Bodies", "body", ">least (mm)", ">largest (mm)", ">end (mm)", ">end (mm/s)")
    for body in system.bodies:
        values = (numbers[f"body.{body}.{part}"] for part in ("least", "largest", "end"))
        speed = numbers[f"body.{body}.end_velocity"]
        bodies.add_row(body, *(significant(1e3 * x) for x in (*values, speed)))
    contacts = new_table("Contacts", "contact", ">events", ">slips first (s)", "at the end")
    for contact in system.contacts:
        own = motion.contact(contact)
        first = next((e.time for e in own.events if e.kind == "slip"), None)
        slip = int(own.slip(motion.core.end, "left"))
        contacts.add_row(
            contact,
            str(len(own.events)),
            "-" if first is None else significant(first),
            "sticks" if slip == 0 else f"slips {'forward' if slip > 0 else 'backward'}",
        )
    energy, worst = motion.energy, motion.certificate().worst
    parts = {"inputs": energy.inputs, "dampers": energy.dampers, "contacts": energy.contacts}
    shown = ", ".join(f"{part} {significant(1e3 * value)} mJ" for part, value in parts.items())
    followed = _ending(motion)
    lines = [
        f"{name or 'System'}: {counted(len(motion.events), 'event')} in {motion.core.end:g} s, "
        f"{followed}.",
        f"Energy: {shown}; from {significant(1e3 * energy.before)} "
        f"to {significant(1e3 * energy.after)} mJ.",
        f"The laws hold to {worst:.1e} of the largest quantity.",
    ]
    if motion.shared:
        lines.append(
            f"The friction of {', '.join(motion.shared)} is not unique at times: "
            "it is shared in proportion to static friction."
        )
    return Group(*whole_lines(lines), bodies, contacts)
