"""A scan as a person reads it in a terminal: what each pin did."""

from __future__ import annotations

from math import degrees, nan
from typing import TYPE_CHECKING, Final

from rich.console import Group, RenderableType
from rich.text import Text

from pindrive.device.dataset import numbers
from pindrive.quantities import QUANTITIES
from pindrive.quantities_device import PIN
from pindrive.report import TRUSTED, new_table

if TYPE_CHECKING:
    from rich.table import Table

    from pindrive.device.device import Device
    from pindrive.device.scanning import PinScan, Scan

HEAD, TAIL = 24, 8
"""How many pins of a large array are shown, from its first and from its last."""
HEADINGS: Final = {
    "pin.energised": "magnet\non",
    "pin.switchings": "times\non",
    "pin.slips": "slips\nwhile on",
    "pin.captures": "times\ncaught",
    "pin.carried": "time\nheld",
    "pin.peak_displacement": "peak\n|x|",
    "pin.peak_skin_force": "peak\nforce",
    "pin.peak_stretch": "peak\nstretch",
    "pin_gap": "least\ngap",
}
_MM: Final = 1e3


def scan_report(scan: Scan) -> RenderableType:
    """Its pins in a table, then its hand, its device and how far it can be trusted, in words."""
    lines = (Text(line, no_wrap=True, overflow="ignore") for line in _words(scan))
    return Group(_pins(scan), *lines)


def _pins(scan: Scan) -> Table:
    names = [q.name for q in PIN]
    if scan.device.drive.finger.rigid:
        names.remove("pin.peak_stretch")
    if scan.gaps:
        names.append("pin_gap")
    title = f"Pins, over {scan.scene.title}"
    found = new_table(title, ">pin", ">place", *(f">{HEADINGS[name]}" for name in names))
    found.collapse_padding, found.pad_edge = True, False  # all of it in a hundred columns
    found.add_row("", "mm", *(QUANTITIES[name].display_unit for name in names), style="dim")
    for pin in scan.pins:
        if HEAD <= pin.number < len(scan.pins) - TAIL:
            if pin.number == HEAD:
                found.add_row("...", f"{len(scan.pins) - HEAD - TAIL} more")
            continue
        found.add_row(*_row(scan, pin, names))
    return found


def _row(scan: Scan, pin: PinScan, names: list[str]) -> list[str]:
    x, y = scan.device.array.places[pin.number]
    values = numbers(pin)
    beside = [gap.size for gap in scan.gaps if pin.number in (gap.behind, gap.ahead)]
    values["pin_gap"] = min(beside, default=nan)
    cells = [
        f"{values[n]:g}" if QUANTITIES[n].unit == "" else QUANTITIES[n].digits(values[n])
        for n in names
    ]
    return [str(pin.number), f"{_MM * x:g}, {_MM * y:g}", *cells]


def _words(scan: Scan) -> list[str]:
    device, path = scan.device, scan.path
    largest, _ = path.angles(device.array.axis)
    speed = QUANTITIES["hand_speed"].text(path.peak_speed)
    worst = max(pin.motion.certificate().worst for pin in scan.pins)
    doubt = "" if worst <= TRUSTED else " Do not trust this scan."
    return [
        f"The hand's path takes {path.end - path.begin:.4g} s, at {speed} at the most, up to "
        f"{degrees(largest):.3g} deg off the drive axis.",
        *gap_words(scan),
        *device_words(device),
        f"Laws checked without the solver: largest relative residual {worst:.1e}.{doubt}",
    ]


def gap_words(scan: Scan) -> list[str]:
    """How close neighbouring pins come; nothing where none stands ahead of another."""
    smallest, length = scan.smallest_gap, QUANTITIES["pin_gap"]
    if smallest is None:
        return []
    pins = f"pins {smallest.behind} and {smallest.ahead} at {smallest.time:.4g} s"
    if smallest.size < 0.0:
        overlap = f"Pins overlap by up to {length.text(-smallest.size)}, {pins}"
        return [f"{overlap}: real pins would push each other."]
    return [f"Smallest gap between neighbouring pins: {length.text(smallest.size)}, {pins}."]


def device_words(device: Device) -> list[str]:
    """What follows from a device's numbers."""
    length, force = QUANTITIES["displacement"], QUANTITIES["hold_force"]
    drag = f" Off, the plate drags it {length.text(device.drag)}." if device.drag else ""
    if device.reach:
        words = [f"A magnet carries its pin up to {length.text(device.reach)}.{drag}"]
    else:
        held = device.drive.plate.static_friction * device.load(device.magnet.hold_force)
        words = [
            f"A magnet does not carry its pin: it holds with {force.text(held)} of friction at "
            f"most, the finger with {force.text(device.drive.finger.kinetic)}.{drag}"
        ]
    words.append(f"The plate: {device.friction.words}.")
    coil = device.magnet.coil
    if coil is not None:
        quantities = [
            QUANTITIES[f"coil.{name}"].text(getattr(coil, name))
            for name in ("resistance", "inductance", "current", "power")
        ]
        words.append(
            f"Its coil: {', '.join(quantities)}; on for {coil.duty:.0%} of the time at most, to "
            f"warm by {coil.temperature_rise:g} K."
        )
    return words


def meeting_words(device: Device, speed: float) -> list[str]:
    """Whether neighbouring pins can meet, by where they stand and how far they go at most.

    Args:
        device: the device.
        speed: of the hand at most, m/s.
    """
    array, length = device.array, QUANTITIES["pin_gap"]
    neighbours = array.neighbours
    words = [
        f"Pins {one} and {other} stand abreast, closer than their diameter: they overlap."
        for one, other in array.abreast[:1]
    ]
    if not neighbours:
        return words
    room, reach = min(pair.clearance for pair in neighbours), device.excursion(speed)
    at = f"at {QUANTITIES['hand_speed'].text(speed)} of the hand a pin goes up to"
    gone = f"{at} {length.text(reach)} either way"
    if room < 0.0:
        words.append(f"Neighbouring pins overlap by {length.text(-room)} at rest.")
    elif room < 2.0 * reach:
        words.append(
            f"Neighbouring pins have {length.text(room)} between them at rest, and can meet: "
            f"{gone}. A scan says whether they do."
        )
    else:
        words.append(
            f"Neighbouring pins have {length.text(room)} between them at rest, and cannot meet: "
            f"{gone}."
        )
    return words
