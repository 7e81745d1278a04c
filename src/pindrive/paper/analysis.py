"""Figures of the closed-form analysis: phase and amplitude, reversal, steady state, slips."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np
import xarray as xr
from matplotlib.colors import ListedColormap
from matplotlib.lines import Line2D
from numpy.typing import ArrayLike, NDArray

from pindrive.motion.batch import batched
from pindrive.motion.release import Release
from pindrive.paper import as_printed, formulas
from pindrive.paper.baseline import FACTORS
from pindrive.paper.equations import GOOD
from pindrive.paper.exhibit import Exhibit, by_case, exhibit, page, trend
from pindrive.paper.formulas import UNIT_DRIVE, UNIT_RELEASE, Array, Releases
from pindrive.plot.style import CURVES, GREY, PALETTE, SMALL

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_FACTORS_LABEL: Final = "the paper's damping factors"
_BOUNDS: Final[dict[str, tuple[Any, str]]] = {
    "angle": ("-", "exact"),
    "printed_bound": ((0, (4, 3)), "bound, as printed"),
    "right_bound": (":", "bound, right"),
}
"""The variables of the first reversal's angle: their dashes and what they are."""
_WIDTHS: Final = (0.6, 1.1, 1.8)
"""Widths of the curves for each damping ratio, points, for grey print."""
POINTS: Final = 201


def release(
    ratio: ArrayLike, speed: ArrayLike, friction: ArrayLike, displacement: ArrayLike = 1.0
) -> Releases:
    """A release in units of m and 1/ω_0, and of a length that is 1."""
    damping = 2 * np.asarray(ratio, dtype=np.float64)
    return Releases(
        mass=1.0,
        stiffness=1.0,
        damping=damping,
        friction=friction,
        mouse_velocity=speed,
        displacement=displacement,
    )


def _plain(**values: Any) -> dict[str, tuple[str, Any, dict[str, str]]]:
    """Coordinates without unit."""
    return {name: (name, along, {"units": "1"}) for name, along in values.items()}


# ---- phase and amplitude: (7), (8) ---------------------------------------------------------------


def phase_and_amplitude() -> Exhibit:
    """φ_0 and X_m,0 against the mouse's speed and against x_d, from either side of x_d."""
    speed, offset = np.linspace(0.0, 2.0, POINTS), np.linspace(0.0, 1.0, POINTS)
    ratios = np.array([0.0, 0.16, 0.6])
    places = np.array([0.0, 0.5, 1.2])  # x_d / x_0
    by_speed = release(0.16, speed, places[:, None])
    by_offset = release(ratios[:, None], 0.3, offset)
    data = xr.Dataset(
        {
            "phase_by_speed": (("place", "speed"), formulas.initial_phase(by_speed)),
            "amplitude_by_speed": (("place", "speed"), formulas.amplitude(by_speed)),
            "phase_by_offset": (("ratio", "offset"), formulas.initial_phase(by_offset)),
            "amplitude_by_offset": (("ratio", "offset"), formulas.amplitude(by_offset)),
        },
        coords=_plain(speed=speed, offset=offset, ratio=ratios, place=places),
    )
    for name in data:
        data[name].attrs["units"] = "rad" if str(name).startswith("phase") else "1"

    def over(along: str, name: str, which: str, case: str) -> str:
        curves = data[f"{name}_by_{along}"]
        found = {}
        for value in data[which].values:
            curve = curves.sel({which: value}).dropna(along).values
            found[case.format(value).replace("= 0 x_0", "= 0")] = trend(curve)
        return by_case(found)

    return exhibit(
        "phase-and-amplitude",
        data,
        _draw_phase_and_amplitude,
        phase_by_speed=over("speed", "phase", "place", "x_d = {:g} x_0"),
        amplitude_by_speed=over("speed", "amplitude", "place", "x_d = {:g} x_0"),
        phase_by_offset=over("offset", "phase", "ratio", "ζ = {:g}"),
        amplitude_by_offset=over("offset", "amplitude", "ratio", "ζ = {:g}"),
    )


