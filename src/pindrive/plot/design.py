"""The figure of a design: the front, and maps of the feasible region around it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np
from matplotlib.colors import ListedColormap, Normalize
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import LogLocator, NullFormatter

from pindrive.files.keys import variable
from pindrive.lazy import matplotlib
from pindrive.plot.contours import MAP
from pindrive.plot.style import PALETTE, SMALL, STYLE, Figure, new_figure, plain
from pindrive.study.slices import QUANTITY, axis_label

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

    from pindrive.optimisation.results import Design, Map

_COLUMNS: Final = 3
_UNMET: Final = "0.80"
_CHOSEN: Final[dict[str, Any]] = {
    "marker": "*",
    "ms": 10.0,
    "color": PALETTE["stick"],
    "mec": "white",
    "mew": 0.6,
    "ls": "none",
    "clip_on": False,
    "zorder": 6,
    "gid": "design",
}
_WIDTH: Final = 104
"""Characters of a line of the title."""


def plot_design(found: Design) -> Figure:
    """Draw a design among others.

    The front, with two or three goals, the first goal along the abscissa; then the first goal over
    pairs of variables, grey where a constraint is not met.

    Args:
        found: Result of `optimise`.
    """
    fronts = range(1, len(found.goals)) if found.front else range(0)
    count = len(fronts) + len(found.maps)
    with matplotlib.style.context({**STYLE, "hatch.color": "0.6"}, after_reset=True):
        columns = 2 if count == 4 else min(_COLUMNS, max(count, 1))
        rows = max(1, -(-count // columns))
        figure = new_figure({1: 110, 2: 150}.get(columns, 180), 32 + 56 * rows)
        panels = figure.subplots(rows, columns, squeeze=False).ravel()
        for axes, other in zip(panels, fronts, strict=False):
            _draw_front(axes, found, other)
        for axes, drawn in zip(panels[len(fronts) :], found.maps, strict=False):
            _draw_map(figure, axes, found, drawn)
        for axes in panels[count:]:
            axes.set_axis_off()
        figure.legend(handles=_key(found), loc="outside lower left", ncols=4 if columns > 2 else 2)
        name = found.problem.study.name or found.device.name
        title = plain(f"{name}: {_outcome(found)}", _WIDTH if columns > 2 else 2 * _WIDTH // 3)
        figure.head(title + ("\nmaps: other values as in the design" if found.maps else ""))
    return figure


def _outcome(found: Design) -> str:
    """The goals of the design in words."""
    if not found.feasible:
        return f"no design meets this; {found.closest.replace('_', ' ')}"
    return ", ".join(
        f"{reached.goal.text()}: {QUANTITY[reached.goal.name].text(reached.value)}".replace(
            "_", " "
        )
        for reached in found.goals
    )


def _draw_front(axes: Axes, found: Design, other: int) -> None:
    assert found.front
    names = [found.goals[i].goal.name for i in (0, other)]
    scales = [QUANTITY[name].display_scale for name in names]
    x, y = (scale * found.front.goals[:, i] for scale, i in zip(scales, (0, other), strict=True))
    look: dict[str, Any] = {"color": PALETTE["curve"], "ms": 4.0, "gid": "front"}
    axes.plot(x, y, "o", **look)
    axes.plot(x[found.front.chosen], y[found.front.chosen], **_CHOSEN)
    axes.set_xlabel(axis_label(names[0]))
    axes.set_ylabel(axis_label(names[1]))


def _draw_map(figure: Figure, axes: Axes, found: Design, drawn: Map) -> None:
    goal = found.goals[0].goal.name
    names = [variable(key) for key in drawn.keys]
    x, y = (
        QUANTITY[name].display_scale * along for name, along in zip(names, drawn.along, strict=True)
    )
    values = QUANTITY[goal].display_scale * drawn.goal
    finite = values[np.isfinite(values)]
    low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 1.0)
    if low == high:
        low, high = low - 0.1 * (abs(low) or 1.0), high + 0.1 * (abs(high) or 1.0)
    look: dict[str, Any] = {"shading": "nearest", "rasterized": True}
    mesh = axes.pcolormesh(x, y, values, cmap=MAP, norm=Normalize(low, high), **look, gid="goal")
    unmet = np.where(drawn.met, np.nan, 1.0)
    if not drawn.met.all():
        grey = ListedColormap([_UNMET])
        axes.pcolormesh(x, y, unmet, cmap=grey, alpha=0.85, **look, gid="unmet")
    if drawn.met.any() and not drawn.met.all() and min(drawn.met.shape) > 1:
        border: dict[str, Any] = {"levels": [0.5], "colors": "black", "linewidths": 0.7}
        axes.contour(x, y, drawn.met.astype(float), **border)
    at = [QUANTITY[name].display_scale * v for name, v in zip(names, drawn.design, strict=True)]
    axes.plot(*at, **_CHOSEN)
    for name, axis, along in zip(names, "xy", (x, y), strict=True):
        ratios = along[-1] / along[0] if along[0] > 0.0 else 1.0
        even = np.allclose(np.diff(along), along[1] - along[0]) if len(along) > 1 else True
        if ratios > 5.0 and not even:
            getattr(axes, f"set_{axis}scale")("log")
            ticks = getattr(axes, f"{axis}axis")
            ticks.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
            ticks.set_major_formatter("{x:g}")
            ticks.set_minor_formatter(NullFormatter())
        getattr(axes, f"set_{axis}label")(axis_label(name))
    bar = figure.colorbar(mesh, ax=axes, pad=0.02, fraction=0.06, aspect=20)
    bar.set_label(axis_label(goal))
    bar.outline.set_linewidth(0.0)
    if found.constraints:
        axes.set_title(
            f"constraints met in {100.0 * drawn.share:.3g} %", fontsize=SMALL, loc="left"
        )


def _key(found: Design) -> list[Artist]:
    words = "the design" if found.feasible else "the closest design"
    star = {k: v for k, v in _CHOSEN.items() if k not in ("clip_on", "gid", "zorder")}
    handles: list[Artist] = [Line2D([], [], **star, label=words)]
    if found.front:
        look: dict[str, Any] = {"marker": "o", "ls": "none", "ms": 4.0, "color": PALETTE["curve"]}
        handles.append(Line2D([], [], **look, label="no other is better in all goals"))
    if any(not drawn.met.all() for drawn in found.maps):
        handles.append(Patch(color=_UNMET, label="a constraint is not met"))
        handles.append(Line2D([], [], color="black", lw=0.7, label="border of the constraints"))
    return handles
