"""The picture of how fast a hand may move: speed over pitch."""

from __future__ import annotations

from textwrap import fill
from typing import TYPE_CHECKING, Final

import matplotlib.style
import numpy as np

from pindrive.evaluation.resolution import criterion
from pindrive.plot.style import GREY, PALETTE, SMALL, STYLE, Figure

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from pindrive.evaluation.resolution import SpeedLimit
    from pindrive.evaluation.results import Criteria

MM: Final = 1e3
HANDS: Final = (20.0, 100.0)
"""Hand speeds in finger studies, mm/s (arXiv 2505.11162)."""


def plot_speeds(
    limits: Sequence[SpeedLimit], part: float, criteria: Criteria, device: str = ""
) -> Figure:
    """Draw the largest hand speeds over the pitch, for a page 120 mm wide.

    Args:
        limits: what `largest_speeds` found.
        part: of its way that the pin had to be back.
        criteria: what counted as felt.
        device: its name, for the title.
    """
    with matplotlib.style.context(STYLE, after_reset=True):
        figure = Figure(figsize=(120 / 25.4, 95 / 25.4), dpi=250, layout="constrained")
        axes = figure.add_subplot(label="speed")
        ordered = sorted(limits, key=lambda limit: limit.pitch)
        pitch = np.array([limit.pitch for limit in ordered]) * MM
        apart = np.array([limit.speed for limit in ordered]) * MM
        settled = np.array([limit.settled_speed for limit in ordered]) * MM
        top = 1.12 * float(np.nanmax([*apart, HANDS[1]]))
        axes.axhspan(*HANDS, color=PALETTE["resting"], alpha=0.13, lw=0.0, zorder=0, gid="hands")
        slowest = np.array([_from(limit) for limit in ordered]) * MM
        blue = PALETTE["curve"]
        axes.fill_between(pitch, slowest, apart, alpha=0.12, color=blue, lw=0.0)
        axes.fill_between(pitch, slowest, settled, alpha=0.22, color=blue, lw=0.0)
        if slowest.any():
            axes.plot(pitch, slowest, color=PALETTE["curve"], lw=0.7, ls=":", gid="slowest")
        _curve(axes, pitch, apart, "o", "distinct")
        _curve(axes, pitch, settled, "s", "settled")
        _bands(axes, ordered)
        _names(axes, pitch, apart, settled, part)
        axes.set_xlim(0.0, 1.04 * pitch.max())
        axes.set_ylim(0.0, top)
        axes.set_xlabel("pitch of the lines (mm)")
        axes.set_ylabel("hand speed (mm/s)")
        axes.tick_params(labelsize=SMALL, width=0.6, length=2.5)
        title = f"How fast the hand may move{f': {device}' if device else ''}"
        words = fill(criterion(part, criteria.direction), 78)
        figure.suptitle(f"{title}\n{words}", x=0.012, ha="left", fontsize=8.0)
    return figure


def _from(limit: SpeedLimit) -> float:
    """From which speed on the lines are distinct, m/s; 0: from the slowest tried."""
    return limit.distinct[0][0] if limit.distinct and limit.distinct[0][0] > limit.tried[0] else 0.0


def _curve(
    axes: Axes, pitch: NDArray[np.float64], speed: NDArray[np.float64], marker: str, name: str
) -> None:
    axes.plot(pitch, speed, color=PALETTE["curve"], marker=marker, mfc="white", mew=1.0, gid=name)


def _bands(axes: Axes, limits: Sequence[SpeedLimit]) -> None:
    """Where the lines are distinct again beyond the limit."""
    for limit in limits:
        for low, high in limit.distinct[1:]:
            axes.plot(
                [MM * limit.pitch] * 2, [MM * low, MM * high], color=GREY, lw=2.0, gid="again"
            )


def _names(
    axes: Axes,
    pitch: NDArray[np.float64],
    apart: NDArray[np.float64],
    settled: NDArray[np.float64],
    part: float,
) -> None:
    """The regions by their names, where they are widest."""
    axes.annotate(
        "hands in finger studies",
        (1.0, HANDS[1]),
        (-3, -3),
        xycoords=axes.get_yaxis_transform(),
        textcoords="offset points",
        ha="right",
        va="top",
        fontsize=SMALL,
        color="#8a5a00",
    )
    known = ~np.isnan(apart)
    if not known.any():
        axes.annotate("at no speed distinct", (0.5, 0.5), xycoords="axes fraction", ha="center")
        return
    x, y = pitch[known], apart[known]
    axes.annotate(
        "they run into one",
        (0.05, 0.95),
        xycoords="axes fraction",
        va="top",
        fontsize=8.0,
        color="0.25",
    )
    axes.annotate(
        f"distinct: back by {part:.0%} in between",
        (float(x[-1]), float(y[-1])),
        (-8, 0),
        textcoords="offset points",
        ha="right",
        va="center",
        fontsize=SMALL,
        color=PALETTE["curve"],
    )
    if not np.isnan(settled).all():
        last = int(np.flatnonzero(~np.isnan(settled))[-1])
        axes.annotate(
            "settled in between",
            (float(pitch[last]), float(settled[last])),
            (-4, -40),
            textcoords="offset points",
            ha="right",
            va="top",
            fontsize=SMALL,
            color=PALETTE["curve"],
        )
