"""A scan as an xarray Dataset, what each pin did in numbers, and what is doubtful about it."""

from __future__ import annotations

from dataclasses import asdict
from io import BytesIO
from math import degrees, nan
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pindrive.device.coil import Coil, DataSheet
from pindrive.device.compliant_hand import HandMotion
from pindrive.device.geometry import doubts
from pindrive.device.hand import HandPath
from pindrive.device.hand_force import LARGEST, HandForce
from pindrive.device.page import AT_ONCE
from pindrive.device.pin_scan import PinScan
from pindrive.device.scanning import Scan
from pindrive.lazy import xr
from pindrive.motion.dataset import columns
from pindrive.motion.profile import Profile
from pindrive.quantities import budgets
from pindrive.quantities.quantity import counted
from pindrive.quantities.results import SERIES
from pindrive.quantities.table import QUANTITIES

EACH: Final = 1e-3
"""Between two samples unless their times are given, s."""
ROUNDING: Final = 1e-9
SLOWED: Final = 0.9
"""Part of the intended speed below which a warning is given."""
"""So much too low is no sample rate too low."""


def dataset(scan: Scan, times: ArrayLike | None = None) -> xr.Dataset:
    """Variables over (pin, time), and tables of events and switchings with the pin of each row.

    Args:
        scan: The scan.
        times: s, shape (n,), on the path's clock; each millisecond and the end unless given.

    Raises:
        ValueError: Too many samples.
    """
    from pindrive import __version__

    device, path, pins = scan.device, scan.path, scan.pins
    check_samples(len(pins), sample_count(path) if times is None else np.size(times))
    if times is None:
        times = np.append(np.arange(path.begin, path.end, EACH), path.end)
    t = np.atleast_1d(np.asarray(times, np.float64))
    plate_velocity = path.plate_velocity(device.array.axis)(t - path.begin)
    over_time = dict(zip(("hand_x", "hand_y"), path.position(t), strict=True))
    over_time["hand_force"] = scan.force_on_hand(t)
    if scan.hand:
        over_time["hand_deviation"] = scan.hand.deviation(t)
    if scan.touch is not None:
        touch = scan.touch
        over_time["touch"] = touch(t) if isinstance(touch, Profile) else np.full(t.shape, touch)
    data: dict[str, Any] = {
        name: ("time", values, SERIES[name].attributes)
        for name, values in (over_time | {"plate_velocity": plate_velocity}).items()
    }
    of_pins = [_columns(scan, pin, t) for pin in pins]
    for name in of_pins[0]:
        values = np.stack([found[name] for found in of_pins])
        data[name] = (("pin", "time"), values, SERIES[name].attributes)
    data |= _events(pins) | _switchings(pins) | _numbers(pins) | _gaps(scan)
    data["scene"] = _over(("row", "column"), scan.scene.luminance, "1", "luminance of the scene")
    places, shown = np.array(device.array.places), np.array(device.array.spots)
    coords = {
        "time": _over("time", t, "s", "time of the path"),
        "pin": ("pin", np.arange(len(pins))),
        "pin_x": _over("pin", places[:, 0], "m", "place in the mouse along the drive axis"),
        "pin_y": _over("pin", places[:, 1], "m", "place in the mouse across the drive axis"),
        "spot_x": _over("pin", shown[:, 0], "m", "place of the spot along the drive axis"),
        "spot_y": _over("pin", shown[:, 1], "m", "place of the spot across the drive axis"),
        "row": _over("row", _middles(scan, 0), "m", "down the page"),
        "column": _over("column", _middles(scan, 1), "m", "across the page"),
    }
    attributes = {
        "title": f"Scan of {scan.scene.title}",
        "source": f"pindrive {__version__}",
        "warnings": "\n".join(scan.warnings),
        **inputs(scan),
        **{
            name: value
            for name, value in (
                ("smallest_pin_gap", scan.smallest_gap and scan.smallest_gap.size),
                ("smallest_magnet_gap", scan.smallest_magnet_gap and scan.smallest_magnet_gap.size),
                ("slot_room", scan.slot_room and scan.slot_room.size),
                *_hand_numbers(scan),
                *((f"hand_force_{name}", value) for name, value in asdict(scan.hand_force).items()),
            )
            if value is not None
        },
    }
    return xr.Dataset(data, coords=coords, attrs=attributes)


