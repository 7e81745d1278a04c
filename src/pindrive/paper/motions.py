"""Figures 2 and 4 of the paper: the pin's velocity, and its displacement at three dampings."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import xarray as xr
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, FancyBboxPatch, Patch
from numpy.typing import NDArray

from pindrive import Motion, Profile, simulate
from pindrive.paper import baseline
from pindrive.paper.baseline import FACTORS
from pindrive.paper.exhibit import Exhibit, exhibit, page
from pindrive.paper.wording import TEXTS, worded
from pindrive.plot.style import GREY, HALO, PALETTE, SMALL
from pindrive.quantities.quantity import significant
from pindrive.quantities.table import QUANTITIES

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

READINGS: Final = {"ratio": "damping ratio ζ", "viscous": "b in N·s/m"}

_STUCK: Final = ("slip", "carried", "resting")
_TINT: Final = {"carried": 0.55, "resting": 0.22}
_CARRY: Final = baseline.VALUES["displacement"] / baseline.VALUES["mouse_velocity"]


def _modes(motion: Motion, t: NDArray[np.float64]) -> NDArray[np.int8]:
    """Return the mode at each time, as an index of `_STUCK`."""
    begins = np.array([segment.begin for segment in motion.segments])
    modes = np.array([_STUCK.index(segment.mode) for segment in motion.segments], dtype=np.int8)
    return modes[np.searchsorted(begins, t, side="right") - 1]


def _shade(axes: Axes, t: NDArray[np.float64], mode: NDArray[np.int8]) -> None:
    """Tint where the pin is carried and where it rests."""
    turns = np.flatnonzero(np.diff(mode)) + 1
    for first, last in zip([0, *turns], [*turns, len(t) - 1], strict=True):
        if mode[first]:
            name = _STUCK[mode[first]]
            axes.axvspan(
                t[first],
                t[last],
                color=PALETTE[name],
                alpha=_TINT[name],
                lw=0.0,
                zorder=0.5,
                gid=name,
            )


# ---- Figure 4 ------------------------------------------------------------------------------------


def displacement() -> Exhibit:
    """Figure 4, in both readings of its damping factor."""
    t = np.linspace(0.0, 0.3, 1201)
    motions = {
        (reading, factor): simulate(
            replace(
                baseline.DRIVE,
                damping=factor * (baseline.CRITICAL if reading == "ratio" else 1.0),
            ),
            baseline.RELEASE,
        )
        for reading in READINGS
        for factor in FACTORS
    }
    grid = [[motions[reading, factor] for factor in FACTORS] for reading in READINGS]

    def numbers(name: str) -> tuple[tuple[str, str], list[list[float]], dict[str, str]]:
        values = [[motion.numbers()[name] for motion in row] for row in grid]
        quantity = QUANTITIES[name]
        return (
            ("reading", "factor"),
            values,
            {"units": quantity.unit, "long_name": quantity.meaning},
        )

    over_time = ("reading", "factor", "time")
    data = xr.Dataset(
        {
            "displacement": (
                over_time,
                [[motion.position(t) for motion in row] for row in grid],
                {"units": "m", "long_name": "deflection of the pin from the spring's rest"},
            ),
            "mode": (
                over_time,
                [[_modes(motion, t) for motion in row] for row in grid],
                {"flag_values": [0, 1, 2], "flag_meanings": " ".join(_STUCK)},
            ),
            "damping_ratio": (
                ("reading", "factor"),
                [[motion.drive.damping_ratio for motion in row] for row in grid],
                {"units": "1"},
            ),
            "peak": numbers("transient.peak_displacement"),
            "trough": numbers("transient.trough_displacement"),
            "settling_time": numbers("transient.settling_time"),
            "rest_time": numbers("transient.rest_time"),
        },
        coords={
            "time": ("time", t, {"units": "s", "long_name": "time since the release"}),
            "reading": list(READINGS),
            "factor": ("factor", list(FACTORS), {"long_name": "the paper's damping factor"}),
        },
    )
    words_of_reading = TEXTS["exhibits"]["figure-4-displacement"]["reading"]
    readings = []
    for reading, words in READINGS.items():
        of = data.sel(reading=reading)
        times = [f"{significant(1e3 * x, 3)}" for x in of.settling_time.values]
        depths = [f"{significant(-1e3 * x, 3)}" for x in of.trough.values]
        readings.append(worded(words_of_reading, words=words, times=times, depths=depths))
    return exhibit(
        "figure-4-displacement",
        data,
        _draw_displacement,
        readings=tuple(readings),
        baseline=baseline.stated("damping_ratio"),
    )


def _draw_displacement(data: xr.Dataset) -> Figure:
    figure = page(120)
    panels = figure.subplots(3, 2, sharex=True, sharey=True)
    t = 1e3 * data.time.values
    for column, reading in zip(panels.T, data.reading.values, strict=True):
        for axes, factor, letter in zip(column, data.factor.values, "abc", strict=True):
            of = data.sel(reading=reading, factor=factor)
            unit = "ζ = {:g}" if reading == "ratio" else "b = {:g} N·s/m, ζ = {:.2g}"
            axes.set_title(
                f"({letter})  {unit.format(factor, float(of.damping_ratio))}",
                loc="left",
                fontsize=8.0,
            )
            axes.axhline(0.0, color="0.8", lw=0.5, zorder=0)
            _shade(axes, t, of["mode"].values)
            axes.plot(t, 1e3 * of.displacement, color=PALETTE["curve"], gid="curve")
            settled = 1e3 * float(of.settling_time)
            axes.axvline(settled, color=GREY, lw=0.7, zorder=1, gid="settled")
            axes.annotate(
                f"{settled:.0f} ms",
                (settled, 1.0),
                (3, -2),
                xycoords=axes.get_xaxis_transform(),
                textcoords="offset points",
                va="top",
                fontsize=SMALL,
                path_effects=HALO,
            )
        column[-1].set_xlabel("time after release (ms)")
    panels[0, 0].set_xlim(t[0], t[-1])
    figure.supylabel("displacement $x$ (mm)", fontsize=8.0)
    _key(figure, Line2D([], [], color=GREY, lw=0.7, label="settled: within 5 % from then on"))
    return figure


def _key(figure: Figure, *more: Artist) -> None:
    handles = [
        *more,
        Patch(color=PALETTE["carried"], alpha=0.55, lw=0.0, label="carried by the plate"),
        Patch(color=PALETTE["resting"], alpha=0.22, lw=0.0, label="at rest on the finger"),
    ]
    figure.legend(handles=handles, loc="outside upper right", ncols=3)


# ---- Figure 2 ------------------------------------------------------------------------------------


def velocity() -> Exhibit:
    """The velocity of the pin over a line: carried, released, at rest. Computed, not measured."""
    breakaway = _CARRY
    load = Profile([0.0, breakaway, breakaway + 1e-4], [baseline.HOLD, baseline.HOLD, 1.0])
    release = replace(baseline.RELEASE, displacement=0.0, plate_load=load)
    motion = simulate(baseline.DRIVE, release, duration=0.25)
    t = motion.sample_times(1001)
    released = next(s.end for s in motion.segments if s.mode == "carried")
    after = t >= released
    v = motion.velocity(t)
    lowest = int(np.argmin(v))
    data = xr.Dataset(
        {
            "velocity": (
                "time",
                v,
                {"units": "m/s", "long_name": "velocity of the pin in the housing, computed"},
            ),
            "mode": (
                "time",
                _modes(motion, t),
                {"flag_values": [0, 1, 2], "flag_meanings": " ".join(_STUCK)},
            ),
            "plate_velocity": ((), baseline.VALUES["mouse_velocity"], {"units": "m/s"}),
            "released": ((), released, {"units": "s", "long_name": "when the pin breaks away"}),
        },
        coords={"time": ("time", t, {"units": "s", "long_name": "time since the magnet holds"})},
    )
    mm = QUANTITIES["velocity"].display_scale
    fastest, return_time = -mm * float(v[lowest]), 1e3 * float(t[lowest] - released)
    plate = mm * baseline.VALUES["mouse_velocity"]
    again = float(v[after & (t > t[lowest])].max()) * mm
    return exhibit(
        "figure-2-velocity",
        data,
        _draw_velocity,
        baseline=baseline.stated(),
        hold=baseline.HOLD,
        breakaway=1000.0 * breakaway,
        plate=plate,
        fastest=fastest,
        ratio=fastest / plate,
        return_time=return_time,
        again=again,
    )


def _draw_velocity(data: xr.Dataset) -> Figure:
    figure = page(70)
    axes = figure.subplots()
    t, v = 1e3 * data.time.values, 1e3 * data.velocity.values
    axes.axhline(0.0, color="0.8", lw=0.5, zorder=0)
    level, released = 1e3 * float(data.plate_velocity), 1e3 * float(data.released)
    axes.axhline(level, color="black", lw=0.8, ls=(0, (5, 3)), zorder=1, gid="plate")
    _shade(axes, t, data["mode"].values)
    axes.plot(t, v, color=PALETTE["curve"], gid="curve")
    lowest = int(np.argmin(v))
    axes.plot(t[lowest], v[lowest], "o", color="black", ms=3.5, gid="lowest")
    small: dict[str, Any] = {"textcoords": "offset points", "fontsize": SMALL}
    axes.annotate("$v_{m,b}$", (t[lowest], v[lowest]), (6, -1), va="center", **small)
    axes.annotate(
        "plate $v_p$",
        (1.0, level),
        (0, 3),
        xycoords=axes.get_yaxis_transform(),
        ha="right",
        **small,
    )
    axes.annotate("released", (released, level), (4, 4), **small)
    axes.plot(released, level, "^", color=PALETTE["slip"], mfc="white", mew=0.9, gid="released")
    axes.set_xlim(t[0], t[-1])
    axes.set_ylim(1.15 * v.min(), 1.6 * v.max())
    axes.set_xlabel("time since the magnet holds (ms)")
    axes.set_ylabel("velocity $\\dot x$ (mm/s)")
    axes.annotate(
        "computed, not measured",
        (1.0, 0.04),
        xycoords="axes fraction",
        ha="right",
        fontsize=SMALL,
        color=GREY,
    )
    _key(figure)
    return figure


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
    return exhibit(
        "figure-3-model",
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
