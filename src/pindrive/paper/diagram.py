"""Figure 3 of the paper: the model as a block diagram, each block tied to its term of (1)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import xarray as xr
from matplotlib.patches import Circle, FancyBboxPatch

from pindrive.paper.exhibit import Exhibit, page
from pindrive.style import GREY, PALETTE, SMALL

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Point = tuple[float, float]

_BLOCKS: Final = (
    ("1", r"$\frac{1}{m}$", 4.0, 0.0, r"$\ddot x = \Sigma/m$", "all forces over the mass"),
    ("2", r"$\int$", 6.6, 0.0, r"$\dot x = \int \ddot x\,dt$", "from acceleration to velocity"),
    ("3", r"$\int$", 9.2, 0.0, r"$x = \int \dot x\,dt$", "from velocity to displacement"),
    ("4", "$b$", 4.0, -1.1, r"$b\dot x$", "the damper"),
    ("5", "$k$", 4.0, -2.2, "$kx$", "the spring"),
    ("6", "sign", 5.6, 1.3, r"$-F_f\,\mathrm{sign}\,\dot x$", "friction of the finger"),
    ("7", "sign", 5.6, 2.6, r"$-F_p\,\mathrm{sign}(\dot x - v_p)$", "friction of the plate"),
    ("8", r"$v_p$", 9.9, 2.6, "$v_p$", "the mouse's velocity, an input"),
)
"""Number, sign, place, term of the equation (TeX), meaning."""


def model() -> Exhibit:
    """The block diagram, with its outputs."""
    rows = tuple((number, term, meaning) for number, _, _, _, term, meaning in _BLOCKS)
    outputs = (
        ("x", "the displacement, after block 3: `Motion.position`"),
        (r"\dot x", "the velocity, after block 2: `Motion.velocity`"),
        (r"\ddot x", "the acceleration, after block 1: `Motion.acceleration`"),
    )
    return Exhibit(
        "figure-3-model",
        "Figure 3: the model as a block diagram",
        "Drawn after equation (1) with the sign that dissipates. The paper's diagram is not "
        "printed with its text; what its section on Simulink names is here: the pin, the finger, "
        "and the three outputs. A solver with steps has to guess when a sign block switches; here "
        "the switching times are exact roots.",
        xr.Dataset(
            {
                "term": ("block", [term for _, _, _, _, term, _ in _BLOCKS]),
                "meaning": ("block", [meaning for *_, meaning in _BLOCKS]),
            },
            coords={"block": [int(number) for number, *_ in _BLOCKS]},
        ),
        lambda _: _draw(),
        table=(
            ("block", "term", "what it stands for"),
            *rows,
            *(("output", f"${symbol}$", words) for symbol, words in outputs),
        ),
    )


def _draw() -> Figure:
    figure = page(84)
    axes = figure.subplots()
    axes.set_axis_off()
    axes.set_xlim(0.0, 14.2)
    axes.set_ylim(-3.3, 3.2)
    axes.set_aspect("equal")
    place = {number: (x, y) for number, _, x, y, _, _ in _BLOCKS}
    for number, sign, x, y, _, _ in _BLOCKS:
        _block(axes, (x, y), sign, number)

    # Forward: forces, acceleration, velocity, displacement.
    total, slip = (1.6, 0.0), (8.2, 2.6)
    _sum(axes, total)
    _sum(axes, slip)
    _arrow(axes, (1.82, 0.0), (3.55, 0.0))
    _arrow(axes, (4.45, 0.0), (6.15, 0.0))
    _arrow(axes, (7.05, 0.0), (8.75, 0.0))
    _arrow(axes, (9.65, 0.0), (11.9, 0.0))
    for x, symbol in ((2.7, "forces"), (5.3, r"$\ddot x$"), (8.0, r"$\dot x$"), (10.3, "$x$")):
        axes.text(x, 0.12, symbol, ha="center", fontsize=8.0)
    _output(axes, 0.0, "$x$", "displacement", PALETTE["curve"])
    _output(axes, -1.3, r"$\dot x$", "velocity", PALETTE["stick"], tap=8.2)
    _output(axes, -2.9, r"$\ddot x$", "acceleration", PALETTE["slip"], tap=5.6)

    # Back: the damper and both frictions on velocity, the spring on displacement.
    v, x = 7.7, 10.8
    for number in ("4", "6"):
        across, up = place[number]
        _path(axes, (v, 0.0), (v, up), (across + 0.45, up))
    _path(axes, (x, 0.0), (x, -2.2), (4.45, -2.2))
    _path(axes, (v, 1.3), (8.2, 1.3), (8.2, 2.38))
    _path(axes, (9.45, 2.6), (8.42, 2.6))
    _path(axes, (7.98, 2.6), (6.05, 2.6))
    for at in ((v, 0.0), (v, 1.3), (x, 0.0)):
        _dot(axes, at)
    for at, sign in (((8.34, 2.12), "+"), ((8.55, 2.68), "−")):
        axes.text(*at, sign, fontsize=SMALL)
    axes.text(7.0, 2.72, r"$\dot x - v_p$", ha="center", fontsize=8.0)

    # And into the sum: far ones in a wider loop.
    for number, friction in (("6", "$F_f$"), ("7", "$F_p$")):
        _block(axes, (3.4, place[number][1]), friction)
        _arrow(axes, (5.15, place[number][1]), (3.85, place[number][1]))
    _path(axes, (2.95, 1.3), (1.6, 1.3), (1.6, 0.22))
    _path(axes, (3.55, -1.1), (1.6, -1.1), (1.6, -0.22))
    _path(axes, (2.95, 2.6), (0.6, 2.6), (0.6, 0.14), (1.43, 0.14))
    _path(axes, (3.55, -2.2), (0.6, -2.2), (0.6, -0.14), (1.43, -0.14))
    for at in ((1.68, 0.34), (1.68, -0.5), (1.1, 0.22), (1.1, -0.44)):
        axes.text(*at, "−", fontsize=SMALL)
    return figure


def _output(
    axes: Axes, y: float, symbol: str, name: str, colour: str, tap: float | None = None
) -> None:
    """A named output, and where it is tapped."""
    if tap is not None:
        _path(axes, (tap, 0.0), (tap, y), (11.9, y), colour=colour, behind=True)
        _dot(axes, (tap, 0.0), colour)
    shape = FancyBboxPatch(
        (11.9, y - 0.3), 2.2, 0.6, "round,pad=0,rounding_size=0.1", fc=colour, ec="none"
    )
    axes.add_patch(shape)
    axes.text(12.05, y, symbol, color="white", va="center", fontsize=8.0)
    axes.text(13.97, y, name, color="white", va="center", ha="right", fontsize=SMALL)


def _block(axes: Axes, at: Point, sign: str, number: str = "") -> None:
    x, y = at
    axes.add_patch(
        FancyBboxPatch(
            (x - 0.45, y - 0.36),
            0.9,
            0.72,
            "round,pad=0,rounding_size=0.08",
            fc="white",
            ec="black",
            lw=0.8,
            zorder=3,
        )
    )
    if sign == "sign":  # drawn, as in a block diagram
        axes.plot([x - 0.28, x + 0.28], [y, y], color="0.8", lw=0.5, zorder=4)
        step = [x - 0.28, x, x, x + 0.28], [y - 0.2, y - 0.2, y + 0.2, y + 0.2]
        axes.plot(*step, color=PALETTE["curve"], lw=1.2, zorder=4)
    else:
        axes.text(x, y, sign, ha="center", va="center", fontsize=10.0, zorder=4)
    if number:
        axes.text(x + 0.4, y - 0.42, number, fontsize=SMALL - 1, color=GREY, ha="center", va="top")


def _sum(axes: Axes, at: Point) -> None:
    axes.add_patch(Circle(at, 0.22, fc="white", ec="black", lw=0.8, zorder=3))
    axes.text(*at, "Σ", ha="center", va="center", fontsize=8.0, zorder=4)


def _dot(axes: Axes, at: Point, colour: str = "black") -> None:
    axes.plot(*at, "o", color=colour, ms=2.5, zorder=2)


def _arrow(axes: Axes, start: Point, end: Point, colour: str = "black") -> None:
    style = {"arrowstyle": "-|>", "lw": 0.8, "shrinkA": 0, "shrinkB": 0, "color": colour}
    axes.annotate("", end, start, arrowprops={**style, "mutation_scale": 7})


def _path(axes: Axes, *points: Point, colour: str = "black", behind: bool = False) -> None:
    """A line with corners that ends in an arrow."""
    across, up = zip(*points[:-1], strict=True)
    axes.plot(across, up, color=colour, lw=0.8, zorder=0.5 if behind else 1)
    _arrow(axes, points[-2], points[-1], colour)