def _draw_phase_and_amplitude(data: xr.Dataset) -> Figure:
    figure = page(105)
    panels = figure.subplots(2, 2, sharex="row")
    rows = (
        ("speed", "place", r"mouse speed $v_p/\omega_0x_0$", "$x_d = {:g}\\,x_0$"),
        ("offset", "ratio", "friction offset $x_d/x_0$", r"$\zeta = {:g}$"),
    )
    for row, (along, which, label, legend) in zip(panels, rows, strict=True):
        for axes, name, unit in zip(
            row, ("phase", "amplitude"), (r"$\varphi_0$ (°)", "$X_{m,0}/x_0$"), strict=True
        ):
            scale = 180 / np.pi if name == "phase" else 1.0
            for value, look in zip(data[which].values, CURVES, strict=False):
                y = scale * data[f"{name}_by_{along}"].sel({which: value})
                case = legend.format(value).replace("= 0\\,x_0", "= 0")
                axes.plot(data[along], y, **look, label=case)
            axes.set_ylabel(unit)
            axes.set_xlabel(label)
            axes.set_xlim(0.0, float(data[along].max()))
            axes.set_ylim(0.0, None)
        row[0].set_yticks([0, 45, 90, 135])
        row[1].legend()
    return figure


# ---- when the plate's velocity is reached: (21) to (26) ------------------------------------------


def first_reversal() -> Exhibit:
    """Return the time at which the pin first reaches the plate's velocity, and the exceptions."""
    ratios = np.array([0.0, 0.04, 0.16])
    speed = np.linspace(0.005, 2.0, POINTS)
    r = release(ratios[:, None], speed, 0.2, 1.2)  # d = 1
    w, phase = formulas.damped_frequency(r), formulas.initial_phase(r)
    fine = np.linspace(0.0, 0.8, 161)
    wide = np.linspace(0.01, 2.0, 161)
    limit = formulas.limit_damping_ratio(release(0.0, wide, 0.2, 1.2))
    found = batched(
        UNIT_DRIVE,
        UNIT_RELEASE,
        dict(
            damping=xr.DataArray(2 * fine, dims="ratio_of_map"),
            plate_kinetic=0.2,
            mouse_velocity=xr.DataArray(wide, dims="speed_of_map"),
            displacement=1.2,
            duration=20.0,
        ),
    ).transpose("ratio_of_map", "speed_of_map")
    angles = {"units": "rad"}
    times = found["transient_first_reversal_time"].to_numpy()
    data = xr.Dataset(
        {
            "angle": (("ratio", "speed"), w * formulas.first_reversal_time(r), angles),
            "printed_bound": (("ratio", "speed"), np.pi + 2 * phase, angles),
            "right_bound": (
                ("ratio", "speed"),
                np.pi + 2 * (phase - formulas.velocity_phase(r)),
                angles,
            ),
            "limit": ("speed_of_map", limit, {"units": "1"}),
            "first_reversal": (("ratio_of_map", "speed_of_map"), times, {"units": "1"}),
        },
        coords=_plain(ratio=ratios, speed=speed, ratio_of_map=fine, speed_of_map=wide),
    )
    reverses = ~np.isnan(times)
    foretold = fine[:, None] < limit
    below = (data.angle < data.printed_bound) & data.angle.notnull()
    slow = [float(data.speed[b].max()) if b.any() else 0.0 for b in below.values[1:]]
    return exhibit(
        "first-reversal",
        data,
        _draw_first_reversal,
        ratios=found.sizes["ratio_of_map"],
        speeds=found.sizes["speed_of_map"],
        slow=slow[0],
        slower=slow[1],
        right=int((reverses == foretold).sum()),
        count=reverses.size,
    )


