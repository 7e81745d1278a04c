"""The picture of a motion: displacement, velocity and acceleration over time, phase portrait.

Drawn from the closed forms, phase by phase with the limits at both its ends, so that a corner is a
corner and a jump is a jump. No global state of matplotlib is used or left behind.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import groupby
from math import copysign, inf, isfinite, isnan
from typing import TYPE_CHECKING, Any, Final

import matplotlib.style
import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from pindrive.motion.function import Function
from pindrive.motion.profile import Profile
from pindrive.plot.style import (
    GREY,
    HALO,
    MM,
    PALETTE,
    SIGNS,
    SMALL,
    STYLE,
    Figure,
    event_key,
    mark_events,
    new_figure,
    shade,
)
from pindrive.plot.trace import Trace
from pindrive.quantities.table import QUANTITIES, digits, duration, short

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from pindrive.motion.motion import Motion


_TINT: Final = {"carried": 0.55, "resting": 0.22}  # opacity: two greys in black and white
_GRIP_TINT: Final = 0.3
_STOP_LINE: Final[dict[str, Any]] = {"color": "black", "lw": 1.6, "zorder": 0.8, "gid": "end stop"}

_MOST_MARKERS = 100
"""With more events their markers would hide the curve."""


def plot_motion(motion: Motion) -> Figure:
    """Draw a motion: x, v and a over time, and v over x, for a page 180 mm wide.

    With a compliant finger also the stretch of its skin, with end stops their force on the pin.

    Args:
        motion: Any motion; of a very long one the first phases, and the time axis says until when.

    Returns:
        A figure that belongs to nobody else: `save` it, or show it in a notebook.
    """
    with matplotlib.style.context(STYLE, after_reset=True):
        trace = Trace.of(motion)
        skin, stops = not motion.drive.finger.rigid, motion.drive.travel is not None
        figure = new_figure(180, 125 + 25 * (skin + stops))
        columns = figure.add_gridspec(1, 2, width_ratios=(1.25, 1.0))
        rows = columns[0].subgridspec(3 + skin + stops, 1)
        x = figure.add_subplot(rows[0], label="x")
        v = figure.add_subplot(rows[1], label="v", sharex=x)
        a = figure.add_subplot(rows[2], label="a", sharex=x)
        below = [a]
        if skin:
            below.append(figure.add_subplot(rows[3], label="s", sharex=x))
        if stops:
            below.append(figure.add_subplot(rows[3 + skin], label="f", sharex=x))
        rows = columns[1].subgridspec(2, 1, height_ratios=(2.6, 1.0))
        portrait = figure.add_subplot(rows[0], label="portrait")
        key = figure.add_subplot(rows[1], label="key")
        _draw_over_time(motion, trace, x, v, a)
        if skin:
            _draw_skin(trace, below[1])
        if stops:
            _draw_stop_force(trace, below[-1])
        _name_time_under(below)
        _draw_portrait(motion, trace, portrait)
        _draw_key(motion, trace, key)
        figure.align_ylabels((x, v, *below))
        figure.head(f"{outcome(motion)}\n{parameters(motion)}")
    return figure


# ---- the panels ----------------------------------------------------------------------------------


def _draw_over_time(motion: Motion, trace: Trace, x: Axes, v: Axes, a: Axes) -> None:
    panels = {x: "displacement $x$ (mm)", v: "velocity $v$ (mm/s)", a: "acceleration $a$ (m/s²)"}
    for axes, label in panels.items():
        axes.axhline(0.0, color="0.8", lw=0.5, zorder=0, gid="zero")
        for mode in ("carried", "resting"):
            tint: dict[str, Any] = {"color": PALETTE[mode], "alpha": _TINT[mode], "zorder": 0.5}
            shade(axes, trace.stuck(mode), mode, **tint)
        axes.set_ylabel(label)
        axes.tick_params(labelbottom=axes is a)
    x.plot(trace.t, trace.x, color=PALETTE["curve"], gid="curve")
    v.plot(trace.t, trace.v, color=PALETTE["curve"], gid="curve")
    a.plot(trace.broken(trace.t), trace.broken(trace.a), color=PALETTE["curve"], gid="curve")
    left, right = trace.a[trace.starts[1:] - 1], trace.a[trace.starts[1:]]
    a.vlines(trace.t[trace.starts[1:]], left, right, color=PALETTE["curve"], lw=0.5, gid="jumps")
    _mark_events(trace, x, [(e.time + d) * trace.scale for e, d in trace.events], "position")
    _mark_events(trace, v, [(e.time + d) * trace.scale for e, d in trace.events], "velocity")
    _draw_plate(motion, v, trace)
    _mark_settling(motion, trace, x)
    _mark_extremes(motion, trace, x)
    for place in _stops_met(motion, trace):
        x.axhline(place, **_STOP_LINE)
    x.set_ylim(_room(trace.x, 0.0, margin=0.22))
    v.set_ylim(_room(trace.v, 0.0, *_plate_range(motion, trace)))
    a.set_ylim(_room(trace.a, 0.0))
    part = ""
    if trace.end < motion.duration:
        part = f": the first {duration(trace.end)} of {duration(motion.duration)}"
    a.set_xlabel(f"time after release ({trace.unit}){part}")
    a.set_xlim(0.0, trace.end * trace.scale)


def _name_time_under(panels: list[Axes]) -> None:
    """Move the label of the time axis from the first panel to the last."""
    panels[-1].set_xlabel(panels[0].get_xlabel())
    for axes in panels[:-1]:
        axes.set_xlabel("")
        axes.tick_params(labelbottom=False)


def _draw_stop_force(trace: Trace, axes: Axes) -> None:
    """Force of the end stops on the pin, with jumps where the pin meets a stop with damping."""
    axes.axhline(0.0, color="0.8", lw=0.5, zorder=0, gid="zero")
    axes.plot(trace.broken(trace.t), trace.broken(trace.f), color=PALETTE["curve"], gid="curve")
    left, right = trace.f[trace.starts[1:] - 1], trace.f[trace.starts[1:]]
    axes.vlines(trace.t[trace.starts[1:]], left, right, color=PALETTE["curve"], lw=0.5, gid="jumps")
    axes.set_ylim(_room(trace.f, 0.0))
    axes.set_ylabel("stop force $R_s$ (N)")


def _draw_skin(trace: Trace, axes: Axes) -> None:
    """The stretch of a compliant finger's skin, and where it grips the pin."""
    axes.axhline(0.0, color="0.8", lw=0.5, zorder=0, gid="zero")
    tint: dict[str, Any] = {"color": PALETTE["gripping"], "alpha": _GRIP_TINT, "zorder": 0.5}
    shade(axes, trace.gripping(), "gripping", **tint)
    axes.plot(trace.t, trace.s, color=PALETTE["curve"], gid="curve")
    axes.set_ylim(_room(trace.s, 0.0))
    axes.set_ylabel("skin stretch $s$ (µm)")


