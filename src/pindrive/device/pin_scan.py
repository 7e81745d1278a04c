"""Pins of a scan: what a scan is made of, what the core does with it, and each pin as it moved."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from math import nan
from typing import Any, Final, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pindrive import _core
from pindrive.device.controller import Decision
from pindrive.device.current import CoilState, Commands, Current
from pindrive.device.device import Device
from pindrive.device.hand import HandPath
from pindrive.device.page import FINER, Scene
from pindrive.device.sensitivity import sensitivity_of
from pindrive.device.touch import finger_load, held_stretch
from pindrive.device.trajectory import check_vibration
from pindrive.motion.drive import Drive
from pindrive.motion.function import Function, function_of
from pindrive.motion.motion import Motion
from pindrive.motion.profile import Profile
from pindrive.motion.release import (
    Release,
    core_numbers,
    rows_of,
)
from pindrive.motion.results import Event
from pindrive.motion.sensitivity import Sensitivity
from pindrive.quantities import budgets
from pindrive.quantities.refusal import refusal
from pindrive.quantities.status import SimulationError, Status
from pindrive.quantities.value import concise, equal_by_value

_POSITION: Final = 0
"""Position among the quantities of the core."""
_AT: Final = slice(3, 6)
"""Position, velocity and skin force among the numbers of a state of the core."""
Progress = Callable[[int, int], None]
"""Called after each part of a computation: how many are done, of how many."""


@equal_by_value
@concise
@dataclass(frozen=True, slots=True, kw_only=True)
class PinState:
    """All there is to know of a pin and its magnet at one time: a scan can go on from it."""

    position: float = 0.0
    """Deflection from the spring's rest, m."""
    velocity: float | None = 0.0
    """In the housing, m/s; None: carried by the plate."""
    skin_stretch: float | None = None
    """Stretch of a compliant finger in stick, or under a pin at rest, m; None: in slip, or rigid.
    """
    coil: CoilState | None = None
    """The coil's last switching; None: it is off, without current."""
    decision: Decision = field(default_factory=Decision)
    """State of the control block."""
    contacts: tuple[float, ...] | None = field(default=None, repr=False)
    """Contacts at the end of a scan, as the core keeps them; None: those of a release.

    They belong to the position and velocity of that state.
    """


@dataclass(frozen=True, slots=True)
class ScanInputs:
    """What a scan is made of; equal inputs give equal scans."""

    device: Device
    scene: Scene
    path: HandPath
    start: tuple[PinState, ...] | None
    """State of each pin at the begin; None: springs at rest, magnets off."""
    touch: float | Profile | None
    """Touch force of the finger on each pin, N, over the time of the scan; None: the drive's."""

    @property
    def finger_load(self) -> float | Profile:
        """Touch of the finger over `touch_force` of the drive, over the time since the begin."""
        return finger_load(self.device.drive, self.touch, self.path.begin)

    @property
    def states(self) -> tuple[PinState, ...]:
        """State of each pin at the begin."""
        return self.start or (PinState(),) * len(self.device.array)

    def coil_numbers(self, state: PinState) -> tuple[float, float, float, float, float, bool, bool]:
        """Return the coil of a pin at the begin as the core has it, with the command in force."""
        coil = CoilState(self.path.begin) if state.coil is None else state.coil
        return coil.numbers(state.decision.switched)

    def core(self) -> _core.Scan:
        """Return the pins at the begin, as the core has them."""
        begins = []
        for number, state in enumerate(self.states):
            _check_contacts(number, state)
            begins.append(
                (
                    state.position,
                    nan if state.velocity is None else state.velocity,
                    nan if state.skin_stretch is None else state.skin_stretch,
                    self.coil_numbers(state),
                    state.decision.on,
                    [*state.decision.pending],
                    [*(state.contacts or ())],
                )
            )
        return _core.Scan(
            self.device.core,
            self.scene.raster,
            self.path.rows,
            rows_of(self.finger_load),
            begins,
        )


