"""A pin drive as data: the drive, its two contacts, and inputs that change over time. SI units."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import pairwise
from math import isnan, sqrt
from typing import TYPE_CHECKING, Any, overload

from pindrive.motion.contact import Contact, check_increasing, check_slopes, slopes_of
from pindrive.motion.friction import normal_force
from pindrive.quantities.quantity import brief, counted
from pindrive.quantities.table import QUANTITIES, check, checked, default, refusal
from pindrive.quantities.units import UnitError, quoted, to_si

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from pindrive.quantities.table import Number, OptionalNumber

__all__ = ["Contact", "Drive", "Profile"]


def check_times(
    times: Sequence[float],
    *,
    where: str = "",
    label: str | Callable[[int], str] = "[{}]",
    steps: bool = True,
    why: str = "",
) -> None:
    """Refuse times (s) of rows out of order; with `steps` two may be the same, never three.

    `label` is of the index of the one that is wrong, `why` says why there may be no step.
    """
    if not steps:
        check_increasing(times, "s", where=where, label=label, why=why)
        return
    named = label.format if isinstance(label, str) else label
    for i in range(1, len(times)):
        before, given = f"the one before, {times[i - 1]!r} s", f"{times[i]!r} s"
        if not times[i - 1] <= times[i]:
            raise ValueError(refusal(named(i), f"at least {before}", given, where))
        if i > 1 and times[i - 2] == times[i]:
            required = f"greater than {before}: two rows at one time are a step, a third is none"
            raise ValueError(refusal(named(i), required, given, where))


def check_continuous(name: str, velocity: Profile) -> None:
    """Refuse a velocity of the hand with a step: it would take an infinite force."""
    for t in velocity.steps:
        i = bisect_right(velocity.times, t)
        y, z = velocity.values[i - 2 : i]
        required = "without a step (a jump would take an infinite force)"
        given = f"one from {y!r} m/s to {z!r} m/s at {t!r} s"
        raise ValueError(refusal(name, required, given))


def check_touch(by_coefficient: bool, touch_force: float | None) -> None:
    """Refuse a coefficient of the finger without a touch force (N), or that without the other."""
    if by_coefficient and touch_force is None:
        required = "given where a coefficient gives the finger's friction"
        raise ValueError(refusal("touch_force", required, "none"))
    if not by_coefficient and touch_force is not None:
        required = "left out where the finger's friction is given as a force"
        raise ValueError(refusal("touch_force", required, f"{touch_force!r} N"))


def check_skin(finger: Contact) -> None:
    """Refuse a friction curve at a compliant finger, whose stretch is a third state."""
    if finger.curved and not finger.rigid:
        required = "one row for a compliant finger, whose skin would lag behind it"
        raise ValueError(refusal("finger.curve", required, counted(len(finger.curve or ()), "row")))


def check_finger_load(load: float | Profile, finger: Contact) -> None:
    """Refuse a load that changes on a finger with a stiffness or a curve."""
    if not isinstance(load, Profile) or not load.changes or (finger.rigid and not finger.curved):
        return
    required = "constant for a finger with " + ("a curve" if finger.rigid else "a stiffness")
    raise ValueError(refusal("finger_load", required, f"a Profile of {len(load.times)} rows"))


def check_stretch(stretch: float, finger: Contact, load: float) -> None:
    """Refuse a stretch (m) that the finger's skin cannot have under a load."""
    given = f"{stretch!r} m"
    if finger.rigid:
        raise ValueError(refusal("skin_stretch", "left out for a rigid finger", given))
    largest = finger.static_friction * load / finger.stiffness
    if abs(stretch) > largest:
        required = f"at most static friction over stiffness, {largest!r} m, either way"
        raise ValueError(refusal("skin_stretch", required, given))


@checked
class Drive:
    """A mass on a spring and a damper, rubbed by a plate and a fingertip.

    Every number may also be text with a unit, such as "12 g"; a bare number is SI.

    Args:
        mass: electromagnet and pin, kg, from 1e-12 to 1e12.
        stiffness: of the spring, N/m, from 1e-12 to 1e12.
        damping: viscous, N*s/m, from 0 to 1e12; the damping ratio is 0 or from 1e-11 to 1e6.
        plate: friction of the moving plate on the electromagnet; given by a coefficient it is
            that of weight and preload (and the pull, by which a load multiplies it).
        finger: friction of the resting fingertip on the pin; by a coefficient, of `touch_force`.
        preload: what presses the electromagnet on the plate beside weight and pull, N, from 0 to
            1e12.
        touch_force: with which the finger presses on the pin, N, from 0 to 1e12; for a finger
            given by a coefficient alone.

    Raises:
        ValueError: a value is no number or out of its range.
    """

    mass: Number
    stiffness: Number
    damping: Number
    plate: Contact
    finger: Contact
    preload: Number = default("preload")
    touch_force: OptionalNumber = default("touch_force")

    def __post_init__(self) -> None:
        """Validate what follows from them; coefficients become forces."""
        ratios = QUANTITIES["damping_ratio"].limits
        if (
            float(f"{self.damping_ratio:.12g}") not in ratios
        ):  # what a ratio was made from is rounded
            required = f"such that the damping ratio is {ratios.words()}"
            given = f"{self.damping!r} N*s/m, which makes it {self.damping_ratio:g}"
            raise ValueError(refusal("damping", required, given))
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
            if steepest > ratios.upper * self._critical_damping:  # it acts as damping does
                most = f"at most {brief(ratios.upper)} times critical damping"
                raise ValueError(refusal(f"{label} curve slope", most, f"{steepest:g} N*s/m"))

    @classmethod
    def with_damping_ratio(
        cls,
        *,
        mass: float | str,
        stiffness: float | str,
        damping_ratio: float | str,
        plate: Contact,
        finger: Contact,
        preload: float | str = default("preload"),
        touch_force: float | str | None = None,
    ) -> Drive:
        """A drive whose damping is given as a fraction of the critical one, 0 or from 1e-11 to 1e6.

        Raises:
            ValueError: as for `Drive`.
        """
        mass, stiffness = check("mass", mass), check("stiffness", stiffness)
        damping = 2.0 * check("damping_ratio", damping_ratio) * sqrt(mass) * sqrt(stiffness)
        return cls(
            mass=mass,
            stiffness=stiffness,
            damping=damping,
            plate=plate,
            finger=finger,
            preload=preload,
            touch_force=touch_force,
        )

    @property
    def normal_force(self) -> float:
        """What presses the electromagnet on the plate without any pull, N: weight and preload."""
        return float(normal_force("plate", partial(getattr, self)))

    @property
    def by_forces(self) -> Drive:
        """The same, its friction given by forces alone, which then stay as they are."""
        plate, finger = (
            Contact(c.kinetic, c.static, c.curve, c.stiffness) for c in (self.plate, self.finger)
        )
        return replace(self, plate=plate, finger=finger, touch_force=None)

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


