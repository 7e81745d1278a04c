"""The figure of a friction curve: measured forces, its rows, and AICc over their number."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from pindrive.lazy import matplotlib
from pindrive.plot.style import GREY, PALETTE, STYLE, Figure

if TYPE_CHECKING:
    from pindrive.fitting.friction_curve import FrictionCurve


def plot_friction_curve(found: FrictionCurve) -> Figure:
    """Force over speed on the left, the criterion over the number of rows on the right."""
    with matplotlib.style.context(STYLE, after_reset=True):
        figure = Figure(figsize=(180 / 25.4, 75 / 25.4), layout="constrained")
        axes, beside = figure.subplots(1, 2, width_ratios=(1.8, 1.0))
        speed, force = np.array(found.rows).T
        dots = {"marker": ".", "ms": 2.0, "ls": "none", "color": GREY, "rasterized": True}
        axes.plot(1e3 * found.speed, 1e3 * found.force, **dots, label="measured", gid="measured")
        look = {"color": PALETTE["curve"], "marker": "o", "mfc": "white"}
        errors = 1e3 * np.array(found.standard_errors)
        axes.plot(1e3 * speed, 1e3 * force, **look, label="curve and its rows", gid="curve")
        axes.errorbar(1e3 * speed, 1e3 * force, 1.96 * errors, fmt="none", color=PALETTE["curve"])
        axes.set(xlabel="sliding speed (mm/s)", ylabel="friction force (mN)")
        axes.legend(frameon=False)
        counts = [*found.aicc]
        excess = np.array([*found.aicc.values()]) - min(found.aicc.values())
        beside.plot(counts, excess, **look, gid="aicc")
        beside.set_yscale("symlog", linthresh=10.0)
        beside.set(xlabel="rows", ylabel="AICc above the least")
        beside.set_xticks(counts)
    return figure
