"""Elasticities as a table of colours: numbers down, keys across."""

from __future__ import annotations

from typing import TYPE_CHECKING

import matplotlib.style
import numpy as np

from pindrive.plot.sensitivity import draw_elasticities
from pindrive.plot.style import SMALL, STYLE, Figure
from pindrive.study.design import variable
from pindrive.study.slices import symbol, words

if TYPE_CHECKING:
    from pindrive.study.local_sensitivity import Elasticities


def plot_elasticities(found: Elasticities) -> Figure:
    """Draw the elasticity of each number that has one, to each key.

    Args:
        found: what `local_sensitivity` found.

    Returns:
        A figure that belongs to nobody else.
    """
    numbers = [n for n, row in found.table.items() if not np.isnan([*row.values()]).all()]
    with matplotlib.style.context(STYLE, after_reset=True):
        size = (45 + 14 * len(found.keys)) / 25.4, (26 + 5.6 * max(1, len(numbers))) / 25.4
        figure = Figure(figsize=size, dpi=250, layout="constrained")
        axes = figure.subplots()
        axes.tick_params(labelsize=SMALL, length=0.0, labeltop=True, labelbottom=False)
        axes.spines[["left", "bottom"]].set_visible(False)
        if numbers:
            draw_elasticities(axes, found, numbers)
        axes.set_title("% of change for 1 % more of", fontsize=8.0)
        axes.set_xlim(-0.5, len(found.keys) - 0.5)
        axes.set_ylim(len(numbers) - 0.5, -0.5)
        axes.set_yticks(range(len(numbers)), [words(n) for n in numbers])
        axes.set_xticks(range(len(found.keys)), [symbol(variable(key)) for key in found.keys])
        title = f"{found.name}: elasticities" if found.name else "Elasticities"
        figure.suptitle(title, x=0.008, ha="left", fontsize=8.0)
    return figure
