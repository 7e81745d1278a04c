"""A scan: the hand moves the device over a scene, and each pin's motion is followed exactly.

Each pin is simulated from the scan's begin to its end in one motion: dragged a little while its
magnet is off, carried while it is on, slipping where the spring overcomes the magnet, released,
swinging, caught again in mid-swing.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

import pindrive
from pindrive import lazy
from pindrive.device.controller import Decision
from pindrive.device.current import CoilState, Commands, Current, commanded_spans
from pindrive.device.device import Criteria, Device
from pindrive.device.geometry import Gap, smallest_gaps
from pindrive.device.hand import HandPath
from pindrive.device.page import AT_ONCE, FINER, Scene
from pindrive.device.page_description import Page, recorded
from pindrive.device.pin_array import Neighbours
from pindrive.device.reading import Reading
from pindrive.device.touch import finger_load, held_stretch
from pindrive.device.trajectory import check_vibration
from pindrive.lazy import mpl_figure, xr
from pindrive.motion.drive import Drive
from pindrive.motion.motion import Motion
from pindrive.motion.profile import Profile
from pindrive.motion.release import Release, input_of
from pindrive.motion.results import Event
from pindrive.motion.simulate import simulated
from pindrive.quantities import budgets
from pindrive.quantities.budgets import worker_count
from pindrive.quantities.quantity import counted
from pindrive.quantities.refusal import refusal
from pindrive.quantities.status import SimulationError, Status
from pindrive.quantities.table import check, default
from pindrive.quantities.value import concise, equal_by_value

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


@equal_by_value
@concise
@dataclass(frozen=True, kw_only=True, eq=False)
class PinScan:
    """One pin in a scan: its inputs, and the motion to which they lead, computed when first asked.

    Times are those of the hand's path.
    """

    number: int
    """Its place in the array, from 0."""
    drive: Drive
    begin: float
    end: float
    """End of the scan, s."""
    sample_times: NDArray[np.float64]
    """Sampling instants of the control block, s, shape (n,)."""
    luminance: NDArray[np.float64]
    """Luminance at the pin's spot, shape (n,)."""
    commands: Commands
    """Switchings of the coil by the control block."""
    current: Current
    """The current in the coil, a part of the full one, over time."""
    release: Release
    """The state at `begin`, and the inputs over the time since."""
    coil: CoilState
    """The coil's last switching."""
    decision: Decision
    """State of the control block at the end."""

    @property
    def motion(self) -> Motion:
        """The pin's motion, over the time since `begin`.

        Raises:
            SimulationError: The simulation had to be given up.
        """
        kept = vars(self)  # cached_property of Python 3.11 lets one thread at a time compute
        if "_motion" not in kept:
            kept["_motion"] = self._followed()
        found: Motion = kept["_motion"]
        return found

    def _followed(self) -> Motion:
        motion = simulated(self.drive, self.release, duration=self.end - self.begin)
        if motion.status != Status.ok:
            raise SimulationError(f"pin {self.number}", motion.status)
        return motion

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
        return float(np.abs(self.motion.extrema("position").value).max())

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
        return PinState(
            position=position,
            velocity=0.0 if strikes else None if last.plate == 0 else velocity,
            skin_stretch=self.motion.stretch(lasts, "left") if grips else None,
            coil=self.coil,
            decision=self.decision,
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

    device: Device
    scene: Scene
    path: HandPath
    pins: tuple[PinScan, ...]
    max_angle: float
    """Between motion and drive axis beyond which a warning is given, rad."""
    touch: float | Profile | None = None
    """Touch force on each pin over the path's clock, N; None: that of the drive."""
    criteria: Criteria | None = None
    """Criteria of `evaluate` unless given; None: values of the literature."""

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
        motions = [pin.motion for pin in self.pins]
        found = smallest_gaps(together, motions, self.path.begin)
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
    pins = prepare(whole, scene, path, start, touch)
    segments = 0
    pool = ThreadPoolExecutor(max_workers=min(workers, len(pins)))
    try:
        for done, motion in enumerate(pool.map(lambda pin: pin.motion, pins), 1):
            segments += motion.segment_count
            budgets.SEGMENTS.check(segments, f"after {done} of {len(pins)} pins")
            if progress:
                progress(done, len(pins))
    finally:  # after an error or Ctrl-C no further pin begins
        pool.shutdown(wait=False, cancel_futures=True)
    return Scan(
        device=whole,
        scene=scene,
        path=path,
        pins=tuple(pins),
        max_angle=angle,
        touch=None if touch is None else input_of("touch", touch),
        criteria=None if described is None else described.criteria,
    )


def prepare(
    device: Device,
    scene: Scene,
    path: HandPath,
    start: Sequence[PinState] | None = None,
    touch: float | str | Profile | None = None,
) -> list[PinScan]:
    """Read the scene under each spot and switch the coils; nothing moves yet.

    Arguments and errors as for `scan`.
    """
    check_work(device, scene, path)
    sample_times = device.control.sample_times(path.begin, path.end)
    plate_velocity = path.plate_velocity(device.array.axis)
    across_velocity = path.across_velocity(device.array.axis)
    pressed = finger_load(device.drive, touch, path.begin)
    states = [PinState()] * len(device.array) if start is None else start
    prepared: list[PinScan] = []
    rows = switchings = 0
    for number, state in enumerate(states):
        luminance = _seen(device, scene, path, sample_times, number)
        decide = device.control.decide
        commands, decision = decide(luminance, sample_times, path.end, state.decision)
        before = CoilState(path.begin) if state.coil is None else state.coil
        current = device.magnet.current(commands, before, path.begin, path.end)
        switchings += len(current.begins) - 1
        budgets.SWITCHINGS.check(switchings, f"up to pin {number} of {len(states)}")
        load, coil = _load(device, commands, current, before, path)
        loads = (load, pressed)
        rows += sum(len(given.times) if isinstance(given, Profile) else 1 for given in loads)
        rows += len(path.times)
        budgets.INPUT_ROWS.check(rows, f"up to pin {number} of {len(states)}")
        prepared.append(
            PinScan(
                number=number,
                drive=device.drive,
                begin=path.begin,
                end=path.end,
                sample_times=sample_times,
                luminance=luminance,
                commands=commands,
                current=current,
                release=Release(
                    plate_velocity,
                    state.position,
                    state.velocity,
                    load,
                    None
                    if state.skin_stretch is None
                    else held_stretch(state.skin_stretch, device.drive.finger, pressed),
                    across_velocity=across_velocity,
                    finger_load=pressed,
                ),
                coil=coil,
                decision=decision,
            )
        )
    return prepared


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


def _load(
    device: Device, commands: Commands, current: Current, before: CoilState, path: HandPath
) -> tuple[float | Profile, CoilState]:
    """The load on the plate's friction over the time since the path's begin, and how it ends."""
    if not current.on.any() and before.flux == 0.0:
        return device.load(device.magnet.residual), before
    times, pull = device.magnet.pull_rows(current, path.end, before.pull)
    spans = commanded_spans(commands, before, path.begin, path.end)
    last = max(0, int(np.searchsorted(current.begins, path.end)) - 1)  # the gap may open later
    since = float(current.begins[last])
    after = CoilState(
        since,
        bool(current.on[last]),
        float(current.starts[last]),
        float(pull[np.searchsorted(times, since)]),
        float(current.warmings[last]),
        float(current.levels[last]),
        spans[-1][0] if spans else before.commanded,
    )
    gone = max(0, int(np.searchsorted(times, path.begin, "right")) - 1)
    load = device.load(pull[gone:])
    if len(load) == 1:
        return float(load[0]), after
    return Profile((times[gone:] - path.begin).tolist(), load.tolist()), after


def _spot(device: Device, path: HandPath, pin: int, t: ArrayLike) -> NDArray[np.float64]:
    """Return the spot of one pin on the page at the times t (s, shape (n,)), m, shape (n, 2)."""
    hand = np.stack(path.position(t), axis=-1)
    return np.asarray(hand + device.array.on_page(device.array.spots[pin : pin + 1]))


def _seen(
    device: Device, scene: Scene, path: HandPath, sample_times: NDArray[np.float64], pin: int
) -> NDArray[np.float64]:
    """Return the luminance samples at one pin's spot, shape (samples,)."""
    luminance = np.empty_like(sample_times)
    for begin in range(0, len(sample_times), AT_ONCE):
        part = slice(begin, begin + AT_ONCE)
        luminance[part] = scene.at(*_spot(device, path, pin, sample_times[part]).T)
    return luminance
