"""A simulated motion: closed forms that are evaluated at any time, events, and the numbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from functools import cached_property
from math import inf, nan
from typing import TYPE_CHECKING, Any, Final, Literal, overload

import numpy as np

from pindrive import _core, budgets
from pindrive.drive import (
    Drive,
    Profile,
    check_continuous,
    check_load,
    check_skin,
    check_stretch,
)
from pindrive.events import (
    Crossings,
    Event,
    Extrema,
    QuantityName,
    Segment,
    Table,
    events_at,
    events_of,
    segments_of,
)
from pindrive.plausible import warn_of
from pindrive.quantities import INPUTS, QUANTITIES, check, refusal
from pindrive.quantity import brief, counted
from pindrive.transient import Certificate, ContactUse, Ending, Ledger, Transient

if TYPE_CHECKING:
    from collections.abc import Callable

    import xarray as xr
    from numpy.typing import ArrayLike, NDArray

    from pindrive.sensitivity import Sensitivity
    from pindrive.style import Figure

__all__ = ["Crossings", "Event", "Extrema", "Motion", "Segment", "simulate"]

Side = Literal["left", "right"]
Rows = Sequence[tuple[float, float]]
ContactNumbers = tuple[float, float, float, Rows]
CoreNumbers = tuple[
    float, float, float, ContactNumbers, ContactNumbers, Rows, Rows, float, float, float, float
]
"""In the order of `Numbers` in _core.cpp."""
ContactName = Literal["plate", "finger"]
_QUANTITIES: Final = ("position", "velocity", "acceleration")
"""In the order of `Quantity` in crossings.hpp."""

_SEEN = {quantity.name: quantity.seen for quantity in INPUTS if quantity.seen}
_GLANCE = (
    *(end for name in ("mass", "stiffness") for end in (_SEEN[name].lower, _SEEN[name].upper)),
    *(_SEEN[name].upper for name in ("damping", "plate.static", "finger.static")),
    *(_SEEN["finger.stiffness"].lower, _SEEN["finger.stiffness"].upper),
    *(_SEEN[name].upper for name in ("mouse_velocity", "plate_load", "displacement", "velocity")),
    *(_SEEN["duration"].lower, _SEEN["duration"].upper),
)
"""What any device has, in the order of `_plausible`."""


class Motion:
    """What a pin does after its release, exactly: made by `simulate`.

    Attributes:
        drive: the drive that was simulated.
        mouse_velocity: the plate's velocity in the housing, m/s, constant or a `Profile`.
        displacement: x(0), m.
        initial_velocity: x'(0), m/s.
        plate_load: factor on the plate's friction, constant or a `Profile`.
        skin_stretch: stretch of a compliant finger that gripped at the start, m; None: not given.
        starts_with_plate: whether x'(0) is the plate's velocity because no other was given.
        settling_band: half the band about the end that counts as settled, a part of
            |x(0) - x_end|.
        core_numbers: the same as the core takes them.
        duration: s; the one asked for, or long enough to see the ending.
    """

    def __init__(
        self,
        numbers: CoreNumbers,
        drive: Drive,
        mouse_velocity: float | Profile,
        displacement: float,
        initial_velocity: float,
        plate_load: float | Profile,
        skin_stretch: float | None,
        starts_with_plate: bool,
        settling_band: float = _core.settling_band,
    ) -> None:
        self.core_numbers = numbers
        self._core = core = _core.simulate(*numbers)
        self.drive = drive
        self.mouse_velocity = mouse_velocity
        self.displacement = displacement
        self.initial_velocity = initial_velocity
        self.plate_load = plate_load
        self.skin_stretch = skin_stretch
        self.starts_with_plate = starts_with_plate
        self.settling_band = settling_band
        self.duration: float = core.duration(settling_band)

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled as what was simulated: the rest follows from it."""
        given = (self.mouse_velocity, self.displacement, self.initial_velocity, self.plate_load)
        start = (self.skin_stretch, self.starts_with_plate, self.settling_band)
        return Motion, (self.core_numbers, self.drive, *given, *start)

    def __repr__(self) -> str:
        """How it ends, and after how long, in a line."""
        return (
            f"<Motion of {self.duration:.6g} s, {counted(len(self.events), 'event')}, "
            f"{self.ending.kind}, settling time {self.transient.settling_time:.6g} s>"
        )

    # ---- the motion over time --------------------------------------------------------------------

    @overload
    def position(self, t: float, side: Side = ...) -> float: ...
    @overload
    def position(self, t: ArrayLike, side: Side = ...) -> NDArray[np.float64]: ...
    def position(self, t: ArrayLike, side: Side = "right") -> float | NDArray[np.float64]:
        """Deflection x of the pin from the spring's rest, m.

        Args:
            t: s, any shape, from 0 on; beyond `duration` where the ending is known.
            side: which limit to take at an event.

        Raises:
            ValueError: a time is negative, NaN, or later than the motion is known.
        """
        return self._evaluate(self._core.position, t, side)

    @overload
    def velocity(self, t: float, side: Side = ...) -> float: ...
    @overload
    def velocity(self, t: ArrayLike, side: Side = ...) -> NDArray[np.float64]: ...
    def velocity(self, t: ArrayLike, side: Side = "right") -> float | NDArray[np.float64]:
        """Velocity x' of the pin in the housing, m/s; arguments as for `position`."""
        return self._evaluate(self._core.velocity, t, side)

    @overload
    def acceleration(self, t: float, side: Side = ...) -> float: ...
    @overload
    def acceleration(self, t: ArrayLike, side: Side = ...) -> NDArray[np.float64]: ...
    def acceleration(self, t: ArrayLike, side: Side = "right") -> float | NDArray[np.float64]:
        """Acceleration x'' of the pin in the housing, m/s²; it jumps where friction does."""
        return self._evaluate(self._core.acceleration, t, side)

    @overload
    def force(self, contact: ContactName, t: float, side: Side = ...) -> float: ...
    @overload
    def force(
        self, contact: ContactName, t: ArrayLike, side: Side = ...
    ) -> NDArray[np.float64]: ...
    def force(
        self, contact: ContactName, t: ArrayLike, side: Side = "right"
    ) -> float | NDArray[np.float64]:
        """Friction force of the plate or the finger on the pin, N; `t` and `side` as above."""
        if contact not in ("plate", "finger"):
            raise ValueError(refusal("contact", '"plate" or "finger"', repr(contact)))
        of_contact = self._core.plate_force if contact == "plate" else self._core.finger_force
        return self._evaluate(of_contact, t, side)

    @overload
    def stretch(self, t: float, side: Side = ...) -> float: ...
    @overload
    def stretch(self, t: ArrayLike, side: Side = ...) -> NDArray[np.float64]: ...
    def stretch(self, t: ArrayLike, side: Side = "right") -> float | NDArray[np.float64]:
        """Stretch of a compliant finger's skin, m, the way of x; 0 for a rigid finger.

        The force on the skin is `-force("finger", t)`.
        """
        return self._evaluate(self._core.stretch, t, side)

    @overload
    def stretch_rate(self, t: float, side: Side = ...) -> float: ...
    @overload
    def stretch_rate(self, t: ArrayLike, side: Side = ...) -> NDArray[np.float64]: ...
    def stretch_rate(self, t: ArrayLike, side: Side = "right") -> float | NDArray[np.float64]:
        """How fast the skin of a compliant finger stretches, m/s."""
        return self._evaluate(self._core.stretch_rate, t, side)

    def plate_velocity(self, t: ArrayLike) -> NDArray[np.float64]:
        """The plate's velocity v_p(t) in the housing, m/s, in the shape of t."""
        times = _times(t)
        if isinstance(self.mouse_velocity, Profile):
            return self.mouse_velocity(times)
        return np.full_like(times, self.mouse_velocity)

    def _evaluate(
        self,
        closed_form: Callable[[NDArray[np.float64], bool], NDArray[np.float64]],
        t: ArrayLike,
        side: Side,
    ) -> float | NDArray[np.float64]:
        if side not in ("left", "right"):
            raise ValueError(refusal("side", '"left" or "right"', repr(side)))
        times = self._known(t, "t")
        values = closed_form(np.ascontiguousarray(times).ravel(), side == "right")
        return float(values[0]) if times.ndim == 0 else values.reshape(times.shape)

    def _known(self, t: ArrayLike, name: str) -> NDArray[np.float64]:
        """Times at which the motion is known."""
        times = _times(t)
        known = self._core.known_until
        good = (times >= 0.0) & (times <= known) & (times < inf)
        if not good.all():
            required = f"from 0 s to {known!r} s" if known < inf else "finite and at least 0 s"
            raise ValueError(refusal(name, required, f"{float(times[~good].flat[0])!r} s"))
        return times

    # ---- what happened ---------------------------------------------------------------------------

    @cached_property
    def _table(self) -> Table:
        return self._core.segments()

    @cached_property
    def events(self) -> tuple[Event, ...]:
        """Every change at a contact, in order, the plate's first; of a cycle, one round of it."""
        return events_of(self._table, lambda t: (self.position(t), self.velocity(t)))

    def events_between(self, begin: float, end: float) -> tuple[Event, ...]:
        """Every change at a contact from `begin` to `end`, both included, with cycles expanded.

        Args:
            begin: s, at least 0.
            end: s, at least `begin`; beyond `duration` where the ending is known.

        Returns:
            The events in order, the plate's first.

        Raises:
            ValueError: a time is negative, NaN, or later than the motion is known; `begin` is
                after `end`; or there are more events than the budget.
        """
        begin, end = (
            float(self._known(time, name)) for time, name in ((begin, "begin"), (end, "end"))
        )
        if not begin <= end:
            raise ValueError(refusal("begin", f"at most end ({end!r} s)", f"{begin!r} s"))
        times, ended = self._core.events(begin, end, budgets.MOMENTS.most + 1)
        budgets.MOMENTS.check(len(times), f"events from {begin:g} s to {end:g} s")
        kinds = np.stack([self._table["plate_event"], self._table["finger_event"]], axis=-1)[ended]
        states = zip(self.position(times).tolist(), self.velocity(times).tolist(), strict=True)
        rows = zip(times.tolist(), kinds.tolist(), states, strict=True)
        return tuple(event for row in rows for event in events_at(*row))

    def extrema(self, which: QuantityName) -> Extrema:
        """Times and values of the extrema of a quantity over [0, duration], exactly.

        They are where the motion begins and ends, where the quantity turns, and both sides of a
        jump: between two neighbours it is continuous and does not turn. A quantity that rests
        before it turns back has its extremum where it comes to rest.

        Args:
            which: "position", "velocity" or "acceleration".

        Returns:
            The times (s) and the values (m, m/s or m/s²), shape (n,).

        Raises:
            ValueError: another quantity; more extrema than the budget.
        """
        index = _quantity(which)
        found = Extrema(*self._core.extrema(index, self.duration, budgets.MOMENTS.most + 1))
        budgets.MOMENTS.check(len(found.time), f"extrema of the {which} in {self.duration:g} s")
        return found

    def crossings(self, which: QuantityName, level: float) -> Crossings:
        """Times and directions of the crossings of a level over [0, duration], exactly.

        A crossing leads from one side of the level to the other. Touching it is none; a quantity
        that rests at the level and goes on crosses it where it comes to rest.

        Args:
            which: "position", "velocity" or "acceleration".
            level: m, m/s or m/s².

        Returns:
            The times (s) and the directions, 1 or -1 in turn, shape (n,).

        Raises:
            ValueError: another quantity; a level that is not finite; more crossings than the
                budget.
        """
        index = _quantity(which)
        if not -inf < level < inf:
            raise ValueError(refusal("level", "finite", repr(level)))
        found = Crossings(
            *self._core.crossings(index, float(level), self.duration, budgets.MOMENTS.most + 1)
        )
        budgets.MOMENTS.check(len(found.time), f"crossings by the {which} in {self.duration:g} s")
        return found

    @property
    def segment_count(self) -> int:
        """How many segments there are, without making them."""
        return self._core.segment_count

    @cached_property
    def segments(self) -> tuple[Segment, ...]:
        """The modes in order, each one closed form; of a stick-slip cycle, one round of it."""
        return segments_of(self._table)

    @cached_property
    def status(self) -> str:
        """Either "ok", or what stopped the simulation and what to do about it."""
        if self._core.status == 0:
            return "ok"
        at = f"stopped at t = {self._core.until:.6g} s"
        report = "change a parameter by a little, and please report the drive"
        return {
            1: (
                f"stopped after {_core.event_limit} events at t = {self._core.until:.6g} s: "
                "friction and damping are too weak to end the motion; give a shorter duration"
            ),
            2: f"{at}: events pile up at one instant; {report}",
            3: f"{at}, as was asked: run it again to see the rest",
            4: f"{at}: no mode agrees with the state; {report}",
        }[self._core.status]

    # ---- the numbers -----------------------------------------------------------------------------

    @cached_property
    def _numbers(self) -> dict[str, Any]:
        return self._core.transient(self.duration, self.settling_band)

    @cached_property
    def transient(self) -> Transient:
        """The transient's numbers, from the closed forms."""
        numbers = {k: v for k, v in self._numbers.items() if k not in ("end_position", "amplitude")}
        plate, finger = ContactUse(**numbers.pop("plate")), ContactUse(**numbers.pop("finger"))
        return Transient(**numbers, plate=plate, finger=finger)

    @cached_property
    def ending(self) -> Ending:
        """How the motion ends."""
        return Ending.of(self._core, self._numbers)

    def settling_time(self, band: float = _core.settling_band) -> float:
        """The settling time (s) for another band, a part of |x(0) - x_end|; NaN if none.

        The band is above 0 and at most 1.
        """
        band = check("settling_band", band, label="band")
        return float(self._core.transient(self.duration, band)["settling_time"])

    @cached_property
    def energy(self) -> Ledger:
        """The energy ledger over [0, duration]."""
        return Ledger(**self._core.ledger(self.duration))

    def certificate(self) -> Certificate:
        """The worst residual of each law over [0, duration], computed without the solver."""
        return Certificate(**self._core.certificate(self.duration))

    def plot(self) -> Figure:
        """The motion over time and in the phase plane, as a figure that a notebook shows.

        Returns:
            A figure of 180 mm by 125 or, with skin, 150 mm; `figure.savefig(FILE)` writes it.
        """
        from pindrive.plots import plot_motion

        return plot_motion(self)

    # ---- for other programs ----------------------------------------------------------------------

    def sample_times(self, count: int = 1001) -> NDArray[np.float64]:
        """`count` even times over [0, duration] and the events among them, s, shape (n,)."""
        if not count >= 2:
            raise ValueError(refusal("count", "at least 2", repr(count)))
        even = np.linspace(0.0, self.duration, count)
        events = self._table["end"]
        return np.union1d(even, events[events <= self.duration])

    def to_dataset(self, times: ArrayLike | None = None) -> xr.Dataset:
        """The motion over time, its events and its numbers, with units, as an xarray Dataset.

        Args:
            times: s, shape (n,); `sample_times()` unless given.

        Returns:
            Variables over `time` (right-hand limits) and over `event`; one scalar for each number;
            the drive and the release in the attributes.
        """
        from pindrive.dataset import dataset

        t = self.sample_times() if times is None else np.atleast_1d(_times(times))
        if t.ndim != 1:
            raise ValueError(refusal("times", "of one dimension", f"{t.ndim}"))
        return dataset(self, t)

    def inputs(self) -> dict[str, float | tuple[tuple[float, float], ...]]:
        """What was simulated, SI, by the names of the table of quantities.

        A curve or an input that changes is its rows: (speed, force) or (time, value).
        """
        drive = self.drive
        values: dict[str, float | tuple[tuple[float, float], ...]] = {
            "mass": drive.mass,
            "stiffness": drive.stiffness,
            "damping": drive.damping,
        }
        for name, contact in (("plate", drive.plate), ("finger", drive.finger)):
            values[f"{name}.kinetic"] = contact.kinetic
            values[f"{name}.static"] = contact.static_friction
            if contact.curve:
                values[f"{name}.curve"] = contact.curve
        if not drive.finger.rigid:
            values["finger.stiffness"] = drive.finger.stiffness
        for name in ("mouse_velocity", "plate_load"):
            given = getattr(self, name)
            values[name] = given.rows if isinstance(given, Profile) else given
        values |= {"displacement": self.displacement, "velocity": self.initial_velocity}
        if self.skin_stretch is not None:
            values["skin_stretch"] = self.skin_stretch
        return values | {"duration": self.duration, "settling_band": self.settling_band}

    def sensitivity(self, parameters: Sequence[str]) -> Sensitivity:
        """Exact derivatives of the motion with respect to some of its parameters.

        The motion is followed once more for each, in numbers that carry their derivative through
        every event; nothing is differenced.

        Args:
            parameters: of `mass`, `stiffness`, `damping`; `plate_kinetic`, `plate_static`,
                `finger_kinetic`, `finger_static`, `finger_stiffness`; `mouse_velocity`,
                `plate_load` (all rows of a profile together), `displacement`, `velocity`,
                `skin_stretch`; or one row: `plate_curve[1].force`, `plate_curve[1].speed`,
                `mouse_velocity[2].value`, `plate_load[2].time`.

        Returns:
            The derivatives of position, velocity, events and all numbers, with NaN and the reason
            where one does not exist.

        Raises:
            ValueError: a parameter is unknown, or this motion does not have it.
        """
        from pindrive.sensitivity import Sensitivity

        return Sensitivity(self, parameters)

    def numbers(self) -> dict[str, float]:
        """Every number of the transient, its ending and its energy, SI, by the table's names."""
        groups = {
            "transient": {**asdict(self.transient), "settled": self.transient.settled},
            "ending": {k: v for k, v in asdict(self.ending).items() if k not in ("kind", "cycle")},
            "energy": asdict(self.energy),
        }
        return dict(flattened(groups))


