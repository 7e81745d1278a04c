"""Two parameters at a time, in the dimensionless groups that the six make.

Masses, lengths and times are measured in m, x_0 and 1/ω_0. Four numbers of the drive remain, so
every result is a function of four numbers.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import sqrt
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
import xarray as xr
from matplotlib.colors import LogNorm, Normalize
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from pindrive.motion.batch import batched
from pindrive.paper import baseline, formulas
from pindrive.paper.exhibit import Exhibit, at_most, exhibit, page, trend
from pindrive.paper.formulas import UNIT_DRIVE, UNIT_RELEASE, Releases
from pindrive.paper.population import SEED
from pindrive.plot.contours import MAP, draw_contours, jump_key

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.colorbar import Colorbar
    from matplotlib.figure import Figure

POINTS: Final = 121
BASELINE: Final[dict[str, Any]] = {
    **{"ls": "none", "marker": "o", "color": "white", "mec": "black", "mew": 0.6, "ms": 4.0},
    **{"label": "the baseline", "gid": "baseline"},
}


class Group(NamedTuple):
    """A dimensionless number of the drive, its range, and its value at the baseline."""

    name: str
    symbol: str
    """TeX."""
    least: float
    most: float
    baseline: float


_W0: Final = sqrt(baseline.STIFFNESS / baseline.MASS)
_X0: Final = baseline.VALUES["displacement"]
_FORCE: Final = baseline.STIFFNESS * _X0

_SLOW: Final = 0.02
"""A slower plate takes the pin along for longer than anything else takes."""

GROUPS: Final = {
    group.name: group
    for group in (
        Group("damping", r"\zeta", 0.0, 0.9, baseline.VALUES["damping_ratio"]),
        Group(
            "speed", r"v_p/\omega_0x_0", _SLOW, 2.0, baseline.VALUES["mouse_velocity"] / (_W0 * _X0)
        ),
        Group("plate", r"F_p/kx_0", 0.0, 0.9, baseline.VALUES["plate.kinetic"] / _FORCE),
        Group("finger", r"F_f/kx_0", 0.0, 0.4, baseline.VALUES["finger.kinetic"] / _FORCE),
    )
}
MEANING: Final = {
    "damping": "damping ratio",
    "speed": "mouse speed",
    "plate": "surface friction",
    "finger": "finger friction",
}

TIME_MAPS: Final = (
    ("speed", "damping"),
    ("plate", "damping"),
    ("plate", "speed"),
    ("plate", "finger"),
)
DISPLACEMENT_MAPS: Final = (("speed", "damping"), ("plate", "speed"), ("plate", "finger"))


def numbers(groups: Mapping[str, xr.DataArray | float]) -> xr.Dataset:
    """Return results of `simulate_batch` by dimensionless groups, in units of m, x_0, 1/ω_0."""
    values = {name: groups.get(name, group.baseline) for name, group in GROUPS.items()}
    return batched(
        UNIT_DRIVE,
        UNIT_RELEASE,
        dict(
            damping=2 * values["damping"],
            plate_kinetic=values["plate"],
            finger_kinetic=values["finger"],
            mouse_velocity=values["speed"],
        ),
    )


def plane(across: str, up: str) -> xr.Dataset:
    """The numbers over two of the groups."""
    axes = {n: np.linspace(GROUPS[n].least, GROUPS[n].most, POINTS) for n in (across, up)}
    given = {n: xr.DataArray(x, dims=n) for n, x in axes.items()}
    found = numbers(given).transpose(up, across)
    return xr.Dataset(
        {
            "periods": (
                (up, across),
                found["transient_settling_time"].to_numpy() / (2 * np.pi),
                {"units": "1", "long_name": "settling time in undamped periods"},
            ),
            "peak": (
                (up, across),
                found["transient_peak_displacement"].to_numpy(),
                {"units": "1", "long_name": "largest displacement over x_0"},
            ),
        },
        coords={n: (n, x, {"units": "1", "long_name": MEANING[n]}) for n, x in axes.items()},
    )


def _joined(planes: dict[str, xr.Dataset], name: str) -> xr.Dataset:
    """One number of several planes, each with axes of its own."""
    return xr.merge(
        plane[[name]].rename(
            {str(v): f"{key}_{v}" for v in plane[[name]].variables},
        )
        for key, plane in planes.items()
    )


def time_and_displacement() -> tuple[Exhibit, Exhibit]:
    """Return the maps of the settling time, and the maps of the largest displacement."""
    wanted = dict.fromkeys((*TIME_MAPS, *DISPLACEMENT_MAPS))
    planes = {f"{across}_{up}": plane(across, up) for across, up in wanted}
    at = ", ".join(f"{MEANING[g.name]} {g.baseline:.3g}" for g in GROUPS.values())
    collapse, reduced = _checks()
    time = exhibit(
        "maps-of-time",
        _joined({f"{a}_{u}": planes[f"{a}_{u}"] for a, u in TIME_MAPS}, "periods"),
        _draw_time,
        readings=(
            _reading(planes[f"{a}_{u}"].periods, a, u, "settling time") for a, u in TIME_MAPS
        ),
        baseline=at,
        collapse=at_most(collapse),
        seed=SEED,
    )
    displacement = exhibit(
        "maps-of-displacement",
        _joined({f"{a}_{u}": planes[f"{a}_{u}"] for a, u in DISPLACEMENT_MAPS}, "peak"),
        _draw_displacement,
        readings=(
            _reading(planes[f"{a}_{u}"].peak, a, u, "largest displacement")
            for a, u in DISPLACEMENT_MAPS
        ),
        baseline=at,
        reduced=at_most(reduced),
    )
    return time, displacement


def _reading(values: xr.DataArray, across: str, up: str, name: str) -> str:
    """Return the trends along each axis through the baseline, and the place of the extreme."""
    middle = {n: GROUPS[n].baseline for n in (across, up)}
    along = values.sel({up: middle[up]}, method="nearest").values
    against = values.sel({across: middle[across]}, method="nearest").values
    low, high = float(values.min()), float(values.max())
    where = values.where(values == values.max(), drop=True)
    place = ", ".join(f"{MEANING[n]} {float(where[n][0]):.2g}" for n in (across, up))
    unit = "periods" if name == "settling time" else "x_0"
    return (
        f"{MEANING[across].capitalize()} and {MEANING[up]}: the {name} goes from {low:.3g} to "
        f"{high:.3g} {unit}, the largest at {place}. Through the baseline it {trend(along)} with "
        f"{MEANING[across]} and {trend(against)} with {MEANING[up]}."
    )


def _checks() -> tuple[float, float]:
    """Check that four groups determine the motion, and three its peak."""
    draw = np.random.default_rng(SEED)
    count = 500
    groups = {n: xr.DataArray(draw.uniform(0.02, g.most, count)) for n, g in GROUPS.items()}
    m, k, x0 = draw.uniform(2e-3, 2e-2, count), draw.uniform(20, 400, count), 1e-3
    w0 = np.sqrt(k / m)
    real = Releases(
        mass=m,
        stiffness=k,
        damping=2 * groups["damping"].values * np.sqrt(m * k),
        friction=groups["plate"].values * k * x0,
        mouse_velocity=groups["speed"].values * w0 * x0,
        displacement=x0,
    ).batch(finger_kinetic=groups["finger"].values * k * x0)
    unit = numbers(groups)
    pairs = (
        (w0 * real["transient_settling_time"].values, unit["transient_settling_time"].values),
        (real["transient_peak_displacement"].values / x0, unit["transient_peak_displacement"]),
    )
    collapse = max(float(np.max(np.abs(a / np.asarray(b) - 1))) for a, b in pairs)

    found = plane("plate", "finger")
    plate, finger = np.meshgrid(found.plate.values, found.finger.values)
    g = GROUPS
    release = Releases(
        mass=1.0,
        stiffness=1.0,
        damping=2 * g["damping"].baseline,
        friction=np.maximum(plate - finger, 0.0),
        mouse_velocity=g["speed"].baseline,
        displacement=1.0,
    )
    off = np.abs(formulas.peak_displacement(release) - found.peak.values)
    return collapse, float(np.nanmax(np.where(plate >= finger, off, np.nan)))


# ---- drawing -------------------------------------------------------------------------------------


def _draw_map(
    axes: Axes, data: xr.Dataset, across: str, up: str, name: str, levels: Sequence[float]
) -> None:
    """One map with its contours."""
    key = f"{across}_{up}"
    values = data[f"{key}_{name}"].values
    x, y = (data[f"{key}_{n}"].values for n in (across, up))
    low, high = levels[0], levels[-1]
    norm = LogNorm(low, high) if name == "periods" else Normalize(low, high)
    axes.pcolormesh(
        x, y, values, cmap=MAP, norm=norm, shading="nearest", rasterized=True, gid="map"
    )
    draw_contours(axes, x, y, values, levels[1:], norm)
    axes.plot(GROUPS[across].baseline, GROUPS[up].baseline, **BASELINE)
    axes.set_xlabel(f"{MEANING[across]} ${GROUPS[across].symbol}$")
    axes.set_ylabel(f"{MEANING[up]} ${GROUPS[up].symbol}$")


def _draw_scale(figure: Figure, panels: NDArray[Any], label: str, extend: str) -> Colorbar:
    """The scale of colours of all panels, and what the dot and the lines mean."""
    mesh: Any = panels.flat[0].collections[0]
    bar = figure.colorbar(mesh, ax=panels, extend=extend, shrink=0.8, pad=0.02)
    bar.set_label(label)
    bar.outline.set_linewidth(0.6)
    return bar


def _draw_time(data: xr.Dataset) -> Figure:
    figure = page(130)
    panels = figure.subplots(2, 2)
    for axes, (across, up) in zip(panels.flat, TIME_MAPS, strict=True):
        _draw_map(axes, data, across, up, "periods", [0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 8.0])
    label = r"settling time $\omega_0 t_s/2\pi$ (periods)"
    bar = _draw_scale(figure, panels, label, "both")
    bar.set_ticks([0.25, 0.5, 1, 2, 4, 8], labels=["¼", "½", "1", "2", "4", "8"])
    bar.ax.minorticks_off()
    handles = [Line2D([], [], **BASELINE), *jump_key(figure)]
    figure.legend(handles=handles, loc="outside upper right", ncols=2)
    return figure


def _draw_displacement(data: xr.Dataset) -> Figure:
    figure = page(70)
    panels = figure.subplots(1, 3)
    levels = [1.0, 1.02, 1.05, 1.1, 1.2, 1.4, 1.6, 1.8, 2.0, 2.2, 2.4]
    for axes, (across, up) in zip(panels, DISPLACEMENT_MAPS, strict=True):
        _draw_map(axes, data, across, up, "peak", levels)
    _draw_scale(figure, panels, "$x_{m,a}/x_0$", "neither")
    handles = [Line2D([], [], **BASELINE)]
    figure.legend(handles=handles, loc="outside upper right")
    return figure
