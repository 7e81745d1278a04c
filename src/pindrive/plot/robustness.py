"""How designs scatter within their tolerances, as a picture: histograms, limits, worst cases."""

from __future__ import annotations

from textwrap import fill
from typing import TYPE_CHECKING, Final

import matplotlib.style
import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from pindrive.plot.style import PALETTE, SMALL, STYLE, Figure
from pindrive.quantities.quantity import counted
from pindrive.study.design import variable
from pindrive.study.slices import QUANTITY, axis_label, symbol

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from pindrive.study.robustness import Robustness

_BINS: Final = 80
"""At most: no more than twice the root of the number of draws."""
_WIDTH: Final = 104
"""Characters of a line of the title."""


def plot_robustness(found: Robustness, name: str) -> Figure:
    """Draw the distribution of each watched number, with its limits and worst cases.

    Args:
        found: what `robustness` found.
        name: of the study, for the title.
    """
    with matplotlib.style.context(STYLE, after_reset=True):
        count = len(found.values)
        columns = min(count, 2)
        rows = -(-count // columns)
        size = (180 / 25.4, (30 + 58 * rows) / 25.4)
        figure = Figure(figsize=size, dpi=250, layout="constrained")
        grid = figure.subplots(rows, columns, squeeze=False)
        for axes, number in zip(grid.flat, found.values, strict=False):
            _draw(axes, found, number)
        for axes in list(grid.flat)[count:]:
            axes.set_axis_off()
        for axes in grid[:, 0]:
            axes.set_ylabel(f"designs of {found.designs:,}".replace(",", " "))
        figure.legend(handles=_key(found), loc="outside lower left", ncols=4, frameon=False)
        title = fill(f"{name}: {_outcome(found)}", _WIDTH)
        lines = filter(None, (title, _left_out(found), _scatter(found)))
        figure.suptitle("\n".join(lines), x=0.008, ha="left", fontsize=8.0)
    return figure


def _draw(axes: Axes, found: Robustness, number: str) -> None:
    scale = QUANTITY[number].display_scale
    values = scale * found.values[number]
    values = values[np.isfinite(values)]
    demands = [demand for demand, _ in found.shares if demand.name == number]
    marks = [scale * demand.limit for demand in demands] + [scale * found.own[number]]
    cases = [case for case in found.worst if case.demand.name == number]
    marks += [scale * case.value for case in cases]
    marks = [mark for mark in marks if np.isfinite(mark)]
    ends = [*marks, *(values[[values.argmin(), values.argmax()]] if values.size else [])]
    low, high = (min(ends), max(ends)) if ends else (0.0, 1.0)
    room = 0.04 * (high - low or abs(high) or 1.0)
    axes.set_xlim(low - room, high + room)
    if values.size:
        bins = min(_BINS, 1 + int(2.0 * np.sqrt(values.size)))
        edges = np.histogram_bin_edges(values, bins).tolist()
        axes.hist(values, edges, color=PALETTE["curve"], alpha=0.75, lw=0.0)
        for part, style in ((0.05, ":"), (0.5, "-"), (0.95, ":")):
            axes.axvline(float(np.quantile(values, part)), color="black", lw=0.7, ls=style)
    top = axes.get_ylim()[1]
    for demand in demands:
        limit = scale * demand.limit
        ends_at = high + room if demand.at_most else low - room
        axes.axvspan(limit, ends_at, color=PALETTE["stick"], alpha=0.13, lw=0.0, zorder=0)
        axes.axvline(limit, color=PALETTE["stick"], lw=1.0)
    axes.plot(scale * found.own[number], 0.0, "^", color="black", ms=5.0, clip_on=False, zorder=5)
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
            )
    missing = found.designs - values.size
    if missing:
        share = f"{100.0 * missing / found.designs:.2g} % without"
        axes.annotate(
            share,
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
    axes.tick_params(labelsize=SMALL, width=0.6, length=2.5)


def _outcome(found: Robustness) -> str:
    """The yield in words."""
    if not found.all_met:
        return "how the designs scatter"
    said = " and ".join(demand.text().replace("_", " ") for demand, _ in found.shares)
    share = found.all_met
    return (
        f"{share.text} of the designs have {said} "
        f"(95 % interval {100.0 * share.low:.3f} to {100.0 * share.high:.3f} %)"
    )


def _left_out(found: Robustness) -> str:
    """How many draws are in no bar, as they cannot exist."""
    if not found.refused:
        return ""
    drawn = counted(found.draws, "draw")
    return f"left out, as contradictory: {100.0 * found.refused / found.draws:.2g} % of {drawn}"


def _scatter(found: Robustness) -> str:
    """What scatters, and how."""
    said = []
    for key, scatter in found.ranges.scatter.items():
        quantity = QUANTITY[variable(key)]
        low, high = (f"{quantity.display_scale * x:.3g}" for x in scatter.span)
        around = "" if scatter.kind in ("uniform", "loguniform") else " (3σ)"
        said.append(
            f"{symbol(variable(key))} {low} … {high} {quantity.display_unit}".rstrip() + around
        )
    lines = [", ".join(said[i : i + 5]) for i in range(0, len(said), 5)]
    return ",\n".join(lines)


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