def _quantity(which: str) -> int:
    """The number of a quantity in the core."""
    if which not in _QUANTITIES:
        raise ValueError(refusal("which", " or ".join(map(repr, _QUANTITIES)), repr(which)))
    return _QUANTITIES.index(which)


def _times(t: ArrayLike) -> NDArray[np.float64]:
    try:
        return np.asarray(t, dtype=np.float64)
    except (TypeError, ValueError):
        raise ValueError(refusal("t", "numbers, in seconds", repr(t))) from None


def flattened(tree: dict[str, Any], prefix: str = "") -> list[tuple[str, float]]:
    """The numbers of nested dictionaries, with dotted names."""
    rows = []
    for name, value in tree.items():
        if isinstance(value, dict):
            rows += flattened(value, f"{prefix}{name}.")
        else:
            rows.append((prefix + name, value))
    return rows


def simulate(
    drive: Drive,
    *,
    mouse_velocity: float | Profile,
    displacement: float = 0.0,
    velocity: float | None = None,
    plate_load: float | Profile = 1.0,
    skin_stretch: float | None = None,
    duration: float | None = None,
    settling_band: float = _core.settling_band,
) -> Motion:
    """Follow the pin of a drive from its release, exactly.

    Args:
        drive: the drive; its finger may be compliant, its contacts may have friction curves.
        mouse_velocity: v_p, the velocity at which the plate passes under the mouse, m/s, up to 1e12
            either way; constant or a `Profile` without steps, whose acceleration acts on the pin.
        displacement: x(0), deflection from the spring's rest, m, up to 1e12 either way.
        velocity: x'(0), m/s, up to 1e12 either way; None: the plate's, as for a pin that was
            carried.
        plate_load: factor on the plate's friction, from 0 to 1e12; constant or a `Profile`.
        skin_stretch: stretch of a compliant finger that grips at the start, m; None: the stretch of
            a finger being slid along or, for a pin at rest, none.
        duration: s, from 1e-12 to 1e12, and to 1e12 over the natural frequency; None: long enough
            to see the ending.
        settling_band: half the band about the end in which the motion counts as settled, a part of
            |x(0) - x_end|, above 0 and at most 1.

    Returns:
        The motion. Sustained motions are recognised and reported in its `ending`.

    Raises:
        ValueError: a value is no number or out of its range; a compliant plate; a stretch that the
            skin cannot hold; a friction curve at a compliant finger, or at a plate whose load
            changes: neither is piecewise linear.

    Warns:
        ImplausibleValueWarning: a value that no such device has, such as a velocity in mm/s.
    """
    motion = simulated(
        drive,
        mouse_velocity=mouse_velocity,
        displacement=displacement,
        velocity=velocity,
        plate_load=plate_load,
        skin_stretch=skin_stretch,
        duration=duration,
        settling_band=settling_band,
    )
    if not _plausible(motion.core_numbers):
        given = motion.inputs()
        for name in ("velocity",) * (velocity is None) + ("duration",) * (duration is None):
            del given[name]
        for name, value in given.items():
            warn_of(name, value, stacklevel=2)
    return motion