def _hand_numbers(scan: Scan) -> list[tuple[str, float]]:
    """Numbers of the path of a hand that gave way, by the names of attributes."""
    numbers = scan.hand.numbers if scan.hand else {}
    return [(name.replace(".", "_"), value) for name, value in numbers.items()]


def sample_count(path: HandPath) -> float:
    """At how many times a scan is sampled unless they are given: each millisecond and the end."""
    return (path.end - path.begin) / EACH + 1.0


def check_samples(pins: int, times: float) -> None:
    """Reject too many samples of all pins and times."""
    budgets.SAMPLES.check(pins * times, f"{pins} pins at {times:.0f} times")


def write_netcdf(scan: Scan, path: Path) -> None:
    """Write `Scan.to_dataset`; made in memory first, so that a full disk is refused as such."""
    file = BytesIO()
    packed = {"zlib": True, "complevel": 1}
    scan.to_dataset().to_netcdf(
        file, engine="h5netcdf", encoding={"scene": packed, "luminance": packed}
    )
    path.write_bytes(file.getvalue())


def inputs(scan: Scan) -> dict[str, float]:
    """Return the simulated inputs, SI, by names of the table of quantities."""
    device = scan.device
    drive, magnet = device.drive, device.magnet
    values = {
        "mass": drive.mass,
        "stiffness": drive.stiffness,
        "damping": drive.damping,
        "plate.kinetic": drive.plate.kinetic,
        "plate.static": drive.plate.static_friction,
        "finger.kinetic": drive.finger.kinetic,
        "finger.static": drive.finger.static_friction,
        **({} if drive.finger.rigid else {"finger.stiffness": drive.finger.stiffness}),
        **({"finger.damping": drive.finger.damping} if drive.finger.damping else {}),
        **{k: v for k, v in asdict(magnet).items() if isinstance(v, float)},
        "normal_force": drive.normal_force,
        "preload": drive.preload,
        **({} if drive.touch_force is None else {"touch_force": drive.touch_force}),
        **asdict(device.control),
        **({} if magnet.coil is None else _given(magnet.coil)),
        "axis": device.array.axis,
        "pin_diameter": device.array.pin_diameter,
        **({} if device.array.slot_length is None else {"slot_length": device.array.slot_length}),
        "friction_coefficient": device.friction.kinetic,
        "pixel": scan.scene.pixel,
    }
    angles = scan.path.angles(device.array.axis)
    return values | dict(zip(("angle.largest", "angle.mean"), angles, strict=True))


def _given(coil: Coil | DataSheet) -> dict[str, float]:
    """Return the given numbers."""
    return {name: value for name, value in asdict(coil).items() if value is not None}


def numbers(pin: PinScan) -> dict[str, float]:
    """Return the numbers of one pin, SI, by the names of the table of quantities; exact."""
    motion = pin.motion
    used = motion.transient
    at_plate = [e for e in pin.events if e.contact in ("plate", "both")]
    slips = np.array([e.time for e in at_plate if e.kind == "slip"])
    on = pin.commands.on(slips) if len(slips) else slips
    return {
        "pin.energised": sum(end - begin for begin, end in pin.energised),
        "pin.switchings": float(len(pin.energised)),
        "pin.slips": float(np.count_nonzero(on)),
        "pin.captures": float(sum(e.kind == "stick" for e in at_plate)),
        "pin.carried": used.plate.time_stuck,
        "pin.peak_displacement": pin.peak_displacement,
        "pin.peak_skin_force": used.finger.peak_force,
        "pin.peak_stretch": used.peak_stretch if not motion.drive.finger.rigid else nan,
    }


