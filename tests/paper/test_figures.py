"""The figures of the report show their data: by value, side, order, sign, label and unit."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import matplotlib.style
import numpy as np
import pytest
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import LogNorm, to_hex
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch, FancyBboxPatch
from scipy.interpolate import RegularGridInterpolator

from figure_reading import Array, collisions, data, legend_of, lines, patch_spans, points
from pindrive.paper import analysis, device, maps, motions, sensitivity
from pindrive.paper.exhibit import Exhibit
from pindrive.plot.style import STYLE
from pindrive.quantities.units import to_si

SI = {"mN": "N", "N·s/m": "N*s/m", "N/m": "N/m", "g": "kg", "mm/s": "m/s", "mm": "m", "ms": "s"}


@cache
def curves() -> xr.Dataset:
    return sensitivity.curves()


@cache
def of_maps() -> tuple[Exhibit, Exhibit]:
    return maps.time_and_displacement()


EXHIBITS: dict[str, Callable[[], Exhibit]] = {
    "figure-1-device": device.device,
    "figure-2-velocity": motions.velocity,
    "figure-3-model": motions.model,
    "figure-4-displacement": motions.displacement,
    "influence-on-time": lambda: sensitivity.settling(curves()),
    "influence-on-displacement": lambda: sensitivity.displacement(curves()),
    "maps-of-time": lambda: of_maps()[0],
    "maps-of-displacement": lambda: of_maps()[1],
    "phase-and-amplitude": analysis.phase_and_amplitude,
    "first-reversal": analysis.first_reversal,
    "steady-and-rest": analysis.steady_and_rest,
    "printed-forms": analysis.printed_forms,
}


@cache
def drawn(name: str) -> tuple[xr.Dataset, Figure]:
    exhibit = EXHIBITS[name]()
    assert exhibit.name == name
    with matplotlib.style.context(STYLE, after_reset=True):
        return exhibit.data, exhibit.draw(exhibit.data)


def by_label(axes: Axes) -> dict[str, tuple[Array, Array]]:
    return {str(line.get_label()): points(line) for line in axes.lines}


def same(found: Any, wanted: Any) -> None:
    np.testing.assert_allclose(found, wanted, rtol=1e-12, atol=1e-12)


def stretches(mode: Array, t: Array, which: int) -> list[tuple[float, float]]:
    """From when to when a mode holds, to the samples between which it changes."""
    there = np.concatenate([[False], mode == which, [False]]).astype(int)
    begins, ends = (np.flatnonzero(np.diff(there) == turn) for turn in (1, -1))
    times = np.append(t, t[-1])
    return [(float(times[b]), float(times[e])) for b, e in zip(begins, ends, strict=True)]


def shaded(axes: Axes, name: str) -> list[tuple[float, float]]:
    return [(begin, end) for begin, end, *_ in patch_spans(axes, name)]


@pytest.mark.parametrize("name", EXHIBITS)
def test_no_text_covers_another(name: str) -> None:
    assert collisions(drawn(name)[1]) == []


# ---- the device ----------------------------------------------------------------------------------


def test_the_device_is_labelled() -> None:
    found, figure = drawn("figure-1-device")
    (axes,) = figure.axes
    named = {t.get_text(): t.get_position() for t in axes.texts if t.get_gid() == "part"}
    wanted = ["1 electromagnet", "2 spring", "3 mouse", "4 steel plate", "5 pin"]
    assert list(named) == [*wanted, "damper", "fingertip", "control block"]
    same(list(named.values()), np.column_stack([found.across, found.up]))
    arrows = {p.get_gid(): p for p in axes.patches if isinstance(p, FancyArrowPatch)}
    paths = {}
    for words, arrow in arrows.items():
        paths[words] = tuple(np.sign(np.subtract(*arrow._posA_posB[::-1])))  # type: ignore[attr-defined]
    right = ("$x$", "$v_p$", "$F_p$ on 1", "$F_f$ on 5")  # the pin returns, ẋ < 0
    assert paths == {
        **dict.fromkeys(right, (1, 0)),
        "the hand's motion": (-1, 0),
        "$N_p$ on 1": (0, 1),
        "$N_f$ on 5": (0, -1),
    }


# ---- motions -------------------------------------------------------------------------------------


def test_the_velocity() -> None:
    found, figure = drawn("figure-2-velocity")
    (axes,) = figure.axes
    t, v = 1e3 * found.time.values, 1e3 * found.velocity.values
    same(data(axes, "curve"), (t, v))
    assert axes.get_xlabel() == "time since the magnet holds (ms)"
    assert axes.get_ylabel() == "velocity $\\dot x$ (mm/s)"
    assert {*data(axes, "plate")[1]} == {60.0}, "mm/s, the assumed speed of the mouse"
    (place, value), lowest = np.ravel(data(axes, "lowest")), int(np.argmin(v))
    assert (place, value) == (t[lowest], v.min()) and value < -100.0
    same(np.ravel(data(axes, "released")), (1e3 * float(found.released), 60.0))
    for which, name in ((1, "carried"), (2, "resting")):
        same(shaded(axes, name), stretches(found["mode"].values, t, which))
    assert shaded(axes, "carried")[0][0] == 0.0, "it is carried first"
    assert shaded(axes, "resting")[-1][1] == t[-1], "and rests at last"


def test_the_displacement_at_each_damping() -> None:
    found, figure = drawn("figure-4-displacement")
    grid: Any = np.reshape(np.array(figure.axes, object), (3, 2))
    t = 1e3 * found.time.values
    for column, reading in enumerate(("ratio", "viscous")):
        for row, factor in enumerate((0.04, 0.16, 0.32)):
            axes, of = grid[row, column], found.sel(reading=reading, factor=factor)
            same(data(axes, "curve"), (t, 1e3 * of.displacement))
            settled = 1e3 * float(of.settling_time)
            assert {*data(axes, "settled")[0]} == {settled}
            assert [text.get_text() for text in axes.texts] == [f"{settled:.0f} ms"]
            title = axes.get_title(loc="left")
            assert title.startswith(f"({'abc'[row]})")
            ratio = factor if reading == "ratio" else factor / 2.0
            assert ("N·s/m" in title) == (reading == "viscous")
            assert f"{'ζ' if reading == 'ratio' else 'b'} = {factor:g}" in title
            assert title.endswith(f"ζ = {ratio:g}"), "critical damping is 2 N·s/m"
            for which, name in ((1, "carried"), (2, "resting")):
                same(shaded(axes, name), stretches(of["mode"].values, t, which))
    assert grid[2, 0].get_xlabel() == "time after release (ms)"


@pytest.mark.parametrize("name", ["figure-2-velocity", "figure-4-displacement"])
def test_tints_are_explained(name: str) -> None:
    figure = drawn(name)[1]
    handles = legend_of(figure)
    for words, gid in (("carried by the plate", "carried"), ("at rest on the finger", "resting")):
        patches = [p for axes in figure.axes for p in axes.patches if p.get_gid() == gid]
        assert {p.get_facecolor() for p in patches} == {handles[words].get_facecolor()}


# ---- one parameter at a time ---------------------------------------------------------------------


@pytest.mark.parametrize("name", ["influence-on-time", "influence-on-displacement"])
def test_the_curves_of_one_parameter(name: str) -> None:
    found, figure = drawn(name)
    panels = [axes for axes in figure.axes if axes.get_xlabel()]
    requested = [
        ("mN", "F_p"),
        ("mN", "N_f"),
        ("N·s/m", "b"),
        ("N/m", "k"),
        ("g", "m"),
        ("mm/s", "v_p"),
        ("mm", "x_0"),
        ("ms", "t_f"),
    ]
    base = [22.0, 10.0, 0.32, 100.0, 10.0, 60.0, 2.0, 0.0]
    for i, (axes, (unit, symbol)) in enumerate(zip(panels, requested, strict=True)):
        assert axes.get_xlabel().endswith(f" ${symbol}$ ({unit})")
        of = found.isel(parameter=i)
        x = of.value.values / to_si(f"1 {unit.replace('·', '*')}", SI[unit], "")
        time = name == "influence-on-time"
        shown = (
            {"settled": "settling_time", "rest": "rest_time"}
            if time
            else {"peak": "peak_displacement"}
        )
        for gid, variable in shown.items():
            across, up = data(axes, gid)
            known = ~np.isnan(across)
            same((across[known], up[known]), (x, 1e3 * of[variable].values))
        dot, height = np.ravel(data(axes, "baseline"))
        assert dot == pytest.approx(base[i])
        first = next(iter(shown.values()))
        assert height == pytest.approx(np.interp(dot, x, 1e3 * of[first].values))
        assert bool(lines(axes, "by weight")) == (symbol == "m")
        if symbol == "m":
            same(data(axes, "by weight"), (x, 1e3 * of[f"{first}_by_weight"].values))
            assert "friction follows the weight" in legend_of(figure)
        if not time:
            same(data(axes, "start"), (x, x if symbol == "x_0" else np.full_like(x, 2.0)))
    label = "time (ms)" if name == "influence-on-time" else "$x_{m,a}$ (mm)"
    assert [axes.get_ylabel() for axes in panels] == [label, "", "", "", label, "", "", ""]


def test_settled_differs_from_at_rest() -> None:
    _, figure = drawn("influence-on-time")
    handles = legend_of(figure)
    for words, gid in (("settled within 5 %", "settled"), ("at rest", "rest")):
        for axes in figure.axes:
            assert {line.get_color() for line in lines(axes, gid)} == {handles[words].get_color()}


# ---- maps ----------------------------------------------------------------------------------------

AXES = {
    "damping": r"damping ratio $\zeta$",
    "speed": r"mouse speed $v_p/\omega_0x_0$",
    "plate": r"surface friction $F_p/kx_0$",
    "finger": r"finger friction $F_f/kx_0$",
}
AT = {"damping": 0.16, "speed": 0.3, "plate": 0.11, "finger": 0.025}


@pytest.mark.parametrize("name", ["maps-of-time", "maps-of-displacement"])
def test_the_maps(name: str) -> None:
    found, figure = drawn(name)
    time = name == "maps-of-time"
    pairs = maps.TIME_MAPS if time else maps.DISPLACEMENT_MAPS
    *panels, bar = figure.axes
    for axes, (across, up) in zip(panels, pairs, strict=True):
        key = f"{across}_{up}"
        (mesh,) = (c for c in axes.collections if isinstance(c, QuadMesh))
        values: Any = mesh.get_array()
        same(values, found[f"{key}_{'periods' if time else 'peak'}"].values)
        corners = np.asarray(mesh.get_coordinates())
        x, y = found[f"{key}_{across}"].values, found[f"{key}_{up}"].values
        same(0.5 * (corners[0, 1:, 0] + corners[0, :-1, 0]), x)
        same(0.5 * (corners[1:, 0, 1] + corners[:-1, 0, 1]), y)
        assert (axes.get_xlabel(), axes.get_ylabel()) == (AXES[across], AXES[up])
        same(np.ravel(data(axes, "baseline")), (AT[across], AT[up]))
        assert isinstance(mesh.norm, LogNorm) == time
        at = RegularGridInterpolator((y, x), values)
        drawn_levels = set()
        for lines_of in (c for c in axes.collections if c.get_gid() == "contour"):
            level = float(str(lines_of.get_label()))
            for path in lines_of.get_paths():
                corners = np.asarray(path.vertices)
                inside = np.clip(corners[:, ::-1], (y[0], x[0]), (y[-1], x[-1]))
                assert at(inside) == pytest.approx(np.full(len(corners), level))
                drawn_levels.add(level)
        assert len(drawn_levels) >= 2
        assert mesh.get_clim() == ((0.25, 8.0) if time else (1.0, 2.4))
    if time:
        labels = [text.get_text() for text in bar.get_yticklabels()]
        assert dict(zip(labels, bar.get_yticks().tolist(), strict=True)) == {
            **{"¼": 0.25, "½": 0.5, "1": 1.0, "2": 2.0, "4": 4.0, "8": 8.0}
        }
    unit = r"settling time $\omega_0 t_s/2\pi$ (periods)" if time else "$x_{m,a}/x_0$"
    assert bar.get_ylabel() == unit
    assert "the baseline" in legend_of(figure)


# ---- the analysis --------------------------------------------------------------------------------


def test_phase_and_amplitude() -> None:
    found, figure = drawn("phase-and-amplitude")
    grid: Any = np.reshape(np.array(figure.axes, object), (2, 2))
    cases = (
        ("speed", "place", r"mouse speed $v_p/\omega_0x_0$", "$x_d = {:g}\\,x_0$"),
        ("offset", "ratio", "friction offset $x_d/x_0$", r"$\zeta = {:g}$"),
    )
    for row, (along, which, label, legend) in enumerate(cases):
        for axes, name, scale in zip(
            grid[row], ("phase", "amplitude"), (180 / np.pi, 1), strict=True
        ):
            assert axes.get_xlabel() == label
            assert axes.get_ylabel() == (r"$\varphi_0$ (°)" if name == "phase" else "$X_{m,0}/x_0$")
            shown = by_label(axes)
            assert len(shown) == found.sizes[which]
            for value in found[which].values:
                case = legend.format(value).replace(r"= 0\,x_0", "= 0")
                wanted = found[f"{name}_by_{along}"].sel({which: value})
                same(shown[case], (found[along], scale * wanted))
        assert [*legend_of(grid[row, 1])] == [*by_label(grid[row, 1])]


def test_the_first_reversal() -> None:
    found, figure = drawn("first-reversal")
    left, right = figure.axes
    for ratio in (0.0, 0.04, 0.16):
        for name in ("angle", "printed_bound", "right_bound"):
            across, up = data(left, f"{name} {ratio:g}")
            same((across, np.pi * up), (found.speed, found[name].sel(ratio=ratio)))
    handles = legend_of(left)
    for words, name in (
        ("exact", "angle"),
        ("bound, as printed", "printed_bound"),
        ("bound, right", "right_bound"),
    ):
        (line,) = lines(left, f"{name} 0.04")
        assert line.get_linestyle() == handles[words].get_linestyle()
        assert line.get_color() == handles[r"$\zeta = 0.04$"].get_color()
    assert left.get_ylabel() == r"$\omega t_1/\pi$"
    (mesh,) = (c for c in right.collections if c.get_gid() == "reverses")
    filled = ~np.isnan(np.ma.filled(mesh.get_array(), np.nan))  # type: ignore[arg-type]
    np.testing.assert_array_equal(filled, found.first_reversal.notnull())
    assert filled[0].all() and not filled[-1].any(), "friction reverses where damping is small"
    same(data(right, "limit"), (found.speed_of_map, found.limit))
    assert right.get_ylabel() == r"damping ratio $\zeta$"
    for axes in (left, right):
        assert axes.get_xlabel() == r"mouse speed $v_p/\omega_0(x_0 - x_d)$"
    places = {text.get_text(): text.xy for text in right.texts}  # type: ignore[attr-defined]
    for words, above in (("reaches the plate's velocity", False), ("it never does", True)):
        speed, ratio = places[words]
        assert (ratio > np.interp(speed, found.speed_of_map, found.limit)) == above


def test_steady_state_and_rest() -> None:
    found, figure = drawn("steady-and-rest")
    left, right = figure.axes
    shown = by_label(left)
    for speed in (1, 3, 10):
        wanted = found.steady_after.sel(speed=float(speed))
        same(shown[rf"$v_p = {speed}\,\omega_0x_d$"], (found.place, wanted))
    same(shown["number of reversals"], (found.place, found.reversals))
    same(shown["as printed"], (found.place, found.printed_steady))
    shown = by_label(right)
    same(shown["exact"], (found.finger, found.rest_after))
    same(shown["as printed"], (found.finger, found.printed_rest))
    same(shown["simulated"], (found.finger[::8], found.simulated_rest[::8]))
    assert (left.get_xlabel(), left.get_ylabel()) == (
        "initial deflection $x_0/x_d$",
        "periods until steady",
    )
    assert (right.get_xlabel(), right.get_ylabel()) == (
        r"mouse speed $v_p/\omega_0x_f$",
        "periods to rest",
    )


def test_errors_of_the_printed_forms() -> None:
    found, figure = drawn("printed-forms")
    (axes,) = figure.axes
    shown = by_label(axes)
    for label, name in (
        ("(14) $x_{m,a}$", "peak_displacement"),
        ("(16) $x_{m,c}$", "trough_displacement"),
        ("(17) swing", "swing"),
        ("(20) $v_{m,b}$", "return_velocity"),
    ):
        same(shown[label], (found.ratio[1:], 100.0 * found[name][1:]))
        assert label in legend_of(axes)
    factors = [points(line)[0][0] for line in lines(axes, "factor")]
    assert factors == [0.04, 0.16, 0.32]
    assert axes.get_ylabel() == "off by (% of the amplitude)"
    assert axes.get_yscale() == "log"


# ---- the diagram ---------------------------------------------------------------------------------


def test_the_diagram_names_its_outputs_where_they_are_tapped() -> None:
    _, figure = drawn("figure-3-model")
    (axes,) = figure.axes
    places = {text.get_text(): text.get_position() for text in axes.texts}
    boxes = [p for p in axes.patches if isinstance(p, FancyBboxPatch) and p.get_width() > 2.0]
    between = {"velocity": (7.05, 8.75), "acceleration": (4.45, 6.15)}
    for box, name in zip(boxes, ("displacement", "velocity", "acceleration"), strict=True):
        middle = box.get_y() + 0.5 * box.get_height()
        assert places[name][1] == pytest.approx(middle)
        colour = to_hex(box.get_facecolor())
        taps = [
            float(np.asarray(line.get_xdata())[0])
            for line in axes.lines
            if line.get_marker() == "o" and to_hex(line.get_color()) == colour
        ]
        assert all(between[name][0] < tap < between[name][1] for tap in taps)
        assert len(taps) == (name in between)


def test_the_diagram_subtracts_every_force() -> None:
    """Four go into the sum before 1/m, and the plate's velocity into that before its friction."""
    axes = drawn("figure-3-model")[1].axes[0]
    sign: dict[str, list[float]] = {"−": [], "+": []}
    for text in axes.texts:
        if text.get_text() in sign:
            sign[text.get_text()].append(text.get_position()[0])
    assert sum(x < 2.0 for x in sign["−"]) == 4
    assert [x for x in sign["−"] if x > 2.0] == [8.55]
    assert sign["+"] == [8.34]
    blocks = {"1": 4.0, "2": 6.6, "3": 9.2, "4": 4.0, "5": 4.0, "6": 5.6, "7": 5.6, "8": 9.9}
    texts = {t.get_text(): t.get_position()[0] for t in axes.texts}
    for number, x in blocks.items():
        assert texts[number] == pytest.approx(x + 0.4), "beside its block"