def _draw_portrait(motion: Motion, trace: Trace, axes: Axes) -> None:
    axes.axhline(0.0, color="0.8", lw=0.5, zorder=0, gid="zero")
    for mode in ("carried", "resting"):
        axes.plot(
            trace.only(mode, trace.x),
            trace.only(mode, trace.v),
            color=PALETTE[mode],
            alpha=_TINT[mode],
            lw=8.0,
            solid_capstyle="round",
            zorder=0.5,
            gid=mode,
        )
    axes.plot(trace.x, trace.v, color=PALETTE["curve"], gid="curve")
    _mark_events(trace, axes, [e.position * MM for e, _ in trace.events], "velocity")
    if isinstance(motion.release.mouse_velocity, float):
        _draw_plate(motion, axes, trace)
    _mark_ends(motion, trace, axes)
    for place in _stops_met(motion, trace):
        axes.axvline(place, **_STOP_LINE)
    axes.set_xlabel("displacement $x$ (mm)")
    axes.set_ylabel("velocity $v$ (mm/s)")
    axes.set_xlim(_room(trace.x, margin=0.1))
    axes.set_ylim(_room(trace.v, 0.0, *_plate_range(motion, trace)))


def _draw_key(motion: Motion, trace: Trace, axes: Axes) -> None:
    """Draw the legend of the occurring signs."""
    axes.set_axis_off()
    handles: list[Artist] = []
    notes: list[str] = []
    occur = {(event.kind, event.contact) for event, _ in trace.events}
    if len(trace.events) <= _MOST_MARKERS:
        handles += event_key(sign for sign in SIGNS if sign in occur)
    else:
        notes.append(f"{len(trace.events)} events: too many to mark")
    if len(trace.starts) > 1:
        jump = Line2D([], [], color=PALETTE["curve"], lw=0.5, label="acceleration jumps")
        handles.append(jump)
    handles += [
        Patch(color=PALETTE[mode], alpha=_TINT[mode], lw=0.0, label=stuck_name(motion, mode))
        for mode in _TINT
        if trace.stuck(mode)
    ]
    if not motion.drive.finger.rigid and trace.gripping():
        colour = PALETTE["gripping"]
        handles.append(Patch(color=colour, alpha=_GRIP_TINT, lw=0.0, label=NAME["gripping"]))
    if _stops_met(motion, trace):
        handles.append(Line2D([], [], **_STOP_LINE, label="end stop"))
    if _band(motion) > 0.0:
        part = f"{100 * motion.settling_band:g} %"
        label = rf"$x_\mathrm{{end}}$ ± {part} of $|x_0 - x_\mathrm{{end}}|$"
        handles.append(Line2D([], [], color=GREY, lw=0.7, ls=":", label=label))
    elif motion.ending.kind in ("steady", "irregular"):
        label = r"$x_\mathrm{end}$, about which it oscillates"
        handles.append(Line2D([], [], color=GREY, lw=0.7, ls=":", label=label))
    handles += [Line2D([], [], ls="none", label=note) for note in notes]
    axes.legend(handles=handles, loc="upper left", borderaxespad=0.0)


