"""The paper's question: what the transitional period and the largest displacement depend on.

One parameter at a time, about the baseline: eight curves each, and one more for a mass whose
friction follows its weight.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
import xarray as xr
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from pindrive.motion.batch import batched
from pindrive.motion.drive import Drive
from pindrive.motion.motion import Motion
from pindrive.motion.profile import Profile
from pindrive.motion.simulate import simulated
from pindrive.paper import baseline
from pindrive.paper.exhibit import Exhibit, exhibit, page, trend
from pindrive.plot.style import GREY, PALETTE
from pindrive.quantities.quantity import significant
from pindrive.quantities.table import QUANTITIES

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

POINTS: Final = 801
BASELINE: Final[dict[str, Any]] = {
    **{"ls": "none", "marker": "o", "color": "black", "ms": 3.0},
    **{"label": "the baseline", "gid": "baseline"},
}


class PaperParameter(NamedTuple):
    """Parameter of the paper, and its appearance."""

    argument: str
    name: str
    symbol: str
    unit: str
    scale: float
    """Units in one SI unit."""
    least: float
    most: float
    """SI."""


PARAMETERS: Final = (
    PaperParameter("plate_kinetic", "surface friction", "F_p", "mN", 1e3, 0.0, 0.1),
    PaperParameter("touch_force", "touch force", "N_f", "mN", 1e3, 1e-3, 0.04),
    PaperParameter("damping", "damping", "b", "N·s/m", 1.0, 0.0, 0.9 * baseline.CRITICAL),
    PaperParameter("stiffness", "stiffness", "k", "N/m", 1.0, 20.0, 400.0),
    PaperParameter("mass", "mass", "m", "g", 1e3, 2e-3, 40e-3),
    PaperParameter("mouse_velocity", "mouse speed", "v_p", "mm/s", 1e3, 2e-3, 0.3),
    PaperParameter("displacement", "initial deflection", "x_0", "mm", 1e3, 0.1e-3, 5e-3),
    PaperParameter("fall_time", "fall time of the pull", "t_f", "ms", 1e3, 0.0, 0.03),
)
_NUMBERS: Final = ("settling_time", "rest_time", "peak_displacement")


def curves() -> xr.Dataset:
    """Return the results along the eight ranges, all other parameters at the baseline."""
    values = np.array([np.linspace(p.least, p.most, POINTS) for p in PARAMETERS])
    found = [_along(p.argument, x) for p, x in zip(PARAMETERS, values, strict=True)]
    masses = values[[p.argument for p in PARAMETERS].index("mass")]
    by_weight = _batch(baseline.PRESSED, "mass", masses)
    attributes = {name: dict(by_weight[f"transient_{name}"].attrs) for name in _NUMBERS}
    dims = ("parameter", "point")
    return xr.Dataset(
        {
            "value": (dims, values, {"long_name": "value of the parameter, SI"}),
            **{name: (dims, [of[name] for of in found], attributes[name]) for name in _NUMBERS},
            **{
                f"{name}_by_weight": (
                    "point",
                    by_weight[f"transient_{name}"].to_numpy(),
                    attributes[name] | {"comment": "over the mass, friction following the weight"},
                )
                for name in _NUMBERS
            },
        },
        coords={
            "parameter": [p.argument for p in PARAMETERS],
            "si_unit": (
                "parameter",
                [_si_unit(p.argument) for p in PARAMETERS],
                {"long_name": "unit of the value"},
            ),
        },
    )


def _si_unit(argument: str) -> str:
    if argument == "fall_time":
        return "s"
    return QUANTITIES[argument.replace("_kinetic", ".kinetic")].unit


def _batch(drive: Drive, argument: str, values: NDArray[np.float64]) -> xr.Dataset:
    return batched(drive, baseline.RELEASE, {argument: values})


def _along(argument: str, values: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
    """Return the results over a parameter."""
    if argument == "fall_time":
        transients = [_falling(float(time)).transient for time in values]
        return {name: np.array([getattr(t, name) for t in transients]) for name in _NUMBERS}
    drive = baseline.PRESSED if argument == "touch_force" else baseline.DRIVE
    found = _batch(drive, argument, values)
    return {name: found[f"transient_{name}"].to_numpy() for name in _NUMBERS}


def _falling(time: float) -> Motion:
    """The motion from when the magnet is switched off, its pull falling linearly in `time` (s)."""
    load = Profile([0.0, time], [baseline.HOLD, 1.0])
    return simulated(baseline.DRIVE, replace(baseline.RELEASE, plate_load=load))


_FOLLOWS: Final = "friction follows the weight"
_OF_TWO: Final = (
    f"touch force: F_f = {baseline.FINGER_COEFFICIENT:g} N_f, and F_p = μ N_p with the weight and "
    f"the touch in N_p, μ = {baseline.PRESSED.plate.coefficient or 0.0:.3g}. Fall time: from "
    f"{baseline.HOLD:g} times the plate's own friction linearly to it, from t = 0 on, when the "
    "magnet is switched off. Dashed: F_p grows with the weight by the same μ."
)


def _far_apart(data: xr.Dataset, name: str) -> tuple[float, float]:
    """Return the largest distance between the curves of mass and weight, and its place."""
    of = data.sel(parameter="mass")
    apart = np.abs(of[f"{name}_by_weight"].values - of[name].values)
    return float(apart.max()), float(of.value[int(apart.argmax())])


def _table(data: xr.Dataset, name: str, scale: float, unit: str) -> tuple[tuple[str, ...], ...]:
    """Per parameter: its range, and where the curve starts, ends, and how it goes."""
    rows = [("parameter", "from", "to", "value at from", "value at to", "trend")]
    for p in PARAMETERS:
        y = data[name].sel(parameter=p.argument).values
        first, last = (f"{significant(scale * x, 3)} {unit}" for x in (y[0], y[-1]))
        low, high = (f"{p.scale * x:.3g} {p.unit}" for x in (p.least, p.most))
        rows.append((f"{p.name} ${p.symbol}$", low, high, first, last, trend(y)))
        if p.argument == "mass":
            y = data[f"{name}_by_weight"].values
            first, last = (f"{significant(scale * x, 3)} {unit}" for x in (y[0], y[-1]))
            rows.append((f"{p.name}, {_FOLLOWS}", low, high, first, last, trend(y)))
    return tuple(rows)


def _ranked(data: xr.Dataset, name: str) -> list[tuple[float, str]]:
    """The parameters by how far the number moves over their ranges, largest over least."""
    found = []
    for p in PARAMETERS:
        y = data[name].sel(parameter=p.argument).values
        found.append((float(y.max() / y.min()), p.name))
    return sorted(found, reverse=True)


def settling(data: xr.Dataset) -> Exhibit:
    """The time of the transitional period against the eight."""
    apart, mass = _far_apart(data, "settling_time")
    ranked = _ranked(data, "settling_time")
    order = [f"{name} (by {factor:.2g})" for factor, name in ranked]
    jumps = [
        p.name
        for p in PARAMETERS
        if np.abs(np.diff(data.settling_time.sel(parameter=p.argument).values)).max()
        > 0.05 * float(data.settling_time.sel(parameter=p.argument).max())
    ]
    return exhibit(
        "influence-on-time",
        data[[n for n in data if not str(n).startswith("peak")]],
        _draw_settling,
        table=_table(data, "settling_time", 1e3, "ms"),
        baseline=baseline.stated(),
        scope=_OF_TWO,
        most=order[0],
        others=order[1:],
        jumps=jumps,
        apart=1000.0 * apart,
        mass=1000.0 * mass,
    )


def displacement(data: xr.Dataset) -> Exhibit:
    """The largest displacement against the eight."""
    apart, mass = _far_apart(data, "peak_displacement")
    ranked = _ranked(data, "peak_displacement")
    order = [f"{name} (by {factor:.3g})" for factor, name in ranked]
    small = [name for factor, name in ranked if factor < 1.05]
    return exhibit(
        "influence-on-displacement",
        data[["value", "peak_displacement", "peak_displacement_by_weight"]],
        _draw_displacement,
        table=_table(data, "peak_displacement", 1e3, "mm"),
        baseline=baseline.stated(),
        scope=_OF_TWO,
        most=order[0],
        others=order[1:],
        small=small,
        apart=1000.0 * apart,
        mass=1000.0 * mass,
    )


def _panels(height: float, draw: Callable[[Axes, PaperParameter], None], label: str) -> Figure:
    figure = page(height)
    panels = figure.subplots(2, 4).flat
    for i, (axes, p) in enumerate(zip(panels, PARAMETERS, strict=True)):
        draw(axes, p)
        axes.set_xlabel(f"{p.name} ${p.symbol}$ ({p.unit})")
        axes.set_xlim(min(0.0, p.scale * p.least), p.scale * p.most)
        if i % 4 == 0:
            axes.set_ylabel(label)
    return figure


def _draw_settling(data: xr.Dataset) -> Figure:
    def draw(axes: Axes, p: PaperParameter) -> None:
        of = data.sel(parameter=p.argument)
        x = p.scale * of.value.values
        _jumping(axes, x, 1e3 * of.rest_time.values, PALETTE["resting"], "rest")
        _jumping(axes, x, 1e3 * of.settling_time.values, PALETTE["curve"], "settled")
        if p.argument == "mass":
            axes.plot(x, 1e3 * data.settling_time_by_weight, **_BY_WEIGHT)
        _mark_baseline(axes, p, of.value.values, 1e3 * of.settling_time.values)

    figure = _panels(95, draw, "time (ms)")
    for axes in figure.axes:
        axes.set_ylim(0.0, None)
    handles = [
        Line2D([], [], color=PALETTE["curve"], label="settled within 5 %"),
        Line2D([], [], color=PALETTE["resting"], label="at rest"),
        Line2D([], [], **_BY_WEIGHT, label=_FOLLOWS),
        Line2D([], [], **BASELINE),
    ]
    figure.legend(handles=handles, loc="outside upper right", ncols=4)
    return figure


def _draw_displacement(data: xr.Dataset) -> Figure:
    low, high = 1.95, 2.6

    def draw(axes: Axes, p: PaperParameter) -> None:
        of = data.sel(parameter=p.argument)
        x, y = p.scale * of.value.values, 1e3 * of.peak_displacement.values
        start = x if p.argument == "displacement" else np.full_like(x, 1e3 * _X0)
        axes.plot(x, start, **_START, gid="start")
        axes.plot(x, y, color=PALETTE["curve"], gid="peak")
        if p.argument == "mass":
            axes.plot(x, 1e3 * data.peak_displacement_by_weight, **_BY_WEIGHT)
        _mark_baseline(axes, p, of.value.values, y)
        if p.argument not in ("mouse_velocity", "displacement"):
            axes.set_ylim(low, high)

    figure = _panels(90, draw, "$x_{m,a}$ (mm)")
    handles = [
        Line2D([], [], color=PALETTE["curve"], label="$x_{m,a}$"),
        Line2D([], [], **_BY_WEIGHT, label=_FOLLOWS),
        Line2D([], [], **_START, label="initial deflection $x_0$"),
        Line2D([], [], **BASELINE),
    ]
    figure.legend(handles=handles, loc="outside upper right", ncols=4)
    return figure


_BY_WEIGHT: Final[dict[str, Any]] = {
    **{"color": "black", "lw": 0.8, "ls": (0, (3, 2)), "gid": "by weight"}
}
_X0: Final = baseline.VALUES["displacement"]
_START: Final[dict[str, Any]] = {"color": GREY, "lw": 0.7, "ls": ":"}


def _jumping(
    axes: Axes, x: NDArray[np.float64], y: NDArray[np.float64], colour: str, gid: str
) -> None:
    """A curve with jumps: thin where it jumps, at full width between."""
    jumps = np.flatnonzero(np.abs(np.diff(y)) > 0.02 * y.max())
    broken = np.insert(y, jumps + 1, np.nan)
    axes.plot(np.insert(x, jumps + 1, np.nan), broken, color=colour, gid=gid)
    for i in jumps:
        axes.plot(x[i : i + 2], y[i : i + 2], color=colour, lw=0.4)


def _mark_baseline(
    axes: Axes, p: PaperParameter, values: NDArray[np.float64], y: NDArray[np.float64]
) -> None:
    at = baseline.value(p.argument)
    height = float(np.interp(at, values, y))
    axes.plot(p.scale * at, height, **BASELINE, zorder=4)
