"""A scan: the hand moves the device over a scene, and each pin's motion is followed exactly.

Each pin is simulated from the scan's begin to its end in one motion: dragged a little while its
magnet is off, carried while it is on, slipping where the spring overcomes the magnet, released,
swinging, caught again in mid-swing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

import pindrive
from pindrive import _core
from pindrive.device.compliant_hand import HandMotion, follow_hand
from pindrive.device.device import Criteria, Device
from pindrive.device.geometry import Gap, smallest_gaps
from pindrive.device.hand import HandPath
from pindrive.device.hand_force import HandForce, force_on_hand, hand_force
from pindrive.device.page import Scene
from pindrive.device.page_description import Page, recorded
from pindrive.device.pin_array import Neighbours
from pindrive.device.pin_scan import (
    PinScan,
    PinState,
    Progress,
    ScanInputs,
    simulated,
    spot_at,
)
from pindrive.device.reading import Reading
from pindrive.lazy import mpl_figure, xr
from pindrive.motion.profile import Profile
from pindrive.motion.release import (
    input_of,
)
from pindrive.quantities.budgets import worker_count
from pindrive.quantities.quantity import counted
from pindrive.quantities.refusal import refusal
from pindrive.quantities.status import Status
from pindrive.quantities.table import check, default
from pindrive.quantities.value import equal_by_value
from pindrive.views import NotebookHtml, csv_file, evaluation, figure


@dataclass(frozen=True, slots=True)
class SlotRoom:
    """Smallest distance of a pin from the end of its slot in a scan."""

    pin: int
    """Its number."""
    size: float
    """m; negative where it would go beyond."""


@equal_by_value
@dataclass(frozen=True, kw_only=True, eq=False)
class Scan(NotebookHtml):
    """Motion of a device that a hand moved over a scene."""

    inputs: ScanInputs
    core: _core.Scan = field(repr=False, compare=False)
    max_angle: float
    """Between motion and drive axis beyond which a warning is given, rad."""
    criteria: Criteria | None = None
    """Criteria of the device file, for `evaluate`."""
    hand: HandMotion | None = None
    """Path of a hand that gave way, beside the intended one; None: nothing could slow it."""

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle the inputs of the scan, which is repeated."""
        return followed, (self.inputs, self.max_angle, self.criteria, 1, None, self.hand)

    @cached_property
    def pins(self) -> tuple[PinScan, ...]:
        """Motion of each pin, in the order of the array."""
        count = len(self.inputs.states)
        return tuple(PinScan(number=i, inputs=self.inputs, core=self.core) for i in range(count))

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
        return evaluation(self, "evaluate", chosen)

    def plot(self, pin: int | None = None) -> mpl_figure.Figure:
        """Plot the scanned page and the motions of the pins.

        Args:
            pin: The one drawn in detail, from 0; one that reads a line unless given.

        Returns:
            A figure; `figure.savefig(FILE)` writes it.
        """
        return self.evaluate().plot(pin)  # type: ignore[no-any-return]

    def plot_hand(self) -> mpl_figure.Figure:
        """Plot speed and place of a hand that gave way beside those intended, over time.

        Raises:
            ValueError: Nothing could slow the hand.
        """
        if self.hand is None:
            raise ValueError(refusal("the device", "one with a hand, [hand]", "one without"))
        return figure(self, "plot_hand", self.hand)

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """Doubts about the scan, in words with numbers."""
        from pindrive.device.dataset import scan_warnings

        return scan_warnings(self)

    def force_on_hand(self, t: ArrayLike) -> NDArray[np.float64]:
        """Return the force of all pins on the hand at times on the clock of the path, N.

        Springs, dampers, skins and end stops push it; the force is positive against the way of the
        drive axis, so that it slows a hand that moves along the axis.

        Args:
            t: s, any shape, from begin to end of the path.

        Raises:
            ValueError: A time is outside of the path.
        """
        return force_on_hand(self, np.asarray(t, np.float64))

    @cached_property
    def hand_force(self) -> HandForce:
        """Largest force of all pins on the hand, its mean and its work."""
        return hand_force(self)

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
        """The least room of a pin to the end of its slot; None if the array states no slots."""
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
        return spot_at(self.device, self.path, pin, t)

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
        return csv_file(self, "to_csv", path, rate)

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
            the device file. A hand that gives way (`Device.hand`) means to take this path.
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
    moved: HandMotion | None = None
    if whole.hand is not None:
        given, moved = follow_hand(given)
    return followed(given, angle, criteria, workers, progress, moved)


def followed(
    given: ScanInputs,
    max_angle: float,
    criteria: Criteria | None,
    threads: int = 1,
    progress: Progress | None = None,
    hand: HandMotion | None = None,
) -> Scan:
    """Simulate the pins of a scan along a path that is known; arguments and errors as for `scan`.

    Args:
        given: Inputs of the scan.
        max_angle: Angle between motion and drive axis above which a warning is given, rad.
        criteria: Criteria of the evaluation.
        threads: Number of pins simulated at once.
        progress: Function called after each pin.
        hand: Path of a hand that gave way.
    """
    core = simulated(given, threads, progress)
    return Scan(inputs=given, core=core, max_angle=max_angle, criteria=criteria, hand=hand)
