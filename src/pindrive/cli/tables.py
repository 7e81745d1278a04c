"""Devices and motions as tables and words in a terminal."""

from __future__ import annotations

import sys
from math import degrees, isfinite, isnan, tau
from typing import TYPE_CHECKING

from rich import box
from rich.console import Console, Group, RenderableType
from rich.table import Table
from rich.text import Text

from pindrive.device.coil import Coil
from pindrive.device.geometry import COPPER, IRON, doubts, heaviest, tipping
from pindrive.motion.coefficients import Coefficients
from pindrive.motion.drive import Contact
from pindrive.motion.function import Function
from pindrive.motion.profile import Profile
from pindrive.quantities.drive import COLUMNS
from pindrive.quantities.quantity import Rows, counted, significant
from pindrive.quantities.results import ENDING, TRANSIENT
from pindrive.quantities.table import QUANTITIES, duration

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from pindrive.device.device import Device
    from pindrive.device.electromagnet import Electromagnet
    from pindrive.device.hand import HandPath
    from pindrive.files.device import DeviceFile
    from pindrive.motion.motion import Motion

WIDTH = 100
"""Columns where the output is no terminal."""
HEAD, TAIL = 14, 6
"""Numbers of phases of a long motion that are shown, from its start and from its end."""
TRUSTED = 1e-8
"""Largest relative residual that a million events may leave; numbers that overflow leave more."""

_KINDS = {
    "stick": "sticks",
    "slip": "slips",
    "reverse": "reverses",
    "stop": "is met",
    "leave": "is left",
}
_TIME, _POSITION, _VELOCITY = (QUANTITIES[q] for q in ("duration", "displacement", "velocity"))


def console() -> Console:
    """The standard output, as wide as the terminal."""
    screen = Console(highlight=False, markup=False, emoji=False)
    if not screen.is_terminal:
        screen.width = WIDTH
    return screen


def show(report: RenderableType) -> None:
    """Print a report; what is wider than the terminal is left for it to wrap, never cut off."""
    console().print(report, crop=False)


def whole_lines(lines: Iterable[str]) -> Iterator[Text]:
    """Print lines that the terminal may wrap, so that copies stay whole."""
    return (Text(line, no_wrap=True, overflow="ignore") for line in lines)


def device_report(device: DeviceFile) -> RenderableType:
    """Report a device file and the quantities derived from it."""
    drive = device.drive
    table = new_table("Device", "key", "symbol", ">value", "unit", "meaning")
    for key, value in device.values().items():
        name = key if key in QUANTITIES else key.partition(".")[2]
        if isinstance(value, tuple):
            _add_rows(table, name, value, key)
        elif isinstance(value, Function):
            table.add_row(key, QUANTITIES[name].symbol, "", "", function_words(value))
        elif value is not None:
            _add_number(table, name, value, key)
    _add_number(table, "natural_frequency", drive.natural_frequency, "")
    lines = [drive_words(device)]
    if device.whole:
        whole, hand = device.device, device.reading
        lines += device_words(whole) + touch_words(device.touch)
        lines += meeting_words(whole, max(hand.hand_speed, hand.return_speed))
    elif not drive.plate.frictionless:
        lines.append(f"The plate: {Coefficients.of(drive).words}.")
    lines += [device.recording_words] if device.recording_words else []
    return Group(table, *whole_lines(lines))


def warn_of(device: DeviceFile) -> None:
    """Say what cannot be built as a device file describes it, or is implausible."""
    found = [Coefficients.of(device.drive).doubt]
    if device.whole:
        found += doubts(device.device)
    for doubt in filter(None, found):
        print(f"warning: {doubt}", file=sys.stderr)


def drive_words(device: DeviceFile) -> str:
    """The damping regime and the natural frequency of a drive."""
    hertz = significant(device.drive.natural_frequency / tau)
    words = f"{regime(device.drive.damping_ratio)}, natural frequency {hertz} Hz"
    return f"{device.name or 'The drive'}: {words}."


def release_words(device: DeviceFile) -> list[str]:
    """The drive, the values that its file does not give as they are, and what is recorded."""
    values = device.values_of_drive()
    for name, contact in (("plate", device.drive.plate), ("finger", device.drive.finger)):
        values[f"{name}.static"] = contact.static_friction
    words, said = [drive_words(device)], []
    for key in device.followed:
        value = values[key]
        if isinstance(value, float) and value:
            name = key if key in QUANTITIES else key.partition(".")[2]
            said.append(f"{key} {QUANTITIES[name].text(value)}")
    words += [f"Follow from other values: {', '.join(said)}."] if said else []
    return words + ([device.recording_words] if device.recording_words else [])