@equal_by_value
@concise
@dataclass(frozen=True, kw_only=True, eq=False)
class PinScan:
    """One pin in a scan: what its magnet did, and its motion.

    Times are those of the hand's path.
    """

    number: int
    """Its place in the array, from 0."""
    inputs: ScanInputs
    core: _core.Scan = field(repr=False, compare=False)

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle the inputs of the scan, which is repeated."""
        return _pin_of, (self.inputs, self.number)

    @property
    def drive(self) -> Drive:
        """The drive of each pin."""
        return self.inputs.device.drive

    @property
    def begin(self) -> float:
        """Begin of the scan, s."""
        return self.inputs.path.begin

    @property
    def end(self) -> float:
        """End of the scan, s."""
        return self.inputs.path.end

    @cached_property
    def sample_times(self) -> NDArray[np.float64]:
        """Sampling instants of the control block, s, shape (n,)."""
        return self.inputs.device.control.sample_times(self.begin, self.end)

    @cached_property
    def luminance(self) -> NDArray[np.float64]:
        """Luminance at the pin's spot at each of these instants, shape (n,)."""
        given = self.inputs
        spots = spot_at(given.device, given.path, self.number, self.sample_times)
        return given.scene.at(*spots.T)

    @cached_property
    def commands(self) -> Commands:
        """Switchings of the coil by the control block."""
        at_first = self.core.control(self.number)[0]
        return Commands(self.core.switchings(self.number), at_first)

    @cached_property
    def current(self) -> Current:
        """The current in the coil, a part of the full one, over time."""
        coil = self.inputs.device.magnet.coil
        return Current.of(self.core.coil(self.number), None if coil is None else coil.heat)

    @cached_property
    def release(self) -> Release:
        """The state at `begin`, and the inputs over the time since."""
        given = self.inputs
        state, axis, pressed = given.states[self.number], given.device.array.axis, given.finger_load
        stretch = state.skin_stretch
        if stretch is not None:
            stretch = held_stretch(stretch, self.drive, pressed)
        load = function_of(self.core.load(self.number), "1")
        return Release(
            given.path.plate_velocity(axis),
            state.position,
            state.velocity,
            load if load.changes else load(0.0),
            stretch,
            across_velocity=given.path.across_velocity(axis),
            finger_load=pressed,
        )

    @cached_property
    def motion(self) -> Motion:
        """The pin's motion, over the time since `begin`.

        Derivatives of this motion hold the load on the plate; those by `PinScan.sensitivity` follow
        the magnet, which presses with the weight of the pin.
        """
        numbers = core_numbers(self.drive, self.release, self.end - self.begin)
        core = self.core.motion(self.number)
        return Motion(self.drive, self.release, numbers, core, _core.settling_band)

    def sensitivity(self, parameters: Sequence[str]) -> Sensitivity:
        """Exact derivatives of the pin's motion with respect to parameters of the device.

        The samples of the page are kept: where the hand and the page are given, a coil is switched
        at the same times in a device that differs a little. So is the state at `begin`.

        Args:
            parameters: Names of the drive as for `Motion.sensitivity`, where `mass` and `preload`
                also press on the plate; `magnet.turns` and all other numbers of `Coil` that the
                device gives, or `magnet.hold_force`, `magnet.saturation` (at the same times),
                `magnet.rise_time`, `magnet.fall_time`, `magnet.rise_constant` and
                `magnet.fall_constant` of a magnet without a coil; `magnet.residual`,
                `magnet.pwm_frequency`, `magnet.pwm_duty`; `control.latency`. Keys of device files
                are names, as there.

        Returns:
            Derivatives of position, velocity and events over the time since `begin`, with NaN and
            the reason where one does not exist.

        Raises:
            ValueError: A parameter is unknown, or this device does not have it.
        """
        return sensitivity_of(self, parameters)

    def position(self, t: ArrayLike) -> NDArray[np.float64]:
        """Deflection of the pin in the housing at times t (s, any shape), m.

        The deflection is positive against the hand's motion along the drive axis.
        """
        return np.asarray(self.motion.position(self.since(t)))

    def velocity(self, t: ArrayLike) -> NDArray[np.float64]:
        """Velocity of the pin in the housing, and so over a resting finger, m/s."""
        return np.asarray(self.motion.velocity(self.since(t)))

    def skin_force(self, t: ArrayLike) -> NDArray[np.float64]:
        """Force on the skin along the drive axis, N, positive the way of x."""
        return -np.asarray(self.motion.force("finger", self.since(t)))

    def stretch(self, t: ArrayLike) -> NDArray[np.float64]:
        """Stretch of a compliant finger's skin, m, the way of x; 0 of a rigid one."""
        return np.asarray(self.motion.stretch(self.since(t)))

    def since(self, t: ArrayLike) -> NDArray[np.float64]:
        """Times on the path's clock as times of the motion, s."""
        times = np.asarray(t, np.float64)
        if not ((times >= self.begin) & (times <= self.end)).all():
            required = f"from {self.begin!r} s to {self.end!r} s"
            raise ValueError(refusal("t", required, f"{times.min()!s} to {times.max()!s} s"))
        return times - self.begin

    @property
    def load(self) -> float | Function:
        """Factor on the plate's friction, over the time since `begin`."""
        return cast("float | Function", self.release.plate_load)

    @property
    def finger_load(self) -> float | Profile:
        """Touch over `touch_force` of the drive, over the time since `begin`; 0: lifted."""
        return cast("float | Profile", self.release.finger_load)

    @property
    def events(self) -> tuple[Event, ...]:
        """Events at the contacts, in order, on the path's clock."""
        return tuple(
            Event(self.begin + e.time, e.contact, e.kind, e.position, e.velocity)
            for e in self.motion.events
        )

    @property
    def energised(self) -> list[tuple[float, float]]:
        """From when to when its coil was switched on, s."""
        return self.commands.spans(self.begin, self.end)

    @cached_property
    def peak_warming(self) -> float | None:
        """The largest warming of its coil, K, at a switching or the end; None: not simulated."""
        if self.current.heat is None:
            return None
        begins = self.current.begins
        times = begins[(begins >= self.begin) & (begins < self.end)]
        return float(self.current.warming(np.append(times, self.end)).max())

    @property
    def peak_displacement(self) -> float:
        """Largest deflection of the pin in either direction, m."""
        motion, lasts = self.core.motion(self.number), self.end - self.begin
        _, values = motion.extrema(_POSITION, lasts, int(budgets.TURNS.most))
        return float(np.abs(values).max())

    @property
    def state(self) -> PinState:
        """Return the state at the end."""
        contacts = tuple(self.core.end(self.number))
        position, velocity, skin = contacts[_AT]
        finger = self.drive.finger
        _, on, pending = self.core.control(self.number)
        switched = bool(self.commands.on(self.end))
        return PinState(
            position=position,
            velocity=velocity,
            skin_stretch=None if finger.rigid else skin / finger.stiffness,
            coil=self.current.state,
            decision=Decision(on, switched, tuple(pending)),
            contacts=contacts,
        )


