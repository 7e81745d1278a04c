"""The race as a picture: error against time, each peer a curve over its tolerances or steps."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby
from pathlib import Path
from typing import Any

import matplotlib.style
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from benchmarks.racing.race import Result
from pindrive.plot.style import GREY, PALETTE, SMALL, STYLE, save

# Peer and way: colour, marker, and where the name stands: at the first or last point, and how.
LOOKS: dict[tuple[str, str], tuple[str, str, int, tuple[float, float], str]] = {
    ("pindrive", "simulate"): (PALETTE["curve"], "D", 0, (7, 0), "left"),
    ("pindrive", "simulate_batch"): (PALETTE["curve"], "D", 0, (7, 0), "left"),
    ("numba", "Moreau–Jean"): ("black", "o", 1, (5, 9), "left"),
    ("SciPy", "tanh, LSODA"): (PALETTE["resting"], "v", 0, (-6, 4), "right"),
    ("SciPy", "modes, DOP853"): (PALETTE["stick"], "^", -1, (0, -12), "center"),
    ("SciPy", "modes, LSODA"): (PALETTE["stick"], "v", -1, (8, 0), "left"),
    ("SUNDIALS", "modes, CVODE Adams"): (PALETTE["slip"], "s", 2, (-7, 0), "right"),
    ("MuJoCo", "hard friction"): (PALETTE["gripping"], "o", -1, (0, 13), "center"),
    ("MuJoCo", "soft, as it comes"): (PALETTE["gripping"], "o", -1, (7, 0), "left"),
    ("PathSim", "events, RKCK54"): (PALETTE["carried"], "s", -1, (7, -3), "left"),
    ("Siconos", "time stepping"): (GREY, "P", -1, (0, -13), "center"),
}
PLAIN = (GREY, ".", -1, (5, 0), "left")


def draw(results: Sequence[Result], caption: str, path: Path) -> None:
    """Medians of the error over the drives; a line up to the worst; hollow: some failed."""
    with matplotlib.style.context(STYLE, after_reset=True):
        figure = Figure(figsize=(180 / 25.4, 118 / 25.4), dpi=250, layout="constrained")
        axes = figure.add_subplot()
        for key, group in groupby(results, lambda r: (r.racer.peer, r.racer.way)):
            curve(axes, key, list(group))
        axes.set(xscale="log", yscale="log", xlim=(4e-7, 0.6), ylim=(1e-17, 2.0))
        seconds = 10.0 ** np.arange(-6, 0)
        axes.xaxis.set_major_locator(FixedLocator(seconds.tolist()))
        axes.xaxis.set_major_formatter(FuncFormatter(duration))
        axes.yaxis.set_major_locator(FixedLocator((10.0 ** np.arange(-16, 1, 2)).tolist()))
        axes.xaxis.set_minor_locator(NullLocator())
        axes.yaxis.set_minor_locator(NullLocator())
        axes.grid(lw=0.4, c="0.92")
        axes.set_axisbelow(True)
        axes.set_xlabel("processor time of a transient")
        axes.set_ylabel("largest error of position / release displacement")
        axes.legend(handles=signs(), loc="lower right", frameon=False, handlelength=1.2)
        figure.suptitle(caption, x=0.008, ha="left", fontsize=SMALL)
        save(figure, path)


def duration(seconds: float, _place: object) -> str:
    """With a unit, for an axis."""
    for scale, unit in ((1.0, "s"), (1e-3, "ms"), (1e-6, "µs")):
        if seconds >= 0.999 * scale:
            return f"{seconds / scale:.0f} {unit}"
    return f"{1e9 * seconds:.0f} ns"


def curve(axes: Axes, key: tuple[str, str], results: Sequence[Result]) -> None:
    """One way of using one peer."""
    colour, marker, at, offset, side = LOOKS.get(key, PLAIN)
    shown = [r for r in results if np.isfinite(r.errors).any()]
    if not shown:
        return
    times = [r.seconds for r in shown]
    middles = [float(np.nanmedian(r.errors)) for r in shown]
    worst = [float(np.nanmax(r.errors)) for r in shown]
    soft: dict[str, Any] = {"color": colour, "lw": 0.8, "alpha": 0.45, "zorder": 1}
    axes.vlines(times, middles, worst, **soft)
    axes.plot(times, middles, color=colour, lw=1.1, zorder=2)
    for time, middle, result in zip(times, middles, shown, strict=True):
        fill = "white" if result.failures else colour
        axes.plot(time, middle, marker, color=colour, mfc=fill, mew=0.9, zorder=3)
    axes.annotate(
        "\n".join(key),
        (times[at], middles[at]),
        offset,
        textcoords="offset points",
        ha=side,
        va="center",
        fontsize=SMALL,
        color=colour if colour != PALETTE["carried"] else "#2A7FB0",
        linespacing=1.05,
        zorder=4,
    )


def signs() -> list[Line2D]:
    """Legend of the signs."""
    dot: dict[str, Any] = {"ls": "none", "marker": "o", "color": GREY}
    return [
        Line2D([], [], **dot, label="median over the drives"),
        Line2D([], [], ls="none", marker="|", ms=9, color=GREY, alpha=0.6, label="up to the worst"),
        Line2D([], [], **dot, mfc="white", label="some drives failed"),
    ]