def regime(damping_ratio: float) -> str:
    """The name of a damping regime."""
    if damping_ratio == 0.0:
        return "undamped"
    if abs(damping_ratio - 1.0) < 1e-12:
        return "critically damped"
    return "underdamped" if damping_ratio < 1.0 else "overdamped"


def motion_report(motion: Motion, about: Iterable[str] = ()) -> RenderableType:
    """Phases, numbers, lines `about` the device, and how the motion ends."""
    words = [*about, ending(motion), trust(motion)]
    if motion.status:
        words.append(f"The simulation {motion.status.explanation}.")
    lines = whole_lines(words)
    tables = [_phases(motion), _numbers(motion)]
    if (afterwards := _afterwards(motion)).row_count:
        tables.append(afterwards)
    return Group(*tables, *lines)


def _phases(motion: Motion) -> Table:
    """A line for each stretch of one contact state; the middle of many left out."""
    table = new_table("Phases", ">from", ">to", ">duration", "phase", ">x", ">v", "ends as")
    t, x, v = _TIME.display_unit, _POSITION.display_unit, _VELOCITY.display_unit
    table.add_row(t, t, t, "", x, v, "", style="dim")
    causes: dict[float, list[str]] = {}
    for event in motion.events:
        causes.setdefault(event.time, []).append(f"{event.contact} {_KINDS[event.kind]}")
    phases: list[tuple[float, float, str]] = []
    for segment in motion.segments:
        # A segment also ends at a point of a friction curve and where an input changes.
        goes_on = bool(phases) and segment.mode == phases[-1][2] and segment.begin not in causes
        begin = phases.pop()[0] if goes_on else segment.begin
        phases.append((begin, segment.end, segment.mode))
    for i, (begin, end, mode) in enumerate(phases):
        if HEAD <= i < len(phases) - TAIL:
            if i == HEAD:
                table.add_row("...", "", "", counted(len(phases) - HEAD - TAIL, "more phase"))
            continue
        lasts = isfinite(end)
        table.add_row(
            _TIME.digits(begin),
            _TIME.digits(end) if lasts else "",
            _TIME.digits(end - begin) if lasts else "forever",
            mode,
            _POSITION.digits(motion.position(begin)),
            _VELOCITY.digits(motion.velocity(begin)),
            ", ".join(causes.get(end, [])),
        )
    return table


def _numbers(motion: Motion) -> Table:
    """Return the transient's numbers, without an absent contact."""
    title = f"Transient, from the release to {duration(motion.transient.end_time)}"
    table = new_table(title, "symbol", ">value", "unit", "meaning")
    values = motion.numbers()
    unseen = {"transient.settled"}
    if motion.drive.finger.rigid:
        unseen |= {"transient.peak_stretch", "transient.peak_stretch_rate"}
    absent = _absent(motion, "transient")
    steady = motion.ending.kind == "steady"
    for quantity in TRANSIENT:
        if not quantity.name.startswith(absent) and quantity.name not in unseen:
            in_band = f"within {100.0 * motion.settling_band:g} % of the way to the resting place"
            said = "steady from then on" if steady else f"from then on {in_band}"
            said = said if quantity.name == "transient.settling_time" else ""
            _add_number(table, quantity.name, values[quantity.name], meaning=said)
    return table


def _absent(motion: Motion, table: str) -> tuple[str, ...]:
    """Beginnings of the names of the numbers of contacts without friction."""
    contacts = (("plate", motion.drive.plate), ("finger", motion.drive.finger))
    return tuple(f"{table}.{name}." for name, contact in contacts if contact.frictionless)


def _afterwards(motion: Motion) -> Table:
    """The numbers of the motion after the transient, as far as these exist."""
    table = new_table("Afterwards", "symbol", ">value", "unit", "meaning")
    values, absent = motion.numbers(), _absent(motion, "ending")
    once = motion.ending.rounds == 1.0
    in_words = {"ending.position", "ending.steady_since"}
    in_words |= {"ending.least_amplitude", "ending.rounds"} if once else set()
    for quantity in ENDING:
        if (
            quantity.name not in in_words
            and not quantity.name.startswith(absent)
            and isfinite(values[quantity.name])
        ):
            _add_number(table, quantity.name, values[quantity.name])
    return table


