"""Figures of sensitivity: Sobol' indices and elasticities, and derivatives over time."""

from __future__ import annotations

from itertools import cycle
from typing import TYPE_CHECKING, Any, Final

import matplotlib.style
import numpy as np
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from pindrive.files.keys import variable
from pindrive.lazy import matplotlib
from pindrive.plot.style import CURVES, GREY, PALETTE, SMALL, STYLE, Figure, new_figure, plain
from pindrive.study.slices import elasticity, ranges, symbol, words

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes

    from pindrive.motion.sensitivity import Sensitivity
    from pindrive.study.local_sensitivity import Elasticities
    from pindrive.study.sensitivity import SobolIndices


_SIGNED: Final = LinearSegmentedColormap.from_list(
    "signed", [PALETTE["stick"], "#F6C6A8", "white", "#A9CFE8", PALETTE["curve"]]
)
_FIRST: Final = PALETTE["curve"]
_TOTAL: Final = "#A9CFE8"
_FULL: Final = 2.0
"""The elasticity at which the colour is full."""
_BAR: Final = 0.84
"""Width of a whole variance, as a fraction of a column."""
_LONGEST: Final = 1.15
"""Longest bar, in whole variances: an estimate above 1 is drawn up to the next column."""
_WIDTH: Final = 104
"""Characters of a line of the title."""
_FEW: Final = 8
"""Largest number of columns with a label at the half of each scale."""
MINUS: Final = "\N{MINUS SIGN}"


def plot_sobol_indices(found: SobolIndices, name: str) -> Figure:
    """Draw elasticities as a table of colours, and Sobol' indices as bars beside them.

    Args:
        found: Result of `sobol`.
        name: Name of the study, for the title.
    """
    numbers = [
        n
        for n, indices in found.over.items()
        if n != "transient_settled" and (indices.spread > 0.0 or _known(found, n))
    ]
    with matplotlib.style.context(STYLE, after_reset=True):
        height = 38 + 5.6 * len(numbers)
        figure = new_figure(180, height)
        if found.near:
            near, over = figure.subplots(1, 2, sharey=True, width_ratios=(1.0, 1.25))
            draw_elasticities(near, found.near, numbers)
        else:
            near = over = figure.subplots()
        _draw_over(over, found, numbers)
        near.set_yticks(range(len(numbers)), [words(n) for n in numbers])
        near.set_ylim(len(numbers) - 0.5, -0.5)
        for axes in {near, over}:
            ticks = [symbol(variable(key)) or words(variable(key)) for key in found.keys]
            axes.set_xticks(range(len(found.keys)), ticks)
            axes.set_xlim(-0.5, len(found.keys) - 0.5)
            axes.tick_params(labelsize=SMALL, length=0.0, labeltop=True, labelbottom=False)
            axes.spines[["left", "bottom"]].set_visible(False)
        bars: list[Any] = [
            Patch(color=_FIRST, label="by itself"),
            Patch(color=_TOTAL, label="with interactions"),
            Line2D([], [], color="black", lw=0.6, label="95 % interval of the latter"),
        ]
        figure.legend(handles=bars, loc="outside lower right", ncols=3)
        figure.head(
            f"{plain(f'{name}: which parameter matters', _WIDTH)}\n{ranges(found.ranges.scatter)}"
        )
    return figure


def _known(found: SobolIndices, number: str) -> bool:
    near = found.near.table[number] if found.near else {}
    return any(not np.isnan(x) for x in near.values())


def draw_elasticities(axes: Axes, near: Elasticities, numbers: Sequence[str]) -> None:
    """Elasticities: blue where a number grows with the key, red where it falls."""
    values = np.array([[near.table[n][key] for key in near.keys] for n in numbers])
    strength = np.sign(values) * np.sqrt(np.abs(values) / _FULL)
    axes.imshow(strength, cmap=_SIGNED, vmin=-1.0, vmax=1.0, aspect="auto")
    for edge in range(1, max(values.shape)):
        axes.axhline(edge - 0.5, color="white", lw=1.0)
        axes.axvline(edge - 0.5, color="white", lw=1.0)
    for (row, column), value in np.ndenumerate(values):
        text = elasticity(value)
        dark = abs(value) > 1.2
        axes.text(
            column,
            row,
            text.replace("-", MINUS),
            ha="center",
            va="center",
            fontsize=5.8,
            color="white" if dark else "0.55" if text in ("-", "·") else "black",
        )
    axes.set_title("near: % of change for 1 % more of")
    signs = f"blue: it grows, orange: it falls\n·: below 0.005, {MINUS}: none"
    axes.set_xlabel(signs, fontsize=SMALL, color=GREY)