# ---- the signs -----------------------------------------------------------------------------------


def _room(values: NDArray[np.float64], *others: float, margin: float = 0.15) -> tuple[float, float]:
    """Limits of an axis that shows all these with a margin; rounding is not blown up."""
    low, high = min(float(values.min()), *others, inf), max(float(values.max()), *others, -inf)
    span = high - low
    if span <= 1e-9 * max(abs(low), abs(high)):
        span = max(abs(low), abs(high)) or 1.0
    return low - margin * span, high + margin * span


def _mark_events(trace: Trace, axes: Axes, across: list[float], ordinate: str) -> None:
    if len(trace.events) > _MOST_MARKERS:
        return
    events = zip(trace.events, across, strict=True)
    mark_events(axes, ((e.kind, e.contact, x, getattr(e, ordinate) * MM) for (e, _), x in events))


def _stops_met(motion: Motion, trace: Trace) -> list[float]:
    """Return the end stops that the pin touches, mm; free ones would stretch the axes."""
    sides = {copysign(1.0, e.position) for e, _ in trace.events if e.contact == "stop"}
    if motion.drive.travel is None:
        return []
    travel = motion.drive.travel * MM
    sides |= {side for side in (-1.0, 1.0) if (side * trace.x >= travel).any()}
    return [side * travel for side in sorted(sides)]


def _draw_plate(motion: Motion, axes: Axes, trace: Trace) -> None:
    dashed: dict[str, Any] = {
        "color": PALETTE["plate"],
        "lw": 0.8,
        "ls": (0, (5, 3)),
        "zorder": 1,
        "gid": "plate",
    }
    level = float(motion.plate_velocity(trace.end)) * MM
    if not isinstance(motion.release.mouse_velocity, float):
        hand = motion.release.mouse_velocity
        places = hand.times if isinstance(hand, Profile) else np.linspace(0.0, trace.end, 401)
        times = np.array([0.0, *(t for t in places if 0.0 < t < trace.end), trace.end])
        axes.plot(times * trace.scale, motion.plate_velocity(times) * MM, **dashed)
    else:
        axes.axhline(level, **dashed)
    _note_level(axes, level, r"plate $v_\mathrm{p}$")


def _plate_range(motion: Motion, trace: Trace) -> tuple[float, float]:
    levels = motion.plate_velocity(trace.t / trace.scale) * MM
    return float(levels.min()), float(levels.max())


def _note_level(axes: Axes, level: float, text: str) -> None:
    """Name a horizontal line where it meets the right edge."""
    axes.annotate(
        text,
        (1.0, level),
        (2, 0),
        xycoords=axes.get_yaxis_transform(),
        textcoords="offset points",
        va="center",
        fontsize=SMALL,
        annotation_clip=True,  # a level that is not on the axis takes no room beside it
    )