def new_table(title: str, *headings: str) -> Table:
    """A table with headings; ">" aligns a column to the right."""
    table = Table(title=title, title_justify="left", title_style="bold", box=box.SIMPLE_HEAD)
    for heading in headings:
        right = heading.startswith(">")
        last = heading == headings[-1]
        table.add_column(
            heading.removeprefix(">"), justify="right" if right else "left", no_wrap=not last
        )
    return table


def _add_number(table: Table, name: str, value: float, *before: str, meaning: str = "") -> None:
    """A row for the quantity called `name`: symbol, value, unit, meaning."""
    quantity = QUANTITIES[name]
    shown = f"{value:g}" if quantity.unit == "" else quantity.digits(value)
    table.add_row(
        *before, quantity.symbol, shown, quantity.display_unit, meaning or quantity.meaning
    )


def function_words(function: Function) -> str:
    """Return what an input over time is, in words; its parameters have rows of their own."""
    kinds = {
        "harmonic": "a sinusoid",
        "minimum_jerk": "a stroke of minimum jerk",
        "exponential": "an exponential",
    }
    return kinds.get(function.kind) or f"a function of {counted(len(function.pieces), 'piece')}"


def _add_rows(table: Table, name: str, rows: Rows, key: str) -> None:
    """A line for each row of a curve or a profile: its value, and where it holds."""
    quantity = QUANTITIES[name]
    across = QUANTITIES[COLUMNS[quantity.rows_of][0]]
    for i, (place, value) in enumerate(rows):
        if HEAD <= i < len(rows) - TAIL:
            if i == HEAD:
                table.add_row("...", "", "", "", counted(len(rows) - HEAD - TAIL, "more row"))
            continue
        at = f"at {across.written(place)}"
        table.add_row(
            "" if i else key,
            "" if i else quantity.symbol,
            quantity.digits(value),
            quantity.display_unit,
            at if i else f"{quantity.meaning}; {at}",
        )


def ending(motion: Motion) -> str:
    """Return the ending of the motion in a sentence."""
    end, place = motion.ending, _POSITION.text(motion.ending.position)
    if end.kind == "resting":
        return f"At rest at x = {place} since {duration(motion.transient.rest_time)}."
    if end.kind == "decaying":
        last = motion.transient.last_event_time
        events = f"last event at {duration(last)}" if last > 0.0 else "no event"
        return f"Decays towards x = {place} and never comes to rest; {events}."
    if end.kind == "drifting":
        lag = "" if isnan(end.lag) else f", {_POSITION.text(end.lag)} behind the balance of forces"
        return f"Follows a ramp at {_VELOCITY.text(end.drift_velocity)}{lag}."
    if end.kind in ("growing", "approaching"):
        grows = "Grows" if end.kind == "growing" else "Approaches a limit: the distance changes"
        until = duration(motion.segments[-1].end)
        return (
            f"{grows} by a factor of {end.growth:.8g} in each period of {duration(end.period)}; no "
            f"ending up to {until}."
        )
    if end.kind == "steady":
        rounds = f" ({end.rounds:.0f} rounds)" if end.rounds > 1.0 else ""
        return (
            f"Steady {end.cycle} oscillation about x = {place} "
            f"from {duration(end.steady_since)} on: "
            f"amplitude {_POSITION.text(end.amplitude)}, period {duration(end.period)}{rounds}, "
            f"peak velocity {_VELOCITY.text(end.peak_velocity)}."
        )
    if end.kind == "irregular":
        return (
            f"Irregular oscillation about x = {place}: no repetition up to "
            f"{duration(motion.segments[-1].end)}; amplitude {_POSITION.text(end.least_amplitude)} "
            f"to {_POSITION.text(end.amplitude)}, mean period {duration(end.period)}, "
            f"peak velocity {_VELOCITY.text(end.peak_velocity)}."
        )
    return f"Still moving after {duration(motion.duration)}."


def trust(motion: Motion) -> str:
    """Return the largest residual of the laws, checked without the solver."""
    worst = motion.certificate().worst
    doubt = "" if worst <= TRUSTED else " Do not trust this motion."
    return f"Laws checked without the solver: largest relative residual {worst:.1e}.{doubt}"


