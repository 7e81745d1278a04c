"""The tables of studies: each cell is the number of its row, key, order and sign."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from pindrive.cli.study_tables import (
    QUANTILES,
    count,
    percent,
    robustness_report,
    sobol_report,
)
from pindrive.quantities.names import label
from pindrive.study.outputs import NUMBERS
from pindrive.study.robustness import Robustness, robustness
from pindrive.study.sensitivity import SobolIndices, sobol
from pindrive.study.slices import elasticity
from pindrive.study.spec import load_study
from pindrive.study.study import Study
from table_reading import numbers, printed, table

STUDY = Path(__file__).parents[2] / "examples" / "tactile-mouse-study.toml"
OVER = "Over the whole ranges: part of the variance due to, "


@pytest.fixture(scope="module")
def found() -> SobolIndices:
    return sobol(load_study(STUDY), tolerances=True, rows=128, near=True)


@pytest.fixture(scope="module")
def plan(tmp_path_factory: pytest.TempPathFactory) -> Study:
    file = tmp_path_factory.mktemp("tables") / "study.toml"
    file.write_text(
        f'base = "{(Path(__file__).parents[1] / "minimal.toml").as_posix()}"\n'
        '[tolerances]\nmass = { normal = "4 %" }\nplate.kinetic = "30 %"\n'
        '[specification]\nswing = [">= 0.9 mm", "<= 0.95 mm"]\nsettling_time = "<= 0.1 s"\n'
    )
    return load_study(file)


@pytest.fixture(scope="module")
def scattered(plan: Study) -> Robustness:
    return robustness(plan, count=1000)


def test_elasticities_have_their_signs(found: SobolIndices) -> None:
    heads, *rows = table(sobol_report(found), "Near the device's values")
    assert heads == ["number", "F_p", "F_f", "m", "k", "ζ", "v_p"]
    assert found.near is not None
    named = {label(name): name for name in found.over}
    signs = set()
    for first, *cells in rows:
        for key, cell in zip(found.keys, cells, strict=True):
            value = found.near.table[named[first]][key]
            if np.isnan(value):
                assert cell == "-"
            elif abs(value) < 0.005:
                assert cell == "·"
            else:
                assert float(cell) == pytest.approx(value, abs=0.00501)
                signs.add(cell[0])
    assert signs == {"+", "-"}
    assert elasticity(-0.567) == "-0.57" and elasticity(0.567) == "+0.57"


@pytest.mark.parametrize(
    ("order", "title"), [("first", "by itself"), ("total", "with all interactions")]
)
def test_indices_stand_under_their_order(found: SobolIndices, order: str, title: str) -> None:
    heads, *rows = table(sobol_report(found), OVER + title)
    assert heads == ["number", "F_p", "F_f", "m", "k", "ζ", "v_p"]
    named = {label(name): name for name in found.over}
    compared = 0
    for first, *cells in rows:
        interval = getattr(found.over[named[first]], order)
        for i, cell in enumerate(cells):
            if cell not in ("-", "·"):
                shown, half = numbers(cell.replace("±.", "±0."))
                assert shown == pytest.approx(max(interval.value[i], 0.0), abs=0.00501)
                width = interval.high[i] - interval.low[i]
                assert half == pytest.approx(0.5 * width, abs=0.00501)
                compared += 1
    assert compared > 30


def test_quantiles_of_the_designs(scattered: Robustness, plan: Study) -> None:
    heads, *rows = table(robustness_report(plan, scattered), "Quantiles of the designs")
    assert heads == ["number", "design", "1 %", "5 %", "50 %", "95 %", "99 %", "unit", "exists in"]
    for row in rows:
        (name,) = (name for name in scattered.values if label(name) == row[0])
        scale = NUMBERS[name].display_scale
        values = scattered.values[name]
        expected = [scattered.own[name], *np.quantile(values[np.isfinite(values)], QUANTILES)]
        shown = [float(cell) for cell in row[1:7]]
        assert shown == pytest.approx([scale * x for x in expected], rel=1e-3)
        assert (
            row[7] == NUMBERS[name].display_unit == {"swing": "mm", "settling_time": "ms"}[row[0]]
        )
        assert row[8] == "all"


def test_the_yield(scattered: Robustness, plan: Study) -> None:
    _, *rows, total = table(robustness_report(plan, scattered), "Yield: of 1 000 designs")
    limits = {"swing ≥ 0.9 mm": True, "swing ≤ 0.95 mm": False, "settling_time ≤ 100 ms": False}
    values = scattered.values
    for row, (constraint, share) in zip(rows, scattered.shares, strict=True):
        assert row[0] in limits
        limit, at_least = numbers(row[0])[0] / 1e3, limits[row[0]]
        met = values[constraint.name] >= limit if at_least else values[constraint.name] <= limit
        assert float(row[1].removesuffix(" %")) == pytest.approx(100.0 * met.mean())
        low, high = numbers(row[2])
        assert low == pytest.approx(100.0 * share.low, abs=5e-4)
        assert high == pytest.approx(100.0 * share.high, abs=5e-4)
        assert row[3] == "none"
    swing, time = values["transient_swing"], values["transient_settling_time"]
    every = (swing >= 0.9e-3) & (swing <= 0.95e-3) & (time <= 0.1)
    assert total[0] == "all"
    assert float(total[1].removesuffix(" %")) == pytest.approx(100.0 * every.mean())


def test_worst_cases(scattered: Robustness, plan: Study) -> None:
    heads, *rows = table(robustness_report(plan, scattered), "The worst found for")
    assert heads == ["key", "design", "swing", "swing", "settling_time", "unit"]
    found = {row[0]: row for row in rows}
    assert found["drive.mass"][1] == "10.00" and found["drive.mass"][5] == "g"
    assert found["plate.kinetic"][1] == "20.00" and found["plate.kinetic"][5] == "mN"
    for i, case in enumerate(scattered.worst):
        for key, scale in (("drive.mass", 1e3), ("plate.kinetic", 1e3)):
            assert float(found[key][2 + i]) == pytest.approx(scale * case.keys[key], rel=1e-3)
        assert numbers(found["gives"][2 + i]) == pytest.approx([1e3 * case.value], rel=1e-3)
        drawn = numbers(found["among the draws"][2 + i])
        assert drawn == pytest.approx([1e3 * case.sampled], rel=1e-3)
    said = printed(robustness_report(plan, scattered))
    commands = re.findall(
        r"Worst (\w+): pindrive simulate .* --set drive.mass=\"([\d.]+) g\"", said
    )
    masses = [(label(c.constraint.name), 1e3 * c.keys["drive.mass"]) for c in scattered.worst]
    assert [name for name, _ in commands] == [name for name, _ in masses]
    assert [float(mass) for _, mass in commands] == pytest.approx([mass for _, mass in masses])


def test_counts_and_parts() -> None:
    assert count(10_000_000) == "10 000 000"
    assert [percent(*x) for x in ((0, 8), (8, 8), (1, 8))] == ["none", "all", "12.5 %"]
    assert percent(99_999, 100_000) == "all but 1"
