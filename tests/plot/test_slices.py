"""Maps of studies: what is drawn is what the file holds, and what has no number looks like none."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from numpy.typing import NDArray
from scipy.interpolate import RegularGridInterpolator
from typer.testing import CliRunner, Result

from figure_reading import collisions, legend_of, patch_spans
from pindrive.cli.app import app
from pindrive.plot.contours import draw_contours, find_jumps, jump_key, line_colours
from pindrive.plot.slices import _flattened, plot_study
from pindrive.study.runner import sweep
from pindrive.study.slices import Slice, quantiles
from pindrive.study.spec import load_study

Values = NDArray[np.float64]
BASE = f'base = "{(Path(__file__).parents[1] / "minimal.toml").as_posix()}"\n'
GRID = """
[axes]
mouse_velocity = { lin = ["20 mm/s", "300 mm/s"], count = 15 }
drive.stiffness = { log = ["20 N/m", "500 N/m"], count = 12 }
plate.kinetic = ["0 mN", "5 mN", "10 mN", "15 mN", "20 mN"]
plate.static = ["18 mN"]
damping_ratio = [0.1, 0.2, 0.3]
duration = ["90 ms"]
"""
DRAWN = """
[axes]
mass = { uniform = ["5 g", "20 g"] }
mouse_velocity = { uniform = ["20 mm/s", "300 mm/s"] }
plate.kinetic = ["5 mN", "20 mN"]
[sample]
count = 3000
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder with a study on a grid, a drawn study, and a study of a single point."""
    made = tmp_path_factory.mktemp("maps")
    for name, text in (("grid", GRID), ("drawn", DRAWN), ("one", '[axes]\nmass = ["1 g"]\n')):
        (made / f"{name}.toml").write_text(BASE + text)
        sweep(load_study(made / f"{name}.toml"), made / f"{name}.nc")
    return made


@pytest.fixture
def grid(folder: Path) -> Iterator[Slice]:
    with Slice(folder / "grid.nc") as view:
        yield view


@pytest.fixture
def drawn(folder: Path) -> Iterator[Slice]:
    with Slice(folder / "drawn.nc") as view:
        yield view


def draw(
    view: Slice, numbers: list[str], x: str | None = None, y: str | None = None, **held: float
) -> Figure:
    return plot_study(view, [view.number(n) for n in numbers], *view.axes(x, y, held), held)


def meshes(figure: Figure) -> list[Values]:
    """The values of the maps of numbers: not of what is refused, nor of the scale of colours."""
    found = [c for axes in figure.axes for c in axes.collections if isinstance(c, QuadMesh)]
    arrays = [np.ma.filled(c.get_array(), np.nan) for c in found if c.cmap.name == "viridis"]  # type: ignore[arg-type]
    return [array for array in arrays if array.size != 256]


# ---- grids ---------------------------------------------------------------------------------------


def test_a_map_is_a_slice_of_the_file(grid: Slice) -> None:
    """Over the first two keys, for three values of the third, the middle of the last."""
    figure = draw(grid, ["settling_time"])
    maps = meshes(figure)
    assert len(maps) == 3
    for mesh, friction in zip(maps, (0, 2, 4), strict=True):
        part = grid.data.isel(plate_kinetic=friction, damping_ratio=1).squeeze()
        times = part.transient_settling_time.transpose("stiffness", "mouse_velocity").values
        np.testing.assert_array_equal(mesh.reshape(times.shape), 1e3 * times)
    left = figure.axes[0]
    assert left.get_xlabel() == r"mouse velocity $v_\mathrm{p}$ (mm/s)"
    assert left.get_ylabel() == "stiffness $k$ (N/m)"
    assert (left.get_xscale(), left.get_yscale()) == ("linear", "log")
    assert left.get_title() == r"$F_\mathrm{p}$ = 0 mN"
    assert "$ζ$ = 0.2" in figure.get_suptitle()
    assert figure.axes[-1].get_ylabel() == r"settling time $t_\mathrm{s}$ (ms)"


def test_unsettled_points_are_hatched_and_impossible_points_grey(grid: Slice) -> None:
    (key,) = draw(grid, ["swing"]).legends
    words = [text.get_text() for text in key.get_texts()]
    assert words == [
        "not settled in the time followed",
        "has no swing",
        "no motion: contradictory values",
    ]
    panels = list(grid.panels("transient_swing", *grid.axes(None, None, {}), {}))
    for panel, refused in zip(panels, (False, False, True), strict=True):
        assert panel.refused.all() == panel.refused.any() == refused
        assert panel.unsettled.any() != refused
        assert (panel.unsettled | panel.absent | panel.refused)[np.isnan(panel.values)].all()
        assert refused or not np.isnan(panel.values[panel.unsettled]).all(), "some have a swing"
    settled = list(grid.panels("transient_swing", "mouse_velocity", "", {"stiffness": 500.0}))
    assert all(panel.unsettled.mean() < 1.0 for panel in settled)


def test_a_steady_motion_without_the_number_is_not_called_unsettled(folder: Path) -> None:
    (folder / "steady.toml").write_text(
        BASE + '[axes]\nmouse_velocity = { lin = ["0 mm/s", "200 mm/s"], count = 9 }\n'
        'displacement = { lin = ["-1 mm", "3 mm"], count = 9 }\nfinger.kinetic = ["0 mN"]\n'
        "damping_ratio = [0]\n"
    )
    sweep(load_study(folder / "steady.toml"), folder / "steady.nc")
    with Slice(folder / "steady.nc") as view:
        (panel,) = view.panels("transient_swing", *view.axes(None, None, {}), {})
        assert not panel.unsettled.any()
        assert 0 < panel.absent.sum() < panel.values.size
        np.testing.assert_array_equal(panel.absent, np.isnan(panel.values))
        assert list(legend_of(draw(view, ["swing"]))) == ["has no swing"]
        figure = draw(view, ["swing"], "mouse_velocity", None, displacement=0.0)
        assert list(legend_of(figure)) == ["has no swing"]
        panels = view.panels("transient_settling_time", *view.axes(None, None, {}), {})
        assert not any(panel.absent.any() or panel.unsettled.any() for panel in panels)


def test_refused_points_are_grey_and_unsettled_ones_hatched(grid: Slice) -> None:
    figure = draw(grid, ["settling_time"])
    parts = list(grid.panels("transient_settling_time", *grid.axes(None, None, {}), {}))
    for axes, part in zip(figure.axes, parts, strict=False):
        assert axes.patch.get_hatch(), "shows wherever there is no colour"
        grey = [
            c
            for c in axes.collections
            if isinstance(c, QuadMesh) and c.cmap.name != "viridis" and c.get_array() is not None
        ]
        assert len(grey) == int(part.refused.any())
        for mesh in grey:
            covered = ~np.isnan(np.ma.filled(mesh.get_array(), np.nan))  # type: ignore[arg-type]
            np.testing.assert_array_equal(covered.reshape(part.refused.shape), part.refused)
    assert any(part.refused.any() for part in parts)


def test_curves_are_slices_too(grid: Slice) -> None:
    held = {"stiffness": 100.0, "damping_ratio": 0.3}
    figure = draw(grid, ["swing", "peak_time"], "mouse_velocity", None, **held)
    place = int(np.argmin(np.abs(grid.data.stiffness.values - 100.0)))
    for axes, name in zip(figure.axes, ("swing", "peak_time"), strict=True):
        curves = [line for line in axes.get_lines() if line.get_gid() == "settled"]
        assert len(curves) == 5, "one for each friction"
        for i, curve in enumerate(curves):
            part = grid.data.isel(plate_kinetic=i, stiffness=place, damping_ratio=2)
            settled = part.transient_settled.values.ravel()
            expected = np.where(settled, 1e3 * part[f"transient_{name}"].values.ravel(), np.nan)
            np.testing.assert_array_equal(curve.get_ydata(), expected)
    legend = figure.axes[0].get_legend()
    assert legend is not None
    assert legend.get_texts()[1].get_text() == r"$F_\mathrm{p}$ = 5 mN"


def test_a_single_curve_is_shaded_where_it_has_no_value(grid: Slice) -> None:
    held = {"stiffness": 100.0, "damping_ratio": 0.1, "plate_kinetic": 0.01}
    figure = draw(grid, ["settling_time"], "mouse_velocity", None, **held)
    (axes,) = figure.axes
    assert axes.get_ylabel() == r"settling time $t_\mathrm{s}$ (ms)"
    (part,) = grid.panels("transient_settling_time", "mouse_velocity", "", held)
    assert 0 < part.unsettled.sum() < len(part.values)
    shaded = [span[:2] for span in patch_spans(axes, None)]
    x = 1e3 * part.along[0]
    for i, place in enumerate(x):
        assert any(low <= place <= high for low, high in shaded) == part.unsettled[i]
    assert list(legend_of(figure)) == ["not settled in the time followed"]


def contours(axes: Axes) -> dict[str, list[Values]]:
    """The pieces of each contour, by its level as text."""
    found = [c for c in axes.collections if c.get_gid() == "contour"]
    return {str(c.get_label()): [np.asarray(p.vertices) for p in c.get_paths()] for c in found}


def test_contours_are_at_their_levels_which_stand_at_the_scale(grid: Slice) -> None:
    figure = draw(grid, ["settling_time"])
    _, _, _, *scales = figure.axes
    for axes, values in zip(figure.axes[:3], meshes(figure), strict=True):
        levels = contours(axes)
        bar = scales[0] if len(scales) == 1 else scales[figure.axes.index(axes)]
        if np.isnan(values).all():
            assert not levels
            continue
        assert {f"{tick:.6g}" for tick in bar.get_yticks()} == {*levels}
        x, y = 1e3 * grid.data.mouse_velocity.values, grid.data.stiffness.values
        at = RegularGridInterpolator((y, x), values, bounds_error=False, fill_value=None)
        for level, pieces in levels.items():
            for piece in pieces:
                there = at(piece[:, ::-1])  # NaN beside a point without a number
                np.testing.assert_allclose(there[~np.isnan(there)], float(level), rtol=1e-9)
        for text in (t for t in axes.texts if t.get_gid() == "level"):
            ends = [
                np.abs(piece - text.get_position()).max(axis=1).min()
                for piece in levels[text.get_text()]
            ]
            assert min(ends) == 0.0, "a label stands on its own contour"


X, Y = np.linspace(0.0, 1.0, 21), np.linspace(0.0, 10.0, 11)


def test_contours_end_at_a_jump() -> None:
    """The left half goes from 0 to 10, the right half from 20 to 30: 15 is nowhere."""
    values = np.where(X > 0.52, 20.0, 0.0) + Y[:, None]
    figure = Figure()
    axes = figure.subplots()
    draw_contours(axes, X, Y, values, [5.0, 15.0, 25.0], Normalize(0.0, 30.0))
    assert len(jump_key(figure)) == 1
    found = contours(axes)
    assert found["15"] == []
    for level, left, right in (("5", 0.0, 0.5), ("25", 0.55, 1.0)):
        (piece,) = found[level]
        assert (piece[:, 0].min(), piece[:, 0].max()) == pytest.approx((left, right))
        np.testing.assert_allclose(piece[:, 1], 5.0)
    (fronts,) = (c for c in axes.collections if c.get_gid() == "jumps")
    ends = np.array([path.vertices for path in fronts.get_paths()])
    np.testing.assert_allclose(ends[..., 0], 0.525)
    assert (ends[..., 1].min(), ends[..., 1].max()) == (0.0, 10.0)
    assert {text.get_text() for text in axes.texts} == {"5", "25"}


def test_steep_slope_is_no_jump() -> None:
    for smooth in (X, X**4, np.exp(5 * X) / 150, np.sqrt(X), np.sin(9 * X), np.abs(X - 0.4)):
        assert not find_jumps(smooth, X).any()
    for jump in (0.6, -0.6):
        found = find_jumps(np.sin(2 * X) + jump * (X > 0.32), X)
        assert np.flatnonzero(found).tolist() == [6]
    assert not find_jumps(np.array([0.0, 1.0]), X[:2]).any(), "nothing to compare with"
    assert not find_jumps(np.where(X > 0.5, np.nan, X), X).any()


def test_lines_on_bright_colours_are_black() -> None:
    norm = Normalize(0.0, 1.0)
    assert line_colours([0.0, 0.3, 0.7, 1.0], norm) == ["white", "white", "black", "black"]


def test_a_panel_that_others_would_flatten_has_its_own_scale() -> None:
    one, small, flat = np.array([[0.0, 100.0]]), np.array([[3.0, 5.0]]), np.array([[7.0, 7.0]])
    assert not _flattened([one, 0.5 * one])
    assert _flattened([one, small])
    assert not _flattened([one, flat]), "what is the same everywhere is best seen on a common scale"
    assert not _flattened([one, np.array([[np.nan, np.nan]])])


def test_maps_on_scales_of_their_own(folder: Path) -> None:
    """The settling time at a high damping ratio varies little beside that at a low one."""
    (folder / "flat.toml").write_text(
        BASE + '[axes]\nmouse_velocity = { lin = ["20 mm/s", "300 mm/s"], count = 9 }\n'
        'plate.kinetic = { lin = ["5 mN", "20 mN"], count = 7 }\ndamping_ratio = [0.01, 0.2]\n'
    )
    sweep(load_study(folder / "flat.toml"), folder / "flat.nc")
    with Slice(folder / "flat.nc") as view:
        figure = draw(view, ["settling_time", "swing"])
        for row, name in enumerate(("settling_time", "swing")):
            parts = [view.data[f"transient_{name}"].isel(damping_ratio=i).values for i in (0, 1)]
            own = [(1e3 * np.nanmin(part), 1e3 * np.nanmax(part)) for part in parts]
            limits = []
            for axes in figure.axes[2 * row : 2 * row + 2]:
                (mesh,) = (c for c in axes.collections if isinstance(c, QuadMesh))
                limits.append(mesh.get_clim())
            apart = (own[1][1] - own[1][0]) < 0.25 * (own[0][1] - own[0][0])
            assert apart == (name == "settling_time")
            both = (min(own[0][0], own[1][0]), max(own[0][1], own[1][1]))
            np.testing.assert_allclose(limits, own if apart else [both] * 2)
        scales = figure.axes[4:]
        assert [axes.get_ylabel() for axes in scales] == [
            "",
            r"settling time $t_\mathrm{s}$ (ms)",
            "swing (mm)",
        ]
        assert collisions(figure) == []


def test_titles_of_any_text_stay_on_the_page(folder: Path) -> None:
    name = "Ümläute, 5 $ und 6 $, x_a^2: " + "ein sehr langer Name " * 8
    text = f'name = "{name}"\n' + BASE + GRID
    (folder / "long.toml").write_text(text, encoding="utf-8")
    sweep(load_study(folder / "long.toml"), folder / "long.nc")
    with Slice(folder / "long.nc") as view:
        for y in (None, "stiffness"):
            held = {} if y else {"stiffness": 100.0}
            figure = draw(view, ["swing"], "mouse_velocity", y, **held)
            assert collisions(figure) == []
            box = figure.texts[0].get_window_extent()
            assert box.x0 >= 0.0 and box.x1 <= figure.bbox.x1 and box.y1 <= figure.bbox.y1
            assert r"5 \$ und 6 \$" in figure.get_suptitle().replace("\n", " ")


def test_curves_differ_without_colour(grid: Slice) -> None:
    figure = draw(grid, ["swing"], "mouse_velocity", None, stiffness=100.0)
    curves = [line for line in figure.axes[0].get_lines() if line.get_gid() == "settled"]
    sample_times = {(str(c._dash_pattern), c.get_linewidth()) for c in curves}  # type: ignore[attr-defined]
    assert len(sample_times) == len(curves) == 5


# ---- draws ---------------------------------------------------------------------------------------


def test_draws_over_one_key_are_a_median_and_a_band(drawn: Slice) -> None:
    (panel, _) = drawn.panels("transient_swing", "mouse_velocity", "", {})
    swing = drawn.data.transient_swing.isel(plate_kinetic=0).values
    speed = drawn.data.mouse_velocity.values
    edges = np.linspace(speed.min(), speed.max(), len(panel.values) + 1)
    inside = (speed >= edges[7]) & (speed < edges[8])
    assert panel.low is not None and panel.high is not None
    found = [panel.low[7], panel.values[7], panel.high[7]]
    np.testing.assert_allclose(found, np.quantile(swing[inside], (0.05, 0.5, 0.95)), rtol=1e-12)


def test_draws_over_two_keys_are_a_map_of_medians(drawn: Slice) -> None:
    figure = draw(drawn, ["swing"], "mass", "mouse_velocity", plate_kinetic=0.02)
    (_, bar) = figure.axes
    assert bar.get_ylabel() == "median swing (mm)"
    assert r"$F_\mathrm{p}$ = 20 mN" in figure.get_suptitle()
    (medians,) = meshes(figure)
    swing = 1e3 * drawn.data.transient_swing.isel(plate_kinetic=1).values
    low, middle, high = np.nanquantile(swing, (0.001, 0.5, 0.999))
    assert low < np.nanmin(medians) < middle < np.nanmax(medians) < high


def test_draws_that_are_not_drawn_over_are_summed_up(folder: Path) -> None:
    (folder / "both.toml").write_text(
        BASE + '[axes]\nmouse_velocity = ["50 mm/s", "90 mm/s"]\n'
        'mass = { uniform = ["5 g", "20 g"] }\n[sample]\ncount = 501\n'
    )
    sweep(load_study(folder / "both.toml"), folder / "both.nc")
    with Slice(folder / "both.nc") as view:
        (panel,) = view.panels("transient_swing", "mouse_velocity", "", {})
        swing = view.data.transient_swing.values
        np.testing.assert_allclose(panel.values, np.median(swing, axis=1), rtol=1e-12)
        assert panel.low is not None
        np.testing.assert_allclose(panel.low, np.quantile(swing, 0.05, axis=1), rtol=1e-12)


@given(
    st.lists(
        st.tuples(st.integers(0, 4), st.floats(-1e3, 1e3) | st.just(float("nan"))), max_size=60
    )
)
def test_quantiles_of_groups_are_numpys(pairs: list[tuple[int, float]]) -> None:
    group = np.array([g for g, _ in pairs], np.int64)
    values = np.array([v for _, v in pairs], np.float64)
    found = quantiles(group, values, 5)
    for g in range(5):
        own = values[(group == g) & ~np.isnan(values)]
        expected = np.quantile(own, (0.05, 0.5, 0.95)) if own.size else np.full(3, np.nan)
        np.testing.assert_allclose(found[:, g], expected, rtol=1e-12, atol=1e-12)


def test_the_band_and_the_median_are_the_quantiles(drawn: Slice) -> None:
    figure = draw(drawn, ["swing"], "mouse_velocity", None, plate_kinetic=0.02)
    (axes,) = figure.axes
    (part,) = drawn.panels("transient_swing", "mouse_velocity", "", {"plate_kinetic": 0.02})
    (band,) = (c for c in axes.collections if c.get_gid() == "draws")
    corners = np.concatenate([path.vertices for path in band.get_paths()])
    assert part.low is not None and part.high is not None
    x = 1e3 * part.along[0]
    for i in (0, 20, len(x) - 1):
        there = corners[corners[:, 0] == x[i], 1]
        assert (there.min(), there.max()) == pytest.approx((1e3 * part.low[i], 1e3 * part.high[i]))
    (curve,) = (line for line in axes.get_lines() if line.get_gid() == "settled")
    np.testing.assert_allclose(np.asarray(curve.get_ydata(), float), 1e3 * part.values)
    assert list(legend_of(figure)) == ["median", "5 % to 95 % of draws"]


# ---- the command ---------------------------------------------------------------------------------


def run(*arguments: str) -> Result:
    return CliRunner().invoke(app, ["map", *arguments])


@pytest.mark.parametrize("ending", ["png", "svg", "pdf"])
def test_the_command_draws(folder: Path, tmp_path: Path, ending: str) -> None:
    target = tmp_path / f"map.{ending}"
    held = ("--at", "plate.kinetic=5 mN", "--at", "damping_ratio=0.2")
    said = run(str(folder / "grid.nc"), "--plot", str(target), "--x", "mouse_velocity", *held)
    assert said.exit_code == 0
    assert said.stdout.endswith(f"Wrote {target}\n")
    begin = {"png": b"\x89PNG", "svg": b"<?xml", "pdf": b"%PDF"}[ending]
    assert target.read_bytes().startswith(begin)


REFUSED = {
    "grid.nc --plot a.gif": "--plot a.gif: must end in .png, .svg, .pdf",
    "half.nc.partial --plot a.png": "half.nc.partial: is not finished; `pindrive sweep --resume` "
    "continues it",
    "none.nc --plot a.png": "none.nc: cannot be read: No such file or directory",
    "grid.toml --plot a.png": "grid.toml: cannot be read: ",
    "alien.nc --plot a.png": "alien.nc: is not a study; `pindrive sweep` writes one",
    "one.nc --plot a.png": "one.nc: holds a single point, there is nothing to draw over",
    "grid.nc --plot a.png --x mass": "--x mass: grid.nc does not vary it; there are ",
    "grid.nc --plot a.png --x stifness": "--x stifness: grid.nc does not vary it; did you mean "
    "stiffness?",
    "grid.nc --plot a.png --number heat": "--number: unknown number heat; ",
    "grid.nc --plot a.png --number peak_stretch": "--number peak_stretch: grid.nc does not hold it",
    "grid.nc --plot a.png --at mass": '--at "mass": must be key=value',
    "grid.nc --plot a.png --at plate.kinetic=5": "--at plate.kinetic: must be a number with",
    "grid.nc --plot a.png --x mouse_velocity --y mouse_velocity": "--y mouse_velocity: does not "
    "change independently of mouse_velocity",
    "drawn.nc --plot a.png --at mass=1g": "--at mass: is sampled, and cannot be held at one value",
}


@pytest.mark.parametrize("arguments", REFUSED)
def test_refusals(folder: Path, monkeypatch: pytest.MonkeyPatch, arguments: str) -> None:
    monkeypatch.chdir(folder)
    xr.Dataset({"a": 1.0}).to_netcdf("alien.nc", engine="h5netcdf")
    Path("half.nc.partial").write_bytes(Path("one.nc").read_bytes())
    before = {path.name for path in folder.iterdir()}
    said = run(*arguments.split())
    assert (said.exit_code, said.stdout) == (2, "")
    assert said.stderr.startswith(REFUSED[arguments]), said.stderr
    assert len(said.stderr.splitlines()) == 1
    assert {path.name for path in folder.iterdir()} == before


@pytest.mark.usefixtures("in_empty_folder")
def test_a_number_that_is_the_same_everywhere_has_one_colour() -> None:
    """In every panel, and at the middle of the scale."""
    grid = """
[axes]
mouse_velocity = ["20 mm/s", "30 mm/s"]
drive.stiffness = ["100 N/m", "200 N/m"]
damping_ratio = [0.1, 0.2, 0.3]
"""
    Path("study.toml").write_text(BASE + grid)
    sweep(load_study("study.toml"), Path("study.nc"))
    with Slice("study.nc") as view:
        number = "transient_plate_peak_force"
        figure = plot_study(view, [number], *view.axes("mouse_velocity", "stiffness", {}), {})
    meshes = [
        mesh for axes in figure.axes for mesh in axes.collections if isinstance(mesh, QuadMesh)
    ]
    assert len(meshes) >= 3
    assert {mesh.get_clim() for mesh in meshes[:3]} == {meshes[0].get_clim()}
    low, high = meshes[0].get_clim()
    assert low < float(np.asarray(meshes[0].get_array()).flat[0]) < high
