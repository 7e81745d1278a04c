"""The figure of a motion's derivatives: how far each parameter moves the pin, over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from pindrive.lazy import matplotlib
from pindrive.plot.style import GREY, STYLE, Figure

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
        figure = Figure(figsize=(180 / 25.4, 85 / 25.4), layout="constrained")
        axes = figure.add_subplot()
        axes.axhline(0.0, color=GREY, lw=0.6)
        for name, size, slope in zip(found.parameters, found.sizes, slopes, strict=True):
            axes.plot(1e3 * times, 1e3 * size * slope, label=name)
        axes.set_xlabel("$t$ (ms)")
        axes.set_ylabel(r"$p\,\partial x/\partial p$ (mm)")
        axes.margins(x=0.0)
        axes.legend(frameon=False, ncols=2)
    return figure
