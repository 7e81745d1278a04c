"""Assembly: drives and releases with the values of a fit's parameters.

Static friction and friction curves keep their ratio to kinetic friction, and the skin's stretch to
the largest that it can have, unless they are fitted themselves. Static friction below the kinetic
one acts as the kinetic one.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import inf, isnan
from typing import Any

import numpy as np

from pindrive.fitting.parameters import (
    FALLING_NUMBERS,
    OF_FUNCTIONS,
    ROW,
    Parameter,
    is_of_sensor,
)
from pindrive.motion.core_numbers import PLACES, CoreNumbers, entry, mapped
from pindrive.motion.drive import Contact, Drive
from pindrive.motion.function import STEP, Function, at_begin, core_of
from pindrive.motion.profile import Profile
from pindrive.motion.release import INPUTS, Release, core_numbers


class Assembly:
    """The core's numbers of each recording as functions of the parameters.

    Args:
        found: The parameters.
        drive: Drive that the parameters change.
        releases: Releases that the parameters change, one for each recording.
        durations: Until when each recording is simulated, s.
    """

    def __init__(
        self,
        found: Sequence[Parameter],
        drive: Drive,
        releases: Sequence[Release],
        durations: Sequence[float],
    ) -> None:
        self._own = [
            {
                p.key: i
                for i, p in enumerate(found)
                if p.recording in (None, r) and not is_of_sensor(p.key)
            }
            for r in range(len(releases))
        ]
        self._drive = drive
        self._functions = [
            {
                name: given
                for name in INPUTS
                if isinstance(given := getattr(release, name), Function)
            }
            for release in releases
        ]
        self._base = [core_numbers(drive, release, inf) for release in releases]
        self._durations = durations
        self._releases = releases
        self._carried = [release.velocity is None for release in releases]
        self._still = [mapped(lambda _: 0.0, base) for base in self._base]

    def places(self, r: int) -> Sequence[int]:
        """The parameters that change the motion of a recording."""
        return [*self._own[r].values()]

    def numbers(self, theta: Any, r: int, duration: float | None = None) -> Any:
        """The core's numbers; with arrays in `theta` arrays in their place."""
        values = {key: theta[i] for key, i in self._own[r].items()}
        end = self._durations[r] if duration is None else duration
        return _assembled(values, self._base[r], self._functions[r], self._carried[r], end)

    def drive(self, theta: Any, r: int = 0) -> Drive:
        """The drive of a recording with these parameters."""
        mass, stiffness, damping, *contacts = self.numbers(theta, r)[:5]
        made = [
            _made_contact(numbers, given, f"{name}.static" in self._own[r])
            for numbers, given, name in zip(
                contacts, (self._drive.plate, self._drive.finger), ("plate", "finger"), strict=True
            )
        ]
        return Drive(
            mass=float(mass),
            stiffness=float(stiffness),
            damping=float(damping),
            plate=made[0],
            finger=made[1],
            preload=self._drive.preload,
            load_exponent=float(self.numbers(theta, r)[4][6]),
            travel=self._drive.travel,
            stop_stiffness=self._drive.stop_stiffness,
            stop_damping=self._drive.stop_damping,
        )

    def release(self, theta: Any, r: int) -> Release:
        """The release of a recording with these parameters."""
        _, _, x, v, stretch, *_ = self.numbers(theta, r)[5:13]
        carried = self._carried[r] and "velocity" not in self._own[r]
        return self._releases[r].replace(
            displacement=float(x),
            velocity=None if carried else float(v),
            skin_stretch=None if isnan(stretch) else float(stretch),
            **{name: self._made_input(theta, r, name) for name in INPUTS},
        )

    def _made_input(self, theta: Any, r: int, name: str) -> float | Profile | Function:
        function = self._functions[r].get(name)
        if function is None:
            rows = entry(self.numbers(theta, r), PLACES[name])
            if len(rows) == 1:
                return float(rows[0][1])
            return Profile([float(t) for t, _ in rows], [float(y) for _, y in rows])
        own = _own_of(name, {key: float(theta[i]) for key, i in self._own[r].items()})
        return function.replace(**own) if own else function

    def along(self, theta: Sequence[float], i: int, r: int) -> CoreNumbers:
        """The derivative of the core's numbers with respect to parameter i."""
        values: dict[str, Any] = {key: float(theta[j]) for key, j in self._own[r].items()}
        key = next(key for key, j in self._own[r].items() if j == i)
        values[key] = complex(values[key], STEP)
        numbers = _assembled(values, self._base[r], self._functions[r], self._carried[r], 0.0)
        base, still = self._base[r], self._still[r]
        found = [
            still[j] if part is base[j] else mapped(lambda y: complex(y).imag / STEP, part)
            for j, part in enumerate(numbers)
        ]
        return tuple(found)


