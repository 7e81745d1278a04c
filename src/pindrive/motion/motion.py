"""A simulated motion: closed forms that are evaluated at any time, events, and the numbers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import fields
from functools import cached_property
from math import inf, isnan
from operator import itemgetter
from os import PathLike
from pathlib import Path
from typing import Any, Final, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pindrive import _core
from pindrive.lazy import mpl_figure, xr
from pindrive.motion.core_numbers import DURATION, CoreNumbers
from pindrive.motion.drive import Drive, law_values
from pindrive.motion.friction import COEFFICIENTS, PRESSED_BY
from pindrive.motion.function import Function
from pindrive.motion.profile import Profile
from pindrive.motion.release import INPUTS, Release, core_numbers
from pindrive.motion.results import (
    Certificate,
    ContactName,
    Crossings,
    Ending,
    Event,
    Extrema,
    Ledger,
    QuantityName,
    Segment,
    Table,
    Transient,
    ending_of,
    events_at,
    events_of,
    segments_of,
    transient_of,
)
from pindrive.motion.sensitivity import Sensitivity
from pindrive.quantities import budgets
from pindrive.quantities.drive import SUPPORTS
from pindrive.quantities.quantity import counted
from pindrive.quantities.refusal import refusal
from pindrive.quantities.results import ENDING, ENERGY, TRANSIENT
from pindrive.quantities.status import End, Side, Status
from pindrive.quantities.table import check, default
from pindrive.views import NotebookHtml, csv_file, figure

__all__ = ["Crossings", "Event", "Extrema", "Motion", "Segment"]

_QUANTITIES: Final = ("position", "velocity", "acceleration")
"""In the order of `Quantity` in crossings.hpp."""
_NAMES: Final = tuple(quantity.name for quantity in (*TRANSIENT, *ENDING, *ENERGY))
"""Names of `Motion.numbers()`."""
_ENERGY: Final = tuple(f"energy.{field.name}" for field in fields(Ledger))
"""Names of the numbers of the core's energy ledger, which has the order of the dataclass."""
_READ: Final = itemgetter(*_NAMES)


