"""The pictures of a study: maps over two keys, curves over one, slices side by side."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import matplotlib.style
import numpy as np
from matplotlib.colors import ListedColormap, Normalize
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter

from pindrive._core import settling_band
from pindrive.plot.contours import MAP, draw_contours, jump_key, line_colours
from pindrive.plot.style import CURVES, GREY, PALETTE, SMALL, STYLE, Figure, new_figure, plain
from pindrive.study.outputs import MEASURED, is_stepped
from pindrive.study.slices import QUANTITY, Slice, axis_label, value, values, words

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.collections import QuadMesh

    from pindrive.study.runner import Sweep
    from pindrive.study.slices import Panel

_HATCH: Final[dict[str, Any]] = {
    "facecolor": "0.93",
    "edgecolor": "0.55",
    "hatch": "/////",
    "lw": 0.0,
}
_ABSENT: Final[dict[str, Any]] = {**_HATCH, "hatch": "xxx"}
_REFUSED: Final = "0.72"
_LEVELS: Final = 8
_FLAT: Final = 0.25
"""Fraction of a common scale of colours below which a panel has its own scale."""


def plot_study(
    view: Slice, numbers: Sequence[str], x: str, y: str, held: Mapping[str, float]
) -> Figure:
    """Draw numbers of a study: a row for each, slices side by side.

    Args:
        view: The open study.
        numbers: Variables of the file.
        x: The key along the abscissa.
        y: The key along the ordinate; empty for curves.
        held: Values, SI, at which other keys are held.

    Returns:
        A figure 180 mm wide, or 90 mm with a single panel.
    """
    rows = [list(view.panels(number, x, y, held)) for number in numbers]
    with matplotlib.style.context({**STYLE, "hatch.color": "0.55"}, after_reset=True):
        columns = len(rows[0]) if y else 1
        width = 110 if columns == 1 else 180
        each = 58 if not y else 78 if columns == 1 else 62 if columns == 2 else 52
        height = 24 + len(rows) * each
        figure = new_figure(width, height)
        grid = figure.subplots(len(rows), columns, squeeze=False, sharex=True, sharey="row")
        for panels, axes in zip(rows, grid, strict=True):
            if y:
                _draw_maps(figure, panels, list(axes))
            else:
                _draw_curves(panels, axes[0], named=panels is rows[0])
        for axes in grid[-1]:
            axes.set_xlabel(axis_label(x))
        for axes in grid.flat:
            _scale(axes, view, x, y)
        handles = _key([panel for row in rows for panel in row])
        handles += jump_key(figure)
        if handles:
            figure.legend(handles=handles, loc="outside lower left", ncols=len(handles))
        still = {**rows[0][0].at} if columns == 1 and y else _common(rows[0])
        _title(figure, view, {**view.stated, **still}, int(width * 0.66))
    return figure


def plot_sweep(sweep: Sweep) -> Figure:
    """Draw the file of a complete sweep: its usual number over the first two keys that vary."""
    with Slice(sweep.path) as view:
        return plot_study(view, view.usual_numbers(), *view.axes(None, None, {}), {})


def _common(panels: Sequence[Panel]) -> dict[str, float]:
    """Return the values that all panels share."""
    first = panels[0].at
    return {k: v for k, v in first.items() if all(panel.at[k] == v for panel in panels)}


def _title(figure: Figure, view: Slice, fixed: Mapping[str, float], width: int) -> None:
    shown = {
        name: number
        for name, number in fixed.items()
        if (name, number) not in (("plate_load", 1.0), ("settling_band", settling_band))
    }
    name = ": ".join(filter(None, (str(view.data.attrs.get("title", "")), view.page)))
    said = [plain(name, width), values(shown, width), *view.links]
    figure.head("\n".join(filter(None, said)))


def _scale(axes: Axes, view: Slice, x: str, y: str) -> None:
    for key, axis in ((x, "x"), (y, "y")):
        if key and view.data[key].attrs.get("spacing") == "log":
            getattr(axes, f"set_{axis}scale")("log")
            ticks = getattr(axes, f"{axis}axis")
            ticks.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
            ticks.set_major_formatter("{x:g}")
            ticks.set_minor_formatter(NullFormatter())


# ---- maps ----------------------------------------------------------------------------------------


def _draw_maps(figure: Figure, panels: Sequence[Panel], row: Sequence[Axes]) -> None:
    """One number on one scale of colours, or each panel on its own where one would flatten some."""
    name = panels[0].number
    shown = [QUANTITY[name].display_scale * panel.values for panel in panels]
    every = [*zip(panels, shown, row, strict=True)]
    common = _common(panels)
    for group in [[each] for each in every] if _flattened(shown) else [every]:
        low, high = _ends([values for _, values, _ in group])
        ticks: Any = MaxNLocator(_LEVELS).tick_values(low, high)
        contoured = low < high and panels[0].low is None and not is_stepped(name)
        levels = ticks[(ticks > low) & (ticks < high) & contoured]
        if low == high:  # one colour: the middle
            low, high = low - 0.1 * (abs(low) or 1.0), high + 0.1 * (abs(high) or 1.0)
        norm = Normalize(low, high)
        for panel, values_shown, axes in group:
            drawn = _draw_map(axes, panel, values_shown, norm, levels)
            differs = {k: v for k, v in panel.at.items() if k not in common}
            if differs:
                axes.set_title(", ".join(value(k, v) for k, v in differs.items()), fontsize=SMALL)
        bar = figure.colorbar(
            drawn, ax=[axes for *_, axes in group], pad=0.015, fraction=0.05, aspect=24
        )
        for level, colour in zip(levels, line_colours(levels, norm), strict=True):
            bar.ax.axhline(level, color=colour, lw=0.5)
        if len(levels) > 1:
            bar.set_ticks(levels)
        bar.outline.set_linewidth(0.0)
    said = "median " if name in MEASURED else "median of draws:\n"
    bar.set_label((said if panels[0].low is not None else "") + axis_label(name))
    row[0].set_ylabel(axis_label(panels[0].keys[0]))


def _ends(shown: Sequence[Any]) -> tuple[float, float]:
    """The least and the largest value, 0 and 1 where there is none."""
    finite = np.concatenate([values[np.isfinite(values)] for values in shown])
    return (float(finite.min()), float(finite.max())) if finite.size else (0.0, 1.0)


def _flattened(shown: Sequence[Any]) -> bool:
    """Return True if a varying panel would take a small part of a common scale of colours."""
    low, high = _ends(shown)
    spans = [np.ptp(_ends([values])) for values in shown if np.isfinite(values).any()]
    return any(0.0 < span < _FLAT * (high - low) for span in spans)


def _draw_map(
    axes: Axes,
    panel: Panel,
    shown: Any,
    norm: Normalize,
    levels: Any,
) -> QuadMesh:
    (y, x) = (
        QUANTITY[key].display_scale * along
        for key, along in zip(panel.keys, panel.along, strict=True)
    )
    missing = np.isnan(shown)
    drawn = axes.pcolormesh(x, y, shown, cmap=MAP, norm=norm, shading="nearest", rasterized=True)
    if min(shown.shape) > 1 and (~missing).any() and len(levels):
        draw_contours(axes, x, y, shown, levels, norm)
    axes.patch.set(**_HATCH)
    refused = np.where(panel.refused, 1.0, np.nan)
    if panel.refused.any():
        axes.pcolormesh(
            x,
            y,
            refused,
            cmap=ListedColormap([_REFUSED]),
            shading="nearest",
            rasterized=True,
        )
    if min(shown.shape) > 1:
        _hatch(axes, x, y, panel.unsettled & ~missing, "none", _HATCH["hatch"])
        _hatch(axes, x, y, panel.absent, _ABSENT["facecolor"], _ABSENT["hatch"])
    if (panel.unsettled | panel.absent).any() and min(shown.shape) > 1:
        border = (panel.unsettled | panel.absent | panel.refused).astype(float)
        axes.contour(x, y, border, levels=[0.5], colors="black", linewidths=0.7)
    if panel.met is not None and min(shown.shape) > 1:
        _shade_met(axes, x, y, panel.met >= 0.5)
    return drawn


def _hatch(axes: Axes, x: Any, y: Any, where: Any, colour: str, hatch: str) -> None:
    """Hatches the points that are marked."""
    if where.any():
        axes.contourf(x, y, where, levels=[0.5, 1.5], colors=colour, hatches=[hatch])


def _shade_met(axes: Axes, x: Any, y: Any, met: Any) -> None:
    """Dots where the specification is met, within a line."""
    if met.any():
        inside = axes.contourf(x, y, met * 1.0, levels=[0.5, 1.5], colors="none", hatches=["..."])
        inside.set(gid="met", linewidth=0.0)
    if met.any() and not met.all():
        axes.contour(x, y, met * 1.0, levels=[0.5], colors=PALETTE["stick"], linewidths=1.2)


# ---- curves --------------------------------------------------------------------------------------


def _draw_curves(panels: Sequence[Panel], axes: Axes, named: bool) -> None:
    """One number over x, a curve for each slice; gaps where it does not exist."""
    quantity = QUANTITY[panels[0].number]
    scale = quantity.display_scale
    common = _common(panels)
    for panel, look in zip(panels, CURVES, strict=False):
        colour = look["color"]
        x = QUANTITY[panel.keys[0]].display_scale * panel.along[0]
        differs = {k: v for k, v in panel.at.items() if k not in common}
        label = ", ".join(value(k, v) for k, v in differs.items())
        if panel.low is not None and panel.high is not None:
            band: dict[str, Any] = {"color": colour, "alpha": 0.18, "lw": 0.0}
            axes.fill_between(x, scale * panel.low, scale * panel.high, **band, gid="draws")
        few = len(x) <= 40
        marker = "." if few else ""
        settled = np.where(panel.unsettled, np.nan, scale * panel.values)
        axes.plot(x, settled, **look, label=label, marker=marker, gid="settled")
        if panel.unsettled.any() and len(panels) > 1:
            loose: dict[str, Any] = {"color": colour, "lw": 0.7, "ls": (0, (1, 1.5)), "zorder": 1}
            axes.plot(x, scale * panel.values, **loose, gid="unsettled")
        if panel.met is not None and (panel.met >= 0.5).any():
            met = np.where(panel.met >= 0.5, scale * panel.values, np.nan)
            wide: dict[str, Any] = {"color": colour, "lw": 5.0, "alpha": 0.3, "zorder": 1}
            axes.plot(x, met, **wide, solid_capstyle="butt", gid="met")
        if len(panels) == 1:
            axes.plot(x, scale * panel.values, color=colour, zorder=1, gid="unsettled")
            _shade_gaps(axes, x, panel)
    axes.margins(x=0.0)
    axes.set_ylabel(axis_label(panels[0].number))
    if named and len(panels) > 1:
        axes.legend(loc="best")


def _shade_gaps(axes: Axes, x: Any, panel: Panel) -> None:
    """Shade points without a settled motion, without the number, or without a motion."""
    edges = np.concatenate([x[:1], 0.5 * (x[1:] + x[:-1]), x[-1:]])
    grey = {"color": _REFUSED, "lw": 0.0}
    for where, look in (
        (panel.unsettled, _HATCH),
        (panel.absent, _ABSENT),
        (panel.refused, grey),
    ):
        for i in np.flatnonzero(where):
            axes.axvspan(edges[i], edges[i + 1], **look, zorder=0)


def _key(panels: Sequence[Panel]) -> list[Artist]:
    """Draw the legend of the occurring grey areas and bands."""
    handles: list[Artist] = []
    maps = len(panels[0].keys) == 2
    median = panels[0].low is not None
    motions = panels[0].number in MEASURED
    marked = maps or len(panels) == len({panel.number for panel in panels})
    most = " by most draws" if median else ""
    if marked and any(panel.unsettled.any() for panel in panels):
        handles.append(Patch(**_HATCH, label=f"not settled{most} in the time followed"))
    lacking = dict.fromkeys(words(panel.number) for panel in panels if panel.absent.any())
    if marked and lacking:
        handles.append(Patch(**_ABSENT, label=f"has no {' or '.join(lacking)}{most}"))
    if marked and any(panel.refused.any() for panel in panels):
        what = "motion" if motions else "scan"
        handles.append(Patch(color=_REFUSED, label=f"no {what}: contradictory values"))
    if not marked and any((p.unsettled & ~np.isnan(p.values)).any() for p in panels):
        handles.append(Line2D([], [], color=GREY, lw=0.7, ls=":", label="not settled"))
    if any(panel.met is not None and (panel.met >= 0.5).any() for panel in panels):
        met = f"the specification is met{most}"
        look: dict[str, Any] = {"facecolor": "white", "edgecolor": PALETTE["stick"], "hatch": "..."}
        band = Line2D([], [], color=GREY, lw=5.0, alpha=0.3, label=met)
        handles.append(Patch(**look, label=met) if maps else band)
    if median and not maps:
        handles.append(Line2D([], [], color=GREY, label="median"))
        handles.append(
            Patch(color=PALETTE["curve"], alpha=0.18, lw=0.0, label="5 % to 95 % of draws")
        )
    return handles
