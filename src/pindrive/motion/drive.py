"""A pin drive as data: the drive and its two contacts, by forces or by coefficients. SI units."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, fields
from functools import partial
from math import inf, isinf, nan, sqrt
from typing import Any, Final

from pindrive.motion.friction import COEFFICIENTS, normal_force
from pindrive.quantities.drive import DRIVE_QUANTITIES, PARTS
from pindrive.quantities.part import Part
from pindrive.quantities.quantity import brief
from pindrive.quantities.refusal import refusal
from pindrive.quantities.rows import check_increasing, check_slopes, slopes_of
from pindrive.quantities.value import concise

__all__ = ["Contact", "Drive"]

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
        coefficient: Kinetic friction over the force that presses, from 0 to 1e12, in place of
            `kinetic`. None with a curve of coefficients: its first.
        static_coefficient: Coefficient at rest, in place of `static`; None: `coefficient`.
        coefficient_curve: Rows (speed in m/s, coefficient), in place of `curve`.

    Raises:
        ValueError: A value is not a number or out of its range, static friction is below kinetic,
            neither kinetic friction nor a curve is given, they disagree, or there are both forces
            and coefficients.
    """

    kinetic: float
    static: float | None
    curve: tuple[tuple[float, float], ...] | None
    stiffness: float
    coefficient: float | None
    static_coefficient: float | None
    coefficient_curve: tuple[tuple[float, float], ...] | None

    def __init__(
        self,
        kinetic: float | str | None = None,
        static: float | str | None = None,
        curve: Iterable[tuple[float | str, float | str]] | None = None,
        stiffness: float | str = inf,
        *,
        coefficient: float | str | None = None,
        static_coefficient: float | str | None = None,
        coefficient_curve: Iterable[tuple[float | str, float | str]] | None = None,
    ) -> None:
        """Validate, and keep plain floats and tuples."""
        forces = {"kinetic": kinetic, "static": static, "curve": curve}
        coefficients = {
            "coefficient": coefficient,
            "static_coefficient": static_coefficient,
            "coefficient_curve": coefficient_curve,
        }
        given = forces | coefficients
        by_coefficient = check_one_kind([name for name in given if given[name] is not None])
        chosen = coefficients if by_coefficient else forces
        found = dict(zip(chosen, _checked_friction(*chosen, *chosen.values()), strict=True))
        if by_coefficient:
            found["kinetic"] = nan  # the force that presses is not known yet
        for name in given:
            object.__setattr__(self, name, found.get(name))
        object.__setattr__(
            self, "stiffness", check("contact.stiffness", stiffness, label="stiffness")
        )

    def pressed_by(self, normal_force: float) -> Contact:
        """Return the contact with the friction forces of its coefficients under a normal force (N).

        Raises:
            ValueError: A force is out of its range.
        """
        mu, at_rest, rows = self.coefficient, self.static_coefficient, self.coefficient_curve
        assert mu is not None
        forces = Contact(
            mu * normal_force,
            None if at_rest is None else at_rest * normal_force,
            None if rows is None else [(speed, each * normal_force) for speed, each in rows],
            self.stiffness,
        )
        for name in COEFFICIENTS.values():
            object.__setattr__(forces, name, getattr(self, name))
        return forces

    @property
    def static_friction(self) -> float:
        """Largest friction force without sliding, N."""
        return self.kinetic if self.static is None else self.static

    @property
    def frictionless(self) -> bool:
        """True if the contact carries no force."""
        return self.static_friction == 0.0 and (
            self.curve is None or not any(force for _, force in self.curve)
        )

    @property
    def curved(self) -> bool:
        """True if friction depends on the sliding speed."""
        return self.curve is not None and len(self.curve) > 1

    def largest(self, speed: float) -> float:
        """Largest friction force at sliding speeds up to `speed` (m/s) and without sliding, N."""
        rows = self.curve or ()
        if len(rows) < 2:
            return self.static_friction
        forces = [force for u, force in rows if u <= speed]
        i = min(len(forces), len(rows) - 1)
        (u0, f0), (u1, f1) = rows[i - 1 : i + 1]
        forces.append(f0 + (f1 - f0) / (u1 - u0) * (speed - u0))
        return max([self.static_friction, *forces])

    @property
    def rigid(self) -> bool:
        """True if the surface does not stretch."""
        return isinf(self.stiffness)


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
            that of weight and preload (and the pull, by which a load multiplies it).
        finger: Friction of the resting fingertip on the pin; by a coefficient, of `touch_force`.
        preload: Force that presses the body on the plate beside weight and pull, N, from 0 to 1e12.
        touch_force: Force of the finger on the pin, N, from 0 to 1e12; for a finger given by a
            coefficient alone.
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
        travel: float | str | None = default("travel"),
        stop_stiffness: float | str | None = default("stop_stiffness"),
        stop_damping: float | str | None = default("stop_damping"),
    ) -> None:
        """Validate, and keep plain floats; coefficients become forces."""
        put = object.__setattr__
        put(self, "mass", check("mass", mass))
        put(self, "stiffness", check("stiffness", stiffness))
        put(self, "damping", self._damping_of(damping, damping_ratio))
        put(self, "plate", plate)
        put(self, "finger", finger)
        put(self, "preload", check("preload", preload))
        optional = {
            "touch_force": touch_force,
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
        ratios = _TABLE.rows["damping_ratio"].limits
        if float(f"{self.damping_ratio:.12g}") not in ratios:  # the parts of a ratio are rounded
            required = f"such that the damping ratio is {ratios.words()}"
            given = f"{self.damping!r} N*s/m, which makes it {self.damping_ratio:g}"
            raise ValueError(refusal("damping", required, given))
        check_stops(self.travel, self.stop_stiffness, self.stop_damping)
        for label, contact in (("plate", self.plate), ("finger", self.finger)):
            if not isinstance(contact, Contact):
                raise ValueError(refusal(label, "a Contact", repr(contact)))
            if label == "finger":
                check_touch(contact.coefficient is not None, self.touch_force)
            if contact.coefficient is not None:
                pressed = contact.pressed_by(normal_force(label, partial(getattr, self)))
                object.__setattr__(self, label, pressed)
                contact = pressed
            steepest = max(map(abs, slopes_of(contact.curve or ())), default=0.0)
            if steepest > ratios.upper * self._critical_damping:  # acts as damping
                most = f"at most {brief(ratios.upper)} times critical damping"
                raise ValueError(refusal(f"{label} curve slope", most, f"{steepest:g} N*s/m"))

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
    def normal_force(self) -> float:
        """Normal force on the plate without magnetic pull, N: weight and preload."""
        return float(normal_force("plate", partial(getattr, self)))

    @property
    def by_forces(self) -> Drive:
        """Return the drive with friction given by forces alone, which then remain fixed."""
        plate, finger = (
            Contact(c.kinetic, c.static, c.curve, c.stiffness) for c in (self.plate, self.finger)
        )
        return self.replace(plate=plate, finger=finger, touch_force=None)

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


def check_touch(by_coefficient: bool, touch_force: float | None) -> None:
    """Reject a finger coefficient without a touch force (N), and the reverse."""
    if by_coefficient and touch_force is None:
        required = "given where a coefficient gives the finger's friction"
        raise ValueError(refusal("touch_force", required, "none"))
    if not by_coefficient and touch_force is not None:
        required = "left out where the finger's friction is given as a force"
        raise ValueError(refusal("touch_force", required, f"{touch_force!r} N"))


def check_presses(touch: object, by_coefficient: bool, touch_force: float | None) -> float:
    """Refuse a touch force over time where friction does not follow it; the usual one, N."""
    if by_coefficient and touch_force:
        return touch_force
    friction = "no force" if by_coefficient else "given as a force"
    required = (
        f"left out where the finger's friction is {friction}; "
        "it needs finger.coefficient and a finger.touch_force greater than 0 N"
    )
    given = f"{touch!r} N" if isinstance(touch, float) else "one over time"
    raise ValueError(refusal("touch", required, given))


def check_stops(travel: float | None, stiffness: float | None, damping: float | None) -> None:
    """Refuse what describes end stops (m, N/m, N*s/m) without what they need."""
    for name, value, unit in (
        ("stop_stiffness", stiffness, "N/m"),
        ("stop_damping", damping, "N*s/m"),
    ):
        if value is not None and travel is None:
            required = "left out without travel, as there are no end stops"
            raise ValueError(refusal(name, required, f"{value!r} {unit}"))
    if damping and stiffness is None:
        required = "left out for rigid end stops; give stop_stiffness too"
        raise ValueError(refusal("stop_damping", required, f"{damping!r} N*s/m"))


def check_within_travel(displacement: float, travel: float | None, stiffness: float | None) -> None:
    """Refuse a displacement (m) beyond rigid end stops."""
    if travel is not None and stiffness is None and abs(displacement) > travel:
        required = f"at most travel, {travel!r} m, either way"
        raise ValueError(refusal("displacement", required, f"{displacement!r} m"))


def check_stretch(stretch: float, finger: Contact, load: float) -> None:
    """Refuse a stretch (m) that the finger's skin cannot have under a load."""
    given = f"{stretch!r} m"
    if finger.rigid:
        raise ValueError(refusal("skin_stretch", "left out for a rigid finger", given))
    largest = finger.static_friction * load / finger.stiffness
    if abs(stretch) > largest:
        required = f"at most static friction over stiffness, {largest!r} m, either way"
        raise ValueError(refusal("skin_stretch", required, given))


def check_one_kind(
    given: Sequence[str], table: str = "", where: Callable[[str], str] = lambda _: ""
) -> bool:
    """Refuse friction given both by forces and by coefficients; whether it is by coefficients.

    Args:
        given: Names of the given arguments.
        table: Table of the device file, for messages.
        where: Place of a key, for messages.
    """
    forces, coefficients = (
        [name for name in names if name in given]
        for names in zip(*COEFFICIENTS.items(), strict=True)
    )
    if not (forces and coefficients):
        return bool(coefficients)
    one, other = (f"{table}.{names[0]}".removeprefix(".") for names in (coefficients, forces))
    required, both = f"left out where {other} gives the friction as a force", [one, other]
    if where(one) != where(other):
        both = [f"{key} ({where(key)})" for key in both]
    raise ValueError(refusal(one, required, f"both, {' and '.join(both)}"))


def check_static(static: float, kinetic: float, name: str = "static") -> None:
    """Refuse static friction below kinetic friction, both forces (N) or coefficients."""
    unit = _unit_of(name)
    if static < kinetic:
        required = f"at least the kinetic {_NOUN[unit]}, {kinetic!r}{unit}"
        raise ValueError(refusal(name, required, f"{static!r}{unit}"))


def check_curve(rows: Sequence[tuple[float, float]], kinetic: float, name: str = "curve") -> None:
    """Refuse rows (m/s, N or coefficients) that do not start at speed 0 with the kinetic one."""
    unit = _unit_of(name)
    (speed, value), what = rows[0], "force" if unit else "coefficient"
    if speed != 0.0:
        raise ValueError(refusal(f"{name}[0] speed", "0 m/s", f"{speed!r} m/s"))
    if value != kinetic:
        required = f"the kinetic {_NOUN[unit]}, {kinetic!r}{unit}"
        raise ValueError(refusal(f"{name}[0] {what}", required, f"{value!r}{unit}"))


_NOUN: Final = {" N": "friction", "": "friction coefficient"}


def _unit_of(name: str) -> str:
    return "" if "coefficient" in name else " N"


def _checked_friction(
    of_kinetic: str, of_static: str, of_curve: str, kinetic: Any, static: Any, curve: Any
) -> tuple[float, float | None, tuple[tuple[float, float], ...] | None]:
    """Kinetic and static friction and a curve, by their names, forces or coefficients."""
    rows = None if curve is None else _checked_curve(curve, of_curve)
    if kinetic is None and rows is None:
        kind = "a number in N" if of_kinetic == "kinetic" else "a plain number"
        raise ValueError(refusal(of_kinetic, f"{kind} unless a curve is given", "None"))
    at_rest = rows[0][1] if kinetic is None and rows else check(of_kinetic, kinetic)
    if rows:
        check_curve(rows, at_rest, of_curve)
    if static is not None:
        static = check(of_static, static)
        check_static(static, at_rest, of_static)
    return at_rest, static, rows


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
    check_increasing(speeds, "m/s", label=f"{name}[{{}}] speed")
    found = tuple(zip(speeds, values, strict=True))
    check_slopes(found, _TABLE.rows[SLOPES[name]], label=name)
    return found


SLOPES: Final = {"curve": "curve.slope", "coefficient_curve": "curve.coefficient_slope"}
"""Slopes between the points of a friction curve."""
