"""Terminal output of scans, of their evaluation, and of hand speeds."""

from __future__ import annotations

from math import isnan, nan
from typing import TYPE_CHECKING, Final

from rich.console import Group, RenderableType

from pindrive.cli.tables import (
    TRUSTED,
    device_words,
    new_table,
    path_words,
    touch_words,
    whole_lines,
)
from pindrive.device.dataset import gap_words, hand_force_words, hand_words, numbers, peak_warming
from pindrive.evaluation import page_speed
from pindrive.evaluation.resolution import STUDIED, criterion
from pindrive.quantities.device import PIN
from pindrive.quantities.results import LINE
from pindrive.quantities.table import QUANTITIES

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rich.table import Table

    from pindrive.device.device import Criteria
    from pindrive.device.pin_scan import PinScan
    from pindrive.device.scanning import Scan
    from pindrive.evaluation.page_speed import PageSpeeds
    from pindrive.evaluation.perception import Evaluation
    from pindrive.evaluation.resolution import Band, SpeedLimit

_MM: Final = 1e3
PINS_HEAD, PINS_TAIL = 24, 8
"""Numbers of pins of a large array that are shown, from its first and from its last."""
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
COUNTED: Final = (
    *("crossed", "shown", "direction", "sure", "unsettled", "unseen", "merged", "faint", "false"),
)
"""The counts in the order in which they are told: what was shown, what was missed, what was not."""


def scan_report(scan: Scan) -> RenderableType:
    """Its pins in a table, then its hand, its device and how far it can be trusted, in words."""
    lines = whole_lines(_words(scan))
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
        if PINS_HEAD <= pin.number < len(scan.pins) - PINS_TAIL:
            if pin.number == PINS_HEAD:
                found.add_row("...", f"{len(scan.pins) - PINS_HEAD - PINS_TAIL} more")
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
    device, path, peak = scan.device, scan.path, peak_warming(scan)
    worst = max(pin.motion.certificate().worst for pin in scan.pins)
    doubt = "" if worst <= TRUSTED else " Do not trust this scan."
    return [
        path_words(path, device.array.axis, device.drive.plate),
        *([path.about] if path.about else []),
        *gap_words(scan),
        *device_words(device),
        *touch_words(scan.touch),
        *([hand_words(scan.hand)] if scan.hand else []),
        hand_force_words(scan.hand_force),
        *([] if peak is None else [f"A coil warms by up to {peak:.3g} K in this scan."]),
        f"Laws checked without the solver: largest relative residual {worst:.1e}.{doubt}",
    ]


def evaluation_report(evaluation: Evaluation) -> RenderableType:
    """Report the evaluation: counts of the lines in words, and the numbers of the shown lines."""
    lines = whole_lines(verdict_words(evaluation))
    tables = [_counts(evaluation)] if evaluation.lines else []
    if evaluation.shown:
        tables.append(_spreads(evaluation))
    return Group(*tables, *lines)


def _counts(evaluation: Evaluation) -> Table:
    table = new_table("Counts of the lines", "symbol", ">count", "meaning")
    for name in COUNTED:
        quantity = QUANTITIES[f"lines.{name}"]
        table.add_row(quantity.symbol, str(evaluation.counts[quantity.name]), quantity.meaning)
    return table


def _spreads(evaluation: Evaluation) -> Table:
    title = "Lines shown to the finger"
    table = new_table(title, "symbol", ">least", ">median", ">most", "unit", "meaning")
    for quantity in LINE:
        values = evaluation.spread(quantity.name)
        share = quantity.unit == "1"
        cells = [
            f"{value:.1%}" if share and not isnan(value) else quantity.digits(value)
            for value in values
        ]
        table.add_row(quantity.symbol, *cells, quantity.display_unit, quantity.meaning)
    return table


def verdict_words(evaluation: Evaluation) -> list[str]:
    """Return the counts of the lines in words."""
    counts = {name.removeprefix("lines."): n for name, n in evaluation.counts.items()}
    if not counts["crossed"]:
        return [f"No line passed completely under a pin; {_number(counts['false'], 'false line')}."]
    missed = counts["unseen"] + counts["merged"] + counts["faint"]
    why = _brackets(
        (counts["unseen"], "not seen by the control block"),
        (counts["merged"], "merged with the line before"),
        (counts["faint"], "too faint"),
    )
    doubts = _brackets(
        (counts["unsettled"], "not settled before the next"),
        (counts["shown"] - counts["sure"], "of uncertain direction"),
    )
    limits = evaluation.criteria
    words = [
        f"{_number(counts['crossed'], 'line')} passed under the pins: {counts['shown']} shown"
        f"{doubts}, {missed} missed{why}; {_number(counts['false'], 'false line')}.",
        f"Motion of the skin is felt from {limits.felt * _MM:g} mm on, its direction from "
        f"{limits.direction * _MM:g} mm, and right in 95 % of cases from "
        f"{limits.direction_sure * _MM:g} mm at {limits.direction_speed * _MM:g} mm/s; a false "
        f"line reaches at least {limits.false_line:.0%} of the height of the line before. Lines "
        f"merge where the pin comes back by less than {limits.distinct:.0%} of its way.",
    ]
    if evaluation.scan.device.drive.finger.rigid:
        words.append(
            "The finger is rigid: the pin's motion stands for the skin's, the most that skin could "
            "move."
        )
    return words


def _brackets(*counted: tuple[int, str]) -> str:
    """The counts that are not 0, in brackets; empty where all are."""
    said = ", ".join(f"{count} {words}" for count, words in counted if count)
    return f" ({said})" if said else ""


