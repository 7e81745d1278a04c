"""The picture of a bifurcation diagram: envelope and turning points over a parameter."""

from __future__ import annotations

from math import nan
from typing import TYPE_CHECKING, Any, Final

import matplotlib.style
import numpy as np
from numpy.typing import NDArray

from pindrive.files.keys import NUMERIC_KEYS, variable
from pindrive.plot.style import MM, PALETTE, STYLE, Figure, new_figure, plain
from pindrive.study.slices import words

if TYPE_CHECKING:
    from pindrive.study.bifurcation import Bifurcation

_SIGNS: Final[dict[str, dict[str, Any]]] = {
    "up": {"marker": "^", "color": PALETTE["curve"], "ms": 3.2, "mew": 0.0},
    "down": {"marker": "v", "color": PALETTE["stick"], "ms": 3.8, "mfc": "none", "mew": 0.7},
}


def plot_bifurcation(found: Bifurcation) -> Figure:
    """Draw envelope and turning points of the motions, and their largest multipliers beneath.

    A vertical line marks each end or jump of a branch.

    Args:
        found: Result of `bifurcation`.
    """
    quantity = NUMERIC_KEYS[found.key]
    with matplotlib.style.context(STYLE, after_reset=True):
        figure = new_figure(150, 110)
        axes, beneath = figure.subplots(2, 1, sharex=True, height_ratios=(2.6, 1.0))
        for direction, branch in (("up", found.up), ("down", found.down)):
            places = [
                (motion.value * quantity.display_scale, point * MM)
                for motion in branch
                for point in motion.points
            ]
            look = {"ls": "none", **_SIGNS[direction], "gid": direction}
            axes.plot(*zip(*places, strict=True), **look, label=f"parameter {direction}")
            values = [motion.value * quantity.display_scale for motion in branch]
            line = {"color": look["color"], "lw": 0.7, "gid": f"envelope {direction}"}
            changes = [each for each in found.changes if each.direction == direction]
            ends = [(each.last * quantity.display_scale, each.before) for each in changes]
            for edge in ("lowest", "highest"):
                heights = [getattr(motion, edge) * MM for motion in branch]
                ends_at = [(value, getattr(motion, edge) * MM) for value, motion in ends]
                axes.plot(*_interrupted(values, heights, ends_at, direction), **line)
            for value, _ in ends:
                axes.axvline(value, color=look["color"], lw=0.5, ls=":", gid="change")
            sizes = np.array([motion.multiplier for motion in branch])
            beneath.plot(values, sizes, **look)
        beneath.axhline(1.0, color="black", lw=0.6)
        beneath.set_ylim(bottom=0.0)
        axes.set_ylabel("envelope, turning points (mm)")
        beneath.set_ylabel("largest multiplier")
        unit = f" ({quantity.display_unit})" if quantity.display_unit else ""
        beneath.set_xlabel(f"{words(variable(found.key))}{unit}")
        figure.legend(loc="outside upper right", ncols=2)
        name = plain(found.name)
        figure.suptitle(f"Steady motions{f' of {name}' if name else ''}", x=0.01, ha="left")
    return figure


def _interrupted(
    values: list[float], heights: list[float], ends: list[tuple[float, float]], direction: str
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the points of a line that ends with each branch, with NaN between two branches."""
    x, y = np.array(values), np.array(heights)
    for value, height in ends:
        place = int(np.searchsorted(x, value, side="right" if direction == "up" else "left"))
        last = [height, nan] if direction == "up" else [nan, height]
        x, y = np.insert(x, place, [value, value]), np.insert(y, place, last)
    return x, y
