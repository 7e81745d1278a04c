"""The device in a drawing of its own, and every symbol of the report."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np
import xarray as xr
from matplotlib.patches import Ellipse, FancyArrowPatch, Rectangle

from pindrive.paper.exhibit import Exhibit, exhibit, page
from pindrive.plot.style import GREY, PALETTE, SMALL

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PARTS: Final = {
    "electromagnet": (5.15, 1.75),
    "spring": (2.6, 2.45),
    "mouse": (1.75, 4.55),
    "steel plate": (1.2, 0.55),
    "pin": (4.6, 3.6),
    "damper": (2.6, 1.35),
    "fingertip": (5.15, 5.6),
    "control block": (8.0, 3.35),
}
"""Places of the labels of the parts; the first five have the paper's numbers 1 to 5."""

SYMBOLS: Final = (
    ("$x$", "deflection of the pin from the spring's rest, in the mouse", "m", "$x$"),
    ("$m$", "moving mass: electromagnet and pin", "kg", "$m$"),
    ("$k,\\ b$", "stiffness of the spring, damping of the damper", "N/m, N·s/m", "$k,\\ b$"),
    ("$\\zeta$", "damping ratio, $b/2\\sqrt{mk}$", "1", "damping factor, perhaps"),
    ("$F_p$", "friction force of the plate, sliding", "N", "$F_1$ in (1), $F_2$ from (2) on"),
    ("$F_f$", "friction force of the finger, sliding", "N", "$F_2$ in (1), $F_1 = 0$ from (2) on"),
    ("$N_p$", "normal force of the plate: weight, preload, touch and pull", "N", "none"),
    ("$N_f$", "touch force of the finger on the pin", "N", "system load"),
    ("$v_p$", "velocity of the plate past the mouse", "m/s", "$v_p$, defined twice"),
    ("$x_0$", "deflection at the release", "m", "$x_0$"),
    ("$x_d,\\ x_f$", "$F_p/k$ and $F_f/k$", "m", "$x_d$ for both"),
    ("$d$", "$x_0 - x_d$", "m", "written out"),
    ("$\\omega_0,\\ \\omega$", "natural frequency, without and with damping", "rad/s", "the same"),
    ("$\\alpha$", "$-b/2m$: how oscillations decay", "1/s", "$\\alpha$"),
    ("$C_1,\\ C_2$", "constants of the solution (4)", "m", "the same"),
    ("$X_{m,0}$", "amplitude at the release (7)", "m", "the same, and $X_{m,0p}$ in (17)"),
    (
        "$\\varphi_0,\\ \\varphi'_0$",
        "initial phase (8), lag of the velocity (10)",
        "rad",
        "the same",
    ),
    ("$t_a,\\ x_{m,a}$", "first maximum of the displacement", "s, m", "the same"),
    ("$t_b,\\ v_{m,b}$", "extreme return velocity", "s, m/s", "the same"),
    ("$t_c,\\ x_{m,c}$", "minimum that follows", "s, m", "the same"),
    ("$t_1$", "when the pin first reaches the plate's velocity", "s", "$t_1$"),
    ("$t_s,\\ x_{end}$", "time of the transitional period; where the pin ends", "s, m", "words"),
    ("$t_f$", "fall time of the magnet's pull", "s", "none"),
)
"""Symbol, meaning, SI unit, and what the paper writes."""


def device() -> Exhibit:
    """The device from the side, with its parts, forces and frame."""
    places = np.array(list(PARTS.values()))
    plain = {"units": "1", "long_name": "place of the name in the drawing"}
    data = xr.Dataset(
        {"across": ("part", places[:, 0], plain), "up": ("part", places[:, 1], plain)},
        coords={"part": list(PARTS)},
    )
    return exhibit(
        "figure-1-device",
        data,
        _draw,
        table=(("symbol", "meaning", "unit", "in the paper"), *SYMBOLS),
    )