def _draw_first_reversal(data: xr.Dataset) -> Figure:
    figure = page(75)
    left, right = figure.subplots(1, 2)
    handles: list[Artist] = []
    for ratio, look, width in zip(data.ratio.values, CURVES, _WIDTHS, strict=False):
        of, style = data.sel(ratio=ratio), {"color": look["color"], "lw": width}
        handles.append(Line2D([], [], **style, label=rf"$\zeta = {ratio:g}$"))
        for name, (dashes, _) in _BOUNDS.items():
            y = of[name] / np.pi
            left.plot(of.speed, y, **style, ls=dashes, gid=f"{name} {ratio:g}")
    left.set_ylabel(r"$\omega t_1/\pi$")
    left.set_xlim(0.0, 1.0)
    left.set_ylim(1.0, 1.6)
    handles += [
        Line2D([], [], color=GREY, lw=0.7, ls=dashes, label=label)
        for dashes, label in _BOUNDS.values()
    ]
    left.legend(handles=handles, loc="lower right", ncols=2)
    right.pcolormesh(
        data.speed_of_map,
        data.ratio_of_map,
        np.where(data.first_reversal.notnull(), 1.0, np.nan),
        cmap=ListedColormap([PALETTE["carried"]]),
        alpha=0.55,
        shading="nearest",
        rasterized=True,
        gid="reverses",
    )
    right.plot(data.speed_of_map, data.limit, color="black", gid="limit")
    right.annotate("reaches the plate's velocity", (0.04, 0.1), fontsize=SMALL)
    right.annotate("it never does", (1.1, 0.4), fontsize=SMALL)
    right.annotate("limit case (26)", (0.3, 0.29), fontsize=SMALL)
    right.set_ylabel(r"damping ratio $\zeta$")
    for axes in (left, right):
        axes.set_xlabel(r"mouse speed $v_p/\omega_0(x_0 - x_d)$")
    return figure


# ---- the steady state, and rest ------------------------------------------------------------------


def steady_and_rest() -> Exhibit:
    """Return the times of the undamped pin to its steady oscillation and to rest on the finger."""
    places = np.linspace(0.0, 12.0, 601)  # x_0 / x_d
    speeds = np.array([1.0, 3.0, 10.0])  # v_p / ω_0 x_d
    r = release(0.0, speeds[:, None], 1.0, places)
    ratio = np.linspace(0.05, 7.93, 320)  # v_p / ω_0 x_f, nowhere on a step
    finger = 1 / ratio
    rest = release(0.0, 1.0, 3.0, 0.0)
    found = batched(
        UNIT_DRIVE,
        Release(mouse_velocity=1.0, displacement=3.0),  # start of slip: x_p - x_f
        dict(plate_kinetic=3.0 + finger, finger_kinetic=finger),
    )
    period = 2 * np.pi
    data = xr.Dataset(
        {
            "steady_after": (("speed", "place"), formulas.time_to_steady(r) / period),
            "reversals": ("place", formulas.reversals_to_steady(r)[0]),
            "printed_steady": ("place", as_printed.periods_to_steady(r)[0]),
            "rest_after": ("finger", formulas.periods_to_rest(rest, finger)),
            "printed_rest": ("finger", as_printed.periods_to_rest(rest, finger)),
            "simulated_rest": ("finger", found["transient_rest_time"].to_numpy() / period),
        },
        coords=_plain(place=places, speed=speeds, finger=ratio),
    )
    for name in data:
        data[name].attrs["units"] = "1"
    off = np.abs(data.rest_after - data.printed_rest)
    exact = np.abs(data.simulated_rest - data.rest_after)
    beyond = data.sel(place=slice(1.001, None))
    ratio_of_times = beyond.steady_after / beyond.printed_steady
    return exhibit(
        "steady-and-rest",
        data,
        _draw_steady_and_rest,
        least=float(ratio_of_times.min()),
        most=float(ratio_of_times.max()),
        off=float(off.max()),
        count=exact.size,
        error="rounding" if float(exact.max()) < 1e-10 else f"{float(exact.max()):.1e}",
    )