def _made_contact(numbers: Any, given: Contact, static_free: bool) -> Contact:
    kinetic, static, give, curve, (law, breakaway, velocity, _, viscous), damping, _ = numbers
    rows = [(float(speed), float(force)) for speed, force in curve] or None
    known = given.static is not None or static_free
    return Contact(
        rows[0][1] if rows else float(kinetic),
        float(static) if known else None,
        rows,
        float(give),
        float(damping),
        law=given.law,
        breakaway=float(breakaway) if law else None,
        stribeck_velocity=float(velocity) if law else None,
        exponent=given.exponent,
        viscous=float(viscous) if viscous else None,
    )


def _own_of(name: str, values: Mapping[str, Any]) -> dict[str, Any]:
    """The parameters of the function of an input among values."""
    return {
        key.partition(".")[2]: value
        for key, value in values.items()
        if key in OF_FUNCTIONS and key.startswith(f"{name}.")
    }


def _input(
    values: Mapping[str, Any], name: str, base: Any, functions: Mapping[str, Function]
) -> Any:
    """The rows or pieces of an input."""
    if name not in functions:
        return _table(values, name, base)
    own = _own_of(name, values)
    return core_of(functions[name], own) if own else base


def _assembled(
    values: Mapping[str, Any],
    base: Any,
    functions: Mapping[str, Function],
    carried: bool,
    duration: float,
) -> Any:
    mass, stiffness, damping, plate, finger, plate_velocity, load, x, v, stretch, *others = base
    *others, _, support = others
    mass = values.get("mass", mass)
    stiffness = values.get("stiffness", stiffness)
    damping = values.get("damping", damping)
    if "damping_ratio" in values:
        damping = 2.0 * values["damping_ratio"] * np.sqrt(mass) * np.sqrt(stiffness)
    contacts = []
    for name, contact in (("plate", plate), ("finger", finger)):
        touched = any(key.startswith((f"{name}.", f"{name}_curve")) for key in values)
        touched = touched or (name == "finger" and "load_exponent" in values)
        contacts.append(_contact(values, name, contact) if touched else contact)
    plate_velocity = _input(values, "mouse_velocity", plate_velocity, functions)
    load = _input(values, "plate_load", load, functions)
    x = values.get("displacement", x)
    if "velocity" in values:
        v = values["velocity"]
    elif carried:
        smooth = "mouse_velocity" in functions
        v = at_begin(plate_velocity) if smooth else _at_zero(plate_velocity)
    if "skin_stretch" in values:
        stretch = values["skin_stretch"]
    elif stretch == stretch and contacts[1] is not finger:  # follows the largest
        stretch = stretch / (finger[1] / finger[2]) * (contacts[1][1] / contacts[1][2])
    return (
        *(mass, stiffness, damping, *contacts, plate_velocity, load),
        *(x, v, stretch, *others, duration, support),
    )


def _contact(values: Mapping[str, Any], name: str, contact: Any) -> Any:
    kinetic, static, give, curve, of_law, damping, power = contact
    law, breakaway, velocity, exponent, viscous = of_law
    falls = law in FALLING_NUMBERS
    rest = breakaway if falls else kinetic
    ratio = static / rest if rest else 1.0
    given = values.get(f"{name}.kinetic")
    if given is not None:
        if curve:
            factor = given / kinetic
            curve = tuple((speed, force * factor) for speed, force in curve)
        if falls and kinetic:
            breakaway = breakaway / kinetic * given
        kinetic = given
    curve = _table(values, f"{name}_curve", curve)
    if curve:
        kinetic = curve[0][1]
    breakaway = values.get(f"{name}.breakaway", breakaway)
    if falls:
        breakaway = np.where(np.real(breakaway) > np.real(kinetic), breakaway, kinetic)[()]
    rest = breakaway if falls else kinetic
    own = values.get(f"{name}.static")
    if own is not None:
        static = np.where(np.real(own) > np.real(rest), own, rest)[()]
    elif given is not None or curve or falls:
        static = ratio * rest
    give = values.get(f"{name}.stiffness", give)
    velocity = values.get(f"{name}.stribeck_velocity", velocity)
    viscous = values.get(f"{name}.viscous", viscous)
    damping = values.get(f"{name}.damping", damping)
    if name == "finger":
        power = values.get("load_exponent", power)
    return (
        kinetic,
        static,
        give,
        curve,
        (law, breakaway, velocity, exponent, viscous),
        damping,
        power,
    )


def _table(values: Mapping[str, Any], name: str, rows: Any) -> Any:
    if name in values:
        return [(rows[0][0], values[name])]
    own = [(match, value) for key, value in values.items() if (match := ROW.fullmatch(key))]
    changed = {
        (int(match[2]), int(match[3] in ("force", "value"))): value
        for match, value in own
        if match[1] == name
    }
    if not changed:
        return rows
    return tuple(
        tuple(changed.get((i, j), entry) for j, entry in enumerate(row))
        for i, row in enumerate(rows)
    )


def _at_zero(rows: Any) -> Any:
    """The value at t = 0 of what is linear between rows."""
    after = next((i for i, (t, _) in enumerate(rows) if np.real(t) > 0.0), len(rows))
    if after in (0, len(rows)):
        return rows[max(after - 1, 0)][1]
    (t0, y0), (t1, y1) = rows[after - 1], rows[after]
    return y0 + (y1 - y0) * (-t0 / (t1 - t0))