def _columns(scan: Scan, pin: PinScan, t: NDArray[np.float64]) -> dict[str, NDArray[Any]]:
    """Return the state of one pin at times on the path's clock (s, shape (n,))."""
    found: dict[str, NDArray[Any]] = columns(pin.motion, pin.since(t))
    del found["time"]
    found.pop("plate_velocity", None)  # begin of all pins
    return found | {
        "luminance": scan.scene.at(*scan.spot(pin.number, t).T),
        "command": pin.commands.on(t),
        "current": pin.current(t),
        "pull": scan.device.magnet.pull(pin.current.flux(t)),
        **({} if pin.current.heat is None else {"warming": pin.current.warming(t)}),
    }


def _over(
    dimension: str | tuple[str, ...], values: Any, unit: str, meaning: str
) -> tuple[Any, Any, dict[str, str]]:
    return dimension, values, {"long_name": meaning} | ({"units": unit} if unit else {})


def _middles(scan: Scan, axis: int) -> NDArray[np.float64]:
    """Return the centres of the scene's rows (0) or columns (1) on the page, m."""
    scene = scan.scene
    count, begin = scene.luminance.shape[axis], scene.origin[1 - axis]
    return np.asarray(begin + (np.arange(count) + 0.5) * scene.pixel, np.float64)


def _events(pins: tuple[PinScan, ...]) -> dict[str, Any]:
    """A row for each event of each pin, pin after pin."""
    rows = [(pin.number, event) for pin in pins for event in pin.events]
    table: dict[str, Any] = {
        "event_pin": ("event", np.array([number for number, _ in rows], np.int64))
    }
    for name, unit in (("time", "s"), ("position", "m"), ("velocity", "m/s")):
        values = np.array([getattr(event, name) for _, event in rows], np.float64)
        table[f"event_{name}"] = ("event", values, {"units": unit})
    for name in ("contact", "kind"):
        table[f"event_{name}"] = ("event", [str(getattr(event, name)) for _, event in rows])
    return table


def _switchings(pins: tuple[PinScan, ...]) -> dict[str, Any]:
    """A row for each switching of each coil, pin after pin."""
    times = [pin.commands.times for pin in pins]
    sizes = [len(column) for column in times]
    return {
        "switching_pin": ("switching", np.repeat([pin.number for pin in pins], sizes)),
        "switching_time": ("switching", np.concatenate(times), {"units": "s"}),
        "switching_on": (
            "switching",
            np.concatenate([pin.commands.on(pin.commands.times) for pin in pins]),
        ),
    }


def _numbers(pins: tuple[PinScan, ...]) -> dict[str, Any]:
    rows = [numbers(pin) for pin in pins]
    table = {}
    for name in rows[0]:
        values = np.array([row[name] for row in rows])
        table[name.replace(".", "_")] = ("pin", values, QUANTITIES[name].attributes)
    return table


def _gaps(scan: Scan) -> dict[str, Any]:
    """A row for each two neighbouring pins; nothing where no pin stands ahead of another."""
    table: dict[str, Any] = {}
    for of, along, gaps in (
        ("pin_gap", "neighbours", scan.gaps),
        ("magnet_gap", "magnet_neighbours", scan.magnet_gaps),
    ):
        if not gaps:
            continue
        for name in ("behind", "ahead"):
            table[f"{of}_{name}"] = (along, [getattr(gap, name) for gap in gaps])
        for name, attribute in ((of, "size"), (f"{of}.time", "time")):
            values = [getattr(gap, attribute) for gap in gaps]
            table[name.replace(".", "_")] = (along, values, QUANTITIES[name].attributes)
    return table


def gap_words(scan: Scan) -> list[str]:
    """Return the smallest gaps of neighbouring pins and magnets, and of pins and slot ends.

    A line each; of pins of which none stands ahead of another, and of sizes that are not known,
    nothing.
    """
    length, lines = QUANTITIES["pin_gap"], []
    for name, smallest in (("pins", scan.smallest_gap), ("magnets", scan.smallest_magnet_gap)):
        if smallest is None:
            continue
        two = f"{name} {smallest.behind} and {smallest.ahead} at {smallest.time:.4g} s"
        if smallest.size < 0.0:
            overlap = f"{name.capitalize()} overlap by up to {length.text(-smallest.size)}, {two}"
            lines.append(f"{overlap}: real {name} would push each other.")
        else:
            least = length.text(smallest.size)
            lines.append(f"Smallest gap between neighbouring {name}: {least}, {two}.")
    if room := scan.slot_room:
        lines.append(
            f"Pin {room.pin} would go {length.text(-room.size)} beyond the end of its slot."
            if room.size < 0.0
            else f"Least room to the end of a slot: {length.text(room.size)}, pin {room.pin}."
        )
    return lines