def _number(count: int, noun: str) -> str:
    return f"{count} {noun}{'' if count == 1 else 's'}"


# ---- speed ---------------------------------------------------------------------------------------


def speed_report(
    limits: Sequence[SpeedLimit], criteria: Criteria, *, gives_way: bool = False
) -> RenderableType:
    """The largest hand speed for each pitch, and by which criterion.

    Args:
        limits: Limit of each pitch.
        criteria: Criteria of a felt line.
        gives_way: True for a hand that the pins slow.
    """
    length, speed = QUANTITIES["speed.pitch"], QUANTITIES["hand_speed"]
    table = new_table(
        "Largest hand speed over two lines",
        ">pitch",
        ">width",
        ">distinct up to",
        ">settled up to",
        ">drive alone",
        "a faster hand",
    )
    table.add_row(
        length.display_unit,
        length.display_unit,
        speed.display_unit,
        speed.display_unit,
        speed.display_unit,
        style="dim",
    )
    for limit in limits:
        table.add_row(
            length.digits(limit.pitch),
            length.digits(limit.width),
            _band(limit.distinct, limit),
            _band(limit.settled, limit),
            speed.digits(limit.alone),
            beyond(limit, criteria),
        )
    tried = limits[0].tried[0], max(limit.tried[1] for limit in limits)
    settled = "Settled: the vibration after the first line also ends before the second line."
    words = [
        criterion(criteria),
        *([] if gives_way else [settled]),
        *bound_words(limits),
        hands_words([limit.speed for limit in limits]),
        f"Tried: {speed.text(tried[0])} to {speed.text(tried[1])}, each speed an exact simulation.",
    ]
    if gives_way:
        words.append("The hand gives way: speeds are intended ones, and all pins cross both lines.")
    return Group(table, *whole_lines(words))


def bound_words(limits: Sequence[SpeedLimit]) -> list[str]:
    """Return the part of the device that binds the limits, in a sentence."""
    bounds = [limit.bound for limit in limits]
    found = [bound for bound in bounds if bound]
    if not found:
        return []
    sampled = bounds.count("control block")
    alone = "Drive alone: with a control block that samples a hundred times as often"
    if not sampled:
        return [f"{alone}; the drive and the finger bind every limit."]
    which = "every limit" if sampled == len(found) else f"{sampled} of {len(found)} limits"
    return [f"{alone}. Whole samples of the control block bind {which}: a higher rate raises it."]


def page_speed_report(found: PageSpeeds) -> RenderableType:
    """Report the counts of the lines of a page at each speed, and the largest safe speed."""
    speed = QUANTITIES["hand_speed"]
    headings = (
        ">hand speed",
        ">lines",
        ">shown",
        ">not settled",
        ">direction sure",
        ">false lines",
    )
    table = new_table(f"Largest hand speed over {found.title}", *headings)
    table.add_row(speed.display_unit, style="dim")
    for tried, counts in found.counts.items():
        numbers = (str(counts[f"lines.{name}"]) for name in page_speed.COUNTED)
        table.add_row(speed.digits(tried), *numbers)
    words = [
        f"{said}: {_up_to(limit, found.tried)}."
        for said, limit in (
            ("All lines are shown and none is false", found.shown_speed),
            ("The pin also settles after each", found.settled_speed),
        )
    ]
    return Group(table, *whole_lines([*words, hands_words([found.shown_speed])]))


def _up_to(limit: float, tried: Band) -> str:
    """Up to which speed something holds, in words."""
    if isnan(limit):
        return "not at the slowest speed tried"
    text = QUANTITIES["hand_speed"].text(limit)
    return f"up to {text}, the fastest tried" if limit >= tried[1] else f"up to {text}"


def hands_words(limits: Sequence[float]) -> str:
    """Return the speeds of reading hands beside the limits (m/s) of a device."""
    speed = QUANTITIES["hand_speed"]
    slow, fast = STUDIED
    among = f"Hands in finger studies move at {speed.digits(slow)} to {speed.text(fast)}"
    above = sum(limit > fast for limit in limits)
    if not above:
        return f"{among} (arXiv 2505.11162)."
    which = "the limit is" if len(limits) == 1 else f"{above} of {len(limits)} limits are"
    return f"{among} (arXiv 2505.11162): {which} beyond them."


def _band(bands: tuple[Band, ...], limit: SpeedLimit) -> str:
    """The largest speed of the first band; from where on, unless from the slowest tried."""
    if not bands:
        return "-"
    digits = QUANTITIES["hand_speed"].digits
    low, high = bands[0]
    most = f"> {digits(high)}" if high >= limit.tried[1] else digits(high)
    return most if low <= limit.tried[0] else f"{digits(low)} to {most}"


def beyond(limit: SpeedLimit, criteria: Criteria) -> str:
    """Return the failure of a hand that is faster than the limit, in words."""
    if not limit.distinct:
        return "the lines are distinct at no speed tried"
    trial = limit.beyond
    words = []
    if trial is not None:
        if trial.back == 0.0:
            words.append("merges the lines")
        elif not trial.shown:
            words.append(f"lets the pin return by {trial.back:.0%}")
        if trial.skin < criteria.direction:
            words.append(f"moves the skin by {QUANTITIES['direction'].text(trial.skin)}")
    speed = QUANTITIES["hand_speed"]
    words += [
        f"is distinct again at {speed.digits(a)}-{speed.text(b)}" for a, b in limit.distinct[1:]
    ]
    return ", ".join(words)
