"""The chart of what matters: each cell and bar is the number, of that row, key, order and sign."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from figure_reading import collisions, legend_of
from pindrive.plot.sensitivity import _BAR, _FIRST, _TOTAL, plot_sobol_indices
from pindrive.plot.style import PALETTE
from pindrive.study.sensitivity import SobolIndices, sobol
from pindrive.study.slices import symbol, words
from pindrive.study.spec import load_study

STUDY = Path(__file__).parents[2] / "examples" / "tactile-mouse-study.toml"
KEYS = ("plate_kinetic", "finger_kinetic", "mass", "stiffness", "damping_ratio", "mouse_velocity")


@pytest.fixture(scope="module")
def found() -> SobolIndices:
    return sobol(load_study(STUDY), tolerances=True, rows=128, near=True)


@pytest.fixture(scope="module")
def figure(found: SobolIndices) -> Figure:
    return plot_sobol_indices(found, "a name")


def rows(figure: Figure) -> list[str]:
    return [label.get_text() for label in figure.axes[0].get_yticklabels()]


def named(found: SobolIndices) -> dict[str, str]:
    return {words(name): name for name in found.over}


def test_rows_and_columns_are_named(found: SobolIndices, figure: Figure) -> None:
    for axes in figure.axes:
        assert [label.get_text() for label in axes.get_xticklabels()] == [symbol(k) for k in KEYS]
    assert [key.partition(".")[2] for key in found.keys][2:] == list(KEYS[2:])
    assert rows(figure)[0] == "peak displacement" and "settling time" in rows(figure)
    low, high = figure.axes[0].get_ylim()
    assert low > high, "the first row is the uppermost"
    near, over = figure.axes
    assert near.get_title() == "near: % of change for 1 % more of"
    assert over.get_title() == "over the ranges: part of the variance due to"


def test_elasticities_are_written_with_their_signs(found: SobolIndices, figure: Figure) -> None:
    axes = figure.axes[0]
    assert found.near is not None
    written = {text.get_position(): text.get_text() for text in axes.texts}
    (image,) = axes.images
    colours = image.get_array()
    assert colours is not None
    signs = set()
    for row, label in enumerate(rows(figure)):
        for column, key in enumerate(found.keys):
            value = found.near.table[named(found)[label]][key]
            text = written[column, row]
            if np.isnan(value):
                assert text == "−"
                continue
            assert np.sign(colours[row, column]) == np.sign(value)
            if abs(value) < 0.005:
                assert text == "·"
            else:
                assert text[0] == ("+" if value > 0.0 else "−")
                assert float(text.replace("−", "-")) == pytest.approx(value, abs=0.005)
                signs.add(text[0])
    assert signs == {"+", "−"}
    assert image.get_clim() == (-1.0, 1.0)
    assert to_hex(image.cmap(1.0)) == to_hex(PALETTE["curve"]), "blue: it grows"
    assert to_hex(image.cmap(0.0)) == to_hex(PALETTE["stick"]), "orange: it falls"
    assert axes.get_xlabel() == "blue: it grows, orange: it falls\n·: below 0.005, −: none"


def bars(axes: Axes, colour: str) -> dict[tuple[int, int], Any]:
    """By row and column."""
    return {
        (round(bar.get_y() + 0.5 * bar.get_height()), round(bar.get_x() + 0.5 * _BAR)): bar  # type: ignore[attr-defined]
        for bar in axes.patches
        if to_hex(bar.get_facecolor()) == to_hex(colour)
    }


def test_bars_are_the_indices_in_their_order(found: SobolIndices, figure: Figure) -> None:
    axes = figure.axes[1]
    differ = 0
    for row, label in enumerate(rows(figure)):
        indices = found.over[named(found)[label]]
        for order, colour in (("first", _FIRST), ("total", _TOTAL)):
            values = getattr(indices, order).value
            drawn = bars(axes, colour)
            for column, value in enumerate(values):
                if not np.isnan(indices.total.value[column]):
                    length = drawn[row, column].get_width() / _BAR
                    assert length == pytest.approx(np.clip(value, 0.0, 1.15))
                    assert drawn[row, column].get_x() == pytest.approx(column - 0.5 * _BAR)
        differ += int((indices.total.value - indices.first.value > 0.1).sum())
    assert differ > 10, "the orders are told apart"
    first, total = bars(axes, _FIRST), bars(axes, _TOTAL)
    assert all(first[at].get_height() < total[at].get_height() for at in first)
    signs = legend_of(figure)
    assert to_hex(signs["by itself"].get_facecolor()) == to_hex(_FIRST)
    assert to_hex(signs["with interactions"].get_facecolor()) == to_hex(_TOTAL)


def test_intervals_are_those_of_the_total(found: SobolIndices, figure: Figure) -> None:
    assert "95 % interval of the latter" in legend_of(figure)
    row = rows(figure).index("settling time")
    total = found.over["transient_settling_time"].total
    expected = np.clip([total.low, total.high], 0.0, 1.15).T
    every: list[Any] = [c for c in figure.axes[1].collections if c.get_gid() == "interval"]
    segments = [lines.get_segments()[0] for lines in every]
    ends = sorted((s for s in segments if s[0, 1] == row), key=lambda segment: segment[0, 0])
    for column, (segment, interval) in enumerate(zip(ends, expected, strict=True)):
        shown = [(x - column) / _BAR + 0.5 for x in segment[:, 0]]
        assert shown == pytest.approx(interval, abs=1e-9)


def test_bars_have_a_scale(figure: Figure) -> None:
    (scale,) = figure.axes[1].child_axes
    labels = [label.get_text() for label in scale.get_xticklabels()]
    assert labels == ["0", "½", "1"] * len(KEYS)
    parts = {"0": 0.0, "½": 0.5, "1": 1.0}
    expected = [
        column + _BAR * (parts[label] - 0.5)
        for column in range(len(KEYS))
        for label in ("0", "½", "1")
    ]
    assert scale.get_xticks() == pytest.approx(expected)


def test_words_do_not_overlap(found: SobolIndices) -> None:
    figure = plot_sobol_indices(found, "1 $ and 2 $: " + "a long name " * 12)
    assert collisions(figure) == []
    assert figure.texts[0].get_window_extent().x1 < figure.bbox.x1
    assert r"$F_\mathrm{p}$ 15.4 … 28.6 mN" in figure.get_suptitle()