@dataclass(frozen=True, slots=True, init=False)
class Profile:
    """A quantity over time: linear between its rows, constant before the first and after the last.

    Two rows at one time are a step: from that time on the later one holds. A load may have steps, a
    velocity may not.

    Args:
        times: s, or text with a unit, from -1e12 to 1e12, none less than the one before, no three
            alike; at least one.
        values: one for each time, SI, or text with a unit, such as "60 mm/s", from -1e12 to 1e12,
            as is the rate between two rows.

    Attributes:
        unit: the SI unit of values that were text, empty where none was: `Release` refuses those of
            another quantity.

    Raises:
        ValueError: lengths differ, times decrease, a number or a rate is out of range, or a text is
            in no unit of a quantity that may change over time.
    """

    times: tuple[float, ...]
    values: tuple[float, ...]
    unit: str = field(compare=False, repr=False)

    def __init__(self, times: Iterable[float | str], values: Iterable[float | str]) -> None:
        """Validate, and keep tuples of plain floats."""
        unit, numbers = _in_si(_listed(values))
        t = _column(_listed(times), "profile.time", "times")
        y = _column(numbers, "profile.value", "values")
        if not t:
            raise ValueError(refusal("times", "at least one", "none"))
        if len(t) != len(y):
            raise ValueError(refusal("values", f"as many as times, {len(t)}", len(y)))
        check_times(t, label="times[{}]")
        check_slopes(list(zip(t, y, strict=True)), "profile.rate", label="profile")
        object.__setattr__(self, "times", t)
        object.__setattr__(self, "values", y)
        object.__setattr__(self, "unit", unit)

    @property
    def changes(self) -> bool:
        """Whether it takes more than one value."""
        return any(value != self.values[0] for value in self.values)

    @property
    def steps(self) -> tuple[float, ...]:
        """The times at which its value jumps, s."""
        return tuple(t for (t, y), (after, z) in pairwise(self.rows) if t == after and y != z)

    @property
    def rows(self) -> tuple[tuple[float, float], ...]:
        """Its rows (time, value), SI."""
        return tuple(zip(self.times, self.values, strict=True))

    @overload
    def __call__(self, t: float) -> float: ...
    @overload
    def __call__(self, t: ArrayLike) -> NDArray[np.float64]: ...
    def __call__(self, t: ArrayLike) -> float | NDArray[np.float64]:
        """The value at time t (s): a float for a float, an array of the same shape for an array.

        At a step it is the value after it.
        """
        if not isinstance(t, (float, int)):
            import numpy as np

            return np.interp(np.asarray(t, dtype=np.float64), self.times, self.values)
        i = bisect_right(self.times, t)
        if i == 0 or i == len(self.times):
            return self.values[max(i - 1, 0)]
        (t0, t1), (y0, y1) = self.times[i - 1 : i + 1], self.values[i - 1 : i + 1]
        return y0 + (y1 - y0) * ((t - t0) / (t1 - t0))


def _listed(values: Iterable[float | str]) -> list[Any]:
    try:
        return values.tolist() if hasattr(values, "tolist") else list(values)
    except TypeError:
        raise ValueError(refusal("a profile", "sequences of numbers", repr(values))) from None


def _in_si(values: list[Any]) -> tuple[str, list[Any]]:
    """The SI unit of values of which some are text, empty where none is, and all of them in SI."""
    if str not in set(map(type, values)):
        return "", values
    over_time = [quantity for quantity in QUANTITIES.values() if quantity.rows_of == "profile"]
    first = {quantity.unit: quantity for quantity in reversed(over_time)}  # of each unit
    units = [*dict.fromkeys(quantity.unit for quantity in over_time)]
    for unit in units:
        with suppress(UnitError):
            return unit, [to_si(y, unit, "") if isinstance(y, str) else y for y in values]
    usual = " or all like ".join(quoted(first[unit].usual) for unit in units)
    texts = ", ".join(quoted(y) for y in values if isinstance(y, str))
    raise ValueError(refusal("values", f"numbers in SI, or text all like {usual}", texts))


def _column(values: list[Any], name: str, label: str) -> tuple[float, ...]:
    """Numbers of the quantity called `name`, each checked; plain finite floats all at once."""
    bounds = QUANTITIES[name].limits
    plain = set(map(type, values)) == {float} and not any(map(isnan, values))
    if plain and min(values) in bounds and max(values) in bounds:
        return tuple(values)
    return tuple(check(name, y, label=f"{label}[{i}]") for i, y in enumerate(values))
