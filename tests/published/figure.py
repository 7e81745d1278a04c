"""The figure of a case: the motion beside the published values, and every difference."""

from __future__ import annotations

import matplotlib.style
from cycler import cycler

from pindrive.plot.style import GREY, PALETTE, SMALL, STYLE, Figure

from .case import Case, Number

CYCLE = [PALETTE["curve"], PALETTE["stick"], PALETTE["slip"], PALETTE["gripping"]]
EDGE = 1.25
"""Place of a difference beyond the allowed one, in units of the allowed one."""


def part(number: Number) -> float:
    """The difference in parts of the allowed one."""
    return number.difference / number.allowed if number.difference else 0.0


def figure(case: Case) -> Figure:
    """Draw a case."""
    look = {**STYLE, "axes.prop_cycle": cycler(color=CYCLE)}
    with matplotlib.style.context(look, after_reset=True):
        drawn = Figure(figsize=(6.6, 2.9), dpi=160, layout="constrained")
        motion, differences = drawn.subplots(1, 2, width_ratios=(2.2, 1.0))
        case.draw(motion)
        if motion.get_legend_handles_labels()[0]:
            motion.legend(frameon=False)
        parts = [part(number) for number in case.numbers]
        rows = range(1, len(parts) + 1)
        differences.axvspan(-1.0, 1.0, color="0.9", lw=0.0)
        differences.axvline(0.0, color=GREY, lw=0.6)
        inside = [(x, y) for x, y in zip(parts, rows, strict=True) if abs(x) <= 1.0]
        differences.plot(*zip(*inside, strict=True), "o", color=PALETTE["curve"])
        for x, y in zip(parts, rows, strict=True):
            if abs(x) > 1.0:
                side = 1.0 if x > 0.0 else -1.0
                marker = ">" if x > 0.0 else "<"
                differences.plot([EDGE * side], [y], marker, color=PALETTE["stick"])
                differences.annotate(
                    f"{x:+.0f}",
                    (EDGE * side, y),
                    (-6 * side, 0),
                    textcoords="offset points",
                    ha="right" if x > 0.0 else "left",
                    va="center",
                    fontsize=SMALL,
                )
        differences.set(
            xlim=(-1.4, 1.4),
            ylim=(len(parts) + 0.6, 0.4),
            yticks=list(rows),
            xlabel="Difference over the allowed one",
            ylabel="Row of the table",
        )
    return drawn
