"""A contact as data: dry friction by forces or by coefficients, and stiffness. SI units."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import islice, pairwise
from math import copysign, inf, isinf, nan
from operator import lt
from typing import Any, Final

from pindrive.motion.friction import COEFFICIENTS
from pindrive.quantities.table import QUANTITIES, check, refusal

__all__ = ["Contact"]


@dataclass(frozen=True, slots=True, init=False)
class Contact:
    """Dry friction between the pin drive and a surface: the plate or the fingertip.

    Every number may also be text with a unit, such as "20 mN"; a bare number is SI. Friction is
    given by forces, or by coefficients: friction over the force that presses, which a `Drive`
    knows. The forces of such a contact are NaN until it is part of one.

    Args:
        kinetic: friction force while sliding, N, from 0 to 1e12; 0 with no static friction is no
            contact at all. None with a curve: its first force.
        static: largest friction force without sliding, N, from `kinetic` to 1e12; `kinetic` if
            None.
        curve: kinetic friction over sliding speed as rows (speed in m/s, force in N), speeds
            increasing from 0, linear between rows and on beyond the last; its first force is
            `kinetic`. None: `kinetic` at every speed (Coulomb).
        stiffness: tangential stiffness of the surface, N/m, from 1e-12 to 1e12; infinite: rigid.
        coefficient: kinetic friction over the force that presses, from 0 to 1e12, in place of
            `kinetic`. None with a curve of coefficients: its first.
        static_coefficient: the same at rest, in place of `static`; `coefficient` if None.
        coefficient_curve: rows (speed in m/s, coefficient), in place of `curve`.

    Raises:
        ValueError: a value is no number or out of its range, static friction is below kinetic,
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
        """The same, given by coefficients, with the friction forces under a normal force (N).

        Raises:
            ValueError: a force is out of its range.
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
        """Whether the contact carries no force at all."""
        return self.static_friction == 0.0 and (
            self.curve is None or not any(force for _, force in self.curve)
        )

    @property
    def curved(self) -> bool:
        """Whether friction depends on the sliding speed."""
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
        """Whether the surface gives way by sliding alone."""
        return isinf(self.stiffness)


def check_one_kind(
    given: Sequence[str], table: str = "", where: Callable[[str], str] = lambda _: ""
) -> bool:
    """Refuse friction given both by forces and by coefficients; whether it is by coefficients.

    Args:
        given: which of them are.
        table: of the device file, for the message.
        where: where a key was written, for the message.
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
    check_slopes(found, SLOPES[name], label=name)
    return found


SLOPES: Final = {"curve": "curve.slope", "coefficient_curve": "curve.coefficient_slope"}
"""What the slopes between the rows of a curve are."""


def check_increasing(
    values: Sequence[float],
    unit: str,
    *,
    where: str = "",
    label: str | Callable[[int], str] = "[{}]",
    why: str = "",
) -> None:
    """Refuse values of which one is not greater than the one before; `label` is of its index."""
    if all(map(lt, values, islice(values, 1, None))):
        return
    named = label.format if isinstance(label, str) else label
    for i in range(1, len(values)):
        if not values[i - 1] < values[i]:
            required = f"greater than the one before, {values[i - 1]!r} {unit}{why}"
            raise ValueError(refusal(named(i), required, f"{values[i]!r} {unit}", where))


def slopes_of(rows: Sequence[tuple[float, float]]) -> list[float]:
    """The slopes between rows but for steps; infinite where the quotient overflows."""
    return [
        (y1 - y0) / (x1 - x0) if x1 - x0 > abs(y1 - y0) * 1e-300 else copysign(inf, y1 - y0)
        for (x0, y0), (x1, y1) in pairwise(rows)
        if x1 > x0
    ]


def check_slopes(
    rows: Sequence[tuple[float, float]], name: str, *, where: str = "", label: str
) -> None:
    """Refuse rows of which two lie so close that the slope between them is out of range."""
    bounds = QUANTITIES[name].limits
    slopes = slopes_of(rows)
    if all(bounds.lower <= slope <= bounds.upper for slope in slopes):
        return
    worst = max(slopes, key=abs)
    unit = QUANTITIES[name].unit
    shown = f"{worst:g} {unit}"
    raise ValueError(refusal(f"{label} slope", bounds.words(unit), shown, where))