def _draw_steady_and_rest(data: xr.Dataset) -> Figure:
    figure = page(75)
    left, right = figure.subplots(1, 2)
    printed_style: dict[str, Any] = {"color": GREY, "lw": 0.9, "ls": (0, (4, 3))}
    for speed, look in zip(data.speed.values, CURVES, strict=False):
        label = rf"$v_p = {speed:g}\,\omega_0x_d$"
        left.plot(data.place, data.steady_after.sel(speed=speed), **look, label=label)
    left.plot(data.place, data.reversals, color="black", lw=0.7, label="number of reversals")
    left.plot(data.place, data.printed_steady, **printed_style, label="as printed")
    left.set_xlabel("initial deflection $x_0/x_d$")
    left.set_ylabel("periods until steady")
    right.plot(data.finger, data.rest_after, color=PALETTE["curve"], label="exact")
    right.plot(
        data.finger[::8],
        data.simulated_rest[::8],
        "o",
        color=PALETTE["stick"],
        ms=2.0,
        label="simulated",
    )
    right.plot(data.finger, data.printed_rest, **printed_style, label="as printed")
    right.set_xlabel(r"mouse speed $v_p/\omega_0x_f$")
    right.set_ylabel("periods to rest")
    for axes, x in ((left, data.place), (right, data.finger)):
        axes.set_xlim(0.0, float(x.max()))
        axes.set_ylim(0.0, None)
        axes.legend()
    return figure


# ---- where the printed forms slip ----------------------------------------------------------------

SLIPS: Final = {
    "peak_displacement": "(14) $x_{m,a}$",
    "trough_displacement": "(16) $x_{m,c}$",
    "swing": "(17) swing",
    "return_velocity": "(20) $v_{m,b}$",
}


def printed_forms() -> Exhibit:
    """Return the errors of the printed extremes over the damping ratio."""
    ratios = np.linspace(0.0, 0.97, 195)
    speeds = np.linspace(0.0, 3.0, 61)
    r = release(ratios, speeds[:, None], 0.1)
    size = formulas.amplitude(r)
    off = {
        name: np.max(
            np.abs(getattr(as_printed, name)(r) - getattr(formulas, name)(r)) / size, axis=0
        )
        for name in SLIPS
    }
    data = xr.Dataset(
        {name: ("ratio", values, {"units": "1"}) for name, values in off.items()},
        coords=_plain(ratio=ratios),
    )
    at = data.interp(ratio=[*FACTORS])
    worst = [100 * max(float(at[name][i]) for name in SLIPS) for i in range(3)]
    good = [
        f"{label.split()[0]} {_spans(ratios, off[name] <= GOOD)}" for name, label in SLIPS.items()
    ]
    return exhibit(
        "printed-forms",
        data,
        _draw_printed_forms,
        light=worst[0],
        middle=worst[1],
        heavy=worst[2],
        good=100 * GOOD,
        forms=good,
    )


def _spans(ratios: Array, good: NDArray[np.bool_]) -> str:
    """From where to where a form is good, of damping ratios from 0 on, where each is."""
    words = []
    for last in np.flatnonzero(np.diff(good)):
        if good[last]:
            words.append(f"up to ζ = {np.floor(100 * ratios[last] + 1e-9) / 100:.2f}")
        else:
            words.append(f"from ζ = {np.ceil(100 * ratios[last + 1] - 1e-9) / 100:.2f} on")
    return " and ".join(words)


def _draw_printed_forms(data: xr.Dataset) -> Figure:
    figure = page(62)
    axes: Axes = figure.subplots()
    for (name, label), look in zip(SLIPS.items(), CURVES, strict=False):
        axes.plot(data.ratio[1:], 100 * data[name][1:], **look, label=label)
    factors: dict[str, Any] = {"color": GREY, "lw": 0.5, "ls": ":"}
    for factor in FACTORS:
        axes.axvline(factor, **factors, zorder=0, gid="factor")
    axes.set_xlabel(r"damping ratio $\zeta$")
    axes.set_ylabel("off by (% of the amplitude)")
    axes.set_yscale("log")
    axes.set_ylim(1e-3, 100)
    axes.set_xlim(0.0, float(data.ratio.max()))
    handles = [*axes.get_lines()[: len(SLIPS)], Line2D([], [], **factors, label=_FACTORS_LABEL)]
    axes.legend(handles=handles, loc="lower center", ncols=2)
    return figure
