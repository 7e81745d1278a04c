"""Margins of designs: ends of the way of each variable, designs that keep one, digits, ties."""

from __future__ import annotations

from itertools import product
from math import isclose
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import pindrive as pd
from design_problems import MOUSE, SMALL
from pindrive.optimisation import Design, Effort
from pindrive.optimisation.goals import Variable
from pindrive.optimisation.margins import WORSE
from pindrive.optimisation.rounding import rounded
from pindrive.study.distributions import Distribution

Array = NDArray[np.float64]
PROBLEM: dict[str, Any] = {
    "axes": {
        "drive.stiffness": {"uniform": ["50 N/m", "200 N/m"]},
        "drive.damping_ratio": {"uniform": [0.05, 0.6]},
    },
    "specification": {"peak_displacement": ">= 2.1 mm"},
    "goals": {"minimise": "settling_time"},
}


@pytest.fixture(scope="module")
def found() -> Design:
    return pd.optimise(pd.load_device(MOUSE), PROBLEM, effort=SMALL)


def numbers(stiffness: Any, ratio: Any) -> tuple[Array, Array]:
    """Settling time and peak, by `simulate_batch` alone."""
    device = pd.load_device(MOUSE)
    k, z = np.broadcast_arrays(np.asarray(stiffness, np.float64), ratio)
    data = pd.simulate_batch(
        device.drive,
        device.release,
        stiffness=k,
        damping=2.0 * z * np.sqrt(device.drive.mass * k),
        outputs=["transient_settling_time", "transient_peak_displacement"],
    )
    time, peak = data.transient_settling_time.values, data.transient_peak_displacement.values
    return np.where(np.isnan(time), np.inf, time), peak


def well(found: Design, key: str, value: float) -> bool:
    """Return True if a design with another value of one key is as good."""
    values = {**found.values, key: value}
    time, peak = numbers(values["drive.stiffness"], values["drive.damping_ratio"])
    return bool(
        time <= (1.0 + WORSE) * found.goals[0].value * (1.0 + 1e-9)
        and peak >= 2.1e-3 * (1.0 - 1e-9)
    )


def test_a_variable_may_move_to_its_margins_and_no_further(found: Design) -> None:
    assert [next(iter(m.variable.axes)) for m in found.margins] == list(PROBLEM["axes"])
    ended = 0
    for margin in found.margins:
        key = next(iter(margin.variable.axes))
        assert margin.value == pytest.approx(found.values[key], rel=1e-12)
        for end in (margin.below, margin.above):
            inside = margin.value + np.linspace(0.0, 1.0, 201) * (end.value - margin.value)
            assert all(well(found, key, value) for value in inside)
            if end.number is None:
                continue
            ended += 1
            span = next(iter(margin.variable.axes.values())).span
            beyond = end.value + np.sign(end.value - margin.value) * 1e-6 * (span[1] - span[0])
            assert not well(found, key, beyond)
            time, peak = numbers(
                *(
                    {**found.values, key: beyond}[k]
                    for k in ("drive.stiffness", "drive.damping_ratio")
                )
            )
            reached = time if end.number.name == "transient_settling_time" else peak
            assert end.reached == pytest.approx(float(reached), rel=5e-3)
            if end.number.name == "transient_settling_time":
                assert end.jumps == (not end.reached <= 1.055 * found.goals[0].value)
    assert ended >= 2
    assert min(margin.part for margin in found.margins) < 0.01  # the best is beside a jump


def test_the_design_with_a_margin_is_as_good_wherever_its_variables_are(found: Design) -> None:
    steady = found.steady
    assert steady is not None
    k, z = (steady.values[key] for key in PROBLEM["axes"])
    off = np.random.default_rng(4).uniform(-steady.margin, steady.margin, (2, 4000))
    time, peak = numbers(k * (1.0 + off[0]), z * (1.0 + off[1]))
    assert peak.min() >= 2.1e-3
    assert time.max() <= 1.01 * steady.goals[0]
    assert steady.goals[0] >= found.goals[0].value
    assert steady.device.drive.stiffness == k