def _mark_ends(motion: Motion, trace: Trace, axes: Axes) -> None:
    """Start and end of the portrait; a steady oscillation has no end."""
    ends = {0: "start"}
    if motion.ending.kind not in ("resting", "decaying", "steady") or trace.end < motion.duration:
        ends[-1] = duration(trace.end)
    elif motion.ending.kind in ("resting", "decaying"):
        ends[-1] = "end"
    moving = trace.v[trace.v != 0.0]
    comes_from_below = len(moving) > 0 and moving[-1] < 0.0
    for i, text in ends.items():
        place = (float(trace.x[i]), float(trace.v[i]))
        fill = "white" if i == 0 else "black"
        axes.plot(*place, "o", color="black", mfc=fill, mew=0.8, ms=3.5, zorder=4, gid="ends")
        above = i == 0 or comes_from_below
        right = i == 0 and 2.0 * place[0] > trace.x.min() + trace.x.max()
        axes.annotate(
            text,
            place,
            (-4 if right else 4, 4 if above else -9),  # at the start away from the plate's name
            textcoords="offset points",
            ha="right" if right else "left",
            fontsize=SMALL,
            path_effects=HALO,
        )


def _band(motion: Motion) -> float:
    """Half the band that counts as settled, mm; 0 where there is none to show."""
    if motion.ending.kind not in ("resting", "decaying"):
        return 0.0
    return motion.settling_band * abs(motion.release.displacement - motion.ending.position) * MM


def _mark_settling(motion: Motion, trace: Trace, axes: Axes) -> None:
    middle, time = motion.ending.position * MM, motion.transient.settling_time
    if isnan(middle):
        return
    if motion.ending.kind in ("steady", "irregular"):
        axes.axhline(middle, color=GREY, lw=0.7, ls=":", zorder=1, gid="middle")
    if motion.ending.kind == "drifting":
        ends = np.array([0.0, trace.end])
        line = middle + motion.ending.drift_velocity * ends * MM
        axes.plot(ends * trace.scale, line, color=GREY, lw=0.7, ls=":", zorder=1, gid="drift")
    for level in {middle - _band(motion), middle + _band(motion)} - {middle}:
        axes.axhline(level, color=GREY, lw=0.7, ls=":", zorder=1, gid="band")
    if motion.ending.kind != "drifting":
        _note_level(axes, middle, r"$x_\mathrm{end}$")
    if 0.0 < time <= trace.end:
        word = "steady from" if motion.ending.kind == "steady" else "settled at"
        axes.axvline(time * trace.scale, color=GREY, lw=0.7, zorder=1, gid="settling")
        side = ("left", "center", "right")[(time > 0.2 * trace.end) + (time > 0.8 * trace.end)]
        axes.annotate(
            f"{word} {duration(time)}",
            (time * trace.scale, 1.0),
            (0, 1),
            xycoords=axes.get_xaxis_transform(),
            textcoords="offset points",
            ha=side,
            va="bottom",
            fontsize=SMALL,
        )


def _mark_extremes(motion: Motion, trace: Trace, axes: Axes) -> None:
    numbers = motion.transient
    for name, up in (("peak", _outward(motion)), ("trough", not _outward(motion))):
        time, place = getattr(numbers, f"{name}_time"), getattr(numbers, f"{name}_displacement")
        if not time <= trace.end or isnan(numbers.swing):
            continue
        late = time > 0.65 * trace.end
        axes.annotate(
            f"{name} {short('displacement', place)}",
            (time * trace.scale, place * MM),
            (-4 if late else 4, 3 if up else -4),
            textcoords="offset points",
            ha="right" if late else "left",
            va="bottom" if up else "top",
            fontsize=SMALL,
            path_effects=HALO,
        )


def _outward(motion: Motion) -> bool:
    """Return True if the peak is above the trough."""
    return not motion.transient.peak_displacement < motion.transient.trough_displacement


NAME: Final = {
    "carried": "carried by the plate",
    "resting": "resting on the finger",
    "gripping": "skin grips the pin",
}

_STOPS: Final = {
    "travel": r"$x_\mathrm{s}$",
    "stop_stiffness": r"$k_\mathrm{s}$",
    "stop_damping": r"$b_\mathrm{s}$",
}
"""Labels of end stops, by their symbols."""
_LINE: Final = 118
"""Characters that fit side by side above the panels."""
_MOST_TURNS: Final = 4
"""Largest number of values shown of a curve or a varying input."""


def _course_of_input(motion: Motion, name: str) -> str:
    """Return an input over time in words, as `_course` does."""
    given = getattr(motion.release, name)
    if isinstance(given, Function):
        return _course(name, given(np.linspace(0.0, motion.duration, 1001)).tolist())
    return _course(name, given.values if isinstance(given, Profile) else (given,))


