"""The picture of scattering designs: bars, limits, quantiles and marks are what was found."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from figure_reading import collisions, legend_of, lines, patch_spans, points
from pindrive.plot.robustness import plot_designs, plot_robustness
from pindrive.plot.style import PALETTE
from pindrive.study.robustness import Robustness, robustness
from pindrive.study.spec import load_study

BASE = f'base = "{(Path(__file__).parents[1] / "minimal.toml").as_posix()}"\n'
TOLERANCES = """
[tolerances]
plate.kinetic = "30 %"
mass = { normal = "4 %" }
mouse_velocity = { uniform = ["80 mm/s", "130 mm/s"] }
"""
CONSTRAINTS = """
[specification]
swing = [">= 0.9 mm", "<= 1.2 mm"]
settling_time = "<= 1 s"
"""
COUNT = 2000


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> Robustness:
    file = tmp_path_factory.mktemp("robustness") / "study.toml"
    file.write_text(BASE + TOLERANCES + CONSTRAINTS)
    return robustness(load_study(file), count=COUNT)


@pytest.fixture(scope="module")
def figure(found: Robustness) -> Figure:
    return plot_robustness(found, "a name")


def of(figure: Figure, label: str) -> Axes:
    (axes,) = (axes for axes in figure.axes if axes.get_xlabel().startswith(label))
    return axes


def test_each_bar_is_as_high_as_its_designs_are_many(found: Robustness, figure: Figure) -> None:
    for label, name, unit in (
        ("swing", "transient_swing", "(mm)"),
        ("settling time", "transient_settling_time", "(ms)"),
    ):
        axes = of(figure, label)
        assert axes.get_xlabel().endswith(unit)
        bars = [p for p in axes.patches if p.get_gid() is None]
        values = 1e3 * found.values[name]
        edges = np.array([bar.get_x() for bar in bars] + [values.max()])  # type: ignore[attr-defined]
        heights = [bar.get_height() for bar in bars]  # type: ignore[attr-defined]
        assert heights == np.histogram(values, edges)[0].tolist()
        assert sum(heights) == COUNT
        assert (edges[0], edges[-1]) == pytest.approx((values.min(), values.max()))
        assert axes.get_ylim()[0] == 0.0 and axes.get_ylim()[1] > max(heights)
    assert figure.axes[0].get_ylabel() == f"designs of {COUNT:,}".replace(",", " ")


def test_quantiles_are_those_of_the_designs(found: Robustness, figure: Figure) -> None:
    drawn = {
        f"{line.get_linestyle()}{i}": points(line)[0][0]
        for i, line in enumerate(lines(of(figure, "swing"), "quantile"))
    }
    expected = np.quantile(1e3 * found.values["transient_swing"], (0.05, 0.5, 0.95))
    assert list(drawn) == [":0", "-1", ":2"], "the median is solid"
    assert list(drawn.values()) == pytest.approx(expected)


def test_points_outside_of_the_specification_are_shaded(figure: Figure) -> None:
    axes = of(figure, "swing")
    low, high = axes.get_xlim()
    below, above = sorted(patch_spans(axes, "beyond"))
    assert below[:2] == pytest.approx((low, 0.9)), "at least 0.9 mm are required"
    assert above[:2] == pytest.approx((1.2, high)), "and at most 1.2 mm"
    assert {span[2:] for span in (below, above)} == {(0.0, 1.0)}
    limits = sorted(points(line)[0][0] for line in lines(axes, "limit"))
    assert limits == pytest.approx([0.9, 1.2])


def test_distant_limit_is_reported_and_does_not_squeeze_the_designs(
    found: Robustness, figure: Figure
) -> None:
    axes = of(figure, "settling time")
    values = 1e3 * found.values["transient_settling_time"]
    high = axes.get_xlim()[1]
    assert values.max() < high < values.max() + 2.0 * np.ptp(values) < 1000.0
    assert [text.get_text() for text in axes.texts] == ["limit 1000 ms: off the axis"]
    ((begin, end, *_),) = patch_spans(axes, "beyond")
    assert high <= begin <= end, "all of the axis is within the specification"


def test_a_limit_that_all_designs_miss_shades_everything(found: Robustness) -> None:
    shares = tuple(
        (replace(constraint, limit=1e-6) if constraint.at_most else constraint, share)
        for constraint, share in found.shares
    )
    axes = of(plot_robustness(replace(found, shares=shares), "a name"), "settling time")
    ((begin, end, *_),) = patch_spans(axes, "beyond")
    low, high = axes.get_xlim()
    assert begin < low and high <= end


def test_the_design_and_the_worst_cases_are_marked(found: Robustness, figure: Figure) -> None:
    axes = of(figure, "swing")
    (design,) = lines(axes, "design")
    assert points(design)[0] == pytest.approx([1e3 * found.own["transient_swing"]])
    worst = [points(line)[0][0] for line in lines(axes, "worst")]
    cases = [case for case in found.worst if case.constraint.name == "transient_swing"]
    assert worst == pytest.approx([1e3 * case.value for case in cases])
    signs = legend_of(figure)
    assert signs["the design itself"].get_marker() == design.get_marker() == "^"
    assert signs["worst case found"].get_marker() == lines(axes, "worst")[0].get_marker()
    assert to_hex(signs["beyond the specification"].get_facecolor()) == to_hex(PALETTE["stick"])
    assert signs["median; 5 and 95 % (dotted)"].get_linestyle() == "-"


def test_title_has_yield_and_ranges(found: Robustness, figure: Figure) -> None:
    title = " ".join(figure.get_suptitle().split())
    assert found.all_met is not None
    assert f"a name: {found.all_met.text} of the designs have swing ≥ 0.9 mm and" in title
    assert r"$F_\mathrm{p}$ 14 … 26 mN, $m$ 8.8 … 11.2 g (3σ)" in title
    assert r"$v_\mathrm{p}$ 80 … 130 mm/s" in title


def test_missing_numbers_are_reported(found: Robustness) -> None:
    values = dict(found.values)
    some = values["transient_swing"].copy()
    some[: COUNT // 4] = np.nan
    changed = replace(found, values={**values, "transient_swing": some})
    figure = plot_robustness(changed, "1 $ and 2 $: " + "a long name " * 12)
    assert "25 % without" in {text.get_text() for text in of(figure, "swing").texts}
    assert collisions(figure) == []
    assert figure.texts[0].get_window_extent().x1 < figure.bbox.x1


def test_drawn_values_are_in_the_bars_of_their_outcome(found: Robustness) -> None:
    """Blue bars count the designs that meet the specification; red bars on top count all others."""
    figure = plot_designs(found, "a name")
    scales = {"drive.mass": 1e3, "motion.mouse_velocity": 1e3, "plate.kinetic": 1e3}
    assert found.drawn.keys() == scales.keys()
    for axes, (key, values) in zip(figure.axes, found.drawn.items(), strict=True):
        drawn = scales[key] * values
        bars: list[Any] = [*axes.patches]
        edges = [-np.inf, *(bar.get_x() for bar in bars[1 : len(bars) // 2]), np.inf]
        for color, chosen in (("curve", found.feasible), ("stick", ~found.feasible)):
            of_color = [b for b in bars if to_hex(b.get_facecolor()) == to_hex(PALETTE[color])]
            heights = [bar.get_height() for bar in of_color]
            assert heights == np.histogram(drawn[chosen], edges)[0].tolist()
    assert [*legend_of(figure)] == ["meets the specification", "violates the specification"]