def test_the_design_with_a_margin_is_the_best_of_a_grid(found: Design) -> None:
    assert found.steady is not None
    k, z = np.meshgrid(np.linspace(50.0, 200.0, 151), np.linspace(0.05, 0.6, 111), indexing="ij")
    longest, least = np.zeros(k.shape), np.full(k.shape, np.inf)
    for a, b in product(np.linspace(-0.01, 0.01, 5), repeat=2):
        time, peak = numbers(k * (1.0 + a), z * (1.0 + b))
        longest, least = np.maximum(longest, time), np.minimum(least, peak)
    best = longest[least >= 2.1e-3].min()
    assert found.steady.goals[0] <= 1.01 * best


def test_printed_digits_give_the_printed_goal(found: Design, tmp_path: Path) -> None:
    """Read from the table of a report, and from the file."""
    from rich.console import Console

    from pindrive.cli.design_tables import design_report
    from pindrive.optimisation.results import designed_file, shown

    text = tmp_path / "report.txt"
    with text.open("w", encoding="utf-8") as file:
        Console(file=file, width=120).print(design_report(found))
    rows = [line.split() for line in text.read_text("utf-8").splitlines()]
    printed = {row[0]: row[1] for row in reversed(rows) if len(row) > 1}
    k, z = (float(printed[key]) for key in PROBLEM["axes"])
    time, peak = numbers(k, z)
    name, value = "transient_settling_time", found.goals[0].value
    assert shown(name, float(time)) == shown(name, value) and peak >= 2.1e-3
    assert max(len(printed[key].replace(".", "").lstrip("0")) for key in PROBLEM["axes"]) <= 6
    path = tmp_path / "device.toml"
    path.write_text(designed_file(found, path), "utf-8")
    device = pd.load_device(path)
    assert device.drive.stiffness == k
    settled = pd.simulate(device.drive, device.release).transient.settling_time
    assert isclose(float(settled), value, rel_tol=1e-9)


@pytest.mark.parametrize(("slope", "digits"), [(0.0, 3), (2.0, 4), (300.0, 6)])
def test_digits_are_as_many_as_the_goal_needs(slope: float, digits: int) -> None:
    """A goal that grows with the distance from its best place."""
    axis = Distribution("uniform", 50.0, 200.0)
    variable = Variable("drive.stiffness", {"drive.stiffness": axis})
    space: Any = SimpleNamespace(variables=(variable,), scans=False, slow=False)
    best = (123.456789 - 50.0) / 150.0

    def worth(points: Array) -> tuple[Array, Array]:
        return 1.0 + slope * abs(points - best), np.zeros(len(points))

    (part,) = rounded(space, worth, np.array([best]), lambda _: True)
    value = float(variable.columns(part)["drive.stiffness"])
    assert float(f"{value:.{digits}g}") == pytest.approx(value, rel=1e-14)
    assert float(f"{value:.{digits - 1}g}") != pytest.approx(value, rel=1e-14)
    assert rounded(space, worth, np.array([best]), lambda _: False) == best


def test_equal_parts_fall_to_the_second_goal_or_to_the_price(tmp_path: Path) -> None:
    """Springs of one stiffness and three prices, dearest first."""
    rows = [("K", 100.0, 3.0), ("L", 100.0, 1.0), ("M", 100.0, 2.0), ("N", 200.0, 0.5)]
    text = "part,drive.stiffness [N/m],price\n" + "".join(f"{a},{b},{c}\n" for a, b, c in rows)
    (tmp_path / "springs.csv").write_text(text, "utf-8")
    problem: dict[str, Any] = {
        "catalogues": {"spring": str(tmp_path / "springs.csv")},
        "axes": {"drive.damping_ratio": {"uniform": [0.05, 0.6]}},
        "specification": {"peak_displacement": ">= 2.05 mm"},
        "goals": {"minimise": ["settling_time", "price"]},
    }
    device = pd.load_device(MOUSE)
    effort = Effort(1 << 10, 32, 40, 64, 0, 100)
    both = pd.optimise(device, problem, effort=effort)
    assert both.front is not None
    prices = both.front.goals[:, 1]
    assert set(prices) <= {0.5, 1.0} and len(np.unique(both.front.goals, axis=0)) == len(prices)
    problem["goals"] = {"minimise": "settling_time"}
    problem["specification"] = {"peak_displacement": ">= 2.05 mm", "price": ">= 0.6"}
    assert pd.optimise(device, problem, effort=effort).parts == {"spring": "L"}
