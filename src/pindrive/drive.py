"""A pin drive as data: the drive, its two contacts, and inputs that change over time. SI units."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import inf, isinf, sqrt
from typing import TYPE_CHECKING, overload

from pindrive.quantities import check, refusal

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

__all__ = ["Contact", "Drive", "Profile"]


@dataclass(frozen=True, slots=True)
class Contact:
    """Dry friction between the pin drive and a surface: the plate or the fingertip.

    Args:
        kinetic: friction force while sliding, N, at least 0; 0 with no static friction is no
            contact at all.
        static: largest friction force without sliding, N, at least `kinetic`; `kinetic` if None.
        curve: kinetic friction over sliding speed as rows (speed in m/s, force in N), speeds
            increasing from 0, linear between rows and on beyond the last; its first force is
            `kinetic`. None: `kinetic` at every speed (Coulomb).
        stiffness: tangential stiffness of the surface, N/m, greater than 0; infinite: rigid.

    Raises:
        ValueError: a value is no number or out of its range, static friction is below kinetic.
    """

    kinetic: float
    static: float | None = None
    curve: Sequence[tuple[float, float]] | None = None
    stiffness: float = inf

    def __post_init__(self) -> None:
        """Validate, and keep plain floats and tuples."""
        kinetic = check("kinetic", self.kinetic)
        object.__setattr__(self, "kinetic", kinetic)
        if self.static is not None:
            static = check("static", self.static)
            check_static(static, kinetic)
            object.__setattr__(self, "static", static)
        if self.curve is not None:
            object.__setattr__(self, "curve", _checked_curve(self.curve, kinetic))
        stiffness = check("contact.stiffness", self.stiffness, label="stiffness")
        object.__setattr__(self, "stiffness", stiffness)

    @property
    def static_friction(self) -> float:
        """Largest friction force without sliding, N."""
        return self.kinetic if self.static is None else self.static

    @property
    def frictionless(self) -> bool:
        """Whether the contact carries no force at all: it is as good as absent."""
        return self.static_friction == 0.0 and (
            self.curve is None or not any(force for _, force in self.curve)
        )

    @property
    def regions(self) -> tuple[tuple[float, float, float, float], ...]:
        """The curve as (from speed, to speed, force at from, slope), empty if Coulomb.

        The last slope goes on; where it falls, until the force is zero: friction never pushes.
        """
        if self.curve is None or len(self.curve) == 1:
            return ()
        rows = list(self.curve)
        slopes = [(f1 - f0) / (u1 - u0) for (u0, f0), (u1, f1) in pairwise(rows)]
        speed, force = rows[-1]
        if slopes[-1] < 0.0:
            if force > 0.0:
                slopes.append(slopes[-1])
                rows.append((speed - force / slopes[-1], 0.0))
            slopes.append(0.0)
        else:
            slopes.append(slopes[-1])
        ends = [u for u, _ in rows[1:]] + [inf]
        return tuple(
            (u, end, f, slope) for (u, f), end, slope in zip(rows, ends, slopes, strict=True)
        )

    @property
    def rigid(self) -> bool:
        """Whether the surface gives way by sliding alone."""
        return isinf(self.stiffness)


def check_static(
    static: float, kinetic: float, *, where: str = "", label: str = "static", given: str = ""
) -> None:
    """Refuse static friction below kinetic friction (both N)."""
    if static < kinetic:
        required = f"at least the kinetic friction, {kinetic!r} N"
        raise ValueError(refusal(label, required, given or f"{static!r} N", where))


def _checked_curve(
    curve: Iterable[tuple[float, float]], kinetic: float
) -> tuple[tuple[float, float], ...]:
    try:
        rows = [(speed, force) for speed, force in curve]
    except (TypeError, ValueError):
        raise ValueError(refusal("curve", "rows of (speed, force)", repr(curve))) from None
    if not rows:
        raise ValueError(refusal("curve", "at least one row of (speed, force)", "none"))
    speeds = [
        check("curve.speed", speed, label=f"curve[{i}] speed") for i, (speed, _) in enumerate(rows)
    ]
    forces = [
        check("curve.force", force, label=f"curve[{i}] force") for i, (_, force) in enumerate(rows)
    ]
    _check_increasing(speeds, "curve[{}] speed", "m/s")
    if speeds[0] != 0.0:
        raise ValueError(refusal("curve[0] speed", "0 m/s", f"{speeds[0]!r} m/s"))
    if forces[0] != kinetic:
        required = f"the kinetic friction, {kinetic!r} N"
        raise ValueError(refusal("curve[0] force", required, f"{forces[0]!r} N"))
    return tuple(zip(speeds, forces, strict=True))


def _check_increasing(values: Sequence[float], label: str, unit: str) -> None:
    for i in range(1, len(values)):
        if not values[i - 1] < values[i]:
            required = f"greater than the one before, {values[i - 1]!r} {unit}"
            raise ValueError(refusal(label.format(i), required, f"{values[i]!r} {unit}"))


@dataclass(frozen=True, slots=True, kw_only=True)
class Drive:
    """A mass on a spring and a damper, rubbed by a plate and a fingertip.

    Args:
        mass: electromagnet and pin, kg, greater than 0.
        stiffness: of the spring, N/m, greater than 0.
        damping: viscous, N*s/m, at least 0.
        plate: friction of the moving plate on the electromagnet.
        finger: friction of the resting fingertip on the pin.

    Raises:
        ValueError: a value is no number or out of its range.
    """

    mass: float
    stiffness: float
    damping: float
    plate: Contact
    finger: Contact

    def __post_init__(self) -> None:
        """Validate, and keep plain floats."""
        object.__setattr__(self, "mass", check("mass", self.mass))
        object.__setattr__(self, "stiffness", check("stiffness", self.stiffness))
        object.__setattr__(self, "damping", check("damping", self.damping))
        # Each in range, yet their quotient may overflow: no closed form could be computed then.
        check("natural_frequency", self.natural_frequency)
        check("damping_ratio", self.damping_ratio)
        for label, contact in (("plate", self.plate), ("finger", self.finger)):
            if not isinstance(contact, Contact):
                raise ValueError(refusal(label, "a Contact", repr(contact)))

    @classmethod
    def with_damping_ratio(
        cls,
        *,
        mass: float,
        stiffness: float,
        damping_ratio: float,
        plate: Contact,
        finger: Contact,
    ) -> Drive:
        """A drive whose damping is given as a fraction of the critical one, at least 0.

        Raises:
            ValueError: as for `Drive`.
        """
        mass, stiffness = check("mass", mass), check("stiffness", stiffness)
        damping = 2.0 * check("damping_ratio", damping_ratio) * sqrt(mass) * sqrt(stiffness)
        return cls(mass=mass, stiffness=stiffness, damping=damping, plate=plate, finger=finger)

    @property
    def natural_frequency(self) -> float:
        """Undamped natural frequency sqrt(k/m), rad/s."""
        return sqrt(self.stiffness / self.mass)

    @property
    def damping_ratio(self) -> float:
        """Damping over critical damping, b / (2 sqrt(m k)): below 1 the drive oscillates."""
        return self.damping / (2.0 * sqrt(self.mass) * sqrt(self.stiffness))


@dataclass(frozen=True, slots=True)
class Profile:
    """A quantity over time: linear between its rows, constant before the first and after the last.

    Args:
        times: s, finite, strictly increasing, at least one.
        values: one for each time, SI, finite.

    Raises:
        ValueError: lengths differ, times do not increase, a number is not finite.
    """

    times: Sequence[float]
    values: Sequence[float]

    def __post_init__(self) -> None:
        """Validate, and keep tuples of plain floats."""
        times = tuple(check("profile.time", t, label=f"times[{i}]") for i, t in _rows(self.times))
        values = tuple(
            check("profile.value", y, label=f"values[{i}]") for i, y in _rows(self.values)
        )
        if not times:
            raise ValueError(refusal("times", "at least one", "none"))
        if len(times) != len(values):
            raise ValueError(refusal("values", f"as many as times, {len(times)}", len(values)))
        _check_increasing(times, "times[{}]", "s")
        object.__setattr__(self, "times", times)
        object.__setattr__(self, "values", values)

    @overload
    def __call__(self, t: float) -> float: ...
    @overload
    def __call__(self, t: ArrayLike) -> NDArray[np.float64]: ...
    def __call__(self, t: ArrayLike) -> float | NDArray[np.float64]:
        """The value at time t (s): a float for a float, an array of the same shape for an array."""
        if not isinstance(t, (float, int)):
            import numpy as np

            return np.interp(np.asarray(t, dtype=np.float64), self.times, self.values)
        i = bisect_right(self.times, t)
        if i == 0 or i == len(self.times):
            return self.values[max(i - 1, 0)]
        (t0, t1), (y0, y1) = self.times[i - 1 : i + 1], self.values[i - 1 : i + 1]
        return y0 + (y1 - y0) * ((t - t0) / (t1 - t0))


def _rows(values: Iterable[float]) -> Iterable[tuple[int, float]]:
    try:
        return enumerate(values)
    except TypeError:
        raise ValueError(refusal("a profile", "sequences of numbers", repr(values))) from None