def simulated(
    drive: Drive,
    *,
    mouse_velocity: float | Profile,
    displacement: float = 0.0,
    velocity: float | None = None,
    plate_load: float | Profile = 1.0,
    skin_stretch: float | None = None,
    duration: float | None = None,
    settling_band: float = _core.settling_band,
) -> Motion:
    """What `simulate` does, without its warnings: for numbers that no person has written."""
    if not isinstance(drive, Drive):
        raise ValueError(refusal("drive", "a Drive", repr(drive)))
    v_plate = _rows(mouse_velocity, "mouse_velocity")
    load = _rows(plate_load, "plate_load")
    x = check("displacement", displacement)
    v = _value_at_start(v_plate) if velocity is None else check("velocity", velocity)
    end = inf if duration is None else check("duration", duration)
    band = check("settling_band", settling_band)
    if duration is not None:
        check_phase(end, drive.natural_frequency)
    plate, finger = drive.plate, drive.finger
    if not plate.rigid:
        raise ValueError(refusal("plate stiffness", "infinite", f"{plate.stiffness!r} N/m"))
    check_skin(finger)
    check_load(plate, plate_load)
    stretch = nan if skin_stretch is None else check("skin_stretch", skin_stretch)
    if skin_stretch is not None:
        check_stretch(stretch, finger)
    numbers = (
        drive.mass,
        drive.stiffness,
        drive.damping,
        (plate.kinetic, plate.static_friction, plate.stiffness, plate.curve or ()),
        (finger.kinetic, finger.static_friction, finger.stiffness, finger.curve or ()),
        v_plate,
        load,
        x,
        v,
        stretch,
        end,
    )
    with_plate = velocity is None
    return Motion(numbers, drive, mouse_velocity, x, v, plate_load, skin_stretch, with_plate, band)