def path_words(path: HandPath, axis: float, plate: Contact | None = None) -> str:
    """Return duration and speed of the hand, and its largest angle to the drive axis (rad).

    With the plate of a device, also whether static friction depends on that angle.
    """
    largest, _ = path.angles(axis)
    speed = QUANTITIES["hand_speed"].text(path.peak_speed)
    words = (
        f"The hand's path takes {path.end - path.begin:.4g} s, at {speed} at the most, up to "
        f"{degrees(largest):.3g} deg off the drive axis."
    )
    straight = path.across_velocity(axis) == 0.0
    if plate is None or not straight or plate.static_friction == plate.kinetic:
        return words
    return (
        f"{words} It is exactly along that axis, where static friction of the plate counts: any "
        "real hand is oblique, and even 0.01 deg off the plate has its kinetic friction alone."
    )


def device_words(device: Device) -> list[str]:
    """Return the quantities derived from a device's numbers."""
    length, force = QUANTITIES["displacement"], QUANTITIES["hold_force"]
    drag = f" Off, the plate drags it {length.text(device.drag())}." if device.drag() else ""
    if device.reach:
        words = [f"A magnet carries its pin up to {length.text(device.reach)}.{drag}"]
    else:
        held = device.drive.plate.static_friction * device.load(device.magnet.sustained_pull)
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
    words += closing_words(device.magnet)
    return words


def closing_words(magnet: Electromagnet) -> list[str]:
    """Return the closing and opening times of the gap; nothing if it stays closed."""
    if not isinstance(magnet.coil, Coil) or magnet.coil.lift is None:
        return []
    closes, opens = (
        QUANTITIES[name].text(getattr(magnet, time))
        for name, time in (("rise_time", "closing_time"), ("fall_time", "opening_time"))
    )
    words = [
        f"At full voltage its gap closes {closes} after it is switched on, and opens {opens} after "
        f"it is switched off."
    ]
    if magnet.sustained_flux <= magnet.closing.flux:
        driven = "pulses" if magnet.steps is None else "voltage"
        words.append(f"With the {driven} given, its gap does not stay closed while it is on.")
    return words


def touch_words(touch: float | Profile | None) -> list[str]:
    """Return the touch force over a scan, if given."""
    force = QUANTITIES["touch"]
    if touch is None:
        return []
    if not isinstance(touch, Profile):
        return [f"The finger presses on each pin with {force.text(touch)} in a scan."]
    low, high = (force.text(end(touch.values)) for end in (min, max))
    lifted = "; at 0 mN it is lifted" if 0.0 in touch.values else ""
    return [f"The finger presses on each pin with {low} to {high} over the time of a scan{lifted}."]


def meeting_words(device: Device, speed: float) -> list[str]:
    """Return the clearances of pins, magnets and slots at the largest displacement.

    Args:
        device: The device.
        speed: Largest speed of the hand, m/s.
    """
    array, length, reach = device.array, QUANTITIES["pin_gap"], device.excursion(speed)
    words = [
        f"Pins {one} and {other} stand side by side, closer than their diameter: they overlap."
        for one, other in array.abreast[:1]
    ]
    at = f"at {QUANTITIES['hand_speed'].text(speed)} of the hand a pin goes up to"
    gone = f"{at} {length.text(reach)} either way"
    for name, pairs in (("pins", array.neighbours), ("magnets", device.magnet_neighbours)):
        if not pairs:
            continue
        room = min(pair.clearance for pair in pairs)
        if room < 0.0:
            words.append(f"Neighbouring {name} overlap by {length.text(-room)} at rest.")
        elif room < 2.0 * reach:
            words.append(
                f"Neighbouring {name} have {length.text(room)} between them at rest, and can meet: "
                f"{gone}. A scan says whether they do."
            )
        else:
            words.append(
                f"Neighbouring {name} have {length.text(room)} between them at rest, and cannot "
                f"meet: {gone}."
            )
    if array.travel is not None:
        ends = "does not come to its ends" if reach <= array.travel else "can come to its ends"
        words.append(
            f"In its slot a pin has {length.text(array.travel)} either way, and {ends}: {gone}."
        )
    stops = device.drive.travel
    if stops is not None:
        met = "does not come to them" if reach < stops else "can come to them"
        words.append(f"The end stops are {length.text(stops)} either way, and a pin {met}: {gone}.")
    solid = heaviest(device.magnet.outer_diameter, device.magnet.height)
    if solid is not None:
        density = device.drive.mass / solid * COPPER
        words.append(
            f"The magnet's size makes its density {density / 1e3:.3g} g/cm3; that of iron is "
            f"{IRON / 1e3:.3g}, of copper {COPPER / 1e3:.3g}."
        )
    moments = tipping(device)
    if moments and not moments.tips:
        words.append(f"The magnet does not tip: {moments.words}.")
    return words