def _draw(data: xr.Dataset) -> Figure:
    figure = page(95)
    axes: Axes = figure.subplots()
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.set_xlim(0.0, 11.0)
    axes.set_ylim(-0.7, 6.3)
    line: dict[str, Any] = {"color": "black", "lw": 1.0}
    axes.add_patch(Rectangle((0.3, 0.2), 10.2, 0.7, fc="0.85", ec="black", lw=0.8))
    housing = ([4.3, 1.2, 1.2, 1.5, 1.5], [4.2, 4.2, 0.9, 0.9, 3.9])
    axes.plot(*housing, **line)
    axes.plot([1.5, 4.3, 4.3], [3.9, 3.9, 4.2], **line)
    axes.plot([6.1, 9.6, 9.6, 9.3, 9.3, 6.1, 6.1], [4.2, 4.2, 0.9, 0.9, 3.9, 3.9, 4.2], **line)
    axes.add_patch(Rectangle((4.1, 0.95), 2.1, 1.6, fc=PALETTE["carried"], alpha=0.35, lw=0.0))
    axes.add_patch(Rectangle((4.1, 0.95), 2.1, 1.6, fill=False, **line))
    axes.add_patch(
        Rectangle((5.0, 2.55), 0.3, 1.8, fc="0.6", **{**line, "color": None, "ec": "black"})
    )
    axes.add_patch(Ellipse((5.15, 5.05), 4.6, 1.7, fc="#f2d6c4", ec="black", lw=0.8, zorder=0))
    coil = np.linspace(0.0, 1.0, 200)
    zigzag = (
        0.16 * (2 / np.pi) * np.arcsin(np.sin(14 * np.pi * coil)) * ((coil > 0.1) & (coil < 0.9))
    )
    axes.plot(1.5 + 2.6 * coil, 2.15 + zigzag, **line, gid="spring")
    axes.plot([1.5, 2.5], [1.75, 1.75], **line)
    axes.plot([3.2, 2.5, 2.5, 3.2], [1.95, 1.95, 1.55, 1.55], **line)
    axes.plot([2.9, 2.9], [1.62, 1.88], **line)
    axes.plot([2.9, 4.1], [1.75, 1.75], **line)
    axes.add_patch(Rectangle((7.1, 2.95), 1.8, 0.8, fc="white", ec="black", lw=0.8))
    axes.plot([8.0, 8.0, 6.2], [2.95, 1.6, 1.6], color=GREY, lw=0.8)
    numbers = ("1", "2", "3", "4", "5")
    for i, name in enumerate(data.part.values):
        words = f"{numbers[i]} {name}" if i < len(numbers) else str(name)
        at = float(data.across[i]), float(data.up[i])
        axes.text(*at, words, ha="center", va="center", fontsize=SMALL, gid="part")
    _arrow(axes, (5.15, -0.35), (6.9, -0.35), "$x$", (7.05, -0.35), "black")
    axes.plot([5.15, 5.15], [-0.55, -0.15], color="black", lw=0.7)
    _arrow(axes, (8.2, 0.55), (9.8, 0.55), "$v_p$", (10.0, 0.55), PALETTE["curve"])
    _arrow(axes, (1.0, 5.2), (0.2, 5.2), "the hand's motion", (0.2, 5.55), GREY)
    force = PALETTE["stick"]
    _arrow(axes, (6.2, 0.97), (7.1, 0.97), "$F_p$ on 1", (7.2, 1.12), force)
    _arrow(axes, (4.6, 0.3), (4.6, 0.95), "$N_p$ on 1", (3.35, 0.45), force)
    _arrow(axes, (5.3, 4.3), (6.15, 4.3), "$F_f$ on 5", (6.15, 4.72), force)
    _arrow(axes, (5.15, 5.2), (5.15, 4.4), "$N_f$ on 5", (5.3, 4.95), force)
    return figure


def _arrow(
    axes: Axes,
    begin: tuple[float, float],
    end: tuple[float, float],
    words: str,
    place: tuple[float, float],
    colour: str,
) -> None:
    arrow = FancyArrowPatch(begin, end, arrowstyle="-|>", mutation_scale=9.0, color=colour, lw=1.1)
    arrow.set_gid(words)
    axes.add_patch(arrow)
    axes.text(*place, words, color=colour, va="center", ha="left")
