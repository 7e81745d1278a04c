"""One pin's history in detail: what it saw, its magnet, its motion, and what the skin felt."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from pindrive.device.touch import spans
from pindrive.evaluation.line_crossings import printed_lines
from pindrive.plot.style import (
    GREY,
    LIFTED,
    MM,
    MS,
    PALETTE,
    PRINTED,
    SMALL,
    Sign,
    event_key,
    mark_events,
    shade,
)
from pindrive.quantities.refusal import check_whole

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.gridspec import SubplotSpec
    from numpy.typing import NDArray

    from pindrive.device.pin_scan import PinScan
    from pindrive.evaluation.line_crossings import Line
    from pindrive.evaluation.perception import Evaluation

LINES: Final = 4
"""Shown in the history, at most."""
LONGEST: Final = 1.2
"""Longest history with more than one line, s."""
BEFORE: Final = 0.04
AFTER: Final = 0.16
"""Before the first line and after the last, s."""


@dataclass(frozen=True, slots=True)
class Moment:
    """A part of a scan: one pin, for a while."""

    pin: int
    begin: float
    end: float
    """s, on the path's clock."""


def moment(evaluation: Evaluation, pin: int | None = None) -> Moment:
    """A part worth a closer look: a few lines that passed under one pin.

    Args:
        evaluation: Evaluation of the scan.
        pin: Number of the pin; None: of the pins with most lines the nearest to the middle.

    Raises:
        ValueError: No pin has this number.
    """
    scan = evaluation.scan
    count = len(scan.pins)
    if pin is not None:
        pin = check_whole(pin, "pin", 0, count - 1)
    else:
        shown = np.bincount([line.pin for line in evaluation.shown], minlength=count)
        middle = np.hypot(*np.array(scan.device.array.places).T)
        pin = int(np.lexsort((middle, -shown))[0])
    lines = [line for line in evaluation.lines if line.pin == pin]
    begin, end = scan.path.begin, scan.path.end
    if not lines:
        return Moment(pin, begin, min(end, begin + LONGEST))
    first, last = _closest(lines)
    return Moment(
        pin, max(begin, lines[first].begin.time - BEFORE), min(end, lines[last].end.time + AFTER)
    )


def _closest(lines: list[Line]) -> tuple[int, int]:
    """The first and the last of the most lines that follow each other in a short time."""
    best = (0, 0)
    for first in range(len(lines)):
        last = first
        while (
            last + 1 < min(len(lines), first + LINES)
            and lines[last + 1].end.time - lines[first].begin.time < LONGEST
        ):
            last += 1
        if last - first > best[1] - best[0]:
            best = (first, last)
    return best


def draw_history(
    evaluation: Evaluation, chosen: Moment, figure: Figure, place: SubplotSpec, where: str
) -> list[Artist]:
    """Draw it: five panels over one time axis; what their signs mean, for a legend.

    `where` says where on the page that is.
    """
    scan = evaluation.scan
    pin = scan.pins[chosen.pin]
    rows = place.subgridspec(5, 1, height_ratios=(0.8, 0.8, 2.0, 1.4, 1.1))
    seen = figure.add_subplot(rows[0], label="seen")
    pull = figure.add_subplot(rows[1], label="pull", sharex=seen)
    x = figure.add_subplot(rows[2], label="x", sharex=seen)
    force = figure.add_subplot(rows[3], label="force", sharex=seen)
    hand = figure.add_subplot(rows[4], label="hand", sharex=seen)
    t = _times(pin, chosen)
    ms = MS * (t - chosen.begin)
    for axes in (seen, pull, x, force, hand):
        _draw_bands(evaluation, chosen, axes)
        axes.tick_params(labelbottom=axes is hand)
    _draw_seen(evaluation, chosen, seen, t, ms)
    pull.plot(ms, scan.device.magnet.pull(pin.current.flux(t)), color=PALETTE["curve"], gid="pull")
    pull.set_ylabel("pull (N)")
    pull.set_ylim(0.0, 1.15 * scan.device.magnet.hold_force)
    signs = _draw_motion(pin, chosen, x, t, ms)
    _draw_force(evaluation, pin, force, t, ms)
    lifted = _draw_lifted(pin, chosen, force)
    hand.plot(ms, scan.force_on_hand(t), color=PALETTE["curve"], gid="hand_force")
    hand.set_ylabel("hand (N)")
    number = f" {chosen.pin}" if len(scan.pins) > 1 else ""
    seen.set_title(
        f"pin{number} from {chosen.begin:.3f} s on, {where}",
        loc="left",
        fontsize=SMALL + 0.5,
        pad=3.0,
        color=PALETTE["slip"],
    )
    hand.set_xlabel("time (ms)")
    hand.set_xlim(0.0, MS * (chosen.end - chosen.begin))
    figure.align_ylabels((seen, pull, x, force, hand))
    return [*_key(signs), *lifted]


def _times(pin: PinScan, chosen: Moment) -> NDArray[np.float64]:
    """Close together, with every event and turning point, and just before each."""
    even = np.linspace(chosen.begin, chosen.end, 3000)
    motion = pin.motion
    events = [event.time for event in motion.events_between(0.0, motion.duration)]
    knots = pin.begin + np.union1d(motion.extrema("position").time, events)
    knots = knots[(knots > chosen.begin) & (knots < chosen.end)]
    return np.union1d(even, np.concatenate([knots, np.nextafter(knots, -np.inf)]))


