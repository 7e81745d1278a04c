"""The words of the picture of a motion: what it did, of which drive, and what the signs mean."""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import groupby
from math import isfinite, isnan
from typing import TYPE_CHECKING, Final

from pindrive.drive import Profile
from pindrive.quantities import QUANTITIES

if TYPE_CHECKING:
    from pindrive.motion import Motion

NAME: Final = {
    "stick": "sticks",
    "slip": "breaks loose",
    "cross": "reverses without sticking",
    "carried": "carried by the plate",
    "resting": "resting on the finger",
    "gripping": "skin grips the pin",
}

_LINE: Final = 118
"""Characters that fit side by side above the panels."""
_MOST_TURNS: Final = 4
"""Of a curve or an input that changes, how many values are told."""


def short(name: str, value: float) -> str:
    """A value as a caption gives it: "26.5 mN"."""
    quantity = QUANTITIES[name]
    return f"{digits(value * quantity.display_scale)} {quantity.display_unit}".rstrip()


def duration(value: float) -> str:
    """A time (s), long ones in seconds."""
    return short("duration", value) if value < 2.0 else f"{digits(value)} s"


def digits(value: float) -> str:
    """Four digits, or all before the point where they are few more."""
    text = f"{value:.0f}" if 1e4 <= abs(value) < 1e7 else f"{value:.4g}"
    return text.replace("-", "\N{MINUS SIGN}")


def _values(given: float | Profile) -> Sequence[float]:
    return given.values if isinstance(given, Profile) else (given,)


def _course(name: str, values: Sequence[float]) -> str:
    """One value, or those that it takes in turn: "60 → 0 mm/s"; of many the first and the last."""
    turns = [value for value, _ in groupby(values)]
    if len(turns) > _MOST_TURNS:
        turns = [turns[0], turns[-1]]
        return " … ".join(short(name, value) for value in turns)
    scale = QUANTITIES[name].display_scale
    return " → ".join([*(digits(value * scale) for value in turns[:-1]), short(name, turns[-1])])


def stuck_name(motion: Motion, mode: str) -> str:
    """What a phase stuck in this way is called."""
    if mode == "resting" and (
        isinstance(motion.mouse_velocity, Profile) or not motion.drive.finger.rigid
    ):
        return "at rest"
    if motion.mouse_velocity != 0.0 or motion.drive.plate.frictionless:
        return NAME[mode]
    on_finger = "" if motion.drive.finger.frictionless else "finger and "
    return f"at rest on {on_finger}plate"


def outcome(motion: Motion) -> str:
    """How it ends, how long the transient lasts and how far it swings."""
    end, numbers = motion.ending, motion.transient
    place = short("displacement", end.position)
    words = {
        "resting": f"At rest at {place} since {duration(numbers.rest_time)}",
        "decaying": f"Decays towards {place}",
        "steady": f"Steady {end.cycle} oscillation of ±{short('displacement', end.amplitude)}",
        "moving": f"Still moving after {duration(motion.duration)}",
    }[end.kind]
    if end.kind == "steady" and isfinite(end.period):
        words += f", period {duration(end.period)}"
    if numbers.settled:
        words += f"; settling time {duration(numbers.settling_time)}"
    if not isnan(numbers.swing):
        words += f"; swing {short('displacement', numbers.swing)}"
    return words


def parameters(motion: Motion) -> str:
    """The drive and its release."""
    drive, v_plate = motion.drive, motion.mouse_velocity
    words = [
        f"$m$ = {short('mass', drive.mass)}",
        f"$k$ = {short('stiffness', drive.stiffness)}",
        f"$ζ$ = {drive.damping_ratio:.4g}",
    ]
    for contact, index in ((drive.plate, "p"), (drive.finger, "f")):
        kinetic, static = contact.kinetic, contact.static_friction
        more = "" if static == kinetic else f" (static {short('plate.static', static)})"
        along = [force for _, force in contact.curve or ()] or [kinetic]
        words.append(rf"$F_\mathrm{{{index}}}$ = {_course('plate.kinetic', along)}{more}")
    if not drive.finger.rigid:
        words.append(rf"$k_\mathrm{{f}}$ = {short('finger.stiffness', drive.finger.stiffness)}")
    if isinstance(motion.plate_load, Profile) or motion.plate_load != 1.0:
        words.append(f"$λ$ = {_course('plate_load', _values(motion.plate_load))}")
    words.append(rf"$v_\mathrm{{p}}$ = {_course('mouse_velocity', _values(v_plate))}")
    words.append(f"$x_0$ = {short('displacement', motion.displacement)}")
    if motion.initial_velocity != float(motion.plate_velocity(0.0)):
        words.append(f"$v_0$ = {short('velocity', motion.initial_velocity)}")
    lines = [words[0]]
    for word in words[1:]:
        longer = f"{lines[-1]}, {word}"
        if len(re.sub(r"[$\\{}_]|mathrm", "", longer)) <= _LINE:
            lines[-1] = longer
        else:
            lines.append(word)
    return ",\n".join(lines)
