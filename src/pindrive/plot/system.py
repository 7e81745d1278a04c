"""The picture of a motion of several bodies: positions, velocities, slip of each contact."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import matplotlib.style
import numpy as np
from matplotlib.patches import Patch

from pindrive.bodies.ending import ENDINGS
from pindrive.plot.style import CURVES, GREY, MM, PALETTE, SMALL, STYLE, new_figure, plain
from pindrive.quantities.quantity import counted
from pindrive.quantities.table import digits

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from pindrive.bodies.system_motion import SystemMotion
    from pindrive.plot.style import Figure

_SAMPLES: Final = 2001
_MOST_CONTACTS: Final = 40
"""With more contacts their rows would be thinner than a line."""
_LOOK: Final = {
    0: (PALETTE["resting"], "stick"),
    1: (PALETTE["curve"], "slip forward"),
    -1: (PALETTE["carried"], "slip backward"),
}


def plot_system(motion: SystemMotion) -> Figure:
    """Draw positions and velocities over time, and below them when each contact sticks or slips.

    Args:
        motion: Any motion of several bodies.

    Returns:
        A figure 180 mm wide that belongs to nobody else.
    """
    contacts = [*motion.system.contacts][:_MOST_CONTACTS]
    with matplotlib.style.context(STYLE, after_reset=True):
        below = 8.0 + 4.2 * len(contacts)
        figure = new_figure(180, 95 + (below if contacts else 0.0))
        heights = [42.0, 42.0, below] if contacts else [42.0, 42.0]
        rows = figure.add_gridspec(len(heights), 1, height_ratios=heights)
        x = figure.add_subplot(rows[0], label="position")
        v = figure.add_subplot(rows[1], label="velocity", sharex=x)
        t, moving = _sampled(motion)
        _draw_bodies(motion, t, moving, x, v)
        last = v
        if contacts:
            last = figure.add_subplot(rows[2], label="contacts", sharex=x)
            _draw_contacts(motion, contacts, last)
            v.tick_params(labelbottom=False)
        last.set_xlabel("time (s)")
        last.set_xlim(0.0, motion.core.end)
        figure.align_ylabels((x, v))
        figure.head(plain(_words(motion)))
    return figure


def _sampled(motion: SystemMotion) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Even times and both sides of each event, and the bodies at them."""
    t = motion.sample_times(_SAMPLES)
    moving, *_ = motion.state_at(t)
    return t, moving


def _draw_bodies(
    motion: SystemMotion, t: NDArray[np.float64], moving: NDArray[np.float64], x: Axes, v: Axes
) -> None:
    names = [*motion.system.bodies]
    for axes, values, label in ((x, moving[0], "position (mm)"), (v, moving[1], "velocity (mm/s)")):
        axes.axhline(0.0, color="0.8", lw=0.5, zorder=0, gid="zero")
        for i in reversed(range(len(names))):
            look: dict[str, Any] = (
                dict(CURVES[i]) if i < len(CURVES) else {"color": GREY, "lw": 0.5}
            )
            words = plain(names[i]) if i < len(CURVES) else "_"
            axes.plot(t, values[i] * MM, label=words, gid=f"body {names[i]}", **look)
        axes.set_ylabel(label)
    x.tick_params(labelbottom=False)
    handles, labels = x.get_legend_handles_labels()
    x.legend(handles[::-1], labels[::-1], loc="center left", bbox_to_anchor=(1.0, 0.5))
    if len(names) > len(CURVES):
        x.set_title(f"grey: {counted(len(names) - len(CURVES), 'further body', 'further bodies')}")


def _draw_contacts(motion: SystemMotion, contacts: list[str], axes: Axes) -> None:
    """Draw a row for each contact, coloured by its slip."""
    _, touching, *_ = motion.state_at(np.zeros(1))
    end, first = motion.core.end, dict(zip(motion.system.contacts, touching[3, :, 0], strict=True))
    for row, name in enumerate(contacts):
        events = motion.contact(name).events
        edges = [0.0, *(event.time for event in events), end]
        slips = [int(first[name]), *(event.after for event in events)]
        for slip, (colour, _) in _LOOK.items():
            spans = [
                (begin, stop - begin)
                for begin, stop, own in zip(edges[:-1], edges[1:], slips, strict=True)
                if own == slip and stop > begin
            ]
            axes.broken_barh(spans, (row - 0.4, 0.8), color=colour, lw=0.0, gid=f"slip {slip}")
    axes.set_yticks(range(len(contacts)), [plain(name) for name in contacts])
    axes.tick_params(axis="y", labelsize=SMALL, length=0.0)
    axes.set_ylim(len(contacts) - 0.5, -0.5)
    key = [Patch(color=colour, label=words) for colour, words in _LOOK.values()]
    axes.legend(handles=key, loc="center left", bbox_to_anchor=(1.0, 0.5))


def _words(motion: SystemMotion) -> str:
    """Return what was simulated, and its events."""
    system = repr(motion.system)[1:-1].removeprefix("System of ")
    kind = motion.ending.kind
    rest = "" if kind == "unknown" else f", {ENDINGS[kind]} at the end"
    return f"{system}: {counted(len(motion.events), 'event')} in {digits(motion.core.end)} s{rest}"
