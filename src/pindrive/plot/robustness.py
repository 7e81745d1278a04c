"""Figure of the scatter within tolerances: histograms, limits, worst cases."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import matplotlib.style
import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from pindrive.files.keys import variable
from pindrive.plot.style import PALETTE, SMALL, STYLE, Figure, new_figure, plain
from pindrive.quantities.quantity import counted
from pindrive.study.slices import QUANTITY, axis_label, ranges

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from pindrive.study.robustness import Robustness

_BINS: Final = 80
"""At most: no more than twice the root of the number of draws."""
_REACH: Final = 1.0
"""A limit farther from the designs than they scatter, times this, would squeeze them."""
_WIDTH: Final = 104
"""Characters of a line of the title."""


def plot_robustness(found: Robustness, name: str) -> Figure:
    """Draw the distribution of each watched number, with its limits and worst cases.

    Args:
        found: Result of `robustness`.
        name: Name of the study, for the title.
    """
    with matplotlib.style.context(STYLE, after_reset=True):
        count = len(found.values)
        columns = min(count, 2)
        rows = -(-count // columns)
        figure = new_figure(180, 30 + 58 * rows)
        grid = figure.subplots(rows, columns, squeeze=False)
        for axes, number in zip(grid.flat, found.values, strict=False):
            _draw(axes, found, number)
        for axes in list(grid.flat)[count:]:
            axes.set_axis_off()
        for axes in grid[:, 0]:
            axes.set_ylabel(f"designs of {found.designs:,}".replace(",", " "))
        figure.legend(handles=_key(found), loc="outside lower left", ncols=4)
        title = plain(f"{name}: {_outcome(found)}", _WIDTH)
        lines = filter(None, (title, _left_out(found), ranges(found.ranges.scatter)))
        figure.head("\n".join(lines))
    return figure


def plot_designs(found: Robustness, name: str) -> Figure:
    """Draw the drawn values of each key, of designs that meet and that violate the specification.

    Args:
        found: Result of `robustness`.
        name: Name of the study, for the title.
    """
    with matplotlib.style.context(STYLE, after_reset=True):
        columns = min(len(found.drawn), 3)
        rows = -(-len(found.drawn) // columns)
        figure = new_figure(180, 30 + 45 * rows)
        grid = figure.subplots(rows, columns, squeeze=False)
        bins = min(_BINS // 2, 1 + int(np.sqrt(found.designs)))
        for axes, (key, values) in zip(grid.flat, found.drawn.items(), strict=False):
            drawn = QUANTITY[variable(key)].display_scale * values
            parts = [drawn[found.feasible], drawn[~found.feasible]]
            colors = [PALETTE["curve"], PALETTE["stick"]]
            axes.hist(parts, bins, stacked=True, color=colors, lw=0.0)
            axes.set_xlabel(axis_label(variable(key)))
        for axes in list(grid.flat)[len(found.drawn) :]:
            axes.set_axis_off()
        for axes in grid[:, 0]:
            axes.set_ylabel(f"designs of {found.designs:,}".replace(",", " "))
        handles = [Patch(color=PALETTE["curve"], lw=0.0, label="meets the specification")]
        handles += [Patch(color=PALETTE["stick"], lw=0.0, label="violates the specification")]
        figure.legend(handles=handles, loc="outside lower left", ncols=2)
        figure.head(
            "\n".join(filter(None, (plain(f"{name}: {_outcome(found)}", _WIDTH), _left_out(found))))
        )
    return figure


def _draw(axes: Axes, found: Robustness, number: str) -> None:
    scale = QUANTITY[number].display_scale
    values = scale * found.values[number]
    values = values[np.isfinite(values)]
    constraints = [constraint for constraint, _ in found.shares if constraint.name == number]
    cases = [case for case in found.worst if case.constraint.name == number]
    marks = [scale * found.own[number], *(scale * case.value for case in cases)]
    marks = [mark for mark in marks if np.isfinite(mark)]
    ends = [*marks, *(values[[values.argmin(), values.argmax()]] if values.size else [])]
    low, high = (min(ends), max(ends)) if ends else (0.0, 1.0)
    reach = _REACH * (high - low) or abs(high) or 1.0
    limits = [scale * constraint.limit for constraint in constraints]
    near = [limit for limit in limits if low - reach <= limit <= high + reach]
    low, high = min([low, *near]), max([high, *near])
    room = 0.04 * (high - low or abs(high) or 1.0)
    axes.set_xlim(low - room, high + room)
    if values.size:
        bins = min(_BINS, 1 + int(2.0 * np.sqrt(values.size)))
        edges = np.histogram_bin_edges(values, bins).tolist()
        axes.hist(values, edges, color=PALETTE["curve"], alpha=0.75, lw=0.0)
        for part, style in ((0.05, ":"), (0.5, "-"), (0.95, ":")):
            place = float(np.quantile(values, part))
            axes.axvline(place, color="black", lw=0.7, ls=style, gid="quantile")
    top = axes.get_ylim()[1]
    notes = []
    for constraint, limit in zip(constraints, limits, strict=True):
        if limit not in near:
            notes.append(f"limit {constraint.shown()}: off the axis")
        ends_at = max(limit, high + room) if constraint.at_most else min(limit, low - room)
        tint: dict[str, Any] = {"color": PALETTE["stick"], "alpha": 0.13, "lw": 0.0}
        axes.axvspan(limit, ends_at, **tint, zorder=0, gid="beyond")
        axes.axvline(limit, color=PALETTE["stick"], lw=1.0, gid="limit")
    design: dict[str, Any] = {"color": "black", "ms": 5.0, "clip_on": False, "zorder": 5}
    axes.plot(scale * found.own[number], 0.0, "^", **design, gid="design")
    for case in cases:
        if np.isfinite(case.value):
            axes.plot(
                scale * case.value,
                0.0,
                "X",
                color=PALETTE["stick"],
                mec="white",
                ms=7.0,
                clip_on=False,
                zorder=6,
                gid="worst",
            )
    missing = found.designs - values.size
    if missing:
        notes.append(f"{100.0 * missing / found.designs:.2g} % without")
    if notes:
        axes.annotate(
            "\n".join(notes),
            (1.0, 1.0),
            (-2, -2),
            xycoords="axes fraction",
            textcoords="offset points",
            ha="right",
            va="top",
            fontsize=SMALL,
        )
    axes.set_ylim(0.0, top)
    axes.set_xlabel(axis_label(number))


def _outcome(found: Robustness) -> str:
    """The yield in words."""
    if not found.all_met:
        return "how the designs scatter"
    said = " and ".join(constraint.text().replace("_", " ") for constraint, _ in found.shares)
    share = found.all_met
    return (
        f"{share.text} of the designs have {said} "
        f"(95 % interval {100.0 * share.low:.3f} to {100.0 * share.high:.3f} %)"
    )


def _left_out(found: Robustness) -> str:
    """Return the number of draws without a bar, for designs that cannot exist."""
    if not found.refused:
        return ""
    drawn = counted(found.draws, "draw")
    return f"left out, as contradictory: {100.0 * found.refused / found.draws:.2g} % of {drawn}"


def _key(found: Robustness) -> list[Line2D | Patch]:
    handles: list[Line2D | Patch] = [
        Line2D([], [], color="black", lw=0.7, label="median; 5 and 95 % (dotted)"),
        Line2D([], [], color="black", marker="^", ls="none", ms=5.0, label="the design itself"),
    ]
    if found.shares:
        handles.append(
            Patch(color=PALETTE["stick"], alpha=0.2, lw=0.0, label="beyond the specification")
        )
    if any(np.isfinite(case.value) for case in found.worst):
        handles.append(
            Line2D(
                [],
                [],
                color=PALETTE["stick"],
                marker="X",
                mec="white",
                ls="none",
                ms=7.0,
                label="worst case found",
            )
        )
    return handles
