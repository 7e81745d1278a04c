"""Figures 2 and 4 of the paper: the pin's velocity, and its displacement at three dampings."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np
import xarray as xr

from pindrive import Contact, Drive, Profile, simulate
from pindrive.paper import baseline
from pindrive.paper.exhibit import Exhibit, page, tidy
from pindrive.quantities import QUANTITIES
from pindrive.quantity import significant
from pindrive.style import GREY, PALETTE, SMALL

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from pindrive import Motion

FACTORS: Final = (0.04, 0.16, 0.32)
"""The damping factors of Figure 4."""
READINGS: Final = {"ratio": "damping ratio ζ", "viscous": "b in N·s/m"}

_STUCK: Final = ("slip", "carried", "resting")
_TINT: Final = {"carried": 0.55, "resting": 0.22}
_HOLD: Final = 12.0
"""The magnet's pull while it holds, as a factor on the plate's friction."""
_CARRY: Final = baseline.VALUES["displacement"] / baseline.VALUES["mouse_velocity"]


def _drive(damping: float) -> Drive:
    return Drive(
        mass=baseline.MASS,
        stiffness=baseline.STIFFNESS,
        damping=damping,
        plate=Contact(baseline.VALUES["plate.kinetic"]),
        finger=Contact(baseline.VALUES["finger.kinetic"]),
    )


def _modes(motion: Motion, t: NDArray[np.float64]) -> NDArray[np.int8]:
    """Which mode holds at each time, as an index of `_STUCK`."""
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
                t[first], t[last], color=PALETTE[name], alpha=_TINT[name], lw=0.0, zorder=0.5
            )


# ---- Figure 4 ------------------------------------------------------------------------------------


def displacement() -> Exhibit:
    """Figure 4, in both readings of its damping factor."""
    t = np.linspace(0.0, 0.3, 1201)
    motions = {
        (reading, factor): simulate(
            _drive(factor * (baseline.CRITICAL if reading == "ratio" else 1.0)),
            mouse_velocity=baseline.VALUES["mouse_velocity"],
            displacement=baseline.VALUES["displacement"],
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
    readings = []
    for reading, words in READINGS.items():
        of = data.sel(reading=reading)
        times = [f"{significant(1e3 * x, 3)}" for x in of.settling_time.values]
        depths = [f"{significant(-1e3 * x, 3)}" for x in of.trough.values]
        readings.append(
            f"Read as {words}: the pin settles after {times[0]}, {times[1]} and {times[2]} ms and "
            f"swings to {depths[0]}, {depths[1]} and {depths[2]} mm on the other side."
        )
    return Exhibit(
        "figure-4-displacement",
        "Figure 4: displacement at damping factor 0.04, 0.16 and 0.32",
        "The paper gives neither the unit of the damping factor nor any other parameter. Left it "
        "is "
        "read as the damping ratio ζ = b / 2√(mk), right as b in N·s/m. Assumed: "
        f"{baseline.stated('damping_ratio')}; static friction equal to kinetic, as in (1). "
        "The line marks when the pin is within 5 % for good.",
        data,
        _draw_displacement,
        tuple(readings),
    )


def _draw_displacement(data: xr.Dataset) -> Figure:
    figure = page(120)
    panels = figure.subplots(3, 2, sharex=True, sharey=True)
    t = 1e3 * data.time.values
    for column, reading in zip(panels.T, data.reading.values, strict=True):
        for axes, factor, letter in zip(column, data.factor.values, "abc", strict=True):
            of = data.sel(reading=reading, factor=factor)
            unit = "ζ = {:g}" if reading == "ratio" else "b = {:g} N·s/m, ζ = {:.2g}"
            tidy(axes, f"({letter})  {unit.format(factor, float(of.damping_ratio))}")
            axes.axhline(0.0, color="0.8", lw=0.5, zorder=0)
            _shade(axes, t, of["mode"].values)
            axes.plot(t, 1e3 * of.displacement, color=PALETTE["curve"])
            settled = 1e3 * float(of.settling_time)
            axes.axvline(settled, color=GREY, lw=0.7, zorder=1)
            axes.annotate(
                f"{settled:.0f} ms",
                (settled, 1.0),
                (3, -2),
                xycoords=axes.get_xaxis_transform(),
                textcoords="offset points",
                va="top",
                fontsize=SMALL,
            )
        column[-1].set_xlabel("time after release (ms)")
    panels[0, 0].set_xlim(t[0], t[-1])
    figure.supylabel("displacement $x$ (mm)", fontsize=8.0)
    _key(figure)
    return figure


def _key(figure: Figure) -> None:
    from matplotlib.patches import Patch

    handles = [
        Patch(color=PALETTE["carried"], alpha=0.55, lw=0.0, label="carried by the plate"),
        Patch(color=PALETTE["resting"], alpha=0.22, lw=0.0, label="at rest on the finger"),
    ]
    figure.legend(handles=handles, loc="outside upper right", ncols=2, frameon=False)


# ---- Figure 2 ------------------------------------------------------------------------------------


def velocity() -> Exhibit:
    """The velocity of the pin over a line: carried, released, at rest. Computed, not measured."""
    let_go = _CARRY
    motion = simulate(
        _drive(baseline.DRIVE["damping"]),
        mouse_velocity=baseline.VALUES["mouse_velocity"],
        displacement=0.0,
        plate_load=Profile([0.0, let_go, let_go + 1e-4], [_HOLD, _HOLD, 1.0]),
        duration=0.25,
    )
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
            "released": ((), released, {"units": "s", "long_name": "when the plate lets go"}),
        },
        coords={"time": ("time", t, {"units": "s", "long_name": "time since the magnet holds"})},
    )
    mm = QUANTITIES["velocity"].display_scale
    fastest, return_time = -mm * float(v[lowest]), 1e3 * float(t[lowest] - released)
    plate = mm * baseline.VALUES["mouse_velocity"]
    again = float(v[after & (t > t[lowest])].max()) * mm
    return Exhibit(
        "figure-2-velocity",
        "In the shape of Figure 2: velocity of the pin while it crosses a line",
        "Computed. The paper's Figure 2 is a measurement whose data are not printed, so nothing of "
        f"it is here. Assumed: {baseline.stated()}; the magnet holds with {_HOLD:g} times the "
        f"plate's own friction until {1e3 * let_go:.1f} ms and lets go within 0.1 ms; static "
        "friction equal to kinetic.",
        data,
        _draw_velocity,
        (
            f"Carried, the pin has the plate's velocity, {plate:g} mm/s; released, it comes back "
            f"at up to {fastest:.0f} mm/s, {fastest / plate:.1f} times as fast, "
            f"{return_time:.1f} ms after the plate let go, and then reaches {again:.0f} mm/s "
            "forwards.",
        ),
    )


def _draw_velocity(data: xr.Dataset) -> Figure:
    figure = page(70)
    axes = figure.subplots()
    tidy(axes)
    t, v = 1e3 * data.time.values, 1e3 * data.velocity.values
    axes.axhline(0.0, color="0.8", lw=0.5, zorder=0)
    level, released = 1e3 * float(data.plate_velocity), 1e3 * float(data.released)
    axes.axhline(level, color="black", lw=0.8, ls=(0, (5, 3)), zorder=1)
    _shade(axes, t, data["mode"].values)
    axes.plot(t, v, color=PALETTE["curve"])
    lowest = int(np.argmin(v))
    axes.plot(t[lowest], v[lowest], "o", color="black", ms=3.5)
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
    axes.plot(released, level, "^", color=PALETTE["slip"], mfc="white", mew=0.9)
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