def _draw_bands(evaluation: Evaluation, chosen: Moment, axes: Axes) -> None:
    """Draw the times at which a printed line is under the pin's spot."""
    scan = evaluation.scan
    lines = printed_lines(scan.device, scan.path, scan.scene)[chosen.pin]
    spans = [
        (MS * (begin - chosen.begin), MS * (end - begin))
        for begin, end in zip(lines.begin.tolist(), lines.end.tolist(), strict=True)
        if end > chosen.begin and begin < chosen.end
    ]
    shade(axes, spans, "printed", **PRINTED, zorder=0)


def _draw_seen(
    evaluation: Evaluation,
    chosen: Moment,
    axes: Axes,
    t: NDArray[np.float64],
    ms: NDArray[np.float64],
) -> None:
    scan = evaluation.scan
    pin, control = scan.pins[chosen.pin], scan.device.control
    spots = scan.spot(chosen.pin, t)
    axes.axhline(control.threshold, color=GREY, lw=0.6, ls=":", gid="threshold")
    axes.plot(ms, scan.scene.at(*spots.T), color="0.3", lw=0.9, gid="luminance")
    for on, off in pin.energised:
        if off > chosen.begin and on < chosen.end:
            span = [(MS * (on - chosen.begin), MS * (off - on))]
            axes.broken_barh(span, (-0.32, 0.2), color=PALETTE["stick"], lw=0.0, gid="command")
    axes.set_ylim(-0.38, 1.12)
    axes.set_yticks([0.0, 1.0])
    axes.set_ylabel("luminance")


def _draw_motion(
    pin: PinScan, chosen: Moment, axes: Axes, t: NDArray[np.float64], ms: NDArray[np.float64]
) -> list[Sign]:
    """The deflection, where the plate carries the pin, and its events; the signs that occur."""
    axes.axhline(0.0, color="0.8", lw=0.5, zorder=0.2, gid="zero")
    carried = [
        (MS * (pin.begin + begin - chosen.begin), MS * (end - begin))
        for begin, end in _held(pin)
        if pin.begin + end > chosen.begin and pin.begin + begin < chosen.end
    ]
    shade(axes, carried, "carried", color=PALETTE["carried"], alpha=0.6, zorder=0.1)
    axes.plot(ms, MM * pin.position(t), color=PALETTE["curve"], lw=1.3, gid="curve")
    signs = mark_events(
        axes,
        (
            (e.kind, e.contact, MS * (e.time - chosen.begin), MM * e.position)
            for e in pin.events
            if chosen.begin < e.time < chosen.end
        ),
    )
    axes.margins(y=0.12)
    axes.set_ylabel("deflection $x$ (mm)")
    return signs


def _held(pin: PinScan) -> list[tuple[float, float]]:
    """Times of stick on the plate, s since the begin of the scan."""
    held: list[tuple[float, float]] = []
    for segment in pin.motion.segments:
        if segment.plate == 0:
            begin = held.pop()[0] if held and held[-1][1] == segment.begin else segment.begin
            held.append((begin, min(segment.end, pin.motion.duration)))
    return held


def _draw_force(
    evaluation: Evaluation,
    pin: PinScan,
    axes: Axes,
    t: NDArray[np.float64],
    ms: NDArray[np.float64],
) -> None:
    finger = evaluation.scan.device.drive.finger
    axes.axhline(0.0, color="0.8", lw=0.5, zorder=0.2, gid="zero")
    axes.plot(ms, 1e3 * pin.skin_force(t), color=PALETTE["curve"], lw=1.1, gid="force")
    axes.margins(y=0.15)
    axes.set_ylabel("skin force (mN)")
    if not finger.rigid and not finger.damping:  # a damper adds a force without a stretch
        other = axes.twinx()
        other.set_ylim(*(1e3 / finger.stiffness * force for force in axes.get_ylim()))
        other.set_ylabel("stretch (µm)")
        other.spines["right"].set_visible(True)


def _draw_lifted(pin: PinScan, chosen: Moment, axes: Axes) -> list[Artist]:
    """While the finger is lifted; the sign for it, where it is."""
    begin, end = chosen.begin - pin.begin, chosen.end - pin.begin
    touched = [(max(t, begin), min(u, end)) for t, u in spans(pin.finger_load)]
    ends = [begin, *(time for t, u in touched if t < u for time in (t, u)), end]
    lifted = [
        (MS * (lift - begin), MS * (touch - lift))
        for lift, touch in zip(ends[::2], ends[1::2], strict=True)
        if lift < touch
    ]
    if not lifted:
        return []
    shade(axes, lifted, "lifted", **LIFTED, zorder=0.2)
    return [Patch(**LIFTED, label="finger lifted")]


def _key(signs: list[Sign]) -> list[Artist]:
    return [
        Patch(**PRINTED, label="printed line under the spot"),
        Line2D([], [], color=GREY, lw=0.6, ls=":", label="threshold of the control block"),
        Patch(color=PALETTE["stick"], lw=0.0, label="magnet switched on"),
        Patch(color=PALETTE["carried"], alpha=0.6, lw=0.0, label="carried by the plate"),
        *event_key(signs),
    ]
