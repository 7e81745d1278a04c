"""The picture of how fast a hand may move: speed over pitch."""

from __future__ import annotations

from textwrap import fill
from typing import TYPE_CHECKING, Any, Final

import matplotlib.style
import numpy as np
from matplotlib.patches import Patch

from pindrive.evaluation.resolution import STUDIED, criterion
from pindrive.plot.style import GREY, HANDS, MM, PALETTE, STYLE, Figure, new_figure, plain

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D

    from pindrive.device.device import Criteria
    from pindrive.evaluation.page_speed import PageSpeeds
    from pindrive.evaluation.resolution import SpeedLimit

CURVE: Final[dict[str, Any]] = {"color": PALETTE["curve"], "mfc": "white", "mew": 1.0}
_STUDIED: Final = tuple(speed * MM for speed in STUDIED)


def plot_speeds(limits: Sequence[SpeedLimit], criteria: Criteria, device: str = "") -> Figure:
    """Draw the largest hand speeds over the pitch, for a page 120 mm wide.

    Args:
        limits: Result of `largest_speeds`.
        criteria: Criteria of a felt line.
        device: Name of the device, for the title.
    """
    with matplotlib.style.context(STYLE, after_reset=True):
        figure = new_figure(120, 105)
        axes = figure.add_subplot(label="speed")
        ordered = sorted(limits, key=lambda limit: limit.pitch)
        pitch = np.array([limit.pitch for limit in ordered]) * MM
        apart = np.array([limit.speed for limit in ordered]) * MM
        settled = np.array([limit.settled_speed for limit in ordered]) * MM
        top = 1.12 * float(np.nanmax([*apart, _STUDIED[1]]))
        blue = PALETTE["curve"]
        slowest = np.array([_from(limit) for limit in ordered]) * MM
        axes.axhspan(*_STUDIED, **HANDS, zorder=0, gid="hands")
        axes.fill_between(pitch, slowest, apart, alpha=0.12, color=blue, lw=0.0, gid="distinct")
        axes.fill_between(pitch, slowest, settled, alpha=0.22, color=blue, lw=0.0, gid="settled")
        handles: list[Artist] = []
        if not np.isnan(apart).all():
            said = f"distinct: back by {criteria.distinct:.0%} in between"
            handles += axes.plot(pitch, apart, marker="o", **CURVE, label=said, gid="distinct")
            _name(axes, "they run into one", (0.02, 0.98))
        else:
            _name(axes, "at no speed distinct", (0.02, 0.98))
        if not np.isnan(settled).all():
            said = "settled in between, too"
            handles += axes.plot(pitch, settled, marker="s", **CURVE, label=said, gid="settled")
        if slowest.any():
            said = "not distinct below"
            style: dict[str, Any] = {"color": blue, "lw": 0.7, "ls": ":"}
            handles += axes.plot(pitch, slowest, **style, label=said, gid="slowest")
        handles += _bands(axes, ordered)[:1]
        handles.append(Patch(**HANDS, label="hands in finger studies"))
        figure.legend(handles=handles, loc="outside lower left", ncols=2)
        axes.set_xlim(0.0, 1.04 * pitch.max())
        axes.set_ylim(0.0, top)
        axes.set_xlabel("pitch of the lines (mm)")
        axes.set_ylabel("hand speed (mm/s)")
        title = f"Largest hand speed{f': {device}' if device else ''}"
        words = fill(criterion(criteria), 78)
        figure.head(f"{plain(title, 66)}\n{words}")
    return figure


def plot_page_speeds(found: PageSpeeds, device: str = "") -> Figure:
    """Draw what becomes of the lines of a page over the hand speed, for a page 120 mm wide.

    Args:
        found: Result of `speeds_over_page`.
        device: Name of the device, for the title.
    """
    with matplotlib.style.context(STYLE, after_reset=True):
        figure = new_figure(120, 90)
        axes = figure.add_subplot(label="page")
        speed = np.array([*found.counts]) * MM
        counts = [*found.counts.values()]
        lines = np.array([max(1, each["lines.crossed"]) for each in counts])
        shown = np.array([each["lines.shown"] for each in counts])
        calm = shown - np.array([each["lines.unsettled"] for each in counts])
        axes.axvspan(*_STUDIED, **HANDS, zorder=0, gid="hands")
        handles: list[Artist] = []
        for part, marker, said in ((shown, "o", "shown"), (calm, "s", "shown and settled")):
            style = CURVE | {"marker": marker, "label": said, "gid": said}
            handles += axes.plot(speed, 100.0 * part / lines, **style)
        handles.append(Patch(**HANDS, label="hands in finger studies"))
        figure.legend(handles=handles, loc="outside lower left", ncols=3)
        axes.set_xscale("log")
        axes.xaxis.set_major_formatter("{x:g}")
        axes.set_ylim(-3.0, 106.0)
        axes.set_xlabel("hand speed (mm/s)")
        axes.set_ylabel("lines (%)")
        about = f"Largest hand speed over {found.title}{f': {device}' if device else ''}"
        figure.head(plain(about, 66))
    return figure


def _from(limit: SpeedLimit) -> float:
    """From which speed on the lines are distinct, m/s; 0: from the slowest tried."""
    return limit.distinct[0][0] if limit.distinct and limit.distinct[0][0] > limit.tried[0] else 0.0


def _bands(axes: Axes, limits: Sequence[SpeedLimit]) -> list[Line2D]:
    """Draw the speeds beyond the limit at which the lines are distinct again."""
    return [
        line
        for limit in limits
        for low, high in limit.distinct[1:]
        for line in axes.plot(
            [MM * limit.pitch] * 2,
            [MM * low, MM * high],
            color=GREY,
            lw=2.0,
            label="distinct again",
            gid="again",
        )
    ]


def _name(axes: Axes, text: str, place: tuple[float, float]) -> None:
    axes.annotate(text, place, xycoords="axes fraction", va="top", color="0.25")