def _draw_over(axes: Axes, found: SobolIndices, numbers: Sequence[str]) -> None:
    """Sobol' indices: a bar for each key, as long as its column where it explains everything."""
    for column in range(len(found.keys)):
        left = column - 0.5 * _BAR
        axes.axvline(left, color="0.8", lw=0.5, zorder=0)
        for part in (0.5, 1.0):
            axes.axvline(left + part * _BAR, color="0.8", lw=0.5, ls=":", zorder=0)
        for row, number in enumerate(numbers):
            first, total = found.over[number].first, found.over[number].total
            if np.isnan(total.value[column]):
                continue
            for interval, colour, thick in ((total, _TOTAL, 0.62), (first, _FIRST, 0.3)):
                length = _BAR * float(np.clip(interval.value[column], 0.0, _LONGEST))
                axes.barh(row, length, thick, left=left, color=colour, lw=0.0)
            ends = np.clip([total.low[column], total.high[column]], 0.0, _LONGEST)
            axes.hlines(row, *(left + _BAR * ends), color="black", lw=0.6, gid="interval")
    for row, number in enumerate(numbers):
        if not found.over[number].spread > 0.0:
            words_for = "constant" if found.over[number].spread == 0.0 else "does not exist"
            axes.text(-0.4, row, words_for, va="center", fontsize=5.8, color="0.55")
    axes.set_title("over the ranges: part of the variance due to")
    parts = {0.0: "0", 0.5: "½", 1.0: "1"} if len(found.keys) <= _FEW else {0.0: "0", 1.0: "1"}
    scale = axes.secondary_xaxis("bottom")
    scale.set_label("scale")
    columns = range(len(found.keys))
    scale.set_xticks(
        [column + _BAR * (part - 0.5) for column in columns for part in parts],
        [label for _ in columns for label in parts.values()],
    )
    scale.tick_params(labelsize=5.8, length=2.0, width=0.5)
    scale.spines["bottom"].set_visible(False)


def plot_elasticities(found: Elasticities) -> Figure:
    """Draw the elasticity of each number that has one, to each key.

    Args:
        found: Result of `local_sensitivity`.

    Returns:
        A figure that belongs to nobody else.
    """
    numbers = [n for n, row in found.table.items() if not np.isnan([*row.values()]).all()]
    with matplotlib.style.context(STYLE, after_reset=True):
        figure = new_figure(45 + 14 * len(found.keys), 26 + 5.6 * max(1, len(numbers)))
        axes = figure.subplots()
        axes.tick_params(labelsize=SMALL, length=0.0, labeltop=True, labelbottom=False)
        axes.spines[["left", "bottom"]].set_visible(False)
        if numbers:
            draw_elasticities(axes, found, numbers)
        axes.set_title("% of change for 1 % more of")
        axes.set_xlim(-0.5, len(found.keys) - 0.5)
        axes.set_ylim(len(numbers) - 0.5, -0.5)
        axes.set_yticks(range(len(numbers)), [words(n) for n in numbers])
        axes.set_xticks(range(len(found.keys)), [symbol(variable(key)) for key in found.keys])
        title = f"{found.name}: elasticities" if found.name else "Elasticities"
        figure.head(title)
    return figure


_SAMPLES = 2000


def plot_motion_sensitivity(found: Sensitivity) -> Figure:
    """Each parameter's size times the derivative of the position, mm, over time, ms.

    A curve is how far the pin would move at a time if the parameter grew by its own size, to first
    order; it ends where the derivative does.
    """
    times = np.linspace(0.0, found.duration, _SAMPLES)
    slopes = found.position(times)
    with matplotlib.style.context(STYLE, after_reset=True):
        figure = new_figure(180, 85)
        axes = figure.add_subplot()
        axes.axhline(0.0, color=GREY, lw=0.6)
        named = zip(found.parameters, found.sizes, slopes, strict=True)
        for (name, size, slope), look in zip(named, cycle(CURVES), strict=False):
            axes.plot(1e3 * times, 1e3 * size * slope, label=name, **look)
        axes.set_xlabel("time (ms)")
        axes.set_ylabel(r"$p\,\partial x/\partial p$ (mm)")
        axes.set_title(
            "How far each parameter $p$ moves the pin, for a change by its own size",
            loc="left",
        )
        axes.margins(x=0.0)
        axes.legend(ncols=2)
    return figure