def _check_contacts(number: int, state: PinState) -> None:
    if state.contacts is None or state.contacts[_AT][:2] == (state.position, state.velocity):
        return
    required = "None where position or velocity is not that at the end of a scan"
    given = f"those of {state.contacts[_AT][0]!r} m and {state.contacts[_AT][1]!r} m/s"
    raise ValueError(refusal(f"start[{number}].contacts", required, given))


def energised(given: ScanInputs) -> _core.Scan:
    """Sample the page under each spot and switch the coils; nothing moves yet.

    Raises:
        ValueError: There is more to do than the budgets allow, or the touch force does not fit.
    """
    check_work(given.device, given.scene, given.path)
    core = given.core()
    most = int(budgets.SWITCHINGS.most), int(budgets.INPUT_ROWS.most)
    switchings, rows, pins = core.energise(*most)
    of = f"up to pin {pins - 1} of {len(given.device.array)}"
    budgets.SWITCHINGS.check(switchings, of)
    budgets.INPUT_ROWS.check(rows, of)
    return core


def simulated(given: ScanInputs, threads: int, progress: Progress | None = None) -> _core.Scan:
    """Simulate the pins of a scan on threads.

    Raises:
        ValueError: There is more to do than the budgets allow.
        SimulationError: The simulation of a pin had to be given up.
    """
    core = energised(given)
    pins = len(given.states)
    segments, done = core.simulate(threads, int(budgets.SEGMENTS.most), progress)
    budgets.SEGMENTS.check(segments, f"after {done} of {pins} pins")
    for i in range(pins):
        if (status := Status(core.motion(i).status)) != Status.ok:
            raise SimulationError(f"pin {i}", status)
    return core


def _pin_of(given: ScanInputs, number: int) -> PinScan:
    return PinScan(number=number, inputs=given, core=simulated(given, 1))


def check_work(device: Device, scene: Scene, path: HandPath) -> None:
    """Refuse a scan whose counts are beyond the budgets: known before anything is allocated."""
    pins, lasts = len(device.array), path.end - path.begin
    device.control.check_samples(path.begin, path.end, pins)
    of = f"{pins} pins, {len(path.times)} rows of hand speed for each"
    budgets.INPUT_ROWS.check(float(pins * len(path.times)), of)
    check_vibration(device.drive, lasts, pins)
    length = float(path.way(path.end))
    of = f"{pins} pins, {length:g} m of way, pixels of {1e3 * scene.pixel:g} mm"
    finer = FINER * (2 if len(path.bend_x) else 1)  # a stroke is almost twice as fast as its mean
    budgets.SAMPLES_OF_PAGE.check(pins * (len(path.times) + finer * length / scene.pixel), of)


def spot_at(device: Device, path: HandPath, pin: int, t: ArrayLike) -> NDArray[np.float64]:
    """Return the spot of one pin on the page at the times t (s, shape (n,)), m, shape (n, 2)."""
    hand = np.stack(path.position(t), axis=-1)
    return np.asarray(hand + device.array.on_page(device.array.spots[pin : pin + 1]))
