"""Points that meet the specification of a study: counts, and shading in maps."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from matplotlib.contour import ContourSet
from numpy.typing import NDArray

from command import run
from figure_reading import legend_of
from pindrive.plot.slices import plot_study
from pindrive.study.outputs import points_that_meet
from pindrive.study.slices import Slice

BASE = f'base = "{(Path(__file__).parents[1] / "minimal.toml").as_posix()}"\n'
GRID = """
outputs = ["swing"]
[axes]
mouse_velocity = { lin = ["20 mm/s", "300 mm/s"], count = 15 }
plate.kinetic = ["0 mN", "5 mN", "10 mN", "15 mN", "20 mN"]
plate.static = ["18 mN"]
[specification]
settling_time = "<= 120 ms"
finger_reversals = "<= 6"
"""
DRAWN = """
[axes]
mass = { uniform = ["5 g", "20 g"] }
plate.kinetic = ["5 mN", "20 mN"]
[sample]
count = 400
[specification]
settling_time = "<= 150 ms"
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("specification")
    for name, text in (("grid", GRID), ("drawn", DRAWN)):
        (made / f"{name}.toml").write_text(BASE + text)
    return made


@pytest.fixture(scope="module")
def swept(folder: Path) -> str:
    done = run("sweep", folder / "grid.toml", "-o", folder / "grid.nc")
    assert done.exit_code == 0, done.output
    assert run("sweep", folder / "drawn.toml", "-o", folder / "drawn.nc").exit_code == 0
    return done.stdout


@pytest.fixture
def data(folder: Path, swept: str) -> Iterator[xr.Dataset]:
    with xr.open_dataset(folder / "grid.nc", engine="h5netcdf") as opened:
        yield opened


def meets(data: xr.Dataset) -> NDArray[np.bool_]:
    """By xarray, which reads a missing count as NaN."""
    quick = (data.transient_settling_time <= 0.12).values
    few = (data.transient_finger_reversals <= 6).values
    return np.asarray(quick & few & (data.status == 0).values)


def test_a_sweep_counts_the_points_that_meet_it(folder: Path, swept: str, data: xr.Dataset) -> None:
    """Constrained numbers are kept without being outputs; rejected points do not count."""
    met, exist = int(meets(data).sum()), int((data.status == 0).sum())
    assert 0 < met < exist < data.status.size
    assert points_that_meet(folder / "grid.nc") == (met, exist)
    share = f"{100.0 * met / exist:.1f} %"
    assert f"specification met: {share} of {exist} points that exist\n" in swept


def test_a_map_shades_and_prints_where_it_is_met(
    folder: Path, data: xr.Dataset, tmp_path: Path
) -> None:
    with Slice(folder / "grid.nc") as view:
        axes = view.axes(None, None, {})
        (panel,) = view.panels("transient_swing", *axes, {})
        expected = meets(data).squeeze().T.astype(float)
        assert panel.met is not None and panel.met.shape == (5, 15)
        assert (panel.met == expected).all()
        figure = plot_study(view, ["transient_swing"], *axes, {})
    (shaded,) = [
        c for c in figure.axes[0].collections if isinstance(c, ContourSet) and c.get_gid() == "met"
    ]
    assert shaded.hatches == ["..."]
    inside = shaded.get_paths()[0]
    for i, x in enumerate(1e3 * panel.along[1]):
        for j, y in enumerate(1e3 * panel.along[0]):
            if panel.met[max(0, j - 1) : j + 2, max(0, i - 1) : i + 2].all():
                assert inside.contains_point((x, y), radius=1e-9) or i in (0, 14) or j in (0, 4)
            if not panel.met[j, i]:
                assert not inside.contains_point((x, y))
    assert "the specification is met" in legend_of(figure)
    done = run("map", folder / "grid.nc", "--number", "swing", "--plot", tmp_path / "map.png")
    met, exist = int(meets(data).sum()), int((data.status == 0).sum())
    assert f"specification met: {100.0 * met / exist:.1f} % of {exist} points" in done.stdout


def test_curves_are_wide_where_it_is_met(folder: Path, data: xr.Dataset) -> None:
    with Slice(folder / "grid.nc") as view:
        figure = plot_study(view, ["transient_swing"], "mouse_velocity", "", {})
    wide = [line for line in figure.axes[0].lines if line.get_gid() == "met"]
    expected = meets(data).squeeze()
    drawn = [np.isfinite(np.asarray(line.get_ydata(), float)) for line in wide]
    assert [d.tolist() for d in drawn] == [e.tolist() for e in expected.T if e.any()]


def test_draws_count_by_the_part_that_meets_the_specification(folder: Path, swept: str) -> None:
    with Slice(folder / "drawn.nc") as view:
        (panel,) = view.panels("transient_settling_time", "plate_kinetic", "", {})
        with xr.open_dataset(folder / "drawn.nc", engine="h5netcdf") as opened:
            met = (opened.transient_settling_time <= 0.15).transpose("plate_kinetic", "sample")
            assert panel.met == pytest.approx(met.values.mean(axis=1))
        (binned,) = view.panels(
            "transient_settling_time", "mass", "", view.held(["plate.kinetic=5 mN"])
        )
        assert binned.met is not None and ((binned.met >= 0.0) & (binned.met <= 1.0)).all()
        assert 0.0 < binned.met.mean() < 1.0
