"""The figures of fits: recordings with what was fitted, profiles; a friction curve."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from pindrive.fitting.recording import display_of
from pindrive.fitting.results import PLACE_UNITS
from pindrive.lazy import matplotlib
from pindrive.plot.style import (
    GREY,
    MM,
    PALETTE,
    SMALL,
    STYLE,
    Figure,
    event_marker,
    event_name,
    new_figure,
    plain,
)
from pindrive.quantities.quantity import significant

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from pindrive.fitting.friction_curve import FrictionCurve
    from pindrive.fitting.results import Estimate, Fit, ModelComparison

    Array = NDArray[np.float64]

BLOCKS: Final = 4
"""Channels that are drawn, of the first recordings."""
DOTS: Final = 1500
"""Samples that are drawn of each."""
ACROSS: Final = 1.96
"""Standard errors on either side of the fit in its band."""
LEGEND: Final = 0.35
"""Part of the height of the first panel that is added for the legend."""
SYMBOLS: Final = {"position": "x", "velocity": "x'", "acceleration": "x''", "force": "F"}
CURVE: Final = PALETTE["curve"]


def plot_fit(found: Fit) -> Figure:
    """Draw a fit.

    On the left each channel over time, with the fit, its 95 % band and the events, and its
    residuals below; on the right the profile of each parameter, with its interval. Where residuals
    keep a structure, their means over time, speed and position follow.
    """
    blocks = found.model.blocks[:BLOCKS]
    estimates = found.estimates
    with matplotlib.style.context(STYLE, after_reset=True):
        structured = [i for i, left in enumerate(found.residuals) if left.structured][:1]
        places = [(i, over) for i in structured for over in PLACE_UNITS]
        rows = -(-(len(estimates) + len(places)) // 2)
        height = min(240.0, 30.0 + max(62.0 * len(blocks), 36.0 * rows))
        figure = new_figure(180, height)
        halves: Any = figure.subfigures(1, 2, width_ratios=(1.15, 1.0))
        left, right = halves
        _draw_blocks(left, found)
        panels = right.subplots(rows, 2, squeeze=False).ravel()
        for axes, estimate in zip(panels, estimates, strict=False):
            _profile(axes, estimate, found.threshold)
        others = panels[len(estimates) :]
        for axes, (i, over) in zip(others, places, strict=False):
            _place(axes, found, i, over)
        for axes in others[len(places) :]:
            axes.set_axis_off()
        right.supylabel("increase of the cost", fontsize=8.0)
        shown = len(blocks) < len(found.model.blocks)
        more = f", {len(blocks)} of {len(found.model.blocks)} channels" if shown else ""
        names = ", ".join(dict.fromkeys(each.name for each in found.recordings[:3]))
        figure.suptitle(plain(f"Fit to {names}{more}"), fontsize=9.0)
    return figure


def _draw_blocks(left: Any, found: Fit) -> None:
    blocks = found.model.blocks[:BLOCKS]
    ratios = [ratio for _ in blocks for ratio in (2.4, 1.0)]
    panels = left.subplots(2 * len(blocks), 1, height_ratios=ratios, squeeze=False)[:, 0]
    for i, block in enumerate(blocks):
        axes, below = panels[2 * i : 2 * i + 2]
        below.sharex(axes)
        axes.tick_params(labelbottom=False)
        recording = found.recordings[block.recording]
        unit, scale = display_of(block.channel)
        times = 1e3 * block.times
        data = scale * found.model.data[block.place]
        values, spread = (scale * part for part in found.predicted(block.recording, block.channel))
        step = max(1, len(times) // DOTS)
        dots = {"marker": ".", "ms": 1.5, "ls": "none", "color": GREY, "rasterized": True}
        axes.plot(times[::step], data[::step], **dots, label="recorded", gid="recorded")
        axes.plot(times, values, color=CURVE, label="fit", gid="fit")
        band = {"color": CURVE, "alpha": 0.25, "lw": 0.0}
        low, high = values - ACROSS * spread, values + ACROSS * spread
        axes.fill_between(times, low, high, **band, label="95 % band of the fit", gid="band")
        if block.channel in ("position", "velocity"):
            _events(axes, found, i, scale)
        several = len(found.recordings) > 1
        symbol = f"${SYMBOLS[block.channel]}$" if block.channel in SYMBOLS else block.channel
        axes.set_ylabel(f"{symbol} ({unit})" if unit else symbol)
        if several:
            axes.set_title(plain(recording.name), fontsize=SMALL, loc="left")
        below.plot(times[::step], (data - values)[::step], **dots, gid="residuals")
        below.axhline(0.0, color=CURVE, lw=0.8)
        left_over = found.residuals[i]
        sigma = scale * left_over.noise
        for way in (-1.0, 1.0):
            below.axhline(way * ACROSS * sigma, color=GREY, lw=0.6, ls="--", gid="noise")
        words = f"noise {significant(sigma, 3)} {unit}"
        words += ", structured" if left_over.structured else ", no structure found"
        below.set_title(words, fontsize=SMALL, loc="left", pad=2.0)
        below.set_ylabel(f"rest ({unit})")
        below.ticklabel_format(axis="y", style="plain")
        if i == 0:
            low, high = axes.get_ylim()
            axes.set_ylim(low, high + LEGEND * (high - low))
            axes.legend(frameon=False, ncols=2, loc="upper right", handlelength=1.2)
    panels[-1].set_xlabel("$t$ (ms)")


def _events(axes: Axes, found: Fit, i: int, scale: float) -> None:
    """The events of the fitted motion within a recording, as its sensor has them."""
    block = found.model.blocks[i]
    motion = found.motions[block.recording]
    shift = found.model.offset(found.theta, block.recording)
    places, columns = found.model.added(i)
    times, sensor = block.times, columns @ found.theta[places]
    marked = set()
    for event in motion.events_between(0.0, motion.duration):
        value = event.position if block.channel == "position" else event.velocity
        added = np.interp(event.time + shift, times, sensor)
        kind = event.kind, event.contact
        label = None if kind in marked else event_name(*kind)
        marked.add(kind)
        look = event_marker(*kind)
        axes.plot(1e3 * (event.time + shift), scale * (value + added), label=label, **look)


def _place(axes: Axes, found: Fit, i: int, over: str) -> None:
    """The mean residuals of a channel in parts of a quantity, in standard errors."""
    unit, scale = PLACE_UNITS[over]
    edges, means = found.rest_over(i)[over]
    axes.axhline(0.0, color=GREY, lw=0.6)
    for way in (-1.0, 1.0):
        axes.axhline(way * ACROSS, color=GREY, lw=0.6, ls="--")
    if len(means):
        axes.stairs(means, scale * edges, color=CURVE, gid=f"rest over {over}")
    axes.set_xlabel(f"{over} ({unit})")
    axes.set_title("mean rest / its error", fontsize=SMALL, loc="left", pad=2.0)


def _profile(axes: Axes, estimate: Estimate, threshold: float) -> None:
    """The profile of one parameter, with its interval and the bound of the excess."""
    unit, scale = estimate.parameter.scale
    axes.set_xlabel(f"{estimate.name.replace('_', ' ')}" + (f" ({unit})" if unit else ""))
    axes.axhline(threshold, color=GREY, lw=0.6, ls="--", gid="threshold")
    axes.set_ylim(0.0, 1.6 * threshold)
    axes.ticklabel_format(axis="x", style="plain")
    axes.locator_params(axis="x", nbins=3, min_n_ticks=2)
    profile = estimate.profile
    if profile is None:
        axes.text(
            0.5,
            0.5,
            str(estimate.identifiability).replace("not", "not\nidentifiable")
            if estimate.explanation
            else "no profile",
            ha="center",
            va="center",
            transform=axes.transAxes,
            fontsize=SMALL,
        )
        axes.axvline(scale * estimate.value, color=CURVE, lw=0.8, gid="value")
        return
    inside = profile.excess <= 2.0 * threshold
    look: dict[str, Any] = {"color": CURVE, "marker": ".", "ms": 3.0}
    axes.plot(scale * profile.values[inside], profile.excess[inside], **look, gid="profile")
    ends = [
        scale * (end if isfinite(end) else bound)
        for end, bound in zip(
            estimate.interval, (profile.values[0], profile.values[-1]), strict=True
        )
    ]
    axes.axvspan(*ends, color=CURVE, alpha=0.12, lw=0.0, gid="interval")
    axes.axvline(scale * estimate.value, color=CURVE, lw=0.8, gid="value")
    open_ = [
        side
        for side, end in zip(("below", "above"), estimate.interval, strict=True)
        if not isfinite(end)
    ]
    if open_:
        words = f"open {' and '.join(open_)}"
        axes.text(0.97, 0.95, words, ha="right", va="top", transform=axes.transAxes, fontsize=SMALL)
    margin = 0.25 * (ends[1] - ends[0])
    axes.set_xlim(ends[0] - margin, ends[1] + margin)


def plot_comparison(compared: ModelComparison) -> Figure:
    """The residuals of each law over time, with its excess of AICc."""
    fits = compared.fits
    with matplotlib.style.context(STYLE, after_reset=True):
        figure = new_figure(180, 20.0 + 30.0 * len(fits))
        panels = figure.subplots(len(fits), 1, sharex=True, sharey=True, squeeze=False)[:, 0]
        for axes, (law, found) in zip(panels, fits.items(), strict=True):
            block = found.model.blocks[0]
            unit, scale = display_of(block.channel)
            values, _ = found.predicted(block.recording, block.channel)
            off = scale * (found.model.data[block.place] - values)
            times = 1e3 * block.times
            axes.axhline(0.0, color=GREY, lw=0.6)
            axes.plot(times, off, ".", ms=1.5, color=CURVE, rasterized=True, gid="residuals")
            words = f"{law}: AICc {compared.excess[law]:+.1f}, {len(found.theta)} parameters"
            axes.set_title(words, fontsize=SMALL, loc="left")
            axes.set_ylabel(f"rest ({unit})")
        panels[-1].set_xlabel("$t$ (ms)")
    return figure


def plot_friction_curve(found: FrictionCurve) -> Figure:
    """Force over speed on the left, the criterion over the number of rows on the right."""
    with matplotlib.style.context(STYLE, after_reset=True):
        figure = new_figure(180, 75)
        axes, beside = figure.subplots(1, 2, width_ratios=(1.8, 1.0))
        speed, force = np.array(found.rows).T
        dots = {"marker": ".", "ms": 2.0, "ls": "none", "color": GREY, "rasterized": True}
        axes.plot(MM * found.speed, 1e3 * found.force, **dots, label="measured", gid="measured")
        look = {"color": PALETTE["curve"], "marker": "o", "mfc": "white"}
        errors = 1e3 * np.array(found.standard_errors)
        axes.plot(MM * speed, 1e3 * force, **look, label="curve and its rows", gid="curve")
        if len(speed) == 1:
            axes.axhline(1e3 * force[0], color=PALETTE["curve"], lw=1.0)
        if found.best != "table":
            law = found.laws[found.best]
            at = np.linspace(0.0, float(found.speed[-1]), 300)
            axes.plot(MM * at, 1e3 * law(at), color=PALETTE["stick"], label=law.name, gid="law")
        axes.errorbar(MM * speed, 1e3 * force, 1.96 * errors, fmt="none", color=PALETTE["curve"])
        for way, branch in zip((1.0, -1.0), found.branches.items(), strict=False):
            name, above = branch
            look_of = {"color": PALETTE["curve"], "ls": ":" if way > 0 else "-."}
            along = np.append(speed, found.speed.max())  # a curve of one row is a level
            level = np.interp(along, speed, force) + above
            axes.plot(MM * along, 1e3 * level, **look_of, label=name, gid="branch")
        axes.set(xlabel="sliding speed (mm/s)", ylabel="friction force (mN)")
        slope, error = found.slope
        words = f"R² {found.r_squared:.2f}, {found.effective_size:.0f} independent samples"
        if len(speed) > 1:
            words += f", slope beyond {slope:.2g} ± {error:.1g} N*s/m"
        axes.set_title(words, fontsize=SMALL, loc="left")
        axes.legend(frameon=False)
        counts = [*found.aicc]
        excess = np.array([*found.aicc.values()]) - min(found.aicc.values())
        beside.plot(counts, excess, **look, gid="aicc")
        beside.set_yscale("symlog", linthresh=10.0)
        beside.set(xlabel="rows", ylabel="AICc above the least")
        beside.set_xticks(counts)
    return figure
