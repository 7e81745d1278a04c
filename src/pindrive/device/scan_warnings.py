"""What is doubtful about a scan, in words with numbers."""

from __future__ import annotations

from math import degrees
from typing import TYPE_CHECKING, Final

import numpy as np

from pindrive.device.scanning import AT_ONCE

if TYPE_CHECKING:
    from pindrive.device.scanning import Scan

ROUNDING: Final = 1e-9
"""So much too low is no sample rate too low."""


def scan_warnings(scan: Scan) -> tuple[str, ...]:
    """What is doubtful about a scan, a line each; nothing where nothing is."""
    return (*_doubts(scan), *_overlaps(scan))


def _doubts(scan: Scan) -> list[str]:
    """What is doubtful about a scan, but for pins that overlap."""
    found = []
    device, scene, path, max_angle = scan.device, scan.scene, scan.path, scan.max_angle
    control, speed = device.control, path.peak_speed
    beyond = _beyond(scan)
    if beyond:
        found.append(beyond)
    enough = control.enough_rate(speed, scene.pixel)
    if control.sample_rate < enough * (1.0 - ROUNDING):
        found.append(
            f"control.sample_rate = {control.sample_rate:g} Hz looks every "
            f"{1e3 * speed / control.sample_rate:.3g} mm at {1e3 * speed:.4g} mm/s, past pixels of "
            f"{1e3 * scene.pixel:.3g} mm: thin lines may be missed; {enough:.4g} Hz sees each"
        )
    if device.friction.doubt:
        found.append(device.friction.doubt)
    largest, mean = path.angles(device.array.axis)
    if largest > max_angle:
        found.append(
            f"the hand moves up to {degrees(largest):.3g} deg (mean {degrees(mean):.3g} deg) off "
            f"the drive axis, more than scan.max_angle, {degrees(max_angle):.3g} deg: the pins "
            f"feel {np.cos(largest):.0%} of the speed, and the plate's friction pulls askew"
        )
    if not any(len(pin.commands.times) or pin.commands.at_first for pin in scan.pins):
        found.append(
            f"no pin met information: nothing under their spots is darker than "
            f"{control.threshold - 0.5 * control.hysteresis:g}"
        )
    coil = device.magnet.coil
    if coil is not None:
        lasts = path.end - path.begin
        most = max(sum(end - begin for begin, end in pin.energised) for pin in scan.pins) / lasts
        if most > coil.duty:
            found.append(
                f"a magnet is on for {most:.0%} of the time; {coil.power:.3g} W warm it by "
                f"{coil.temperature_rise:g} K at {coil.duty:.0%}"
            )
    return found


def _beyond(scan: Scan) -> str:
    """How long a pin's spot is beyond the page, where it sees blank paper; empty: never."""
    worst, part = 0, 0.0
    for pin in scan.pins:
        off = 0
        for begin in range(0, len(pin.looks), AT_ONCE):
            spots = scan.spot(pin.number, pin.looks[begin : begin + AT_ONCE])
            off += int(np.count_nonzero(~scan.scene.contains(spots[:, 0], spots[:, 1])))
        if off > part * len(pin.looks):
            worst, part = pin.number, off / len(pin.looks)
    if not part:
        return ""
    left, right, top, bottom = (1e3 * edge for edge in scan.scene.extent)
    shown = f"{part:.0%}" if part >= 0.01 else "less than 1%"
    return (
        f"the spot of pin {worst} is beyond the page, {left:g} to {right:g} mm across and {top:g} "
        f"to {bottom:g} mm down, for {shown} of the time: it sees blank paper there"
    )


def _overlaps(scan: Scan) -> list[str]:
    """Pins that would have to pass through each other: the motions know nothing of that."""
    found = []
    gaps, array = scan.gaps, scan.device.array
    touching = [gap for gap in gaps if gap.size < 0.0]
    if touching:
        worst = min(touching, key=lambda gap: gap.size)
        pairs = f"; {len(touching)} of {len(gaps)} pairs of neighbours do" if len(gaps) > 1 else ""
        found.append(
            f"pins {worst.behind} and {worst.ahead} overlap by {-1e3 * worst.size:.4g} mm at "
            f"{worst.time:.4g} s{pairs}: real pins would push each other, these pass through"
        )
    for one, other in array.abreast[:1]:
        apart = abs(array.places[other][1] - array.places[one][1])
        found.append(
            f"pins {one} and {other} stand {1e3 * apart:.4g} mm apart across the drive axis, less "
            f"than array.pin_diameter, {1e3 * array.pin_diameter:.4g} mm: they overlap at rest"
        )
    return found