def peak_warming(scan: Scan) -> float | None:
    """The largest warming of a coil, K; None where it is not simulated."""
    peaks = [pin.peak_warming for pin in scan.pins if pin.peak_warming is not None]
    return max(peaks, default=None)


# ---- what is doubtful ----------------------------------------------------------------------------


def scan_warnings(scan: Scan) -> tuple[str, ...]:
    """Return the doubts about a scan, a line each."""
    return (*_doubts(scan), *_overlaps(scan))


def _doubts(scan: Scan) -> list[str]:
    """Return the doubts about a scan, without overlapping pins."""
    found = []
    device, scene, path, max_angle = scan.device, scan.scene, scan.path, scan.max_angle
    control, speed = device.control, path.peak_speed
    beyond = _beyond(scan)
    if beyond:
        found.append(beyond)
    enough = speed / scene.pixel
    if control.sample_rate < enough * (1.0 - ROUNDING):
        found.append(
            f"control.sample_rate = {control.sample_rate:g} Hz samples every "
            f"{1e3 * speed / control.sample_rate:.3g} mm at {1e3 * speed:.4g} mm/s, past pixels of "
            f"{1e3 * scene.pixel:.3g} mm: thin lines may be missed; {enough:.4g} Hz sees each"
        )
    if device.friction.doubt:
        found.append(device.friction.doubt)
    if scan.hand:
        found += _hand_warnings(scan.hand)
    elif scan.hand_force.largest > LARGEST:
        found.append(
            f"the pins push the hand with up to {scan.hand_force.largest:.3g} N, more than "
            f"{LARGEST:g} N, the largest published force on a mouse: the hand would give way, and "
            "this scan's does not; [hand] lets it"
        )
    largest, mean = path.angles(device.array.axis)
    if largest > max_angle:
        found.append(
            f"the hand moves up to {degrees(largest):.3g} deg (mean {degrees(mean):.3g} deg) off "
            f"the drive axis, more than scan.max_angle, {degrees(max_angle):.3g} deg: the pins "
            f"feel {np.cos(largest):.0%} of the speed, and the plate's friction pulls askew"
        )
    if not any(len(pin.commands.times) or pin.commands.at_first for pin in scan.pins):
        found.append(_blank(scan, control.threshold - 0.5 * control.hysteresis))
    coil = device.magnet.coil
    if coil is not None:
        lasts, peak = path.end - path.begin, peak_warming(scan)
        most = max(sum(end - begin for begin, end in pin.energised) for pin in scan.pins) / lasts
        if peak is not None:
            if peak > coil.temperature_rise:
                found.append(
                    f"a coil warms by {peak:.3g} K in this scan, more than "
                    f"magnet.temperature_rise, {coil.temperature_rise:g} K"
                )
        elif most * device.magnet.heating > coil.duty:
            found.append(
                f"a magnet is on for {most:.0%} of the time; {coil.power:.3g} W warm it by "
                f"{coil.temperature_rise:g} K at {coil.duty:.0%}"
            )
    return found


def hand_words(hand: HandMotion) -> str:
    """Return the path of a hand that gave way in a sentence."""
    meant = float(hand.intended_speed(hand.slowest_time))
    return (
        f"The hand slows to {1e3 * hand.slowest_speed:.3g} mm/s where it means to move at "
        f"{1e3 * meant:.3g} mm/s (at {hand.slowest_time:.4g} s), and is up to "
        f"{1e3 * hand.error:.3g} mm off its path."
    )