def _course(name: str, values: Sequence[float]) -> str:
    """Return one value, or its sequence: "60 → 0 mm/s"; for many values the range."""
    turns = [value for value, _ in groupby(values)]
    if len(turns) > _MOST_TURNS:
        return " … ".join(short(name, value) for value in (min(turns), max(turns)))
    scale = QUANTITIES[name].display_scale
    return " → ".join([*(digits(value * scale) for value in turns[:-1]), short(name, turns[-1])])


def stuck_name(motion: Motion, mode: str) -> str:
    """Return the name of a stuck phase."""
    if mode == "resting" and (
        not isinstance(motion.release.mouse_velocity, float)
        or not motion.drive.finger.rigid
        or motion.drive.travel is not None
    ):
        return "at rest"
    if motion.release.mouse_velocity != 0.0 or motion.drive.plate.frictionless:
        return NAME[mode]
    on_finger = "" if motion.drive.finger.frictionless else "finger and "
    return f"at rest on {on_finger}plate"


def outcome(motion: Motion) -> str:
    """Return the ending, the duration of the transient and its swing."""
    end, numbers = motion.ending, motion.transient
    place = short("displacement", end.position)
    words = {
        "resting": f"At rest at {place} since {duration(numbers.rest_time)}",
        "decaying": f"Decays towards {place}",
        "growing": f"Grows by a factor of {end.growth:.6g} in a period",
        "approaching": f"Approaches a limit by a factor of {end.growth:.6g} in a period",
        "drifting": f"Drifts at {short('mouse_velocity', end.drift_velocity)}",
        "steady": f"Steady {end.cycle} oscillation of ±{short('displacement', end.amplitude)}",
        "irregular": f"Irregular oscillation of up to ±{short('displacement', end.amplitude)}",
        "moving": f"Still moving after {duration(motion.duration)}",
    }[end.kind]
    if isfinite(end.period) and end.kind in ("steady", "irregular"):
        mean = "mean " if end.kind == "irregular" else ""
        words += f", {mean}period {duration(end.period)}"
    if end.kind == "steady":
        words += f"; steady from {duration(end.steady_since)}"
    elif numbers.settled:
        words += f"; settling time {duration(numbers.settling_time)}"
    if not isnan(numbers.swing):
        words += f"; swing {short('displacement', numbers.swing)}"
    return words


def parameters(motion: Motion) -> str:
    """The drive and its release."""
    drive = motion.drive
    words = [
        f"$m$ = {short('mass', drive.mass)}",
        f"$k$ = {short('stiffness', drive.stiffness)}",
        f"$ζ$ = {drive.damping_ratio:.4g}",
    ]
    for contact, index in ((drive.plate, "p"), (drive.finger, "f")):
        kinetic, static = contact.kinetic, contact.static_friction
        more = "" if static == kinetic else f" (static {short('plate.static', static)})"
        along = [force for _, force in contact.curve or ()] or [kinetic]
        words.append(rf"$F_\mathrm{{{index}}}$ = {_course('plate.kinetic', along)}{more}")
    if not drive.finger.rigid:
        words.append(rf"$k_\mathrm{{f}}$ = {short('finger.stiffness', drive.finger.stiffness)}")
    if drive.finger.damping:
        words.append(rf"$b_\mathrm{{f}}$ = {short('finger.damping', drive.finger.damping)}")
    words += [
        f"{symbol} = {short(name, value)}"
        for name, symbol in _STOPS.items()
        for value in (getattr(drive, name),)
        if value is not None
    ]
    for name, symbol, usual in (
        ("plate_load", "λ", 1.0),
        ("finger_load", r"λ_\mathrm{f}", 1.0),
        ("across_velocity", "w", 0.0),
        ("force", r"F_\mathrm{e}", 0.0),
        ("mouse_velocity", r"v_\mathrm{p}", None),
    ):
        if getattr(motion.release, name) != usual:
            words.append(f"${symbol}$ = {_course_of_input(motion, name)}")
    words.append(f"$x_0$ = {short('displacement', motion.release.displacement)}")
    if motion.release.initial_velocity != float(motion.plate_velocity(0.0)):
        words.append(f"$v_0$ = {short('velocity', motion.release.initial_velocity)}")
    lines = [words[0]]
    for word in words[1:]:
        longer = f"{lines[-1]}, {word}"
        if len(re.sub(r"[$\\{}_]|mathrm", "", longer)) <= _LINE:
            lines[-1] = longer
        else:
            lines.append(word)
    return ",\n".join(lines)
