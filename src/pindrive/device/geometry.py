"""Whether a device can be built: what stands side by side or fits in what, and what it weighs."""

from __future__ import annotations

from math import hypot, pi
from typing import TYPE_CHECKING, Final

from pindrive.quantities.table import QUANTITIES

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from pindrive.device.device import Device

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
    """What cannot be built so, a line each; nothing where all of it can, or sizes are not given."""
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
    solid = heaviest(magnet.outer_diameter, magnet.height)
    if solid is not None and device.drive.mass > solid * (1.0 + SLACK):
        mass = QUANTITIES["mass"]
        yield (
            f"a magnet cannot be so heavy: drive.mass is {mass.text(device.drive.mass)}, and a "
            f"cylinder as wide and high as magnet.outer_diameter and magnet.height say weighs "
            f"{mass.text(solid)} in solid copper"
        )


def heaviest(diameter: float | None, height: float | None) -> float | None:
    """The mass of a solid cylinder of copper, kg, of these sizes (m); None if one is not given."""
    if diameter is None or height is None:
        return None
    return COPPER * pi / 4.0 * diameter**2 * height


def _apart(places: Sequence[tuple[float, float]], behind: int, ahead: int) -> float:
    """How far one pin stands ahead of the other along the drive axis, m."""
    return places[ahead][0] - places[behind][0]
