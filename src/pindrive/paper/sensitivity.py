"""The paper's question: what the transitional period and the largest displacement depend on.

One parameter at a time, about the baseline: six curves each.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
import xarray as xr
from matplotlib.lines import Line2D

from pindrive.motion.batch import batched
from pindrive.paper import baseline
from pindrive.paper.exhibit import Exhibit, listed, page, trend
from pindrive.plot.style import GREY, PALETTE
from pindrive.quantities.quantity import significant
from pindrive.quantities.table import QUANTITIES

if TYPE_CHECKING:
    from collections.abc import Callable

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

POINTS: Final = 801
BASELINE: Final[dict[str, Any]] = {
    **{"ls": "none", "marker": "o", "color": "black", "ms": 3.0},
    **{"label": "the baseline", "gid": "baseline"},
}


class Parameter(NamedTuple):
    """One of the six, and how it is drawn."""

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
    Parameter("plate_kinetic", "surface friction", "F_p", "mN", 1e3, 0.0, 0.1),
    Parameter("damping", "damping", "b", "N·s/m", 1.0, 0.0, 0.9 * baseline.CRITICAL),
    Parameter("stiffness", "stiffness", "k", "N/m", 1.0, 20.0, 400.0),
    Parameter("mass", "mass", "m", "g", 1e3, 2e-3, 40e-3),
    Parameter("mouse_velocity", "mouse speed", "v_p", "mm/s", 1e3, 2e-3, 0.3),
    Parameter("displacement", "initial deflection", "x_0", "mm", 1e3, 0.1e-3, 5e-3),
)


def curves() -> xr.Dataset:
    """The numbers along each of the six ranges, the other parameters at the baseline."""
    names = ("transient_settling_time", "transient_rest_time", "transient_peak_displacement")
    values = np.array([np.linspace(p.least, p.most, POINTS) for p in PARAMETERS])
    columns: dict[str, list[NDArray[np.float64]]] = {name: [] for name in names}
    for parameter, along in zip(PARAMETERS, values, strict=True):
        found = batched(baseline.DRIVE, baseline.RELEASE, {parameter.argument: along})
        for name in names:
            columns[name].append(found[name].to_numpy())
    dims = ("parameter", "point")
    return xr.Dataset(
        {
            "value": (dims, values, {"long_name": "value of the parameter, SI"}),
            **{name.partition("_")[2]: (dims, columns[name], found[name].attrs) for name in names},
        },
        coords={
            "parameter": [p.argument for p in PARAMETERS],
            "si_unit": (
                "parameter",
                [QUANTITIES[p.argument.replace("_kinetic", ".kinetic")].unit for p in PARAMETERS],
                {"long_name": "unit of the value"},
            ),
        },
    )


def _table(data: xr.Dataset, name: str, scale: float, unit: str) -> tuple[tuple[str, ...], ...]:
    """Per parameter: its range, and where the curve starts, ends, and how it goes."""
    rows = [("parameter", "from", "to", "at the first", "at the last", "it")]
    for p in PARAMETERS:
        y = data[name].sel(parameter=p.argument).values
        first, last = (f"{significant(scale * x, 3)} {unit}" for x in (y[0], y[-1]))
        low, high = (f"{p.scale * x:.3g} {p.unit}" for x in (p.least, p.most))
        rows.append((f"{p.name} ${p.symbol}$", low, high, first, last, trend(y)))
    return tuple(rows)


def _ranked(data: xr.Dataset, name: str) -> list[tuple[float, str]]:
    """The parameters by how far the number moves over their ranges, largest over least."""
    found = []
    for p in PARAMETERS:
        y = data[name].sel(parameter=p.argument).values
        found.append((float(y.max() / y.min()), p.name))
    return sorted(found, reverse=True)


def settling(data: xr.Dataset) -> Exhibit:
    """The time of the transitional period against the six."""
    ranked = _ranked(data, "settling_time")
    order = [f"{name} (by {factor:.2g})" for factor, name in ranked]
    jumps = [
        p.name
        for p in PARAMETERS
        if np.abs(np.diff(data.settling_time.sel(parameter=p.argument).values)).max()
        > 0.05 * float(data.settling_time.sel(parameter=p.argument).max())
    ]
    return Exhibit(
        "influence-on-time",
        "The time of the transitional period against each of the six parameters",
        f"Blue: settled, from then on within 5 % of |x_0 − x_end|. Orange: at rest. Dot: the "
        f"baseline ({baseline.stated()}), which every other parameter keeps.",
        data[["value", "settling_time", "rest_time"]],
        _draw_settling,
        (
            f"Between the ends of these ranges the settling time changes most with {order[0]}, "
            f"then with {listed(order[1:])}, largest over least.",
            "It jumps by more than a twentieth along "
            f"{listed(jumps)}: the pin comes to rest in whole half swings, and one more or one "
            "less leaves the 5 % band at such a place.",
        ),
        _table(data, "settling_time", 1e3, "ms"),
    )


def displacement(data: xr.Dataset) -> Exhibit:
    """The largest displacement against the six."""
    ranked = _ranked(data, "peak_displacement")
    order = [f"{name} (by {factor:.3g})" for factor, name in ranked]
    small = [name for factor, name in ranked if factor < 1.05]
    return Exhibit(
        "influence-on-displacement",
        "The largest displacement against each of the six parameters",
        "The first displacement maximum (14). Grey: the initial deflection, from which it starts. "
        f"Dot: the baseline ({baseline.stated()}). Same scale but in the last two panels.",
        data[["value", "peak_displacement"]],
        _draw_displacement,
        (
            f"It changes most with {order[0]}, then with {listed(order[1:])}, largest over least; "
            f"{listed(small)} change it by less than 5 %.",
        ),
        _table(data, "peak_displacement", 1e3, "mm"),
    )


def _panels(height: float, draw: Callable[[Axes, Parameter], None], label: str) -> Figure:
    figure = page(height)
    panels = figure.subplots(2, 3).flat
    for i, (axes, p) in enumerate(zip(panels, PARAMETERS, strict=True)):
        draw(axes, p)
        axes.set_xlabel(f"{p.name} ${p.symbol}$ ({p.unit})")
        axes.set_xlim(min(0.0, p.scale * p.least), p.scale * p.most)
        if i % 3 == 0:
            axes.set_ylabel(label)
    return figure


def _draw_settling(data: xr.Dataset) -> Figure:
    def draw(axes: Axes, p: Parameter) -> None:
        of = data.sel(parameter=p.argument)
        x = p.scale * of.value.values
        _jumping(axes, x, 1e3 * of.rest_time.values, PALETTE["resting"], "rest")
        _jumping(axes, x, 1e3 * of.settling_time.values, PALETTE["curve"], "settled")
        _mark_baseline(axes, p, of.value.values, 1e3 * of.settling_time.values)

    figure = _panels(95, draw, "time (ms)")
    for axes in figure.axes:
        axes.set_ylim(0.0, None)
    handles = [
        Line2D([], [], color=PALETTE["curve"], label="settled within 5 %"),
        Line2D([], [], color=PALETTE["resting"], label="at rest"),
        Line2D([], [], **BASELINE),
    ]
    figure.legend(handles=handles, loc="outside upper right", ncols=3)
    return figure


def _draw_displacement(data: xr.Dataset) -> Figure:
    low, high = 1.95, 2.5

    def draw(axes: Axes, p: Parameter) -> None:
        of = data.sel(parameter=p.argument)
        x, y = p.scale * of.value.values, 1e3 * of.peak_displacement.values
        start = x if p.argument == "displacement" else np.full_like(x, 1e3 * _X0)
        axes.plot(x, start, **_START, gid="start")
        axes.plot(x, y, color=PALETTE["curve"], gid="peak")
        _mark_baseline(axes, p, of.value.values, y)
        if p.argument not in ("mouse_velocity", "displacement"):
            axes.set_ylim(low, high)

    figure = _panels(90, draw, "$x_{m,a}$ (mm)")
    handles = [
        Line2D([], [], color=PALETTE["curve"], label="$x_{m,a}$"),
        Line2D([], [], **_START, label="initial deflection $x_0$"),
        Line2D([], [], **BASELINE),
    ]
    figure.legend(handles=handles, loc="outside upper right", ncols=3)
    return figure


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
    axes: Axes, p: Parameter, values: NDArray[np.float64], y: NDArray[np.float64]
) -> None:
    at = baseline.value(p.argument)
    height = float(np.interp(at, values, y))
    axes.plot(p.scale * at, height, **BASELINE, zorder=4)
