"""The figure of a motion's derivatives: how far each parameter moves the pin, over time."""

from __future__ import annotations

from itertools import cycle
from typing import TYPE_CHECKING

import numpy as np

from pindrive.lazy import matplotlib
from pindrive.plot.style import CURVES, GREY, STYLE, Figure

if TYPE_CHECKING:
    from pindrive.motion.sensitivity import Sensitivity

_SAMPLES = 2000


def plot_motion_sensitivity(found: Sensitivity) -> Figure:
    """Each parameter's size times the derivative of the position, mm, over time, ms.

    A curve is how far the pin would move at a time if the parameter grew by its own size, to first
    order; it ends where the derivative does.
    """
    times = np.linspace(0.0, found.duration, _SAMPLES)
    slopes = found.position(times)
    with matplotlib.style.context(STYLE, after_reset=True):
        figure = Figure(figsize=(180 / 25.4, 85 / 25.4), dpi=250, layout="constrained")
        axes = figure.add_subplot()
        axes.axhline(0.0, color=GREY, lw=0.6)
        named = zip(found.parameters, found.sizes, slopes, strict=True)
        for (name, size, slope), look in zip(named, cycle(CURVES), strict=False):
            axes.plot(1e3 * times, 1e3 * size * slope, label=name, **look)
        axes.set_xlabel("time after release (ms)")
        axes.set_ylabel(r"$p\,\partial x/\partial p$ (mm)")
        axes.set_title(
            "How far each parameter $p$ moves the pin, for a change by its own size",
            loc="left",
            fontsize=8.0,
        )
        axes.margins(x=0.0)
        axes.legend(frameon=False, ncols=2)
    return figure
