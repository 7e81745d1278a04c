"""A scan: the hand moves the device over a scene, and each pin's motion is followed exactly.

Each pin is simulated from the scan's begin to its end in one motion: dragged a little while its
magnet is off, carried while it is on, slipping where the spring overcomes the magnet, released,
swinging, caught again in mid-swing.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import nan
from os import PathLike
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

import pindrive
from pindrive import _core, lazy
from pindrive.device.controller import Decision
from pindrive.device.current import CoilState, Commands, Current
from pindrive.device.device import Criteria, Device
from pindrive.device.geometry import Gap, smallest_gaps
from pindrive.device.hand import HandPath
from pindrive.device.page import FINER, Scene
from pindrive.device.page_description import Page, recorded
from pindrive.device.pin_array import Neighbours
from pindrive.device.reading import Reading
from pindrive.device.touch import finger_load, held_stretch
from pindrive.device.trajectory import check_vibration
from pindrive.lazy import mpl_figure, xr
from pindrive.motion.drive import Drive
from pindrive.motion.motion import Motion
from pindrive.motion.profile import Profile
from pindrive.motion.release import (
    Release,
    core_numbers,
    drive_numbers,
    input_of,
    rows_of,
)
from pindrive.motion.results import Event
from pindrive.quantities import budgets
from pindrive.quantities.budgets import worker_count
from pindrive.quantities.quantity import counted
from pindrive.quantities.refusal import refusal
from pindrive.quantities.status import SimulationError, Status
from pindrive.quantities.table import check, default
from pindrive.quantities.value import concise, equal_by_value

_POSITION: Final = 0
"""Position among the quantities of the core."""
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
        """Factor on the finger's friction, over the time since the begin."""
        return finger_load(self.device.drive, self.touch, self.path.begin)

    @property
    def states(self) -> tuple[PinState, ...]:
        """State of each pin at the begin."""
        return self.start or (PinState(),) * len(self.device.array)

    def core(self) -> _core.Scan:
        """Return the pins at the begin, as the core has them."""
        device = self.device
        drive, control, magnet = device.drive, device.control, device.magnet
        pressed = self.finger_load
        begins = []
        for state in self.states:
            coil = CoilState(self.path.begin) if state.coil is None else state.coil
            pull = magnet.pull(coil.flux) if coil.pull is None else coil.pull
            begins.append(
                (
                    state.position,
                    nan if state.velocity is None else state.velocity,
                    nan if state.skin_stretch is None else state.skin_stretch,
                    coil.numbers(pull, state.decision.switched),
                    state.decision.on,
                    [*state.decision.pending],
                )
            )
        return _core.Scan(
            drive_numbers(drive),
            drive.normal_force,
            magnet.core_numbers,
            (control.sample_rate, control.latency, control.threshold, control.hysteresis),
            device.array.axis,
            self.scene.raster,
            self.path.rows,
            np.ascontiguousarray(device.array.on_page(device.array.spots), np.float64),
            rows_of(pressed),
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
        spots = _spot(given.device, given.path, self.number, self.sample_times)
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
            stretch = held_stretch(stretch, self.drive.finger, pressed)
        times, load = self.core.load(self.number)
        return Release(
            given.path.plate_velocity(axis),
            state.position,
            state.velocity,
            Profile(times.tolist(), load.tolist()) if len(load) > 1 else float(load[0]),
            stretch,
            across_velocity=given.path.across_velocity(axis),
            finger_load=pressed,
        )

    @cached_property
    def motion(self) -> Motion:
        """The pin's motion, over the time since `begin`."""
        numbers = core_numbers(self.drive, self.release, self.end - self.begin)
        core = self.core.motion(self.number)
        return Motion(self.drive, self.release, numbers, core, _core.settling_band)

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
    def load(self) -> float | Profile:
        """Factor on the plate's friction, over the time since `begin`."""
        return self.release.plate_load

    @property
    def finger_load(self) -> float | Profile:
        """Factor on the finger's friction, over the time since `begin`: 0 where it is lifted."""
        return self.release.finger_load

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
        last, lasts = self.motion.segments[-1], self.end - self.begin
        drive = self.motion.drive
        position = self.motion.position(lasts, "left")
        velocity = self.motion.velocity(lasts, "left")
        # a rigid stop that is struck at the end has taken the velocity: the skin grips as it was
        strikes = abs(position) == drive.rigid_travel and position * velocity > 0.0
        # under a falling touch skin also slips under a pin at rest, and keeps a stretch
        grips = (last.finger == 0 or strikes or velocity == 0.0) and not drive.finger.rigid
        _, on, pending = self.core.control(self.number)
        switched = bool(self.commands.on(self.end))
        return PinState(
            position=position,
            velocity=0.0 if strikes else None if last.plate == 0 else velocity,
            skin_stretch=self.motion.stretch(lasts, "left") if grips else None,
            coil=self.current.state,
            decision=Decision(on, switched, tuple(pending)),
        )


@dataclass(frozen=True, slots=True)
class SlotRoom:
    """Smallest distance of a pin from the end of its slot in a scan."""

    pin: int
    """Its number."""
    size: float
    """m; negative where it would go beyond."""


@equal_by_value
@dataclass(frozen=True, kw_only=True, eq=False)
class Scan(lazy.NotebookHtml):
    """Motion of a device that a hand moved over a scene."""

    inputs: ScanInputs
    pins: tuple[PinScan, ...]
    core: _core.Scan = field(repr=False, compare=False)
    max_angle: float
    """Between motion and drive axis beyond which a warning is given, rad."""
    criteria: Criteria | None = None
    """Criteria of the device file, for `evaluate`."""

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle the inputs of the scan, which is repeated."""
        return followed, (self.inputs, self.max_angle, self.criteria)

    @property
    def device(self) -> Device:
        """The device."""
        return self.inputs.device

    @property
    def scene(self) -> Scene:
        """The page."""
        return self.inputs.scene

    @property
    def path(self) -> HandPath:
        """Path of the hand."""
        return self.inputs.path

    @property
    def touch(self) -> float | Profile | None:
        """Touch force of the finger on each pin, N, over the time of the scan."""
        return self.inputs.touch

    def __repr__(self) -> str:
        """Return the scanned page, the duration and the number of pins in a line."""
        pins, lasts = counted(len(self.pins), "pin"), self.path.end - self.path.begin
        return f"<Scan of {self.scene.title} by {pins} in {lasts:.6g} s, {self.status.name}>"

    def evaluate(self, criteria: Criteria | None = None) -> Any:
        """Evaluate the shown lines against the printed lines.

        Args:
            criteria: Criteria of a felt line; None: those of the device file or, of a device
                without a file, the middle of the literature.

        Returns:
            A `pindrive.evaluation.Evaluation`: lines shown and missed, their lag and smear.
        """
        chosen = self.criteria if criteria is None else criteria
        from pindrive.evaluation.perception import evaluate

        return evaluate(self, chosen)

    def plot(self, pin: int | None = None) -> mpl_figure.Figure:
        """Plot the scanned page and the motions of the pins.

        Args:
            pin: The one drawn in detail, from 0; one that reads a line unless given.

        Returns:
            A figure; `figure.savefig(FILE)` writes it.
        """
        return self.evaluate().plot(pin)  # type: ignore[no-any-return]

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """Doubts about the scan, in words with numbers."""
        from pindrive.device.dataset import scan_warnings

        return scan_warnings(self)

    @cached_property
    def gaps(self) -> tuple[Gap, ...]:
        """The smallest gap of each two neighbouring pins, as the array's `neighbours` has them."""
        return self._gaps_of(self.device.array.neighbours)

    @cached_property
    def magnet_gaps(self) -> tuple[Gap, ...]:
        """Smallest gaps of neighbouring magnets; empty without diameters."""
        return self._gaps_of(self.device.magnet_neighbours)

    def _gaps_of(self, neighbours: Sequence[Neighbours]) -> tuple[Gap, ...]:
        return tuple(
            replace(self._approaches[pair.behind, pair.ahead], size=pair.clearance + approach)
            for pair in neighbours
            for approach in (self._approaches[pair.behind, pair.ahead].size,)
        )

    @cached_property
    def _approaches(self) -> dict[tuple[int, int], Gap]:
        """The gaps of all pairs of pins that are requested, as if they stood at one place."""
        device = self.device
        pairs = {(p.behind, p.ahead) for p in device.array.neighbours + device.magnet_neighbours}
        together = [Neighbours(*pair, 0.0) for pair in sorted(pairs)]
        motions = [self.core.motion(pin.number) for pin in self.pins]
        begin, end = self.path.begin, self.path.end
        found = smallest_gaps(together, motions, begin, end - begin)
        return {(gap.behind, gap.ahead): gap for gap in found}

    @cached_property
    def slot_room(self) -> SlotRoom | None:
        """The least room of a pin to the end of its slot, exactly; None of no known slots."""
        travel = self.device.array.travel
        if travel is None:
            return None
        return min(
            (SlotRoom(pin.number, travel - pin.peak_displacement) for pin in self.pins),
            key=lambda room: room.size,
        )

    @property
    def status(self) -> Status:
        """Largest status code of all pins: complete, or the reason for the end."""
        return max(pin.motion.status for pin in self.pins)

    @property
    def smallest_gap(self) -> Gap | None:
        """The smallest of its gaps; None where no pin stands ahead of another."""
        return min(self.gaps, key=lambda gap: gap.size, default=None)

    @property
    def smallest_magnet_gap(self) -> Gap | None:
        """Smallest gap between magnets; None without one."""
        return min(self.magnet_gaps, key=lambda gap: gap.size, default=None)

    @property
    def state(self) -> tuple[PinState, ...]:
        """Return the state of each pin at the end."""
        return tuple(pin.state for pin in self.pins)

    def spots(self, t: ArrayLike) -> NDArray[np.float64]:
        """Return the spots of all pins on the page at times t (s, shape (n,)), m, (pins, n, 2)."""
        return np.stack([self.spot(pin.number, t) for pin in self.pins])

    def spot(self, pin: int, t: ArrayLike) -> NDArray[np.float64]:
        """Return the spot of one pin, by number, on the page at times t (s, (n,)), (n, 2)."""
        return _spot(self.device, self.path, pin, t)

    def to_csv(self, path: str | PathLike[str], rate: float | str = default("rate")) -> Path:
        """Write each pin at even times as CSV: x, its velocity and acceleration, the forces on it.

        Args:
            path: The file of samples, pin after pin, on the path's clock. The events go beside it:
                those of "s.csv" to "s-events.csv". Both are whole or not there.
            rate: Samples a second, Hz, from 1e-6 to 1e12, the first at the path's begin.

        Returns:
            The path of the events.

        Raises:
            ValueError: The samples of all pins exceed their budget, as for `Motion.to_csv`.
        """
        from pindrive.files.export import scan_to_csv

        return scan_to_csv(self, path, rate)

    def to_dataset(self, times: ArrayLike | None = None) -> xr.Dataset:
        """All pins over time, their events and commands, the hand and the scene, with units.

        Args:
            times: s, shape (n,), on the path's clock; each millisecond and the end unless given.
        """
        from pindrive.device.dataset import dataset

        return dataset(self, times)


def scan(
    device: Device | pindrive.DeviceFile,
    page: Page | Scene | str,
    hand: HandPath | Reading | str | PathLike[str] | None = None,
    *,
    touch: float | str | Profile | None = None,
    start: Sequence[PinState] | None = None,
    max_angle: float | str | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Scan:
    """Simulate a device that moves over a page, with each pin exact.

    Args:
        device: Device as `load_device` reads it; or a `Device`, with the hand of `Reading`.
        page: Content of the page: a `Page` (text, an image, or lines), a `Scene`, or text.
        hand: Motion of the hand: a `HandPath`, whose positions are those at which the hand's axis
            crosses the array's middle; a `Reading`, which strokes along the lines of the page; or
            the CSV of a recorded path. None: strokes along the lines of the page, with the speed of
            the device file.
        touch: Force with which the finger presses on each pin, N, at least 0: a number, or a
            `Profile` on the path's clock, 0 where it is lifted; for a finger with a coefficient.
            None: that of the device file, otherwise that of the drive.
        start: State of each pin at the begin of the path, as `Scan.state` of an earlier scan; None:
            springs at rest, magnets off.
        max_angle: Angle between motion and drive axis above which a warning is given, rad, from 0
            to a right angle; None: that of the device file.
        threads: Number of pins simulated at once, at least 1; None: all cores.
        progress: Function called after each pin.

    Returns:
        The scan, with its warnings.

    Raises:
        ValueError: The page or the recording cannot be read, a state is missing or cannot be, the
            finger's friction does not follow a touch force, `threads` is no count, or there is more
            to do than `pindrive.quantities.budgets` allow.
        SimulationError: The simulation of a pin had to be given up.

    Examples:
        >>> import pindrive as pd
        >>> device = pd.load_device("tactile-reader.toml")
        >>> scan = pd.scan(device, pd.Page(grating=["4 mm"]))
        >>> scan
        <Scan of lines every 4 mm by 16 pins in 1.18438 s, ok>
        >>> scan.evaluate().counts["lines.shown"]
        64
    """
    described = None if isinstance(device, Device) else device
    if described is not None and not isinstance(described, pindrive.DeviceFile):
        required = "a Device or a DeviceFile"
        raise ValueError(refusal("device", required, repr(device)))
    whole = device if isinstance(device, Device) else device.device
    reading = Reading() if described is None else described.reading
    if isinstance(hand, Reading):
        reading, hand = hand, None
    if isinstance(page, str):
        page = Page(text=page)
    if not isinstance(page, Page | Scene):
        raise ValueError(refusal("page", "a Page, a Scene or text", repr(page)))
    if isinstance(page, Page):
        page.check("{}")
    scene = page if isinstance(page, Scene) else page.scene(reading, whole.array)
    if hand is None:
        path = (
            reading.strokes(scene, whole.array)
            if isinstance(page, Scene)
            else page.hand(reading, scene, whole.array)
        )
    else:
        path = hand if isinstance(hand, HandPath) else recorded(hand, reading)
    if start is not None and len(start) != len(whole.array):
        required = f"one state for each pin, {len(whole.array)}"
        raise ValueError(refusal("start", required, str(len(start))))
    angle = reading.max_angle if max_angle is None else check("max_angle", max_angle)
    workers = worker_count(threads)
    if touch is None and described is not None:
        touch = described.touch
    given = ScanInputs(
        whole,
        scene,
        path,
        None if start is None else tuple(start),
        None if touch is None else input_of("touch", touch),
    )
    criteria = None if described is None else described.criteria
    return followed(given, angle, criteria, workers, progress)


def followed(
    given: ScanInputs,
    max_angle: float,
    criteria: Criteria | None,
    threads: int = 1,
    progress: Progress | None = None,
) -> Scan:
    """Simulate the pins of a scan; arguments and errors as for `scan`."""
    core = energised(given)
    pins = tuple(PinScan(number=i, inputs=given, core=core) for i in range(len(given.states)))
    segments, done = core.simulate(threads, int(budgets.SEGMENTS.most), progress)
    budgets.SEGMENTS.check(segments, f"after {done} of {len(pins)} pins")
    for i in range(len(pins)):
        if (status := Status(core.motion(i).status)) != Status.ok:
            raise SimulationError(f"pin {i}", status)
    return Scan(inputs=given, core=core, pins=pins, max_angle=max_angle, criteria=criteria)


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


def _pin_of(given: ScanInputs, number: int) -> PinScan:
    return followed(given, 0.0, None).pins[number]


def check_work(device: Device, scene: Scene, path: HandPath) -> None:
    """Refuse a scan whose counts are beyond the budgets: known before anything is allocated."""
    pins, lasts = len(device.array), path.end - path.begin
    device.control.check_samples(path.begin, path.end, pins)
    of = f"{pins} pins, {len(path.times)} rows of hand speed for each"
    budgets.INPUT_ROWS.check(float(pins * len(path.times)), of)
    check_vibration(device.drive, lasts, pins)
    length = float(path.way(path.end))
    of = f"{pins} pins, {length:g} m of way, pixels of {1e3 * scene.pixel:g} mm"
    budgets.SAMPLES_OF_PAGE.check(pins * (len(path.times) + FINER * length / scene.pixel), of)


def _spot(device: Device, path: HandPath, pin: int, t: ArrayLike) -> NDArray[np.float64]:
    """Return the spot of one pin on the page at the times t (s, shape (n,)), m, shape (n, 2)."""
    hand = np.stack(path.position(t), axis=-1)
    return np.asarray(hand + device.array.on_page(device.array.spots[pin : pin + 1]))
