"""The whole device as data: drive, electromagnet, control block, pin array; what counts as felt."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import cos
from typing import overload

import numpy as np
from numpy.typing import NDArray

from pindrive import _core
from pindrive.device.controller import ControlBlock
from pindrive.device.electromagnet import Electromagnet
from pindrive.device.hand_mechanics import Hand
from pindrive.device.pin_array import Neighbours, PinArray
from pindrive.motion.coefficients import Coefficients
from pindrive.motion.drive import Drive, values_of
from pindrive.motion.release import drive_numbers
from pindrive.quantities.contradictions import refuse
from pindrive.quantities.part import Number
from pindrive.quantities.table import checked, default
from pindrive.quantities.value import concise


@concise
@dataclass(frozen=True, slots=True, kw_only=True)
class Device:
    """A tactile device: pins that are all alike, each with its own magnet and spot.

    Args:
        drive: Drive of each pin; the friction of its plate is that with the magnet off.
        magnet: Electromagnet of each pin.
        control: The control block.
        array: Places of the pins.
        hand: Hand that gives way to its pins; None: nothing can slow it.

    Raises:
        ValueError: A plate without friction, by which no magnet could hold.
    """

    drive: Drive
    magnet: Electromagnet = field(default_factory=Electromagnet)
    control: ControlBlock = field(default_factory=ControlBlock)
    array: PinArray = field(default_factory=PinArray)
    hand: Hand | None = None

    def __post_init__(self) -> None:
        """Validate what fits together."""
        refuse(values_of(self.drive), whole=True)

    @property
    def core(self) -> _core.Device:
        """Return the device as the core has it."""
        drive, control, array = self.drive, self.control, self.array
        return _core.Device(
            drive_numbers(drive),
            (drive.normal_force, drive.plate_touch),
            self.magnet.core_numbers,
            (control.sample_rate, control.latency, control.threshold, control.hysteresis),
            array.axis,
            np.ascontiguousarray(array.on_page(array.spots), np.float64),
        )

    @property
    def magnet_neighbours(self) -> tuple[Neighbours, ...]:
        """Magnets that would meet if one moved far; none where their diameter is not known."""
        width = self.magnet.outer_diameter
        return () if width is None else self.array.neighbours_of(width)

    @property
    def friction(self) -> Coefficients:
        """The plate's friction over the force that presses: μ = F / W, kinetic and static."""
        return Coefficients.of(self.drive)

    @property
    def reach(self) -> float:
        """Largest displacement of a carried pin before the spring wins over the magnet, m."""
        held = self.drive.plate.static_friction * self.load(self.magnet.sustained_pull)
        return max(0.0, held - self.drive.finger.kinetic) / self.drive.stiffness

    def excursion(self, speed: float) -> float:
        """Largest displacement of a pin from its rest in either direction, m.

        Carried to where the plate's friction ends against the spring, static or at the speeds at
        which it pulls outwards, it has the plate's velocity left. A hand that speeds up by a adds
        m a / k. No pin goes beyond rigid end stops.

        Args:
            speed: Largest speed of the hand, m/s.
        """
        held = self.drive.plate.largest(speed) * self.load(self.magnet.hold_force)
        reach = held / self.drive.stiffness + speed / self.drive.natural_frequency
        ends = self.drive.rigid_travel
        return reach if ends is None else min(reach, ends)

    def drag(
        self, angle: float = default("axis"), finger_load: float = default("finger_load")
    ) -> float:
        """Quasi-static drag of the plate on a pin that is off, m; 0 in stick on the finger.

        Args:
            angle: Angle between the motion of the hand and the drive axis, rad.
            finger_load: Touch over `touch_force`, 0 where the finger is lifted.
        """
        drive, finger = self.drive, self.drive.finger
        touched = drive.plate_touch * (finger_load - 1.0)
        plate = drive.plate.kinetic * self.load(self.magnet.residual + touched) * abs(cos(angle))
        pressed = float(finger_load**drive.load_exponent)
        if plate <= finger.static_friction * pressed:
            return 0.0
        return (plate - finger.kinetic * pressed) / drive.stiffness

    @overload
    def load(self, pull: float) -> float: ...
    @overload
    def load(self, pull: NDArray[np.float64]) -> NDArray[np.float64]: ...
    def load(self, pull: float | NDArray[np.float64]) -> float | NDArray[np.float64]:
        """The factor on the plate's friction at a pull (N), any shape: (W + P) / W."""
        return 1.0 + pull / self.drive.normal_force


@checked
class Criteria:
    """Criteria of the evaluation, by the sources in the table of quantities.

    Args:
        felt: Motion that is felt as a pulse, m, greater than 0.
        direction: Motion of skin whose direction is perceived, m, greater than 0.
        direction_sure: Skin motion whose direction is recognised in more than 95 % of cases, m.
        direction_speed: Least mean speed of the skin over `direction_sure`, m/s.
        false_line: Least height of a false line over that of the line before, in (0, 1].
        distinct: Least return of the pin between two distinct lines, over its way back to the rest,
            in (0, 1]; and at least `felt`.

    Raises:
        ValueError: A value is not a number or out of its range.
    """

    felt: Number = default("felt")
    direction: Number = default("direction")
    direction_sure: Number = default("direction_sure")
    direction_speed: Number = default("direction_speed")
    false_line: Number = default("false_line")
    distinct: Number = default("distinct")

    @property
    def numbers(self) -> tuple[float, float, float, float, float, float]:
        """Values in the order of the core, SI."""
        return (
            self.felt,
            self.direction,
            self.direction_sure,
            self.direction_speed,
            self.false_line,
            self.distinct,
        )