class Motion(NotebookHtml):
    """Exact motion of a pin after its release, made by `simulate`.

    Attributes:
        drive: The drive that was simulated.
        release: The initial state and the inputs.
        settling_band: Half the band about the end that counts as settled, a part of
            |x(0) - x_end|.
        core_numbers: Drive, release and the duration, as the core takes them.
        duration: S; the one given, or long enough to see the ending.
    """

    def __init__(
        self,
        drive: Drive,
        release: Release,
        numbers: CoreNumbers,
        core: _core.Motion,
        settling_band: float,
    ) -> None:
        self.drive = drive
        self.release = release
        self.core_numbers = numbers
        self.core = core
        self.settling_band = settling_band
        self.duration: float = core.duration(settling_band)

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle the arguments of the simulation, which is repeated."""
        requested = self.core_numbers[DURATION]
        duration = None if requested == inf else requested
        return solve, (self.drive, self.release, duration, self.settling_band)

    def __eq__(self, other: object) -> bool:
        """Return True if drive, release and duration are equal."""
        return type(self) is type(other) and self.__reduce__() == other.__reduce__()

    def __hash__(self) -> int:
        return hash(self.__reduce__())

    def __repr__(self) -> str:
        """Return the ending and its time in a line."""
        return (
            f"<Motion of {self.duration:.6g} s, {counted(len(self.events), 'event')}, "
            f"{self.ending.kind}, settling time {self.transient.settling_time:.6g} s, "
            f"{self.status.name}>"
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
            side: Side of an event on which the limit is taken.

        Raises:
            ValueError: A time is negative, NaN, or later than the motion is known.
        """
        return self._evaluate(self.core.position, t, side)

    @overload
    def velocity(self, t: float, side: Side = ...) -> float: ...
    @overload
    def velocity(self, t: ArrayLike, side: Side = ...) -> NDArray[np.float64]: ...
    def velocity(self, t: ArrayLike, side: Side = "right") -> float | NDArray[np.float64]:
        """Velocity x' of the pin in the housing, m/s; arguments as for `position`."""
        return self._evaluate(self.core.velocity, t, side)

    @overload
    def acceleration(self, t: float, side: Side = ...) -> float: ...
    @overload
    def acceleration(self, t: ArrayLike, side: Side = ...) -> NDArray[np.float64]: ...
    def acceleration(self, t: ArrayLike, side: Side = "right") -> float | NDArray[np.float64]:
        """Acceleration x'' of the pin in the housing, m/s²; it jumps where friction does."""
        return self._evaluate(self.core.acceleration, t, side)

    @overload
    def force(self, contact: ContactName, t: float, side: Side = ...) -> float: ...
    @overload
    def force(
        self, contact: ContactName, t: ArrayLike, side: Side = ...
    ) -> NDArray[np.float64]: ...
    def force(
        self, contact: ContactName, t: ArrayLike, side: Side = "right"
    ) -> float | NDArray[np.float64]:
        """Force of the plate, the finger or the end stops on the pin, N; `t`, `side` as above."""
        if contact not in ("plate", "finger", "stop"):
            raise ValueError(refusal("contact", '"plate", "finger" or "stop"', repr(contact)))
        of_contact = getattr(self.core, f"{contact}_force")
        return self._evaluate(of_contact, t, side)

    @overload
    def housing_force(self, t: float, side: Side = ...) -> float: ...
    @overload
    def housing_force(self, t: ArrayLike, side: Side = ...) -> NDArray[np.float64]: ...
    def housing_force(self, t: ArrayLike, side: Side = "right") -> float | NDArray[np.float64]:
        """Force of the pin on the housing and the finger, which the hand feels, N, the way of x.

        Spring, damper, finger and end stops push the housing: k x + b x' - R_f - R_s. For a spring
        on the ground (`Release.support`) it is the force on what holds spring and finger.
        """
        return self._evaluate(self.core.housing_force, t, side)

    @overload
    def stretch(self, t: float, side: Side = ...) -> float: ...
    @overload
    def stretch(self, t: ArrayLike, side: Side = ...) -> NDArray[np.float64]: ...
    def stretch(self, t: ArrayLike, side: Side = "right") -> float | NDArray[np.float64]:
        """Stretch of a compliant finger's skin, m, the way of x; 0 for a rigid finger.

        The force on the skin is `-force("finger", t)`.
        """
        return self._evaluate(self.core.stretch, t, side)

    @overload
    def stretch_rate(self, t: float, side: Side = ...) -> float: ...
    @overload
    def stretch_rate(self, t: ArrayLike, side: Side = ...) -> NDArray[np.float64]: ...
    def stretch_rate(self, t: ArrayLike, side: Side = "right") -> float | NDArray[np.float64]:
        """Return the stretch rate of the skin of a compliant finger, m/s."""
        return self._evaluate(self.core.stretch_rate, t, side)

    def columns(self, t: ArrayLike) -> dict[str, NDArray[np.float64]]:
        """Return all quantities at the times t (s, shape (n,)), right-hand limits, by name.

        The forces are "plate_force", "finger_force" and "housing_force", with end stops
        "stop_force"; of a rigid finger there is no stretch.
        """
        return self.core.columns(np.ascontiguousarray(self._known(t, "t")), True)

    def plate_velocity(self, t: ArrayLike) -> NDArray[np.float64]:
        """The plate's velocity v_p(t) in the housing, m/s, in the shape of t."""
        times = _times(t)
        given = self.release.mouse_velocity
        return np.full_like(times, given) if isinstance(given, float) else given(times)

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
        known = self.core.known_until
        good = (times >= 0.0) & (times <= known) & (times < inf)
        if not good.all():
            required = f"from 0 s to {known!r} s" if known < inf else "finite and at least 0 s"
            raise ValueError(refusal(name, required, f"{float(times[~good].flat[0])!r} s"))
        return times

    # ---- what happened ---------------------------------------------------------------------------

    @cached_property
    def _table(self) -> Table:
        return self.core.segments()

    @cached_property
    def events(self) -> tuple[Event, ...]:
        """Changes at a contact in order, the plate's first; of a cycle, one period."""
        return events_of(self._table, lambda t: (self.position(t), self.velocity(t)))

    def events_between(self, begin: float, end: float) -> tuple[Event, ...]:
        """Every change at a contact from `begin` to `end`, both included, with cycles expanded.

        Args:
            begin: s, at least 0.
            end: s, at least `begin`; beyond `duration` where the ending is known.

        Returns:
            The events in order, the plate's first.

        Raises:
            ValueError: A time is negative, NaN, or later than the motion is known; `begin` is
                after `end`; or there are more events than the budget.
        """
        begin, end = (
            float(self._known(time, name)) for time, name in ((begin, "begin"), (end, "end"))
        )
        if not begin <= end:
            raise ValueError(refusal("begin", f"at most end ({end!r} s)", f"{begin!r} s"))
        times, ended = self.core.events(begin, end, budgets.MOMENTS.most + 1)
        budgets.MOMENTS.check(len(times), f"events from {begin:g} s to {end:g} s")
        each = [self._table[f"{name}_event"] for name in ("plate", "finger", "stop")]
        kinds = np.stack(each, axis=-1)[ended]
        states = zip(self.position(times).tolist(), self.velocity(times).tolist(), strict=True)
        rows = zip(times.tolist(), kinds.tolist(), states, strict=True)
        return tuple(event for row in rows for event in events_at(*row))

    def extrema(self, which: QuantityName) -> Extrema:
        """Times and values of the extrema of a quantity over [0, duration], exactly.

        Extrema are begin and end of the motion, turning points of the quantity, and both sides of a
        jump: between two neighbours it is continuous and does not turn. A quantity that rests
        before it turns back has its extremum where it comes to rest.

        Args:
            which: "position", "velocity" or "acceleration".

        Returns:
            The times (s) and the values (m, m/s or m/s²), shape (n,).

        Raises:
            ValueError: Another quantity; more extrema than the budget.
        """
        index = _quantity(which)
        found = Extrema(*self.core.extrema(index, self.duration, budgets.MOMENTS.most + 1))
        budgets.MOMENTS.check(len(found.time), f"extrema of the {which} in {self.duration:g} s")
        return found

    def crossings(self, which: QuantityName, level: float) -> Crossings:
        """Times and directions of the crossings of a level over [0, duration], exactly.

        A crossing leads from one side of the level to the other. Touching it is none; a quantity
        that rests at the level and then continues crosses it where it comes to rest.

        Args:
            which: "position", "velocity" or "acceleration".
            level: m, m/s or m/s².

        Returns:
            The times (s) and the directions, 1 or -1 in turn, shape (n,).

        Raises:
            ValueError: Another quantity; a level that is not finite; more crossings than the
                budget.
        """
        index = _quantity(which)
        if not -inf < level < inf:
            raise ValueError(refusal("level", "finite", repr(level)))
        found = Crossings(
            *self.core.crossings(index, float(level), self.duration, budgets.MOMENTS.most + 1)
        )
        budgets.MOMENTS.check(len(found.time), f"crossings by the {which} in {self.duration:g} s")
        return found

    @property
    def segment_count(self) -> int:
        """Number of segments; does not create them."""
        return self.core.segment_count

    @cached_property
    def segments(self) -> tuple[Segment, ...]:
        """Modes in order, each one closed form; of a stick-slip cycle, one period."""
        return segments_of(self._table)

    @cached_property
    def acceleration_bounds(self) -> NDArray[np.float64]:
        """Bounds of |x''| of the segments without a closed form, m/s², shape (segments,).

        NaN of one in closed form, whose swing says so.
        """
        return self.core.acceleration_bounds()

    @property
    def status(self) -> Status:
        """Status of the simulation: complete, or the reason for its end (`Status.explanation`)."""
        return Status(self.core.status)

    # ---- the numbers -----------------------------------------------------------------------------

    @cached_property
    def _numbers(self) -> dict[str, float]:
        """Numbers of the transient and the ending, by their names in the table of quantities."""
        numbers: dict[str, float] = self.core.transient(self.duration, self.settling_band)
        for count in ("transient.plate.reversals", "transient.finger.reversals"):
            numbers[count] = int(numbers[count])
        return numbers

    @cached_property
    def _energy(self) -> dict[str, float]:
        """Numbers of the energy ledger, by their names in the table of quantities."""
        return dict(zip(_ENERGY, self.core.ledger(self.duration).values(), strict=True))

    @cached_property
    def transient(self) -> Transient:
        """The transient's numbers, from the closed forms."""
        return transient_of(self._numbers)

    @cached_property
    def ending(self) -> Ending:
        """Ending of the motion."""
        return ending_of(End(self.core.end), self._numbers)

    def settling_time(self, band: float = _core.settling_band) -> float:
        """The settling time (s) for another band, a part of |x(0) - x_end|; NaN if none.

        The band is above 0 and at most 1.
        """
        band = check("settling_band", band, label="band")
        return float(self.core.transient(self.duration, band)["transient.settling_time"])

    @cached_property
    def energy(self) -> Ledger:
        """The energy ledger over [0, duration]."""
        return Ledger(*self._energy.values())

    def certificate(self) -> Certificate:
        """The worst residual of each law over [0, duration], computed without the solver."""
        return Certificate(**self.core.certificate(self.duration))

    def plot(self) -> mpl_figure.Figure:
        """The motion over time and in the phase plane, as a figure that a notebook shows.

        Returns:
            A figure of 180 mm by 125 or, with skin, 150 mm; `figure.savefig(FILE)` writes it.
        """
        return figure(self, "plot")

    # ---- for other programs ----------------------------------------------------------------------

    def even_times(self, count: int = 1001) -> NDArray[np.float64]:
        """`count` even times over [0, duration], s, shape (count,)."""
        if not count >= 2:
            raise ValueError(refusal("count", "at least 2", repr(count)))
        return np.linspace(0.0, self.duration, count)

    def sample_times(self, count: int = 1001) -> NDArray[np.float64]:
        """`count` even times over [0, duration] and the events among them, s, shape (n,)."""
        events = self._table["end"]
        return np.union1d(self.even_times(count), events[events <= self.duration])

    def to_dataset(self, times: ArrayLike | None = None) -> xr.Dataset:
        """The motion over time, its events and its numbers, with units, as an xarray Dataset.

        Args:
            times: s, shape (n,); `sample_times()` unless given.

        Returns:
            Variables over `time` (right-hand limits) and over `event`; one scalar for each number;
            the drive and the release in the attributes.
        """
        t = self.sample_times() if times is None else np.atleast_1d(_times(times))
        if t.ndim != 1:
            raise ValueError(refusal("times", "of one dimension", f"{t.ndim}"))
        from pindrive.motion.dataset import dataset

        return dataset(self, t)

    def to_csv(self, path: str | PathLike[str], rate: float | str = default("rate")) -> Path:
        """Write the motion at even times as CSV, and its events to a file of their own.

        Args:
            path: The file of samples, whose header names columns and SI units. The events go beside
                it: Those of "m.csv" to "m-events.csv". Both are whole or not there.
            rate: Samples a second, Hz, from 1e-6 to 1e12, the first at 0 s.

        Returns:
            The path of the events.

        Raises:
            ValueError: A rate out of its range; more than 10 000 000 samples; a file that is there
                and holds something else, or one that cannot be written.
        """
        return csv_file(self, "to_csv", path, rate)

    def inputs(self) -> dict[str, float | str | tuple[tuple[float, float], ...]]:
        """Simulated inputs, SI, by the names of the table of quantities.

        A curve or a profile is its rows: (speed, force) or (time, value). A function is its
        parameters, `mouse_velocity.amplitude`, or the text of its pieces, `mouse_velocity.pieces`.
        """
        drive = self.drive
        values: dict[str, float | str | tuple[tuple[float, float], ...]] = {
            "mass": drive.mass,
            "stiffness": drive.stiffness,
            "damping": drive.damping,
        }
        for name, contact in (("plate", drive.plate), ("finger", drive.finger)):
            values[f"{name}.kinetic"] = contact.kinetic
            values[f"{name}.static"] = contact.static_friction
            own = {n: getattr(contact, n) for n in ("curve", "breakaway", "viscous")}
            own |= law_values(contact)
            values |= {f"{name}.{n}": value for n, value in own.items() if value is not None}
            if contact.coefficient is not None:
                parts = {n: getattr(contact, n) for n in COEFFICIENTS.values()}
                values |= {f"{name}.{n}": value for n, value in parts.items() if value is not None}
                pressing = {n: getattr(drive, n) for n in PRESSED_BY[name] if n != "mass"}
                values |= {n: value for n, value in pressing.items() if value is not None}
        if not drive.finger.rigid:
            values["finger.stiffness"] = drive.finger.stiffness
        if drive.finger.damping:
            values["finger.damping"] = drive.finger.damping
        for name in INPUTS:
            given = getattr(self.release, name)
            if isinstance(given, Function):
                values |= {f"{name}.{part}": value for part, value in given.described.items()}
            else:
                values[name] = given.rows if isinstance(given, Profile) else given
        values["displacement"] = self.release.displacement
        values["velocity"] = self.release.initial_velocity
        if self.release.support != SUPPORTS[0]:
            values["support"] = self.release.support
        if self.release.skin_stretch is not None:
            values["skin_stretch"] = self.release.skin_stretch
        return values | {"duration": self.duration, "settling_band": self.settling_band}

    def sensitivity(self, parameters: Sequence[str]) -> Sensitivity:
        """Exact derivatives of the motion with respect to some of its parameters.

        The motion is followed once more for each, in numbers that carry their derivative through
        every event; nothing is differenced.

        Args:
            parameters: Names among `mass`, `stiffness`, `damping`; `plate_kinetic`, `plate_static`,
                `finger_kinetic`, `finger_static`, `finger_stiffness`; of a contact given by a
                coefficient `plate_coefficient`, `plate_static_coefficient`, `preload`,
                `finger_coefficient`, `finger_static_coefficient`, `touch_force`; `mouse_velocity`,
                `plate_load`, `force`, `across_velocity`, `finger_load` (all rows of a profile
                together), `displacement`, `velocity`, `skin_stretch`; or one row:
                `plate_curve[1].force`, `plate_curve[1].speed`, `mouse_velocity[2].value`,
                `plate_load[2].time`. Keys of device files are names too; by `drive.mass`,
                `drive.stiffness` and `drive.damping_ratio` the derivative includes the damping
                that follows, where the drive was given a ratio.

        Returns:
            The derivatives of position, velocity, events and all numbers, with NaN and the reason
            where one does not exist.

        Raises:
            ValueError: A parameter is unknown, or this motion does not have it.
        """
        from pindrive.motion.sensitivity import Sensitivity

        return Sensitivity(self, parameters)

    def multipliers(self) -> tuple[complex, ...]:
        """Floquet multipliers of a steady motion, the largest first.

        A small deviation from the motion changes by these factors in one period: the motion is
        stable where all are within the unit circle. They are the eigenvalues of the exact
        derivative of position and velocity after one period by those at its begin, through every
        event; 0 stands for a deviation that a contact in stick ends. Under constant inputs the
        factor 1 of a shift in time is left out.

        Returns:
            Two multipliers under inputs that repeat, one under constant inputs.

        Raises:
            ValueError: The motion is not steady, a contact holds the pin throughout, or the
                derivative does not exist, as where the motion grazes an event.
        """
        from pindrive.motion.stability import multipliers

        return multipliers(self)

    def fundamental(self) -> complex:
        """Fundamental of the position in a steady motion, m, with its phase.

        The position is Im(fundamental · exp(2πit/period)) with its mean and its further harmonics:
        the absolute value is an amplitude, the angle a phase (rad) beside sin(2πt/period), as
        `harmonic` has it. Under a sinusoid at that period the angle is the phase of the response.

        Raises:
            ValueError: The motion is not steady.
        """
        from pindrive.motion.stability import fundamental

        return fundamental(self)

    def numbers(self) -> dict[str, float]:
        """Every number of the transient, its ending and its energy, SI, by the table's names."""
        settled = not isnan(self._numbers["transient.settling_time"])
        found = {**self._numbers, **self._energy, "transient.settled": settled}
        return dict(zip(_NAMES, _READ(found), strict=True))


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


def solve(
    drive: Drive,
    release: Release,
    duration: float | None,
    settling_band: float,
    progress: Callable[[float], None] | None = None,
) -> Motion:
    """Simulate a pin with checked arguments.

    Args:
        drive: Drive of the pin.
        release: Initial state and inputs, which fit the drive.
        duration: End of the simulation, s. None: until the ending is known.
        settling_band: Half width of the settling band, as a fraction of |x(0) - x_end|.
        progress: Function called with the simulated time, s, of a long simulation.
    """
    numbers = core_numbers(drive, release, duration)
    return Motion(drive, release, numbers, _core.simulate(*numbers, progress), settling_band)