def _rows(given: float | Profile, name: str) -> Rows:
    """An input as rows (time, value): one row is a constant."""
    if not isinstance(given, Profile):
        return [(0.0, check(name, given))]
    bounds, limits = QUANTITIES[name].bounds, QUANTITIES[name].limits
    if name == "mouse_velocity":
        check_continuous(given, "m/s")
    if not all(end in bounds and end in limits for end in (min(given.values), max(given.values))):
        for i, y in enumerate(given.values):
            check(name, y, label=f"{name} values[{i}]")
    if not given.changes:
        return [(0.0, given.values[0])]
    return list(given.rows)


def check_phase(
    duration: float, natural_frequency: float, *, where: str = "", label: str = "duration"
) -> None:
    """Refuse a duration (s) in which the phase grows beyond what doubles tell apart."""
    bounds = QUANTITIES["phase"].limits
    if duration * natural_frequency > bounds.upper:
        longest, phase = brief(bounds.upper / natural_frequency), brief(bounds.upper)
        required = f"at most {longest} s, {phase} over the natural frequency"
        raise ValueError(refusal(label, required, f"{duration!r} s", where))


def _plausible(numbers: CoreNumbers) -> bool:
    """Whether `warn_of` has nothing to say, at a glance: a motion takes microseconds."""
    mass, stiffness, damping, plate, finger, v_plate, load, x, v, _, duration = numbers
    m0, m1, k0, k1, b1, plate1, finger1, skin0, skin1, speed1, load1, x1, v1, t0, t1 = _GLANCE
    return (
        m0 <= mass <= m1
        and k0 <= stiffness <= k1
        and damping <= b1
        and plate[1] <= plate1
        and finger[1] <= finger1
        and (skin0 <= finger[2] <= skin1 or finger[2] == inf)
        and not (plate[3] or finger[3])
        and len(v_plate) == len(load) == 1
        and abs(v_plate[0][1]) <= speed1
        and load[0][1] <= load1
        and abs(x) <= x1
        and abs(v) <= v1
        and (t0 <= duration <= t1 or duration == inf)
    )


def _value_at_start(rows: Rows) -> float:
    if len(rows) == 1:
        return rows[0][1]
    times, values = zip(*rows, strict=True)
    return float(np.interp(0.0, times, values))
