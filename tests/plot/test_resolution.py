"""The picture of how fast a hand may move: each curve and area is the limit that it is named."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from figure_reading import Array, collisions, data, legend_of, lines, patch_spans, points
from pindrive.device import Criteria
from pindrive.evaluation.resolution import SpeedLimit
from pindrive.plot.resolution import plot_speeds

TRIED = (0.005, 1.0)


def limit(
    pitch: float, distinct: list[tuple[float, float]], settled: list[tuple[float, float]]
) -> SpeedLimit:
    return SpeedLimit(
        pitch=pitch,
        width=0.5 * pitch,
        tried=TRIED,
        distinct=tuple(distinct),
        settled=tuple(settled),
        beyond=None,
    )


LIMITS = [  # not in order
    limit(0.004, [(0.005, 0.4), (0.5, 0.6)], [(0.005, 0.25)]),
    limit(0.001, [(0.02, 0.1)], [(0.02, 0.07)]),
    limit(0.002, [(0.005, 0.2)], []),
]


@pytest.fixture(scope="module")
def figure() -> Figure:
    return plot_speeds(LIMITS, Criteria(distinct=0.4), "a $ mouse of 5 $")


def area(axes: Axes, gid: str) -> Array:
    """The highest place of an area over each pitch."""
    (found,) = (c for c in axes.collections if c.get_gid() == gid)
    corners = np.concatenate([path.vertices for path in found.get_paths()])
    return np.array([[x, corners[corners[:, 0] == x, 1].max()] for x in np.unique(corners[:, 0])])


def test_curves_are_the_limits(figure: Figure) -> None:
    (axes,) = figure.axes
    assert (axes.get_xlabel(), axes.get_ylabel()) == (
        "pitch of the lines (mm)",
        "hand speed (mm/s)",
    )
    pitch, distinct = data(axes, "distinct")
    assert pitch.tolist() == [1.0, 2.0, 4.0]
    assert distinct == pytest.approx([100.0, 200.0, 400.0])
    settled = data(axes, "settled")[1]
    np.testing.assert_allclose(settled, [70.0, np.nan, 250.0])
    assert data(axes, "slowest")[1] == pytest.approx([20.0, 0.0, 0.0])
    np.testing.assert_allclose(area(axes, "distinct")[:, 1], distinct)
    assert area(axes, "settled")[:, 1].max() == pytest.approx(250.0)
    (again,) = lines(axes, "again")
    assert points(again)[0].tolist() == [4.0, 4.0]
    assert points(again)[1] == pytest.approx([500.0, 600.0])


def test_each_sign_is_explained(figure: Figure) -> None:
    (axes,) = figure.axes
    signs = legend_of(figure)
    for words, gid in (
        ("distinct: back by 40% in between", "distinct"),
        ("settled in between, too", "settled"),
        ("not distinct below", "slowest"),
        ("distinct again", "again"),
    ):
        (line,) = lines(axes, gid)
        handle = signs[words]
        assert handle.get_marker() == line.get_marker()
        assert handle.get_linestyle() == line.get_linestyle()
        assert handle.get_linewidth() == line.get_linewidth()
    ((_, _, low, high),) = patch_spans(axes, "hands")
    assert (low, high) == (20.0, 100.0)
    assert "hands in finger studies" in signs
    assert len(signs) == 5
    assert collisions(figure) == []


def test_title_names_study_and_method(figure: Figure) -> None:
    title = figure.get_suptitle()
    assert title.startswith(r"Largest hand speed: a \$ mouse of 5 \$")
    assert "at least 40% of its way" in " ".join(title.split())


def test_pitch_without_distinct_lines_has_no_curve() -> None:
    figure = plot_speeds([limit(0.001, [], [])], Criteria())
    (axes,) = figure.axes
    assert {line.get_gid() for line in axes.lines} == set()
    assert [text.get_text() for text in axes.texts] == ["at no speed distinct"]
    assert list(legend_of(figure)) == ["hands in finger studies"]
