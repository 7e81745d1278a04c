"""Feasibility of a device: fits, masses, and clearances of the pins.

The gap of two pins along the drive axis is their clearance at rest less how far one runs into the
other, x(ahead) - x(behind): x is counted against the drive axis. The core finds the smallest with a
proven bound (include/pindrive/device/closest_approach.hpp).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import hypot, pi
from typing import Final

from pindrive import _core
from pindrive.device.device import Device
from pindrive.device.pin_array import Neighbours
from pindrive.quantities.table import QUANTITIES

IRON: Final = 7870.0
COPPER: Final = 8960.0
"""Densities at 20 °C, kg/m³ (CRC Handbook of Chemistry and Physics)."""
SLACK: Final = 1e-9
"""So much too large, a part of itself, is rounding."""


def nearest_pins(places: Sequence[tuple[float, float]]) -> tuple[int, int, float] | None:
    """Two pins of which none stand closer, and how far apart they are, m; None of a single one."""
    inside = sorted(range(len(places)), key=lambda i: places[i])
    best: tuple[int, int, float] | None = None
    for at, i in enumerate(inside):
        for j in inside[at + 1 :]:
            if best and places[j][0] - places[i][0] >= best[2]:
                break
            apart = hypot(places[j][0] - places[i][0], places[j][1] - places[i][1])
            if best is None or apart < best[2]:
                best = min(i, j), max(i, j), apart
    return best


def doubts(device: Device) -> Iterator[str]:
    """Return the reasons for which a device cannot be built, a line each; none without sizes."""
    array, magnet = device.array, device.magnet
    nearest = nearest_pins(array.places)
    if nearest and magnet.outer_diameter is not None:
        one, other, apart = nearest
        if magnet.outer_diameter > apart * (1.0 + SLACK):
            wide = QUANTITIES["outer_diameter"].text(magnet.outer_diameter)
            yield (
                f"magnets cannot stand side by side: magnet.outer_diameter is {wide}, and pins "
                f"{one} and {other} are {QUANTITIES['pitch'].text(apart)} apart"
            )
    if array.slot_length is not None:
        ends = [(p, _apart(array.places, p.behind, p.ahead)) for p in array.neighbours]
        pair, step = min(ends, key=lambda end: end[1], default=(None, 0.0))
        if pair and array.slot_length > step * (1.0 + SLACK):
            yield (
                f"slots overlap: array.slot_length is "
                f"{QUANTITIES['slot_length'].text(array.slot_length)}, and pins {pair.behind} and "
                f"{pair.ahead} are {QUANTITIES['pitch'].text(step)} apart along the drive axis"
            )
    travel, room, slot = device.drive.travel, array.travel, array.slot_length
    if travel and room is not None and slot and travel > room * (1.0 + SLACK):
        wide = QUANTITIES["pin_diameter"].text(array.pin_diameter)
        yield (
            f"end stops outside the slot: drive.travel is {QUANTITIES['travel'].text(travel)} "
            f"either way, and in a slot (array.slot_length) of "
            f"{QUANTITIES['slot_length'].text(slot)} a pin {wide} wide (array.pin_diameter) has "
            f"{QUANTITIES['travel'].text(room)}"
        )
    moments = tipping(device)
    if moments and moments.tips:
        yield f"a magnet tips before it lets its pin go: {moments.words}"
    solid = heaviest(magnet.outer_diameter, magnet.height)
    if solid is not None and device.drive.mass > solid * (1.0 + SLACK):
        mass = QUANTITIES["mass"]
        yield (
            f"a magnet cannot be so heavy: drive.mass is {mass.text(device.drive.mass)}, and a "
            f"cylinder as wide and high as magnet.outer_diameter and magnet.height say weighs "
            f"{mass.text(solid)} in solid copper"
        )


@dataclass(frozen=True, slots=True)
class Tipping:
    """Moments about the edge of a magnet that carries its pin as far as it can.

    The friction of the plate balances spring and finger: what the finger's static friction leaves
    is the spring's.
    """

    spring: float
    """Force of the spring, N."""
    finger: float
    """Force of the finger, N."""
    spring_height: float
    """Height of the spring, m."""
    pin_height: float
    """Height of the finger, m."""
    stays: float
    """Moment of weight and pull, which hold it, N*m."""

    @property
    def turns(self) -> float:
        """Moment of spring and finger, N*m."""
        return self.spring * self.spring_height + self.finger * self.pin_height

    @property
    def tips(self) -> bool:
        """True if spring and finger win."""
        return self.turns > self.stays * (1.0 + SLACK)

    @property
    def words(self) -> str:
        """The moments in words."""
        length, force = QUANTITIES["height"], QUANTITIES["plate.kinetic"]
        return (
            f"spring ({force.text(self.spring)} at magnet.spring_height, "
            f"{length.text(self.spring_height)}) and finger ({force.text(self.finger)} at "
            f"magnet.pin_height, {length.text(self.pin_height)}) turn it with "
            f"{1e3 * self.turns:.3g} mN*m, and it stands with {1e3 * self.stays:.3g} mN*m"
        )


def tipping(device: Device) -> Tipping | None:
    """The moments on a magnet of a device; None without its size."""
    magnet, drive = device.magnet, device.drive
    if magnet.outer_diameter is None or magnet.height is None:
        return None
    held = drive.plate.static_friction * device.load(magnet.sustained_pull)
    finger = min(drive.finger.static_friction, held)
    middle, top = 0.5 * magnet.height, magnet.height
    return Tipping(
        spring=held - finger,
        finger=finger,
        spring_height=middle if magnet.spring_height is None else magnet.spring_height,
        pin_height=top if magnet.pin_height is None else magnet.pin_height,
        stays=0.5 * magnet.outer_diameter * (drive.normal_force + magnet.sustained_pull),
    )


def heaviest(diameter: float | None, height: float | None) -> float | None:
    """Return the mass of a solid copper cylinder with these sizes (m), kg; None if incomplete."""
    if diameter is None or height is None:
        return None
    return COPPER * pi / 4.0 * diameter**2 * height


def _apart(places: Sequence[tuple[float, float]], behind: int, ahead: int) -> float:
    """Return the distance of one pin ahead of another along the drive axis, m."""
    return places[ahead][0] - places[behind][0]


# ---- how close neighbouring pins come ------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Gap:
    """The smallest gap between two neighbouring pins in a scan."""

    behind: int
    ahead: int
    """Their numbers, as the array has them."""
    size: float
    """m; negative where they would have to pass through each other."""
    time: float
    """Earliest time of the smallest gap, s, on the path's clock."""


def smallest_gaps(
    neighbours: Sequence[Neighbours],
    motions: Sequence[_core.Motion],
    begin: float,
    duration: float,
) -> tuple[Gap, ...]:
    """The smallest gap of each pair of neighbours.

    Args:
        neighbours: Neighbours of each pin in the array.
        motions: Motion of each pin, by its number, as the core has it.
        begin: Begin of the motions on the clock of the path, s.
        duration: Duration of the search, s.
    """
    pairs = [(pair.behind, pair.ahead) for pair in neighbours]
    found = zip(*_core.closest_approaches(motions, pairs, duration), strict=True)
    return tuple(
        Gap(pair.behind, pair.ahead, pair.clearance + float(approach), begin + float(time))
        for pair, (approach, time) in zip(neighbours, found, strict=True)
    )
