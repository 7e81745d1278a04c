"""A pin drive as data: the drive and its two contacts, by forces or by coefficients. SI units."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, fields
from functools import partial
from math import inf, isinf, nan, sqrt
from typing import Any, Final, TypedDict, Unpack

from pindrive.motion.friction import (
    COEFFICIENTS,
    FALLING,
    LAW,
    PRESSED_BY,
    SKIN,
    normal_force,
)
from pindrive.quantities.contradictions import refuse, refuse_contact
from pindrive.quantities.drive import DRIVE_QUANTITIES, FRICTION_LAWS, PARTS
from pindrive.quantities.part import Part
from pindrive.quantities.refusal import refusal
from pindrive.quantities.value import concise

__all__ = ["Contact", "Drive", "HessSoom", "Stribeck"]

_TABLE: Final = Part((*DRIVE_QUANTITIES, *PARTS))
check: Final = _TABLE.check
default: Final = _TABLE.default


@concise
@dataclass(frozen=True, slots=True, init=False)
class Contact:
    """Dry friction between the pin drive and a surface: the plate or the fingertip.

    Every number may also be text with a unit, such as "20 mN"; a bare number is SI. Friction is
    given by forces, or by coefficients: friction over the force that presses, which a `Drive`
    knows. The forces of such a contact are NaN until it is part of one.

    Args:
        kinetic: Friction force while sliding, N, from 0 to 1e12; 0 with no static friction is no
            contact at all. None with a curve: its first force.
        static: Largest friction force without sliding, N, from `kinetic` to 1e12; `kinetic` if
            None.
        curve: Kinetic friction over sliding speed as rows (speed in m/s, force in N), speeds
            increasing from 0, linear between rows and on beyond the last; its first force is
            `kinetic`. None: `kinetic` at every speed (Coulomb).
        stiffness: Tangential stiffness of the surface, N/m, from 1e-12 to 1e12; infinite: rigid.
        damping: Tangential damping of the surface, parallel to its stiffness (a Kelvin-Voigt
            element), N*s/m, from 0 to 1e12; none if None.
        coefficient: Kinetic friction over the force that presses, from 0 to 1e12, in place of
            `kinetic`. None with a curve of coefficients: its first.
        static_coefficient: Coefficient at rest, in place of `static`; None: `coefficient`.
        coefficient_curve: Rows (speed in m/s, coefficient), in place of `curve`.
        law: Law of kinetic friction over the sliding speed |u|: "coulomb", "stribeck",
            "hess-soom" or "table"; None: "table" with a curve, else "coulomb". `Stribeck` and
            `HessSoom` make contacts of these laws.
        breakaway: Friction at rest from which that of the laws "stribeck" and "hess-soom" falls to
            `kinetic`, N, from `kinetic` to 1e12; `static` is `breakaway` then if None.
        stribeck_velocity: Sliding speed over which it falls, m/s, from 1e-12 to 1e12.
        exponent: Exponent of the law "stribeck", 1 or 2; 1 if None.
        viscous: Part per sliding speed under any law, N*s/m, from 0 to 1e12; none if None.
        breakaway_coefficient: Coefficient at rest, in place of `breakaway`.
        viscous_coefficient: Viscous part of the coefficient, s/m, in place of `viscous`.

    Raises:
        ValueError: A value is not a number or out of its range, static friction is below kinetic,
            neither kinetic friction nor a curve is given, they disagree, a law lacks a parameter or
            has one that belongs to another law, or there are both forces and coefficients.
    """

    kinetic: float
    static: float | None
    curve: tuple[tuple[float, float], ...] | None
    stiffness: float
    damping: float | None
    coefficient: float | None
    static_coefficient: float | None
    coefficient_curve: tuple[tuple[float, float], ...] | None
    law: str | None
    breakaway: float | None
    stribeck_velocity: float | None
    exponent: float | None
    viscous: float | None
    breakaway_coefficient: float | None
    viscous_coefficient: float | None

    def __init__(
        self,
        kinetic: float | str | None = None,
        static: float | str | None = None,
        curve: Iterable[tuple[float | str, float | str]] | None = None,
        stiffness: float | str = inf,
        damping: float | str | None = None,
        *,
        coefficient: float | str | None = None,
        static_coefficient: float | str | None = None,
        coefficient_curve: Iterable[tuple[float | str, float | str]] | None = None,
        law: str | None = None,
        breakaway: float | str | None = None,
        stribeck_velocity: float | str | None = None,
        exponent: float | str | None = None,
        viscous: float | str | None = None,
        breakaway_coefficient: float | str | None = None,
        viscous_coefficient: float | str | None = None,
    ) -> None:
        """Validate, and keep plain floats and tuples."""
        forces = {
            "kinetic": kinetic,
            "static": static,
            "curve": curve,
            "breakaway": breakaway,
            "viscous": viscous,
        }
        coefficients = {
            "coefficient": coefficient,
            "static_coefficient": static_coefficient,
            "coefficient_curve": coefficient_curve,
            "breakaway_coefficient": breakaway_coefficient,
            "viscous_coefficient": viscous_coefficient,
        }
        of_law = {"law": law, "stribeck_velocity": stribeck_velocity, "exponent": exponent}
        given = forces | coefficients
        by_coefficient = any(value is not None for value in coefficients.values())
        if by_coefficient and any(value is not None for value in forces.values()):
            refuse_contact({name: None for name in given if given[name] is not None})
        chosen = coefficients if by_coefficient else forces
        found = _checked_friction(chosen, of_law)
        if by_coefficient:
            found["kinetic"] = nan  # the force that presses is not known yet
        for name in (*given, *of_law):
            object.__setattr__(self, name, found.get(name))
        object.__setattr__(
            self, "stiffness", check("contact.stiffness", stiffness, label="stiffness")
        )
        damper = 0.0 if damping is None else check("contact.damping", damping, label="damping")
        if damper and isinf(self.stiffness):
            required = "left out for a rigid contact; give stiffness too"
            raise ValueError(refusal("damping", required, f"{damper!r} N*s/m"))
        object.__setattr__(self, "damping", damper or None)

    def pressed_by(self, normal_force: float) -> Contact:
        """Return the contact with the friction forces of its coefficients under a normal force (N).

        Raises:
            ValueError: A force is out of its range.
        """
        rows = self.coefficient_curve
        forces = Contact(
            **{
                force: None if (mu := getattr(self, name)) is None else mu * normal_force
                for force, name in COEFFICIENTS.items()
                if force != "curve"
            },
            curve=None if rows is None else [(speed, each * normal_force) for speed, each in rows],
            stiffness=self.stiffness,
            damping=self.damping,
            **{name: getattr(self, name) for name in LAW},
        )
        for name in COEFFICIENTS.values():
            object.__setattr__(forces, name, getattr(self, name))
        return forces

    @property
    def static_friction(self) -> float:
        """Largest friction force without sliding, N."""
        if self.static is None:
            return self.kinetic if self.breakaway is None else self.breakaway
        return self.static

    @property
    def falls(self) -> bool:
        """True if friction falls by a law, from `breakaway` to `kinetic`."""
        return self.law in FALLING

    @property
    def frictionless(self) -> bool:
        """True if the contact carries no force."""
        curve = self.curve or ()
        return not (self.static_friction or self.viscous or any(force for _, force in curve))

    @property
    def curved(self) -> bool:
        """True if friction depends on the sliding speed."""
        rows = self.curve or ()
        return self.falls or bool(self.viscous) or len(rows) > 1

    def largest(self, speed: float) -> float:
        """Largest friction force at sliding speeds up to `speed` (m/s) and without sliding, N."""
        rows, viscous = self.curve or (), self.viscous or 0.0
        if len(rows) < 2:
            return max(self.static_friction, (self.breakaway or self.kinetic) + viscous * speed)
        forces = [force + viscous * u for u, force in rows if u <= speed]
        i = min(len(forces), len(rows) - 1)
        (u0, f0), (u1, f1) = rows[i - 1 : i + 1]
        forces.append(f0 + (f1 - f0) / (u1 - u0) * (speed - u0) + viscous * speed)
        return max([self.static_friction, *forces])

    @property
    def law_numbers(self) -> tuple[float, float, float, float, float]:
        """Law as the core has it: number, breakaway, Stribeck velocity, exponent, viscous part."""
        number = float(FRICTION_LAWS.index(self.law)) if self.law else 0.0
        falling = (self.breakaway or 0.0, self.stribeck_velocity or 1.0, self.exponent or 1.0)
        return (number, *falling, self.viscous or 0.0)

    @property
    def rigid(self) -> bool:
        """True if the surface does not stretch."""
        return isinf(self.stiffness)


class FallingLaw(TypedDict, total=False):
    """Parameters of a law under which friction falls with the sliding speed: those of `Contact`."""

    kinetic: float | str | None
    breakaway: float | str | None
    stribeck_velocity: float | str
    exponent: float | str | None
    viscous: float | str | None
    static: float | str | None
    coefficient: float | str | None
    breakaway_coefficient: float | str | None
    viscous_coefficient: float | str | None
    static_coefficient: float | str | None


def Stribeck(**law: Unpack[FallingLaw]) -> Contact:
    """Return a rigid contact under Stribeck's law.

    Kinetic friction is kinetic + (breakaway - kinetic) exp(-(|u|/stribeck_velocity)^exponent) +
    viscous |u| at a sliding speed |u| (Armstrong-Helouvry, Dupont, Canudas de Wit 1994, Automatica
    30:1083).

    Args:
        **law: `kinetic`, `breakaway`, `stribeck_velocity`, `exponent`, `viscous` and `static` as
            for `Contact`, or the coefficients in place of the forces.

    Returns:
        A `Contact` of the law.

    Raises:
        ValueError: A value is invalid, as for `Contact`.

    Examples:
        >>> import pindrive as pd
        >>> pd.Stribeck(kinetic=0.020, breakaway=0.026, stribeck_velocity="30 mm/s").law
        'stribeck'
    """
    return Contact(law="stribeck", **law)


def HessSoom(**law: Unpack[FallingLaw]) -> Contact:
    """Return a rigid contact under the law of Hess and Soom.

    Kinetic friction is kinetic + (breakaway - kinetic) / (1 + (|u|/stribeck_velocity)^2) +
    viscous |u| at a sliding speed |u| (Hess, Soom 1990, J. Tribology 112:147).

    Args:
        **law: `kinetic`, `breakaway`, `stribeck_velocity`, `viscous` and `static` as for
            `Contact`, or the coefficients in place of the forces.

    Returns:
        A `Contact` of the law.

    Raises:
        ValueError: A value is invalid, as for `Contact`.
    """
    return Contact(law="hess-soom", **law)


@concise
@dataclass(frozen=True, init=False)
class Drive:
    """A mass on a spring and a damper, rubbed by a plate and a fingertip.

    Every number may also be text with a unit, such as "12 g"; a bare number is SI.

    Args:
        mass: Mass of the moving body, in a device electromagnet and pin, kg, from 1e-12 to 1e12.
        stiffness: Stiffness of the spring, N/m, from 1e-12 to 1e12.
        damping: Viscous, N*s/m, from 0 to 1e12.
        damping_ratio: Damping ratio b / (2 sqrt(m k)) in place of damping, 0 or from 1e-11 to 1e6.
        plate: Friction of the moving plate on the body; given by a coefficient it is
            that of weight, preload and a share of the touch force (and the pull, by which a load
            multiplies it).
        finger: Friction of the resting fingertip on the pin; by a coefficient, of `touch_force`.
        preload: Force that presses the body on the plate beside weight and pull, N, from 0 to 1e12.
        touch_force: Force of the finger on the pin, N, from 0 to 1e12; for a finger given by a
            coefficient alone.
        touch_share: Part of the touch force that presses the body on the plate, from 0 to 1: all of
            it unless the spring carries the touch.
        load_exponent: Exponent n of the finger's friction over its touch force, from 0.1 to 2. The
            friction is coefficient · N₀ (N/N₀)ⁿ at the touch N; 1 is Coulomb friction. A factor λ
            on the touch during a motion makes λⁿ times the friction.
        reference_touch: Touch force N₀ at which the coefficients of the finger hold, N, from 1e-12
            to 1e12; needed where `load_exponent` is not 1.
        travel: Travel of the pin from the rest position of the spring to an end stop, either way,
            m, from 1e-12 to 1e12; None: no stops.
        stop_stiffness: Stiffness of the end stops, N/m, from 1e-12 to 1e12; None: rigid and plastic
            stops, at which a pin loses its velocity.
        stop_damping: Damping of elastic end stops, N*s/m, from 0 to 1e12. Stops push and never
            pull.

    Raises:
        ValueError: A value is no number or out of its range, or the damping is given twice or not
            at all.
    """

    mass: float
    stiffness: float
    damping: float
    plate: Contact
    finger: Contact
    preload: float
    touch_force: float | None
    touch_share: float
    load_exponent: float
    reference_touch: float | None
    travel: float | None
    stop_stiffness: float | None
    stop_damping: float | None

    def __init__(
        self,
        *,
        mass: float | str,
        stiffness: float | str,
        damping: float | str | None = None,
        damping_ratio: float | str | None = None,
        plate: Contact,
        finger: Contact,
        preload: float | str = default("preload"),
        touch_force: float | str | None = default("touch_force"),
        touch_share: float | str = default("touch_share"),
        load_exponent: float | str = default("load_exponent"),
        reference_touch: float | str | None = default("reference_touch"),
        travel: float | str | None = default("travel"),
        stop_stiffness: float | str | None = default("stop_stiffness"),
        stop_damping: float | str | None = default("stop_damping"),
    ) -> None:
        """Validate, and keep plain floats; coefficients become forces."""
        put = object.__setattr__
        put(self, "mass", check("mass", mass))
        put(self, "stiffness", check("stiffness", stiffness))
        put(self, "damping", self._damping_of(damping, damping_ratio))
        put(self, "_by_ratio", damping is None)
        put(self, "plate", plate)
        put(self, "finger", finger)
        put(self, "preload", check("preload", preload))
        put(self, "touch_share", check("touch_share", touch_share))
        put(self, "load_exponent", check("load_exponent", load_exponent))
        optional = {
            "touch_force": touch_force,
            "reference_touch": reference_touch,
            "travel": travel,
            "stop_stiffness": stop_stiffness,
            "stop_damping": stop_damping,
        }
        for name, value in optional.items():
            put(self, name, None if value is None else check(name, value))
        self._check_together()

    def _damping_of(self, damping: float | str | None, ratio: float | str | None) -> float:
        """The damping that is given, or that which a ratio makes, N*s/m."""
        if (damping is None) == (ratio is None):
            given = "neither" if ratio is None else f"both, {damping!r} and {ratio!r}"
            raise ValueError(refusal("damping", "given as damping or as damping_ratio", given))
        if ratio is None:
            assert damping is not None
            return check("damping", damping)
        # In this order everywhere, so that a batch and the page have the same bits.
        return 2.0 * check("damping_ratio", ratio) * sqrt(self.mass) * sqrt(self.stiffness)

    def _check_together(self) -> None:
        """Validate what follows from the values together; coefficients become forces."""
        for label, contact in (("plate", self.plate), ("finger", self.finger)):
            if not isinstance(contact, Contact):
                raise ValueError(refusal(label, "a Contact", repr(contact)))
        refuse(values_of(self))
        for label, contact in (("plate", self.plate), ("finger", self.finger)):
            if contact.coefficient is not None:
                pressed = contact.pressed_by(normal_force(label, partial(getattr, self)))
                object.__setattr__(self, label, pressed)

    def replace(self, **changes: Any) -> Drive:
        """A drive with other values of the arguments of `Drive`; the damping stays unless given.

        Raises:
            ValueError: A value is invalid, as for `Drive`.
            TypeError: An argument is unknown.
        """
        given = {field.name: getattr(self, field.name) for field in fields(self)}
        if "damping_ratio" in changes:
            del given["damping"]
        return Drive(**given | changes)

    @property
    def by_ratio(self) -> bool:
        """True if the damping was given by its ratio."""
        return bool(vars(self)["_by_ratio"])

    @property
    def normal_force(self) -> float:
        """Normal force on the plate without pull, N: weight, preload and a share of the touch."""
        return float(normal_force("plate", partial(getattr, self)))

    @property
    def plate_touch(self) -> float:
        """Part of that normal force that is touch, N."""
        return self.touch_share * (self.touch_force or 0.0)

    @property
    def by_forces(self) -> Drive:
        """Return the drive with friction given by forces alone, which then remain fixed."""
        plate, finger = (
            Contact(**{name: getattr(c, name) for name in (*COEFFICIENTS, *LAW, *SKIN)})
            for c in (self.plate, self.finger)
        )
        preload = self.preload + self.plate_touch
        pressing = {"preload": preload, "touch_force": None, "reference_touch": None}
        return self.replace(plate=plate, finger=finger, **pressing)

    @property
    def rigid_travel(self) -> float | None:
        """Largest displacement of the pin in either direction, m; None without rigid end stops."""
        return self.travel if self.stop_stiffness is None else None

    @property
    def natural_frequency(self) -> float:
        """Undamped natural frequency sqrt(k/m), rad/s."""
        return sqrt(self.stiffness / self.mass)

    @property
    def slowest_rate(self) -> float:
        """Rate at which the slowest part of a free motion decays, 1/s; 0 without damping."""
        ratio = self.damping_ratio
        if ratio <= 1.0:
            return ratio * self.natural_frequency
        return self.natural_frequency / (ratio + sqrt(ratio - 1.0) * sqrt(ratio + 1.0))

    @property
    def damping_ratio(self) -> float:
        """Damping over critical damping, b / (2 sqrt(m k)): below 1 the drive oscillates."""
        return self.damping / self._critical_damping

    @property
    def _critical_damping(self) -> float:
        return 2.0 * sqrt(self.mass) * sqrt(self.stiffness)


def values_of(drive: Drive) -> dict[str, Any]:
    """The given values of a drive by the keys of a device file, friction as it is given."""
    own = ("mass", "stiffness", "damping", "travel", "stop_stiffness", "stop_damping")
    values = {f"drive.{name}": getattr(drive, name) for name in own}
    pressing = {"plate": ("preload", "touch_share"), "finger": PRESSED_BY["finger"]}
    values |= {
        f"{table}.{n}": getattr(drive, n) for table, names in pressing.items() for n in names
    }
    for table, contact in (("plate", drive.plate), ("finger", drive.finger)):
        names = COEFFICIENTS if contact.coefficient is None else COEFFICIENTS.values()
        values |= {f"{table}.{name}": getattr(contact, name) for name in names}
        values |= {f"{table}.{name}": value for name, value in law_values(contact).items()}
    if not drive.finger.rigid:
        values["finger.stiffness"] = drive.finger.stiffness
    if drive.finger.damping:
        values["finger.damping"] = drive.finger.damping
    return {key: value for key, value in values.items() if value is not None}


def law_name(number: float | None) -> str | None:
    """Return the name of a friction law by its number."""
    return None if number is None else FRICTION_LAWS[int(number)]


def law_values(contact: Contact) -> dict[str, float | None]:
    """What a contact has of its law by the names in a device file; the law by its number."""
    number = None if contact.law is None else float(FRICTION_LAWS.index(contact.law))
    return {"law": number, **{name: getattr(contact, name) for name in LAW if name != "law"}}


def _checked_friction(friction: dict[str, Any], of_law: dict[str, Any]) -> dict[str, Any]:
    """Friction by the names of forces or coefficients, kinetic first, and its law."""
    of_kinetic, _, of_curve, *_ = friction
    law, curve = of_law["law"], friction[of_curve]
    if law is not None and law not in FRICTION_LAWS:
        raise ValueError(refusal("law", f"one of {', '.join(FRICTION_LAWS)}", repr(law)))
    rows = None if curve is None else _checked_curve(curve, of_curve)
    if friction[of_kinetic] is None and rows is None:
        kind = "a number in N" if of_kinetic == "kinetic" else "a plain number"
        raise ValueError(refusal(of_kinetic, f"{kind} unless a curve is given", "None"))
    given = friction | of_law
    found: dict[str, Any] = {
        name: None if value is None else check(_LAW_QUANTITIES.get(name, name), value, label=name)
        for name, value in given.items()
        if name not in (of_curve, "law")
    }
    found |= {of_curve: rows, "law": law}
    if found[of_kinetic] is None and rows:
        found[of_kinetic] = rows[0][1]
    values = found | {"law": None if law is None else float(FRICTION_LAWS.index(law))}
    known = {name: value for name, value in values.items() if value is not None}
    if known.keys() != {of_kinetic}:
        refuse_contact(known)
    return found


_LAW_QUANTITIES: Final = {
    name: f"plate.{name}"
    for name in (
        *("breakaway", "breakaway_coefficient", "stribeck_velocity"),
        *("exponent", "viscous", "viscous_coefficient"),
    )
}
"""Quantities of a law, whose bounds are alike at both contacts."""


def _checked_curve(
    curve: Iterable[tuple[float | str, float | str]], name: str
) -> tuple[tuple[float, float], ...]:
    what = "force" if name == "curve" else "coefficient"
    try:
        rows = [(speed, value) for speed, value in curve]
    except (TypeError, ValueError):
        raise ValueError(refusal(name, f"rows of (speed, {what})", repr(curve))) from None
    if not rows:
        raise ValueError(refusal(name, f"at least one row of (speed, {what})", "none"))
    speeds, values = (
        [check(f"curve.{part}", row[j], label=f"{name}[{i}] {part}") for i, row in enumerate(rows)]
        for j, part in enumerate(("speed", what))
    )
    return tuple(zip(speeds, values, strict=True))