def _hand_warnings(hand: HandMotion) -> list[str]:
    found = []
    meant = float(hand.intended_speed(hand.slowest_time))
    if hand.stops:
        total = sum(end - begin for begin, end in hand.stops)
        found.append(
            f"the pins stop the hand: it stands or goes back {counted(len(hand.stops), 'time')}, "
            f"for {1e3 * total:.3g} ms in all, first at {hand.stops[0][0]:.4g} s"
        )
    elif hand.slowest_speed < SLOWED * meant:
        found.append(
            f"the pins slow the hand to {hand.slowest_speed / meant:.0%} of the speed that it "
            f"means to have, {1e3 * hand.slowest_speed:.3g} mm/s at {hand.slowest_time:.4g} s"
        )
    if hand.ambiguous:
        found.append(
            f"the path of the hand is ambiguous from {hand.ambiguous[0]:.6g} s on: there a sample "
            "falls on an edge to within rounding"
        )
    return found


def hand_force_words(force: HandForce) -> str:
    """Return the force on the hand in a sentence."""
    return (
        f"The pins push the hand with up to {force.largest:.3g} N (at {force.time:.4g} s), "
        f"{force.mean:.3g} N in the mean; its work against them is {1e3 * force.work:.3g} mJ."
    )


def _blank(scan: Scan, threshold: float) -> str:
    """Return where the print is that no pin met."""
    words = f"no pin met information: nothing under their spots is darker than {threshold:g}"
    printed = scan.scene.printed(threshold)
    if printed is None:
        return f"{words}, nor is anything on the page"
    x, _ = scan.path.position(np.linspace(scan.path.begin, scan.path.end, 1001))
    spots = scan.device.array.on_page(scan.device.array.spots)[:, 0]
    passed = 1e3 * (x.min() + spots.min()), 1e3 * (x.max() + spots.max())
    left, right = (1e3 * edge for edge in printed)
    return (
        f"{words}; the print is {left:.4g} to {right:.4g} mm across, and the spots pass "
        f"{passed[0]:.4g} to {passed[1]:.4g} mm"
    )


def _beyond(scan: Scan) -> str:
    """Return the time of a pin's spot beyond the page, on blank paper; "" for none."""
    worst, part = 0, 0.0
    for pin in scan.pins:
        off = 0
        for begin in range(0, len(pin.sample_times), AT_ONCE):
            spots = scan.spot(pin.number, pin.sample_times[begin : begin + AT_ONCE])
            off += int(np.count_nonzero(~scan.scene.contains(spots[:, 0], spots[:, 1])))
        if off > part * len(pin.sample_times):
            worst, part = pin.number, off / len(pin.sample_times)
    if not part:
        return ""
    left, right, top, bottom = (1e3 * edge for edge in scan.scene.extent)
    shown = f"{part:.0%}" if part >= 0.01 else "less than 1%"
    return (
        f"the spot of pin {worst} is beyond the page, {left:g} to {right:g} mm across and {top:g} "
        f"to {bottom:g} mm down, for {shown} of the time: it sees blank paper there"
    )


def _overlaps(scan: Scan) -> list[str]:
    """Return the overlaps of parts, which the motions do not model."""
    found = [*doubts(scan.device)]
    array = scan.device.array
    for name, gaps in (("pins", scan.gaps), ("magnets", scan.magnet_gaps)):
        touching = [gap for gap in gaps if gap.size < 0.0]
        if not touching:
            continue
        worst = min(touching, key=lambda gap: gap.size)
        pairs = f"; {len(touching)} of {len(gaps)} pairs of neighbours do" if len(gaps) > 1 else ""
        found.append(
            f"{name} {worst.behind} and {worst.ahead} overlap by {-1e3 * worst.size:.4g} mm at "
            f"{worst.time:.4g} s{pairs}: real {name} would push each other, these pass through"
        )
    room = scan.slot_room
    if room and room.size < 0.0:
        found.append(
            f"pin {room.pin} goes {-1e3 * room.size:.4g} mm beyond the end of its slot, "
            f"{1e3 * (array.slot_length or 0.0):.4g} mm long: a real one would stop there"
        )
    for one, other in array.abreast[:1]:
        apart = abs(array.places[other][1] - array.places[one][1])
        found.append(
            f"pins {one} and {other} stand {1e3 * apart:.4g} mm apart across the drive axis, less "
            f"than array.pin_diameter, {1e3 * array.pin_diameter:.4g} mm: they overlap at rest"
        )
    return found
